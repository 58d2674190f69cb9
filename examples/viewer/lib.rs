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
//!
//! The tools that draw glyphs open windows of their own with `--window`: see [`glyphs`].

mod app;
mod asking;
mod camera;
mod cli;
mod drawing;
pub mod glyphs;
mod graph;
#[path = "../render/input.rs"]
#[allow(dead_code, reason = "it is shared with the example `render`, which uses all of it")]
mod input;
mod look;
#[path = "../render/options.rs"]
#[allow(dead_code, reason = "it is shared with the example `render`, which uses all of it")]
mod options;
mod pace;
mod panel;
mod picking;
mod pointer;
mod progress;
mod script;
mod stage;
mod surface;
mod theme;
#[path = "../render/view.rs"]
mod view;
mod viewing;
mod viewport;
mod window;
mod worker;

use anyhow::{Context, Result};
use std::{io::Write, process::ExitCode};

/// Reads the command line, and shows what it names until the window is closed.
pub fn main() -> ExitCode {
    match cli::parse().map_err(Into::into).and_then(run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nobody may be listening any more.
            writeln!(std::io::stderr(), "error: {error:#}").ok();
            ExitCode::FAILURE
        }
    }
}

fn run(cli: cli::Cli) -> Result<()> {
    if let Some(threads) = cli.render.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().context("cannot start the threads")?;
    }
    let size = cli.render.size;
    window::run(size, |proxy| viewing::Viewing::new(cli, proxy))
}
