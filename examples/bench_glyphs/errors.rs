//! Time against error: how far curves are off for a tolerance, and what it costs.

use crate::{
    Options,
    clock::{Span, time},
    curves::Curves,
    deviation::{self, Deviation},
    scene::{self, overview},
    table::{Table, cell, in_turn, number, times},
};
use anyhow::{Result, bail};
use puncta::{Bricks, CpuRenderer, Depth, FrustumCull, Glyph, Glyphs, Pipeline, View};
use serde_json::{Value, json};

/// In pixels.
const TOLERANCES: [f32; 7] = [0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// How many glyphs deviations are measured of.
const GLYPHS: u32 = 4000;

/// What was measured for a tolerance.
#[derive(Debug)]
pub(crate) struct Row {
    tolerance: f32,
    deviation: Deviation,
    /// In the scene.
    triangles: f64,
    frames: Vec<Span>,
}

impl Row {
    /// Whether curves are as near as was promised.
    fn is_kept(&self) -> bool {
        self.deviation.max <= f64::from(self.tolerance)
    }
}

/// Measures the scenes that have curves, for all tolerances.
pub(crate) fn run(options: &Options) -> Result<Vec<(String, Vec<Row>)>> {
    let mut all = Vec::new();
    for name in &options.scenes {
        let (kind @ ("arcs" | "tubes"), count) = scene::parse(name)? else {
            bail!("{name}: only arcs and tubes are curved");
        };
        let rows = if kind == "arcs" {
            measure(options, deviation::of_arcs, |pixels| scene::arcs(count, pixels))?
        } else {
            measure(options, deviation::of_tubes, |pixels| Ok(scene::tubes(count, pixels)))?
        };
        all.push((name.clone(), rows));
    }
    Ok(all)
}

fn measure<G: Glyph, B: Bricks>(
    options: &Options,
    deviation: impl Fn(f32, u32) -> Result<Deviation>,
    make: impl Fn(f32) -> Result<Curves<G, B>>,
) -> Result<Vec<Row>> {
    let curves = make(TOLERANCES[0])?;
    let view = overview(&curves.bounds(), options.size)?;
    let mut subjects = Vec::new();
    let mut rows = Vec::new();
    for tolerance in TOLERANCES {
        let curves = make(tolerance)?;
        let triangles = curves.levels(&view).sum() as f64;
        rows.push(Row {
            tolerance,
            deviation: deviation(tolerance, GLYPHS)?,
            triangles: triangles / curves.scene.records.len().max(1) as f64,
            frames: vec![],
        });
        let renderer = CpuRenderer::of(curves.glyphs);
        let pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
        subjects.push((pipeline, vec![]));
    }
    in_turn(options, &mut subjects, |pipeline| {
        pipeline.forget::<G>();
        let (drawn, span) = time(|| draw(pipeline, &curves, &view));
        drawn.map(|()| span)
    })?;
    for (row, (_, frames)) in rows.iter_mut().zip(subjects) {
        row.frames = frames;
    }
    Ok(rows)
}

type Cpu<G> = Pipeline<(FrustumCull, Depth), CpuRenderer<Glyphs<G>>>;

fn draw<G: Glyph, B: Bricks>(
    pipeline: &mut Cpu<G>,
    curves: &Curves<G, B>,
    view: &View,
) -> Result<()> {
    for step in &mut pipeline.progressive(&curves.scene, &curves.bricks, view, u64::MAX)? {
        step?;
    }
    Ok(())
}

pub(crate) fn table(name: &str, rows: &[Row]) -> String {
    let head = [
        "tolerance, pixels",
        "largest deviation",
        "mean deviation",
        "triangles a glyph",
        "frame",
        "promise",
    ];
    let mut table = Table::new(&format!("Time against error: {name}"), head);
    for row in rows {
        table.push(vec![
            row.tolerance.to_string(),
            format!("{:.4}", row.deviation.max),
            format!("{:.5}", row.deviation.mean),
            number(row.triangles),
            cell(&row.frames),
            if row.is_kept() { "kept" } else { "broken" }.to_owned(),
        ]);
    }
    let [points, glyphs, capped] =
        [|of: &Deviation| of.points, |of: &Deviation| of.glyphs, |of: &Deviation| of.capped]
            .map(|of| rows.iter().map(|row| of(&row.deviation)).sum::<u64>());
    format!(
        "{table}\nDeviations are of {points} points of {glyphs} glyphs in random views; {capped} more would \
         have needed more chords than there may be.\n"
    )
}

pub(crate) fn json(name: &str, rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "tolerance": row.tolerance,
            "largest_deviation": row.deviation.max,
            "mean_deviation": row.deviation.mean,
            "points": row.deviation.points,
            "glyphs": row.deviation.glyphs,
            "capped": row.deviation.capped,
            "triangles_per_glyph": row.triangles,
            "frame": times(&row.frames),
            "kept": row.is_kept(),
        })
    };
    json!({ "scene": name, "rows": rows.iter().map(row).collect::<Vec<_>>() })
}

/// An error if any promise is broken.
pub(crate) fn check(all: &[(String, Vec<Row>)]) -> Result<()> {
    let rows = all.iter().flat_map(|(name, rows)| rows.iter().map(move |row| (name, row)));
    match rows.into_iter().find(|(_, row)| !row.is_kept()) {
        None => Ok(()),
        Some((name, row)) => bail!(
            "{name}: curves are off by {} pixels, and not by {} at most",
            row.deviation.max,
            row.tolerance
        ),
    }
}
