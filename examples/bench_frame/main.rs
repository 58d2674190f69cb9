//! Measures what a frame costs before anything is drawn (culling, the occlusion graph, each order),
//! against the number of bricks, and what drawing costs after that.
//!
//! ```text
//! cargo run --release --example bench_frame -- --json out.json --plot out.svg
//! cargo run --release --example bench_frame -- --help
//! ```
//!
//! All parts take turns, so that a machine that is slower for a while is so for all of them. Times are
//! medians: on the clock at the wall, and the time of all processors divided by the number of threads,
//! which is the better figure where other programs are running. The graph has a plain twin, which is
//! measured in the same run. Table 5.1 of the thesis that puncta is built on stands beside.

mod case;
mod frame;
mod naive;
mod part;
mod plot;
mod report;
mod thesis;

#[path = "../convergence/clock.rs"]
mod clock;
#[path = "../render/input.rs"]
#[expect(dead_code, reason = "the tool `render` uses more of it")]
mod input;
#[path = "../render/options.rs"]
mod options;
#[path = "../convergence/order.rs"]
mod order;
#[path = "../render/progress.rs"]
mod progress;
#[path = "../render/view.rs"]
mod view;
#[path = "../convergence/world.rs"]
#[expect(dead_code, reason = "the tool `convergence` uses more of it")]
mod world;

use anyhow::{Context, Result, ensure};
use case::{Case, Dims};
use clap::Parser;
use std::{fs, io::Write, num::NonZero, path::PathBuf};

/// Measures culling, the occlusion graph and the orders against the number of bricks.
#[derive(Debug, Parser)]
#[command(name = "bench_frame", version)]
struct Options {
    /// Scenes to measure: files and generators, as in the tool `render`
    #[arg(default_values = ["hall:n=5000000", "cube:n=5000000"])]
    scenes: Vec<String>,
    /// Numbers of cells along the longest side of scenes
    #[arg(long, value_delimiter = ',', default_values = ["25", "50", "100", "150", "200"])]
    grids: Vec<NonZero<u32>>,
    /// Full blocks of bricks, one record in each
    #[arg(
        long,
        value_delimiter = ',',
        default_values = ["50x8x8", "100x16x16", "200x33x33", "64x64x64", "100x100x100"]
    )]
    blocks: Vec<Dims>,
    /// Measure no blocks
    #[arg(long)]
    no_blocks: bool,
    /// How often to measure each part
    #[arg(long, default_value_t = 15)]
    repetitions: usize,
    /// How often to measure what takes long: the plain twin, and drawing
    #[arg(long, default_value_t = 3)]
    slow_repetitions: usize,
    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x1024")]
    size: String,
    /// Number of threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Write all times here
    #[arg(long)]
    json: Option<PathBuf>,
    /// Write tables in Markdown here
    #[arg(long)]
    table: Option<PathBuf>,
    /// Write a plot here, as SVG
    #[arg(long)]
    plot: Option<PathBuf>,
}

fn main() {
    if let Err(error) = run(&Options::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<()> {
    ensure!(options.repetitions > 0 && options.slow_repetitions > 0, "nothing is to be measured");
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global()
        .context("cannot start the threads")?;
    let mut cases = Vec::new();
    let mut tell = |case: Case| {
        // Nobody may be listening any more; the files are written all the same.
        writeln!(std::io::stdout(), "{}", report::text(&case)).ok();
        cases.push(case);
    };
    let often = case::Often { parts: options.repetitions, slow: options.slow_repetitions };
    if !options.no_blocks {
        for dims in &options.blocks {
            tell(case::block(dims, &options.size, often)?);
        }
    }
    for scene in &options.scenes {
        case::scene(scene, (&options.size, &options.grids), often, &mut tell)?;
    }
    if let Some(path) = &options.json {
        let text = serde_json::to_string_pretty(&report::json(&cases))? + "\n";
        fs::write(path, text).with_context(|| path.display().to_string())?;
    }
    if let Some(path) = &options.table {
        fs::write(path, report::tables(&cases)).with_context(|| path.display().to_string())?;
    }
    match &options.plot {
        Some(path) => plot::write(&cases, path),
        None => Ok(()),
    }
}
