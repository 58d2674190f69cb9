//! What hierarchical depth saves: until a picture is settled, against drawing everything with the
//! same set-up; and what a second view needs.

use crate::{
    Options,
    clock::{Span, median, time},
    place::{Place, roomy},
    progress::Bar,
    table::{Table, cell, in_turn, number, times},
};
use anyhow::{Result, ensure};
use puncta::{
    Depth, FrustumCull, Gpu, GpuRenderer, Pipeline, Progress, Sphere, View,
    gpu::{Error, GpuConfig, Setup, Skipping},
};
use serde_json::{Value, json};

/// The records of a step, where pictures are drawn in steps.
const STEP: u64 = 500_000;

/// How far the second view is turned, in radians.
const TURN: f64 = 0.1;

type Stages = (FrustumCull, Depth);

/// What was measured of a set-up.
#[derive(Debug)]
pub(crate) enum Row {
    Measured(Box<Measured>),
    /// The device cannot do this.
    Unsupported(Setup, String),
}

#[derive(Debug)]
pub(crate) struct Measured {
    setup: Setup,
    /// At once, in steps, and everything.
    frames: [Vec<Span>; 3],
    progress: Progress,
    differing: usize,
    again: Vec<Again>,
}

/// A second view, with and without what was seen in the first.
#[derive(Debug)]
struct Again {
    first_step: Span,
    settled: Span,
    progress: Progress,
    brought: u64,
}

pub(crate) fn measure(gpu: &Gpu, place: &Place, options: &Options) -> Result<Vec<Row>> {
    let bar = Bar::counting("skipping", options.setups.len() as u64);
    let mut rows = Vec::new();
    for &setup in &options.setups {
        let make = |skipping| {
            let config = roomy(place.records(), skipping);
            let renderer = GpuRenderer::new(gpu, GpuConfig { setup: Some(setup), ..config })?;
            Ok(Pipeline::new((FrustumCull, Depth::default()), renderer))
        };
        rows.push(match (make(Skipping::Hidden), make(Skipping::Nothing)) {
            (Ok(hidden), Ok(nothing)) => {
                Row::Measured(Box::new(row(place, options, setup, [hidden, nothing])?))
            }
            (Err(Error::Unsupported { what, .. }), _) => Row::Unsupported(setup, what),
            (Err(error), _) | (_, Err(error)) => return Err(error.into()),
        });
        bar.set(rows.len() as u64);
    }
    bar.finish();
    Ok(rows)
}

fn row(
    place: &Place,
    options: &Options,
    setup: Setup,
    [mut hidden, mut nothing]: [Pipeline<Stages, GpuRenderer>; 2],
) -> Result<Measured> {
    let view = &place.view;
    place.away.draw(&mut hidden, place.world.scene())?;
    place.away.draw(&mut nothing, place.world.scene())?;
    // What is drawn first makes what the others use.
    let differing =
        place.differing(&hidden.render(place.world.scene(), &place.world.grid, view)?);
    let world = &place.world;
    nothing.progressive(world.scene(), &world.grid, view, 1)?.next().transpose()?;
    let mut progress = Progress::default();
    let mut ways = [0, 1, 2].map(|way| (way, vec![])).to_vec();
    in_turn(options, &mut ways, |&mut way| {
        let (pipeline, budget) = match way {
            0 => (&mut hidden, u64::MAX),
            1 => (&mut hidden, STEP),
            _ => (&mut nothing, u64::MAX),
        };
        pipeline.forget::<Sphere>();
        let (found, span) = time(|| settle(place, pipeline, (view, budget)));
        if way == 0 {
            progress = found?;
        }
        Ok(span)
    })?;
    let mut spans = ways.into_iter().map(|(_, spans)| spans);
    let frames = std::array::from_fn(|_| spans.next().unwrap_or_default());
    let turned = view.clone().orbited(place.pivot(), TURN, 0.0);
    let mut again = Vec::new();
    for has_cache in [true, false] {
        settle(place, &mut hidden, (view, u64::MAX))?;
        if !has_cache {
            hidden.forget::<Sphere>();
        }
        again.push(second(place, &mut hidden, &turned)?);
    }
    Ok(Measured { setup, frames, progress, differing, again })
}

