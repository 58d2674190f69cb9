//! The window: events in, paint out.

use crate::{
    app::App,
    cli::Cli,
    script::Script,
    surface::Surface,
    theme,
    worker::{self, Content, Engine},
};
use anyhow::{Context, Result};
use egui::ViewportId;
use std::{
    path::PathBuf,
    process::ExitCode,
    sync::Arc,
    time::{Duration, Instant},
};
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::{StartCause, WindowEvent},
    event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy},
    window::WindowId,
};

/// What other threads tell the window.
#[derive(Debug)]
pub(crate) enum Message {
    Opened(Result<Arc<Content>>),
    Scaled(Result<Arc<Content>>),
    Started(Result<Engine>),
    Saved(Result<PathBuf>),
    /// There is something new on the desk.
    Drawn,
}

/// The window, before and after it is open.
pub(crate) struct Window {
    app: App,
    script: Script,
    size: (u32, u32),
    context: egui::Context,
    open: Option<Open>,
    result: Result<ExitCode>,
}

/// A window that is open.
struct Open {
    window: Arc<winit::window::Window>,
    surface: Surface,
    input: egui_winit::State,
    /// When egui wants to be asked again.
    due: Option<Instant>,
}

impl Window {
    pub(crate) fn new(cli: Cli, proxy: EventLoopProxy<Message>) -> Result<Self> {
        let context = egui::Context::default();
        theme::apply(&context);
        let (script, size) = (Script::new(&cli), cli.render.size);
        let app = App::new(cli, worker::spawn(proxy)?)?;
        Ok(Self { app, script, size, context, open: None, result: Ok(ExitCode::SUCCESS) })
    }

    /// How it went.
    pub(crate) fn result(self) -> Result<ExitCode> {
        self.result
    }

    fn create(&mut self, events: &ActiveEventLoop) -> Result<Open> {
        let attributes = winit::window::Window::default_attributes()
            .with_title("puncta")
            .with_inner_size(PhysicalSize::<u32>::from(self.size));
        let window = events.create_window(attributes).context("there can be no window")?;
        let window = Arc::new(window);
        let surface = Surface::new(events, &window)?;
        let input = egui_winit::State::new(
            self.context.clone(),
            ViewportId::ROOT,
            &window,
            None,
            None,
            Some(surface.side_max()),
        );
        Ok(Open { window, surface, input, due: None })
    }

    fn paint(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let size = open.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return;
        }
        let start = Instant::now();
        let input = open.input.take_egui_input(&open.window);
        let mut output = self.context.run_ui(input, |ui| self.app.show(ui));
        open.input.handle_platform_output_with_event_loop(
            &open.window,
            events,
            output.platform_output,
        );
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.app.note_work(start.elapsed());
        let is_painted =
            open.surface.paint(&shapes, &output.textures_delta, output.pixels_per_point);
        // They were applied, whether or not there was a surface to paint on.
        output.textures_delta.clear();
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        open.due = delay.and_then(|delay| start.checked_add(delay));
        if !is_painted || delay.is_some_and(|delay| delay.is_zero()) {
            open.window.request_redraw();
        }
        if let Some(title) = self.app.new_title() {
            open.window.set_title(&title);
        }
        if is_painted {
            match self.script.after_frame(&mut self.app) {
                Ok(false) => {}
                Ok(true) => open.window.request_redraw(),
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: anyhow::Error) {
        self.result = Err(error);
        events.exit();
    }
}

impl ApplicationHandler<Message> for Window {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.create(events) {
                Ok(open) => {
                    open.window.request_redraw();
                    self.open = Some(open);
                }
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, _: StartCause) {
        if let Some(open) = &mut self.open
            && open.due.is_some_and(|due| due <= Instant::now())
        {
            open.due = None;
            open.window.request_redraw();
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, message: Message) {
        if let Message::Saved(saved) = &message
            && self.script.is_over(saved)
        {
            events.exit();
        }
        self.app.receive(message, &self.context);
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::RedrawRequested => return self.paint(events),
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => open.surface.resize(size.width, size.height),
            WindowEvent::DroppedFile(ref path) => self.app.open(&path.to_string_lossy()),
            _ => {}
        }
        if open.input.on_window_event(&open.window, &event).repaint {
            open.window.request_redraw();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let due = self.open.as_ref().and_then(|open| open.due);
        // What is due long from now is not worth a clock that may not reach so far.
        let due = due.filter(|due| *due < Instant::now() + Duration::from_secs(3600));
        events.set_control_flow(due.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }
}
