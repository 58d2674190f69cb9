//! Draws trajectories: particles in a flow, or the tracks of a TrackVis file.
//!
//! ```text
//! cargo run --release --example trajectories -- [FILE.trk] [--draw tubes|lines|spheres|auto]
//! ```

mod flow;
#[path = "../glyphs/mod.rs"]
mod glyphs;
mod look;
mod path;
mod trk;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use flow::Flow;
use glam::DVec3;
use glyphs::{Built, DrawingOptions, Outlook, Paint};
use look::{ColorBy, Draw, Look};
use path::Path;
use puncta::{
    Background, Bounds, ColorMap, Glyphs, Scene,
    avc::{Node, Runs, Trajectories},
};
use std::{path::PathBuf, process::ExitCode};

/// Draws trajectories: tracks of a TrackVis file, or without a file particles in a flow.
#[derive(Clone, Debug, Parser)]
#[command(name = "trajectories", version)]
struct Options {
    /// A TrackVis file
    #[arg(conflicts_with_all = ["flow", "count", "points", "seed"])]
    file: Option<PathBuf>,

    /// The flow that particles follow
    #[arg(long, value_enum, default_value_t = Flow::Thomas)]
    flow: Flow,

    /// How many particles there are
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    count: u32,

    /// How many points each of them leaves behind
    #[arg(long, value_name = "N", default_value_t = 700, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    points: u32,

    /// Another number lets particles start elsewhere
    #[arg(long, value_name = "N", default_value_t = 5)]
    seed: u64,

    /// As what they are drawn
    #[arg(long, value_enum, default_value_t = Draw::Tubes)]
    draw: Draw,

    /// What gives them their color: by default speed in a flow, and direction in a file
    #[arg(long, value_enum)]
    color: Option<ColorBy>,

    /// The color map for speeds
    #[arg(long, value_name = "NAME", default_value = "plasma")]
    colormap: String,

    /// A trajectory that is shown before all others, which fade
    #[arg(long, value_name = "ID")]
    select: Option<u32>,

    /// The radius of tubes; what suits by default
    #[arg(long, value_name = "R")]
    radius: Option<f32>,

    /// The width of lines, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1.5)]
    width: f32,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("trajectories", &options.drawing, || build(&options))
}

fn build(options: &Options) -> Result<Built<Node, Runs>> {
    let map = ColorMap::named(&options.colormap).context("--colormap")?;
    let (paths, mut notes, name) = match &options.file {
        Some(file) => {
            let trk::Tracks { paths, notes } = trk::read(file)?;
            (paths, notes, file.display().to_string())
        }
        None => {
            let paths = options.flow.follow(options.count, options.points, options.seed);
            (paths, vec![], format!("{:?}", options.flow))
        }
    };
    let count = paths.len();
    if let Some(id) = options.select {
        ensure!((id as usize) < count, "--select {id}: there are {count}, counted from 0");
    }
    let bounds = bounds(&paths);
    ensure!(!bounds.is_empty(), "{name}: there is no point in it");
    let mut all = Trajectories::default();
    for path in &paths {
        all.push(&path.points, &path.times);
    }
    let faults = all.faults;
    for (count, what) in [
        (faults.not_finite, "points are not drawn: a number is not finite"),
        (faults.not_increasing, "steps take no time: no speed is known from them"),
        (faults.too_many, "trajectories left out: there are no more ids"),
    ] {
        if count > 0 {
            notes.push(format!("{count} {what}"));
        }
    }
    let outlook = outlook(options, &paths);
    let view = outlook.view(&options.drawing)?;
    let speeds = look::speeds(&all.nodes);
    let color = options.color.unwrap_or(match options.file {
        Some(_) => ColorBy::Direction,
        None => ColorBy::Speed,
    });
    let reach = bounds.extent().length();
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let look = Look {
        draw: options.draw,
        radius: options.radius.unwrap_or((reach * 0.0022) as f32),
        width: options.width,
        selected: options.select,
        speeds,
        halfway: (view.eye() - bounds.center()).length() as f32,
    };
    let glyphs = Glyphs::new(look.style()?);
    let colors = look.colors(&paths, &all.nodes, color, &map);
    let mut facts = vec![format!("{name}: {count} trajectories, {} points", all.nodes.len())];
    facts.push(format!("speeds from {:.4} to {:.4}", speeds[0], speeds[1]));
    let mut scene = Scene::new(all.nodes);
    scene.attributes.colors = Some(colors.into());
    let bricks = Runs::new(&glyphs.cloud(&scene.records));
    Ok(Built { scene, bricks, glyphs, paint: Paint::Scene, outlook, notes, facts })
}

/// The box around all points.
fn bounds(paths: &[Path]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for point in paths.iter().flat_map(|path| &path.points) {
        bounds.add(DVec3::from(point.map(f64::from)));
    }
    bounds
}

/// A view of all points, or of as many as say enough.
fn outlook(options: &Options, paths: &[Path]) -> Outlook {
    let all: usize = paths.iter().map(|path| path.points.len()).sum();
    let points = paths.iter().flat_map(|path| &path.points).step_by(all.div_ceil(1 << 16).max(1));
    let toward = match (&options.file, options.flow) {
        (Some(_), _) => DVec3::new(1.0, -0.6, 0.45),
        (None, Flow::Lorenz) => DVec3::new(0.55, -1.0, 0.12),
        (None, Flow::Thomas) => DVec3::new(1.0, -0.7, 0.6),
    };
    Outlook {
        points: points.map(|point| DVec3::from(point.map(f64::from))).collect(),
        toward,
        fov: 30.0,
        zoom: 1.0,
        sun: DVec3::new(0.3, -1.0, 1.1),
        background: Background::Gradient([20, 24, 34], [58, 64, 80]),
    }
}
