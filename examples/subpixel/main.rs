//! What a least radius does to spheres below the size of a pixel: how far pictures are from the truth,
//! how much flickers when the camera moves, and what it costs.
//!
//! The truth is the share of each pixel that is covered, from a picture with many more pixels. A
//! picture of one sample a pixel shows all or nothing; its error is the mean difference from that share.
//! What flickers is the share of pixels that change between two views a fraction of a pixel apart; the
//! truth changes, too, and says how much of that is due.
//!
//! ```text
//! cargo run --release --example subpixel -- --help
//! ```

#![expect(clippy::cast_possible_truncation, reason = "means of shares are small numbers")]

use anyhow::{Context, Result};
use clap::Parser;
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};
use puncta::{
    CpuRenderer, Depth, FrustumCull, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig, NO_RECORD,
    Picture, Pipeline, Renderer, Scene, Source, Sphere, View, gpu::Extent,
    io::synthetic::Generator,
};
use std::{fmt::Write as _, io::Write as _, time::Instant};

/// Measures what a least radius does to spheres below the size of a pixel.
#[derive(Debug, Parser)]
struct Options {
    /// Generators, with radii that are small at this size of picture
    #[arg(default_values = ["cube:n=20000,r=0.001", "cube:n=200000,r=0.0004", "halo:n=200000"])]
    scenes: Vec<String>,

    /// Columns and rows of the picture
    #[arg(long, default_value_t = 256)]
    size: u32,

    /// How many samples along each side of a pixel tell the truth
    #[arg(long, default_value_t = 8)]
    samples: u32,

    /// How many views, each a third of a pixel from the one before
    #[arg(long, default_value_t = 8)]
    views: u32,

    /// Least radii, in pixels
    #[arg(long, value_delimiter = ',', default_values_t = [0.0, 0.25, 0.5, 0.7072, 1.0])]
    least: Vec<f32>,

    /// A part of the name of the GPU to draw with
    #[arg(long)]
    adapter: Option<String>,
}

fn main() {
    if let Err(error) = run(&Options::parse()) {
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<()> {
    let gpu = Gpu::new(options.adapter.as_deref(), Extent::Full)?;
    let mut text = format!(
        "{}; {size}x{size} pixels, {} views, truth by {s}x{s} samples\n\n",
        gpu.name(),
        options.views,
        size = options.size,
        s = options.samples
    );
    text +=
        "| scene | least radius, px | covered, % of the truth | error | flickers | draw, ms |\n";
    text += "|---|---|---|---|---|---|\n";
    let count = options.scenes.len() * (options.least.len() + 1);
    let bar = ProgressBar::new(count as u64);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?);
    for name in &options.scenes {
        let generator: Generator = name.parse().with_context(|| name.clone())?;
        let mut scene = generator.into_scene()?;
        let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
        let views = views(options, &scene)?;
        bar.set_message(name.clone());
        let truth = truth(options, (&scene, &grid), &views)?;
        bar.inc(1);
        writeln!(text, "| {name} | truth | 100 | 0 | {:.4} | |", change(&truth))?;
        for &least in &options.least {
            let config = GpuConfig { radius_min_pixels: least, ..GpuConfig::default() };
            let renderer = GpuRenderer::new(&gpu, config)?;
            let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
            let (pictures, ms) = shares(&mut pipeline, (&scene, &grid), &views)?;
            let sum = |all: &[Vec<f32>]| all.iter().flatten().sum::<f32>();
            let covered = 100.0 * sum(&pictures) / sum(&truth);
            let (error, flicker) = (difference(&pictures, &truth), change(&pictures));
            writeln!(text, "| | {least} | {covered:.1} | {error:.4} | {flicker:.4} | {ms:.1} |")?;
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    writeln!(std::io::stdout(), "{text}").ok();
    Ok(())
}

/// Views that turn around the scene, by a third of a pixel at its front each time.
fn views(options: &Options, scene: &Scene<Sphere>) -> Result<Vec<View>> {
    let bounds = scene.bounds();
    let middle = (bounds.min + bounds.max) * 0.5;
    let view = View::look_at(middle + DVec3::new(1.0, 0.7, 2.0), middle, DVec3::Y)?
        .with_size(options.size, options.size)?
        .fitted(&bounds);
    let turn = 2.0 / f64::from(options.size) / 3.0;
    let turned = |i: u32| view.clone().orbited(middle, turn * f64::from(i), 0.0);
    Ok((0..options.views).map(turned).collect())
}

/// The share of each pixel that is covered, for each view.
fn truth(
    options: &Options,
    (scene, grid): (&Scene<Sphere>, &Grid),
    views: &[View],
) -> Result<Vec<Vec<f32>>> {
    let (size, samples) = (options.size as usize, options.samples as usize);
    let fine = options.size * options.samples;
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let share = |view: &View| -> Result<Vec<f32>> {
        let view = view.clone().with_size(fine, fine)?;
        let picture = pipeline.render(scene, grid, &view)?;
        let mut shares = vec![0.0; size * size];
        for (sample, _) in picture.id.iter().enumerate().filter(|(_, id)| **id != NO_RECORD) {
            let (row, column) = (sample / fine as usize, sample % fine as usize);
            shares[row / samples * size + column / samples] += 1.0 / (samples * samples) as f32;
        }
        Ok(shares)
    };
    views.iter().map(share).collect()
}

/// What pictures of one sample a pixel show, 0 or 1, and how long one took to draw, in the median.
fn shares<D: Renderer<Sphere>>(
    pipeline: &mut Pipeline<(FrustumCull, Depth), D>,
    (scene, grid): (&Scene<Sphere>, &Grid),
    views: &[View],
) -> Result<(Vec<Vec<f32>>, f64)>
where
    anyhow::Error: From<D::Error>,
{
    let (mut shares, mut times) = (Vec::new(), Vec::new());
    for view in views {
        pipeline.forget::<Sphere>();
        let start = Instant::now();
        let picture: Picture = pipeline.render(scene, grid, view)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        let share = |&id: &u32| if id == NO_RECORD { 0.0 } else { 1.0 };
        shares.push(picture.id.iter().map(share).collect());
    }
    times.sort_by(f64::total_cmp);
    Ok((shares, times.get(times.len() / 2).copied().unwrap_or_default()))
}

/// The mean difference of pixels that show anything in either.
fn difference(a: &[Vec<f32>], b: &[Vec<f32>]) -> f32 {
    let pixels = a.iter().flatten().zip(b.iter().flatten());
    let (sum, count) = pixels
        .filter(|(a, b)| **a > 0.0 || **b > 0.0)
        .fold((0.0_f64, 0_u32), |(sum, count), (a, b)| (sum + f64::from((a - b).abs()), count + 1));
    (sum / f64::from(count.max(1))) as f32
}

/// The mean change from one view to the next, of pixels that show anything in either.
fn change(views: &[Vec<f32>]) -> f32 {
    let (first, second) = (&views[..views.len().saturating_sub(1)], &views[1.min(views.len())..]);
    difference(first, second)
}
