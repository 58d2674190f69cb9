//! Draws a particle or point file, or a synthetic scene, exactly, on the CPU or a GPU.
//!
//! ```text
//! cargo run --release --example render -- INPUT [options]
//! cargo run --release --example render -- --help
//! ```

mod backend;
mod input;
mod options;
mod output;
mod progress;
mod statistics;
mod view;

use anyhow::{Context, Result};
use backend::Backend;
use clap::Parser;
use options::Options;
use puncta::{
    Depth, FrustumCull, Grid, GridConfig, Picture, Pipeline, Resolution, Scene, Sphere, View,
};
use statistics::Statistics;
use std::io::Write;

fn main() {
    if let Err(error) = run(&Options::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<()> {
    if let Some(threads) = options.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().context("cannot start the threads")?;
    }
    let mut statistics = Statistics::default();
    let mut input = statistics.time("read", || input::read(options))?;
    for notice in &input.notices {
        writeln!(std::io::stderr(), "note: {notice}").ok();
    }
    let view = statistics.time("view", || view::choose(options, &input))?;
    let look = output::Look::new(options, &input, &view)?;
    let backend = Backend::new(options)?;
    statistics.backend.clone_from(&backend.name);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), backend);
    let grid = statistics.time("sort", || sort(options, &mut input))?;
    let picture = draw(&mut pipeline, (&input.scene, &grid), &view, ("frame", &mut statistics))?;
    statistics.describe(&input, &grid, &view, &picture);
    output::write_numbers(options, &input.scene, &picture)?;
    let image =
        output::image(options, (&input, &grid), &look, picture, (&mut pipeline, &mut statistics))?;
    statistics.time("write", || output::write_image(options, &image))?;
    statistics.finish(options)?;
    // Nobody may be listening any more; the files are written all the same.
    writeln!(std::io::stdout(), "{statistics}\n{}", output::place(options)).ok();
    Ok(())
}

/// Sorts the records into bricks, unless they are sorted and no other grid is asked for.
fn sort(options: &Options, input: &mut input::Input) -> Result<Grid> {
    let known = input.known.as_mut().and_then(|known| known.grid.take());
    if let (Some(grid), None) = (known, options.grid) {
        return Ok(grid);
    }
    let spinner = progress::Bar::spinner("sorting");
    let resolution =
        options.grid.map_or_else(Resolution::default, |cells| Resolution::LongestSide(cells.get()));
    let grid =
        Grid::sort_scene(&mut input.scene, &GridConfig { resolution, ..GridConfig::default() })?;
    spinner.finish();
    Ok(grid)
}

/// What draws the pictures.
type Drawing = Pipeline<(FrustumCull, Depth), Backend>;

/// Draws the whole picture, with a progress bar, and notes the time it takes.
fn draw(
    pipeline: &mut Drawing,
    (scene, grid): (&Scene<Sphere>, &Grid),
    view: &View,
    (step, statistics): (&'static str, &mut Statistics),
) -> Result<Picture> {
    let budget = (scene.records.len() as u64 / 100).max(1 << 18);
    let (picture, progress) = statistics.time(step, || {
        let mut steps = pipeline.progressive(scene, grid, view, budget)?;
        let all = steps.progress().left.records;
        let bar = progress::Bar::counting("drawing", all);
        for step in &mut steps {
            bar.set(all - step?.left.records);
        }
        bar.finish();
        anyhow::Ok((steps.picture()?, steps.progress()))
    })?;
    if step == "frame" {
        statistics.drawn = progress.drawn;
    }
    Ok(picture)
}
