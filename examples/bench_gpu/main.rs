//! Measures the strategies of the GPU renderer: set-ups against fragments, what skipping saves,
//! ways to bring records to the device, and how soon a new view is answered.
//!
//! ```text
//! cargo run --release --example bench_gpu -- --json out.json --plot out.svg > tables.md
//! cargo run --release --example bench_gpu -- --help
//! ```
//!
//! The tables are those of chapter 2.1 of the thesis that puncta is built on (2.1 to 2.8), and two
//! that it could not have: nothing is skipped there. What is compared takes turns, so that a
//! machine that is slower for a while is so for all of it. Times are medians: on the clock at the
//! wall, and of all processors of the machine, which for a device that is made of them is the
//! better figure where other programs are running.

mod latency;
mod memory;
mod place;
mod plot;
mod ring;
mod skipping;
mod strategies;
mod table;
mod uploads;
mod ways;

#[path = "../convergence/clock.rs"]
mod clock;
#[path = "../render/input.rs"]
#[expect(dead_code, reason = "the tool `render` uses more of it")]
mod input;
#[path = "../render/options.rs"]
mod options;
#[path = "../render/progress.rs"]
mod progress;
#[path = "../render/view.rs"]
mod view;
#[path = "../convergence/world.rs"]
#[expect(dead_code, reason = "the tool `convergence` uses more of it")]
mod world;

use anyhow::{Context, Result, ensure};
use clap::{Parser, ValueEnum};
use place::Place;
use puncta::{
    Gpu,
    gpu::{Extent, Fragment, Setup},
};
use serde_json::{Map, Value, json};
use std::{fs, io::Write, path::PathBuf};

/// Measures the strategies of the GPU renderer.
#[derive(Debug, Parser)]
#[command(name = "bench_gpu", version)]
pub(crate) struct Options {
    /// Scenes to draw: files and generators, as in the tool `render`
    #[arg(default_values = ["cube:n=1000000", "cube:n=10000000"])]
    scenes: Vec<String>,
    /// What to measure
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = Tables::ALL)]
    tables: Vec<Tables>,
    /// How spheres become fragments
    #[arg(long, value_delimiter = ',', default_values_t = Setup::ALL)]
    setups: Vec<Setup>,
    /// What fragments do
    #[arg(long, value_delimiter = ',', default_values_t = Fragment::ALL)]
    fragments: Vec<Fragment>,
    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x1024")]
    size: String,
    /// How often to measure each
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// After so many seconds, measure nothing again that was measured once
    #[arg(long, default_value_t = 30.0)]
    seconds: f64,
    /// Numbers of particles to bring for each frame
    #[arg(
        long,
        value_name = "N",
        value_delimiter = ',',
        default_values = ["5e5", "1e6", "2e6", "5e6", "1e7"],
        value_parser = count
    )]
    counts: Vec<usize>,
    /// How often to turn the view while a picture is drawn
    #[arg(long, default_value_t = 50)]
    turns: u32,
    /// The adapter whose name contains this; the best one by default
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// What to use of what the adapter has
    #[arg(long, value_enum, default_value_t = Use::Full)]
    extent: Use,
    /// Tell how far memory grows with one of the ways to bring particles, and nothing else
    #[arg(long, hide = true)]
    growth: Option<usize>,
    /// Write all times here
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
    /// Write a plot of the strategies here, as SVG
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

/// What can be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Tables {
    /// Set-ups against fragments, everything drawn
    #[value(alias = "1")]
    Strategies,
    /// Until a picture is settled, against drawing everything; and a second view
    #[value(alias = "2")]
    Skipping,
    /// Bringing particles for each frame
    #[value(alias = "3")]
    Uploads,
    /// How long a new view waits for an answer
    #[value(alias = "4")]
    Latency,
}

impl Tables {
    const ALL: [Self; 4] = [Self::Strategies, Self::Skipping, Self::Uploads, Self::Latency];
}

/// What is used of an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Use {
    /// What every WebGPU adapter has
    Core,
    /// Everything that makes drawing faster
    Full,
}

impl Use {
    const fn name(self) -> &'static str {
        match self {
            Self::Core => "core",
            Self::Full => "full",
        }
    }
}

fn main() {
    if let Err(error) = run(&Options::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<()> {
    ensure!(options.runs > 0 && options.turns > 0, "nothing is to be measured");
    let extent = if options.extent == Use::Core { Extent::Core } else { Extent::Full };
    let gpu = Gpu::new(options.adapter.as_deref(), extent)?;
    if let Some(place) = options.growth {
        tell(&uploads::growth(&gpu, options, place)?);
        return Ok(());
    }
    tell(&format!(
        "{}, {}; {} threads; {} pixels; at most {} runs or {} s each; ms, in brackets those of all \
         processors together\n",
        gpu.name(),
        options.extent.name(),
        rayon::current_num_threads(),
        options.size,
        options.runs,
        options.seconds
    ));
    let has = |tables| options.tables.contains(&tables);
    let mut found = Map::new();
    let mut drawn = Vec::new();
    for name in &options.scenes {
        if options.tables == [Tables::Uploads] {
            break;
        }
        let place = Place::new(name, &options.size)?;
        let mut parts = Map::new();
        if has(Tables::Strategies) {
            let rows = strategies::measure(&gpu, &place, options)?;
            tell(&strategies::table(name, &rows));
            parts.insert("strategies".to_owned(), strategies::json(&rows));
            drawn.push((name.clone(), rows));
        }
        if has(Tables::Skipping) {
            let rows = skipping::measure(&gpu, &place, options)?;
            tell(&skipping::table(name, &rows));
            parts.insert("skipping".to_owned(), skipping::json(&rows));
        }
        if has(Tables::Latency) {
            let rows = latency::measure(&gpu, place, options)?;
            tell(&latency::table(name, &rows));
            parts.insert("latency".to_owned(), latency::json(&rows));
        }
        found.insert(name.clone(), Value::Object(parts));
    }
    if has(Tables::Uploads) {
        let rows = uploads::measure(&gpu, options)?;
        tell(&uploads::table(&rows));
        found.insert("uploads".to_owned(), uploads::json(&rows));
    }
    if let Some(path) = &options.json {
        let all = json!({ "adapter": gpu.name(), "size": options.size, "found": found });
        let text = serde_json::to_string_pretty(&all)? + "\n";
        fs::write(path, text).with_context(|| path.display().to_string())?;
    }
    match &options.plot {
        Some(path) => plot::write(gpu.name(), &drawn, path),
        None => Ok(()),
    }
}

/// Says it at once: the rest may take long. Nobody may be listening any more; the files are written
/// all the same.
fn tell(text: &str) {
    writeln!(std::io::stdout(), "{text}").ok();
}

/// A number such as 5e7.
fn count(text: &str) -> Result<usize, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    let is_count = (1.0..=4e9).contains(&number) && number.fract() == 0.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    let count = number as usize;
    is_count.then_some(count).ok_or_else(|| "must be a whole number up to 4e9".into())
}
