//! The window: events in, paint out. What it shows is a [`Program`].

use crate::{surface::Surface, theme};
use anyhow::{Context, Result};
use egui::ViewportId;
use std::{
    fmt::Debug,
    sync::Arc,
    time::{Duration, Instant},
};
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::{StartCause, WindowEvent},
    event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy},
    window::WindowId,
};

/// What a window shows, and what it does with what it is told.
pub(crate) trait Program {
    /// What other threads tell the window.
    type Message: Debug + Send + 'static;

    /// Shows everything, and takes in what the user does.
    fn show(&mut self, ui: &mut egui::Ui);

    /// Takes in what another thread has to say. Another frame is shown in any case.
    fn receive(&mut self, message: Self::Message, context: &egui::Context) -> Next;

    /// Goes on after a frame was shown.
    fn after_frame(&mut self) -> Result<Next>;

    /// The title of the window, if there is a new one.
    fn new_title(&mut self) -> Option<String>;

    /// Notes how long the window took to make up what it paints.
    fn note_work(&mut self, _took: Duration) {}

    /// Takes a file that was dropped onto the window.
    fn open(&mut self, _path: &str) {}
}

/// What a window does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    /// Waits until something happens.
    Wait,
    /// Shows another frame.
    Again,
    /// Closes.
    End,
}

/// Opens a window of this size for a program, and returns when it is closed.
pub(crate) fn run<P: Program>(
    size: (u32, u32),
    start: impl FnOnce(EventLoopProxy<P::Message>) -> Result<P>,
) -> Result<()> {
    let events = EventLoop::with_user_event().build().context("there is no display")?;
    let context = egui::Context::default();
    theme::apply(&context);
    let program = start(events.create_proxy())?;
    let mut window = Window { program, size, context, open: None, result: Ok(()) };
    events.run_app(&mut window).context("the window is gone")?;
    window.result
}

/// The window, before and after it is open.
struct Window<P> {
    program: P,
    size: (u32, u32),
    context: egui::Context,
    open: Option<Open>,
    result: Result<()>,
}

/// A window that is open.
struct Open {
    window: Arc<winit::window::Window>,
    surface: Surface,
    input: egui_winit::State,
    /// When egui wants to be asked again.
    due: Option<Instant>,
}

impl<P: Program> Window<P> {
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
        let mut output = self.context.run_ui(input, |ui| self.program.show(ui));
        open.input.handle_platform_output_with_event_loop(
            &open.window,
            events,
            output.platform_output,
        );
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.program.note_work(start.elapsed());
        let is_painted =
            open.surface.paint(&shapes, &output.textures_delta, output.pixels_per_point);
        // They were applied, whether or not there was a surface to paint on.
        output.textures_delta.clear();
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        open.due = delay.and_then(|delay| start.checked_add(delay));
        if !is_painted || delay.is_some_and(|delay| delay.is_zero()) {
            open.window.request_redraw();
        }
        if let Some(title) = self.program.new_title() {
            open.window.set_title(&title);
        }
        if is_painted {
            match self.program.after_frame() {
                Ok(Next::Wait) => {}
                Ok(Next::Again) => open.window.request_redraw(),
                Ok(Next::End) => events.exit(),
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: anyhow::Error) {
        self.result = Err(error);
        events.exit();
    }
}

impl<P: Program> ApplicationHandler<P::Message> for Window<P> {
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

    fn user_event(&mut self, events: &ActiveEventLoop, message: P::Message) {
        if self.program.receive(message, &self.context) == Next::End {
            events.exit();
        }
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
            WindowEvent::DroppedFile(ref path) => self.program.open(&path.to_string_lossy()),
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
