//! The viewer as the program of a window.

use crate::{
    app::App,
    cli::Cli,
    script::Script,
    window::{Next, Program},
    worker::{self, Content, Engine},
};
use anyhow::Result;
use std::{path::PathBuf, sync::Arc, time::Duration};
use winit::event_loop::EventLoopProxy;

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

/// The state of the viewer, and what it does by itself.
pub(crate) struct Viewing {
    app: App,
    script: Script,
}

impl Viewing {
    pub(crate) fn new(cli: Cli, proxy: EventLoopProxy<Message>) -> Result<Self> {
        let script = Script::new(&cli);
        Ok(Self { app: App::new(cli, worker::spawn(proxy)?)?, script })
    }
}

impl Program for Viewing {
    type Message = Message;

    fn show(&mut self, ui: &mut egui::Ui) {
        self.app.show(ui);
    }

    fn receive(&mut self, message: Message, context: &egui::Context) -> Next {
        let is_over = matches!(&message, Message::Saved(saved) if self.script.is_over(saved));
        self.app.receive(message, context);
        if is_over { Next::End } else { Next::Again }
    }

    fn after_frame(&mut self) -> Result<Next> {
        let wants_another = self.script.after_frame(&mut self.app)?;
        Ok(if wants_another { Next::Again } else { Next::Wait })
    }

    fn new_title(&mut self) -> Option<String> {
        self.app.new_title()
    }

    fn note_work(&mut self, took: Duration) {
        self.app.note_work(took);
    }

    fn open(&mut self, path: &str) {
        self.app.open(path);
    }
}
