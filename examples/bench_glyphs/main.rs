//! Compares representations of glyphs, as the paper on attributed vertex clouds does: memory, vertices,
//! and the time of a frame with and without pixels.
//!
//! ```text
//! cargo run --release --example bench_glyphs -- --json out.json --plot out.svg > tables.md
//! cargo run --release --example bench_glyphs -- --errors
//! cargo run --release --example bench_glyphs -- --help
//! ```
//!
//! All representations draw the same scene before the same camera into a picture of ids with a depth
//! buffer, and nothing is shaded. How many pixels tell another glyph or another face than those of
//! the first representation is part of the table. What is compared takes turns, so that a machine
//! that is slower for a while is so for all of it. Times are medians: on the clock at the wall, and of
//! all processors of the machine.

mod baked;
mod boxes;
mod candidates;
mod curves;
mod deviation;
mod device;
mod easel;
mod errors;
mod expanded;
mod glyphs;
mod instanced;
mod measure;
mod mesh;
mod noise;
mod own;
mod pipes;
mod plot;
mod pulled;
mod report;
mod scene;
mod trial;
mod way;

#[path = "../convergence/clock.rs"]
mod clock;
#[path = "../bench_gpu/table.rs"]
mod table;

use anyhow::{Context, Result, ensure};
use candidates::Devices;
use clap::Parser;
use device::Device;
use scene::Scene;
use serde_json::{Value, json};
use std::{fs, io::Write, path::PathBuf, rc::Rc};

/// Compares representations of glyphs.
#[derive(Debug, Parser)]
#[command(name = "bench_glyphs", version)]
pub(crate) struct Options {
    /// Scenes: blocks:N and caves:N are worlds of N³ cells, all of them solid or about half of them;
    /// cuboids:N are bars on a plane, arcs:N are arcs on one, tubes:N are pieces of tubes in a cube
    scenes: Vec<String>,
    /// Measures something else: how far curves are off for a tolerance, and what it costs. It fails if
    /// they are off by more
    #[arg(long)]
    errors: bool,
    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = size)]
    size: [u32; 2],
    /// Only representations whose names contain one of these, such as pulled,Renderer
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    only: Vec<String>,
    /// How often to measure each
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// After so many seconds, measure nothing again that was measured once
    #[arg(long, default_value_t = 30.0)]
    seconds: f64,
    /// Stand so close that much of the scene lies beside the picture
    #[arg(long)]
    close: bool,
    /// How far curves may be off, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 0.25)]
    tolerance: f32,
    /// The most memory of one representation, in MiB
    #[arg(long, value_name = "MIB", default_value_t = 1536)]
    memory: u64,
    /// The adapter whose name contains this; the best one by default
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Write all times here
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
    /// Write a plot here, as SVG
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

impl Options {
    /// Whether a representation takes part.
    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|part| name.contains(part))
    }
}

fn main() {
    if let Err(error) = run(Options::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

/// What is measured by default.
const SCENES: [&str; 13] = [
    "blocks:16",
    "blocks:32",
    "blocks:64",
    "blocks:100",
    "blocks:128",
    "caves:64",
    "cuboids:1e4",
    "cuboids:1e5",
    "cuboids:1e6",
    "arcs:1e3",
    "arcs:1e4",
    "tubes:1e3",
    "tubes:1e4",
];

/// What is measured of errors by default.
const CURVES: [&str; 2] = ["arcs:1e4", "tubes:1e4"];

fn run(mut options: Options) -> Result<()> {
    ensure!(options.runs > 0, "nothing is to be measured");
    if options.scenes.is_empty() {
        let scenes = if options.errors { &CURVES[..] } else { &SCENES };
        options.scenes = scenes.iter().map(ToString::to_string).collect();
    }
    if options.errors {
        return run_errors(&options);
    }
    let (name, memory) = (options.adapter.as_deref(), options.memory.saturating_mul(1 << 20));
    let devices = Devices {
        plain: Rc::new(Device::new(name, memory)?),
        meshes: Device::with_meshes(name, memory)?.map(Rc::new),
    };
    devices.plain.check_size(options.size)?;
    let adapter = devices.plain.gpu.name();
    tell(&format!("{adapter}; {}", conditions(&options)));
    let (mut found, mut drawn) = (Vec::new(), Vec::new());
    for name in &options.scenes {
        let scene = Scene::new(name, &options).context(name.clone())?;
        let rows = measure::measure(&devices, &scene, &options).context(name.clone())?;
        tell(&report::table(&scene, &rows));
        found.push(report::json(&scene, &rows));
        drawn.push((scene.name, scene.content.len(), rows));
        // After each scene: what was measured is not lost if the next one takes too long.
        write_json(
            &options,
            &json!({ "adapter": adapter, "size": options.size, "scenes": found }),
        )?;
        if let Some(path) = &options.plot {
            plot::write(adapter, &drawn, path)?;
        }
    }
    Ok(())
}

/// The second part. It needs no GPU.
fn run_errors(options: &Options) -> Result<()> {
    ensure!(options.plot.is_none(), "errors are not plotted");
    tell(&conditions(options));
    let all = errors::run(options)?;
    for (name, rows) in &all {
        tell(&errors::table(name, rows));
    }
    let found: Vec<_> = all.iter().map(|(name, rows)| errors::json(name, rows)).collect();
    write_json(options, &json!({ "size": options.size, "errors": found }))?;
    errors::check(&all)
}

fn conditions(options: &Options) -> String {
    format!(
        "{} threads; {}x{} pixels; at most {} runs or {} s each; ms, in brackets those of all \
         processors together\n",
        rayon::current_num_threads(),
        options.size[0],
        options.size[1],
        options.runs,
        options.seconds
    )
}

fn write_json(options: &Options, all: &Value) -> Result<()> {
    let Some(path) = &options.json else { return Ok(()) };
    let text = serde_json::to_string_pretty(all)? + "\n";
    fs::write(path, text).with_context(|| path.display().to_string())
}

/// Says it at once: the rest may take long. Nobody may be listening any more; the files are written
/// all the same.
fn tell(text: &str) {
    writeln!(std::io::stdout(), "{text}").ok();
}

/// A size such as 640x480.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides.ok_or_else(|| format!("{text:?} is no size: write it as 640x480"))
}
