//! Shows a particle or point file, or a synthetic scene, in a window: exact pictures that follow
//! the mouse.
//!
//! ```text
//! cargo run --release --example viewer -- INPUT [options]
//! cargo run --release --example viewer -- --help
//! ```
//!
//! Three threads share the work, and the window waits for none of the others:
//!
//! * The **window thread** turns input into views (`camera.rs`) and paints what it has.
//! * The **drawing thread** of a [`puncta::Live`] draws the latest view, makes images of it and
//!   leaves them where the window finds them (`drawing.rs`).
//! * The **worker** does what takes long and is not drawing: reading, sorting, waking up a GPU
//!   (`worker.rs`).

mod app;
mod camera;
mod cli;
mod drawing;
mod graph;
#[path = "../render/input.rs"]
#[allow(dead_code, reason = "it is shared with the example `render`, which uses all of it")]
mod input;
mod look;
#[path = "../render/options.rs"]
#[allow(dead_code, reason = "it is shared with the example `render`, which uses all of it")]
mod options;
mod panel;
mod picking;
mod progress;
mod script;
mod stage;
mod surface;
mod theme;
#[path = "../render/view.rs"]
mod view;
mod viewport;
mod window;
mod worker;

use anyhow::{Context, Result};
use std::{io::Write, process::ExitCode};
use winit::event_loop::EventLoop;

/// Reads the command line, and shows what it names until the window is closed.
pub fn main() -> ExitCode {
    let code = cli::parse().map_err(Into::into).and_then(run);
    code.unwrap_or_else(|error: anyhow::Error| {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        ExitCode::FAILURE
    })
}

fn run(cli: cli::Cli) -> Result<ExitCode> {
    if let Some(threads) = cli.render.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().context("cannot start the threads")?;
    }
    let events = EventLoop::with_user_event().build().context("there is no display")?;
    let mut window = window::Window::new(cli, events.create_proxy())?;
    events.run_app(&mut window).context("the window is gone")?;
    window.result()
}
