//! The way from options to a picture in a file or a window.

use super::{
    backend::Backend,
    built::Built,
    drawing::Drawing,
    light,
    options::{Drawing as Options, Window},
};
use anyhow::{Context, Result, ensure};
use puncta::{Bricks, Glyph, Shading, View, io::png, shade_glyphs};
use puncta_viewer::glyphs::{self, Script, Show};
use std::{
    io::Write,
    path::PathBuf,
    process::ExitCode,
    time::{Duration, Instant},
};

/// Builds, draws and writes, or shows a window; what goes wrong is told on the error stream.
pub(crate) fn run<G, B>(
    name: &str,
    options: &Options,
    build: impl FnOnce() -> Result<Built<G, B>>,
) -> ExitCode
where
    G: Glyph + 'static,
    B: Bricks + Send + Sync + 'static,
{
    match start(name, options, build) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nobody may be listening any more.
            writeln!(std::io::stderr(), "error: {error:#}").ok();
            ExitCode::FAILURE
        }
    }
}

fn start<G, B>(
    name: &str,
    options: &Options,
    build: impl FnOnce() -> Result<Built<G, B>>,
) -> Result<()>
where
    G: Glyph + 'static,
    B: Bricks + Send + Sync + 'static,
{
    if let Some(threads) = options.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().context("cannot start the threads")?;
    }
    let mut watch = Watch::default();
    let built = build()?;
    watch.lap("build");
    for note in &built.notes {
        writeln!(std::io::stderr(), "note: {note}").ok();
    }
    ensure!(!built.scene.records.is_empty(), "there is nothing to draw");
    let view = built.outlook.view(options)?;
    if options.window.window {
        return show(name, options, (built, view));
    }
    write(name, options, (&built, &view), watch)
}

/// Shows a window until it is closed.
fn show<G, B>(name: &str, options: &Options, (built, view): (Built<G, B>, View)) -> Result<()>
where
    G: Glyph + 'static,
    B: Bricks + Send + Sync + 'static,
{
    let backend = Backend::new(options, &built.glyphs)?;
    for fact in &built.facts {
        // Nobody may be listening any more.
        writeln!(std::io::stdout(), "{fact}").ok();
    }
    let Window { screenshot, frames, orbit, log, .. } = options.window.clone();
    let bounds = built.outlook.bounds();
    let background = options.background.unwrap_or(built.outlook.background);
    let Built { scene, bricks, glyphs, paint, .. } = built;
    let show = Show {
        name: format!("{name} by {}", backend.name),
        scene,
        bricks,
        glyphs,
        paint,
        view,
        bounds,
        background,
        supersample: options.supersample,
        script: Script { screenshot, frames, orbit, log },
    };
    glyphs::show(show, backend)
}

/// Draws and writes.
fn write<G, B>(
    name: &str,
    options: &Options,
    (built, view): (&Built<G, B>, &View),
    mut watch: Watch,
) -> Result<()>
where
    G: Glyph + 'static,
    B: Bricks,
{
    let records = built.scene.records.len();
    let side = |side: u32| side.saturating_mul(options.supersample);
    let fine = view.clone().with_size(side(view.width()), side(view.height()));
    let fine = fine.context("lower --supersample or --size")?;
    let mut drawing = Drawing::new(options, built)?;
    let (picture, drawn) = drawing.picture(&fine)?;
    watch.lap("draw");
    let background = options.background.unwrap_or(built.outlook.background);
    let supersample = options.supersample;
    let image = if options.sky > 0 {
        let how = (options.sky, supersample, background);
        light::image(&mut drawing, built, (&fine, &picture), how)?
    } else {
        let Built { glyphs, scene, bricks, paint, .. } = built;
        paint.with_coloring(scene, |coloring| {
            let shading = Shading { coloring, background, supersample, ..Shading::default() };
            shade_glyphs(glyphs, scene, bricks, view, &picture, &shading)
        })?
    };
    watch.lap("light");
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.png")));
    png::write(&out, &image)?;
    watch.lap("write");
    let visible = picture.visible_records().len();
    let covered = picture.covered_pixels();
    let place = out.canonicalize().unwrap_or(out);
    let facts: String = built.facts.iter().map(|fact| format!("{fact}\n")).collect();
    // Nobody may be listening any more; the file is written all the same.
    writeln!(
        std::io::stdout(),
        "{facts}{records} records of {} bytes, {} drawn, {visible} visible on {covered} pixels, by {}; {}\n\
         the picture is {}",
        size_of::<G>(),
        drawn.records,
        drawing.backend(),
        watch.told(),
        place.display(),
    )
    .ok();
    Ok(())
}

/// How long the steps took.
#[derive(Debug)]
struct Watch {
    start: Instant,
    laps: Vec<(&'static str, Duration)>,
}

impl Default for Watch {
    fn default() -> Self {
        Self { start: Instant::now(), laps: Vec::new() }
    }
}

impl Watch {
    fn lap(&mut self, step: &'static str) {
        self.laps.push((step, self.start.elapsed()));
        self.start = Instant::now();
    }

    fn told(&self) -> String {
        let lap = |(step, time): &(&str, Duration)| format!("{step} {:.2} s", time.as_secs_f64());
        self.laps.iter().map(lap).collect::<Vec<_>>().join(", ")
    }
}