/// Draws until nothing can change any more.
fn settle(
    place: &Place,
    pipeline: &mut Pipeline<Stages, GpuRenderer>,
    (view, budget): (&View, u64),
) -> Result<Progress> {
    let world = &place.world;
    let mut steps = pipeline.progressive(world.scene(), &world.grid, view, budget)?;
    for step in &mut steps {
        step?;
    }
    ensure!(steps.progress().settled(), "the picture is not settled");
    Ok(steps.progress())
}

fn second(
    place: &Place,
    pipeline: &mut Pipeline<Stages, GpuRenderer>,
    view: &View,
) -> Result<Again> {
    let world = &place.world;
    let before = pipeline.renderer().brought_bytes();
    let mut first_step = Span::default();
    let (progress, settled) = time(|| {
        let (steps, began) =
            time(|| pipeline.progressive(world.scene(), &world.grid, view, u64::MAX));
        let mut steps = steps?;
        let (step, span) = time(|| steps.next());
        step.transpose()?;
        first_step += began;
        first_step += span;
        for step in &mut steps {
            step?;
        }
        anyhow::Ok(steps.progress())
    });
    let brought = pipeline.renderer().brought_bytes() - before;
    Ok(Again { first_step, settled, progress: progress?, brought })
}

impl Measured {
    /// The time until a picture is settled, of that in which everything is drawn: at the wall, and
    /// of the processors.
    fn shares(&self) -> [f64; 2] {
        let [settled, _, everything] = &self.frames;
        match median(settled).zip(median(everything)) {
            Some((a, b)) => [a.wall / b.wall, a.processors / b.processors],
            None => [f64::NAN; 2],
        }
    }
}

pub(crate) fn table(name: &str, rows: &[Row]) -> String {
    let head = [
        "setup",
        "settled",
        "in steps",
        "everything",
        "share",
        "drawn",
        "skipped",
        "ids that differ",
    ];
    let mut table = Table::new(&format!("Skipping: {name}, until settled"), head);
    let head = [
        "setup",
        "recalled",
        "first step",
        "settled",
        "bytes brought",
        "without: settled",
        "bytes brought",
    ];
    let mut again = Table::new("A second view, with what was seen in the first and without", head);
    let mut lacks = String::new();
    for row in rows {
        let row = match row {
            Row::Measured(row) => row,
            Row::Unsupported(setup, what) => {
                lacks += &format!("\nNot on this device: {setup} (cannot {what}).\n");
                continue;
            }
        };
        let mut cells = vec![row.setup.to_string()];
        cells.extend(row.frames.iter().map(|spans| cell(spans)));
        let [wall, processors] = row.shares();
        cells.push(format!("{wall:.3} ({processors:.3})"));
        cells.push(row.progress.drawn.records.to_string());
        cells.push(row.progress.skipped.records.to_string());
        cells.push(row.differing.to_string());
        table.push(cells);
        if let [with, without] = row.again.as_slice() {
            again.push(vec![
                row.setup.to_string(),
                with.progress.recalled.to_string(),
                number(with.first_step.wall * 1e3),
                number(with.settled.wall * 1e3),
                with.brought.to_string(),
                number(without.settled.wall * 1e3),
                without.brought.to_string(),
            ]);
        }
    }
    format!("{table}{lacks}\n{again}")
}

pub(crate) fn json(rows: &[Row]) -> Value {
    let again = |again: &Again| {
        json!({
            "first_step_seconds": again.first_step.wall,
            "settled_seconds": again.settled.wall,
            "recalled": again.progress.recalled,
            "drawn": again.progress.drawn.records,
            "brought_bytes": again.brought,
        })
    };
    let row = |row: &Row| match row {
        Row::Measured(row) => json!({
            "setup": row.setup.to_string(),
            "settled": times(&row.frames[0]),
            "settled_in_steps": times(&row.frames[1]),
            "everything": times(&row.frames[2]),
            "shares": row.shares(),
            "drawn": row.progress.drawn.records,
            "skipped": row.progress.skipped.records,
            "differing": row.differing,
            "second_view": row.again.iter().map(again).collect::<Vec<_>>(),
        }),
        Row::Unsupported(setup, what) => json!({ "setup": setup.to_string(), "cannot": what }),
    };
    rows.iter().map(row).collect()
}
