/*!
What it costs to bring particles to the device for each frame.

The renderer of puncta takes part twice: with a budget in which a quarter of the scene fits, so that in
each frame nothing that is needed is there any more, and with one in which all of it fits. It brings 20
bytes for each particle, with its id, and sets all of them up.
*/

use crate::{
    Options,
    clock::{Span, time},
    memory,
    place::{Away, roomy},
    progress::Bar,
    table::{Table, best, cell, in_turn, number, times, wall},
    ways::{Desk, Way},
};
use anyhow::{Result, ensure};
use puncta::{
    Gpu, GpuRenderer, Grid, GridConfig, Pipeline, Scene, Source, Sphere, View,
    gpu::{GpuConfig, Skipping},
    io::synthetic::Generator,
};
use serde_json::{Value, json};

/// What was measured of a way to bring so many particles.
#[derive(Debug)]
pub(crate) struct Row {
    way: &'static str,
    count: usize,
    /// What a frame brings.
    bytes: u64,
    frames: Vec<Span>,
    growth: Option<u64>,
}

/// One that takes part.
enum Subject<'a> {
    Plain(&'a Desk, Way),
    Renderer(Box<Pipeline<(), GpuRenderer>>),
}

/// What is brought.
struct Load {
    scene: Scene<Sphere>,
    away: Away,
}

pub(crate) fn measure(gpu: &Gpu, options: &Options) -> Result<Vec<Row>> {
    let bar = Bar::counting("bringing", options.counts.len() as u64);
    let mut rows = Vec::new();
    for (done, &count) in (1..).zip(&options.counts) {
        ensure!(
            count as u64 * 16 <= gpu.device().limits().max_buffer_size,
            "{count} particles are too many for one buffer of {}",
            gpu.name()
        );
        rows.extend(measure_count(gpu, options, count)?);
        bar.set(done);
    }
    bar.finish();
    Ok(rows)
}

fn measure_count(gpu: &Gpu, options: &Options, count: usize) -> Result<Vec<Row>> {
    let generator: Generator = format!("cube:n={count}").parse().map_err(anyhow::Error::from)?;
    let mut scene = generator.into_scene()?;
    let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    let like = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y)?;
    let away = Away::new(&scene, puncta::Bricks::bricks(&grid), &like.with_size(1024, 1024)?)?;
    let load = Load { scene, away };
    let desk = Desk::new(gpu, count as u64 * 16)?;
    let all = count as u64 * 20;
    let budgets = [("puncta, a quarter fits", all / 4), ("puncta, resident", u64::MAX)];
    let mut subjects = Vec::new();
    for (name, way) in Way::all(gpu) {
        subjects.push((name, Subject::Plain(&desk, way)));
    }
    for (name, record_bytes) in budgets {
        let config = roomy(count as u64, Skipping::Nothing);
        let record_bytes = record_bytes.min(config.record_bytes);
        let renderer = GpuRenderer::new(gpu, GpuConfig { record_bytes, ..config })?;
        subjects.push((name, Subject::Renderer(Pipeline::new((), renderer).into())));
    }
    let mut ready = Vec::new();
    for (name, mut subject) in subjects {
        // The first frame makes what the others use.
        let (done, growth) = memory::growth(|| {
            subject.frame(&load)?;
            subject.frame(&load)
        });
        let bytes = done?;
        ready.push(((name, subject, growth, bytes), vec![]));
    }
    in_turn(options, &mut ready, |(_, subject, ..)| {
        let (done, span) = time(|| subject.frame(&load));
        done.map(|_| span)
    })?;
    let row = |((way, _, growth, bytes), frames)| Row { way, count, bytes, frames, growth };
    Ok(ready.into_iter().map(row).collect())
}

impl Subject<'_> {
    /// Draws a frame; returns how many bytes it brought.
    fn frame(&mut self, load: &Load) -> Result<u64> {
        match self {
            Self::Plain(desk, way) => {
                let bytes: &[u8] = bytemuck::cast_slice(load.scene.records.as_slice());
                desk.frame(way, bytes)?;
                Ok(if matches!(way, Way::Static) { 0 } else { bytes.len() as u64 })
            }
            Self::Renderer(pipeline) => {
                let before = pipeline.renderer().brought_bytes();
                pipeline.forget::<Sphere>();
                load.away.draw(pipeline, &load.scene)?;
                Ok(pipeline.renderer().brought_bytes() - before)
            }
        }
    }
}

pub(crate) fn table(rows: &[Row]) -> String {
    let head =
        ["particles", "way", "frame", "best", "MB brought", "GB/s", "memory grows by at most, MB"];
    let mut table = Table::new("Bringing particles for each frame", head);
    for row in rows {
        let seconds = wall(&row.frames).unwrap_or(f64::NAN) * 1e-3;
        let speed = row.bytes as f64 / seconds * 1e-9;
        table.push(vec![
            row.count.to_string(),
            row.way.to_owned(),
            cell(&row.frames),
            best(&row.frames),
            number(row.bytes as f64 * 1e-6),
            if row.bytes > 0 { number(speed) } else { String::new() },
            row.growth.map_or_else(String::new, |growth| number(growth as f64 * 1e-6)),
        ]);
    }
    table.to_string()
}

pub(crate) fn json(rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "way": row.way,
            "particles": row.count,
            "bytes": row.bytes,
            "frame": times(&row.frames),
            "memory_growth_bytes": row.growth,
        })
    };
    rows.iter().map(row).collect()
}
