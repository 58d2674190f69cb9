//! Set-ups against fragments: everything is drawn, nothing is skipped, nothing is brought.

use crate::{
    Options,
    clock::{Span, time},
    place::{self, Place, roomy},
    progress::Bar,
    table::{Table, best, cell, in_turn, times},
};
use anyhow::{Result, ensure};
use puncta::{
    Gpu, GpuRenderer, Pipeline,
    gpu::{Error, Fragment, GpuConfig, Setup, Skipping},
};
use serde_json::{Value, json};

/// What was measured of a strategy.
#[derive(Debug)]
pub(crate) enum Row {
    Measured(Measured),
    /// The device cannot do this.
    Unsupported(Setup, Fragment, String),
}

/// The times of a strategy.
#[derive(Debug)]
pub(crate) struct Measured {
    pub(crate) setup: Setup,
    pub(crate) fragment: Fragment,
    pub(crate) frames: Vec<Span>,
    /// Frames in which no record covers a pixel.
    pub(crate) away: Vec<Span>,
    /// Pixels that do not show the record that they should.
    pub(crate) differing: usize,
}

/// One that takes part.
struct Subject {
    setup: Setup,
    pipeline: Pipeline<(), GpuRenderer>,
    differing: Option<usize>,
}

/// Measures all strategies; the set-ups of one kind of fragment take turns.
pub(crate) fn measure(gpu: &Gpu, place: &Place, options: &Options) -> Result<Vec<Row>> {
    let total = options.setups.len() * options.fragments.len();
    let bar = Bar::counting("drawing", total as u64);
    let mut rows = Vec::new();
    for &fragment in &options.fragments {
        let mut subjects = Vec::new();
        for &setup in &options.setups {
            match subject(gpu, place, (setup, fragment))? {
                Ok(subject) => subjects.push((subject, vec![])),
                Err(what) => rows.push(Row::Unsupported(setup, fragment, what)),
            }
        }
        in_turn(options, &mut subjects, |subject| subject.frame(place))?;
        let mut away: Vec<_> = subjects.iter_mut().map(|(one, _)| (one, vec![])).collect();
        in_turn(options, &mut away, |subject| {
            let (drawn, span) =
                time(|| place.away.draw(&mut subject.pipeline, place.world.scene()));
            drawn.map(|()| span)
        })?;
        let away: Vec<Vec<Span>> = away.into_iter().map(|(_, spans)| spans).collect();
        for ((subject, frames), away) in subjects.into_iter().zip(away) {
            let Subject { setup, differing, .. } = subject;
            let differing = differing.unwrap_or_default();
            rows.push(Row::Measured(Measured { setup, fragment, frames, away, differing }));
        }
        bar.set(rows.len() as u64);
    }
    bar.finish();
    Ok(rows)
}

/// One with all records on the device and all pipelines made, or what the device cannot do.
fn subject(
    gpu: &Gpu,
    place: &Place,
    (setup, fragment): (Setup, Fragment),
) -> Result<Result<Subject, String>> {
    let config = roomy(place.records(), Skipping::Nothing);
    let config = GpuConfig { setup: Some(setup), fragment: Some(fragment), ..config };
    let renderer = match GpuRenderer::new(gpu, config) {
        Ok(renderer) => renderer,
        Err(Error::Unsupported { what, .. }) => return Ok(Err(what)),
        Err(error) => return Err(error.into()),
    };
    let mut pipeline = Pipeline::new((), renderer);
    place.away.draw(&mut pipeline, place.world.scene())?;
    let world = &place.world;
    let first = pipeline.progressive(world.scene(), &world.grid, &place.view, 1)?.next();
    first.transpose()?;
    Ok(Ok(Subject { setup, pipeline, differing: None }))
}

impl Subject {
    fn frame(&mut self, place: &Place) -> Result<Span> {
        let world = &place.world;
        let brought = self.pipeline.renderer().brought_bytes();
        // Otherwise what was seen would be drawn twice.
        self.pipeline.forget::<puncta::Sphere>();
        let (drawn, span) =
            time(|| place::draw(&mut self.pipeline, (world.scene(), &world.grid), &place.view));
        drawn?;
        let more = self.pipeline.renderer().brought_bytes() - brought;
        ensure!(more == 0, "{more} bytes were brought for records that were there");
        if self.differing.is_none() {
            let content = puncta::Content {
                scene: world.scene(),
                bricks: world.grid.bricks(),
                blocks: puncta::Bricks::blocks(&world.grid),
            };
            let picture = puncta::Renderer::finish(self.pipeline.renderer_mut(), &content)?;
            self.differing = Some(place.differing(&picture));
        }
        Ok(span)
    }
}

pub(crate) fn table(name: &str, rows: &[Row]) -> String {
    let head = ["setup", "fragment", "frame", "best", "geometry only", "ids that differ"];
    let mut table = Table::new(&format!("Strategies: {name}, everything drawn"), head);
    let mut lacks: Vec<String> = Vec::new();
    for row in rows {
        match row {
            Row::Measured(row) => table.push(vec![
                row.setup.to_string(),
                row.fragment.to_string(),
                cell(&row.frames),
                best(&row.frames),
                cell(&row.away),
                row.differing.to_string(),
            ]),
            Row::Unsupported(setup, fragment, what) => {
                lacks.push(format!("{setup} with {fragment} (cannot {what})"));
            }
        }
    }
    if lacks.is_empty() {
        return table.to_string();
    }
    format!("{table}\nNot on this device: {}.\n", lacks.join(", "))
}

pub(crate) fn json(rows: &[Row]) -> Value {
    let row = |row: &Row| match row {
        Row::Measured(row) => json!({
            "setup": row.setup.to_string(),
            "fragment": row.fragment.to_string(),
            "frame": times(&row.frames),
            "geometry": times(&row.away),
            "differing": row.differing,
        }),
        Row::Unsupported(setup, fragment, what) => json!({
            "setup": setup.to_string(),
            "fragment": fragment.to_string(),
            "cannot": what,
        }),
    };
    rows.iter().map(row).collect()
}
