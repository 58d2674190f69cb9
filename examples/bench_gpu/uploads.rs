/*!
What it costs to bring particles to the device for each frame.

The renderer of puncta takes part twice: with a budget in which a quarter of the scene fits, so that
in each frame nothing that is needed is there any more, and with one in which all of it fits. It
brings 20 bytes for each particle, with its id, and sets all of them up.

How much memory a way takes is measured in a process of its own: what one way has given back, the
next would take again, and seem to need nothing.
*/

use crate::{
    Options,
    clock::{Span, time},
    memory,
    place::{Away, roomy},
    progress::Bar,
    table::{Table, cell, in_turn, number, times, wall},
    ways::{Desk, Way},
};
use anyhow::{Context, Result, ensure};
use puncta::{
    Gpu, GpuRenderer, Grid, GridConfig, Pipeline, Scene, Source, Sphere, View,
    gpu::{GpuConfig, Skipping},
    io::synthetic::Generator,
};
use serde_json::{Value, json};
use std::process::Command;

/// The smallest budget that the renderer takes.
const LEAST: u64 = 1024 * 24;

/// What was measured of a way to bring so many particles.
#[derive(Debug)]
pub(crate) struct Row {
    way: &'static str,
    count: usize,
    /// What a frame brings.
    bytes: u64,
    frames: Vec<Span>,
    /// Bringing without drawing, where the two can be told apart.
    alone: Vec<Span>,
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

impl Load {
    fn new(count: usize) -> Result<Self> {
        let generator: Generator = format!("cube:n={count}").parse()?;
        let mut scene = generator.into_scene()?;
        let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
        let like = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y)?;
        let away = Away::new(&scene, grid.bricks(), &like.with_size(1024, 1024)?)?;
        Ok(Self { scene, away })
    }
}

pub(crate) fn measure(gpu: &Gpu, options: &Options) -> Result<Vec<Row>> {
    let bar = Bar::counting("bringing", options.counts.len() as u64);
    let mut rows = Vec::new();
    for (done, &count) in (1..).zip(&options.counts) {
        rows.extend(measure_count(gpu, options, count)?);
        bar.set(done);
    }
    bar.finish();
    Ok(rows)
}

fn measure_count(gpu: &Gpu, options: &Options, count: usize) -> Result<Vec<Row>> {
    let desk = desk(gpu, count)?;
    let load = Load::new(count)?;
    let mut ready = Vec::new();
    for (name, mut subject) in subjects(gpu, &desk, count)? {
        // The first frame makes what the others use.
        subject.frame(&load)?;
        let bytes = subject.frame(&load)?;
        ready.push(((name, subject, bytes), vec![]));
    }
    in_turn(options, &mut ready, |(_, subject, _)| {
        let (done, span) = time(|| subject.frame(&load));
        done.map(|_| span)
    })?;
    let mut alone: Vec<_> = ready.iter_mut().map(|((_, one, _), _)| (one, vec![])).collect();
    in_turn(options, &mut alone, |subject| {
        let (done, span) = time(|| subject.bring(&load));
        done.map(|()| span)
    })?;
    let alone: Vec<Vec<Span>> = alone.into_iter().map(|(_, spans)| spans).collect();
    let mut rows = Vec::new();
    for (place, (((way, subject, bytes), frames), alone)) in
        ready.into_iter().zip(alone).enumerate()
    {
        let is_plain = matches!(subject, Subject::Plain(_, _));
        let alone = if is_plain && bytes > 0 { alone } else { vec![] };
        drop(subject);
        let growth = ask_growth(options, place, count)?;
        rows.push(Row { way, count, bytes, frames, alone, growth });
    }
    Ok(rows)
}

fn desk(gpu: &Gpu, count: usize) -> Result<Desk> {
    let (bytes, limit) = (count as u64 * 16, gpu.device().limits().max_buffer_size);
    let name = gpu.name();
    ensure!(bytes <= limit, "{count} particles are {bytes} bytes; a buffer of {name} has {limit}");
    Desk::new(gpu, bytes)
}

/// All that take part, with their names.
fn subjects<'a>(
    gpu: &Gpu,
    desk: &'a Desk,
    count: usize,
) -> Result<Vec<(&'static str, Subject<'a>)>> {
    let plain = |(name, way)| (name, Subject::Plain(desk, way));
    let mut subjects: Vec<_> = Way::all(gpu).map(plain).into();
    let all = count as u64 * 24;
    for (name, record_bytes) in
        [("puncta, a quarter fits", (all / 4).max(LEAST)), ("puncta, resident", u64::MAX)]
    {
        let config = roomy(count as u64, Skipping::Nothing);
        let record_bytes = record_bytes.min(config.record_bytes);
        let renderer = GpuRenderer::new(gpu, GpuConfig { record_bytes, ..config })?;
        subjects.push((name, Subject::Renderer(Pipeline::new((), renderer).into())));
    }
    Ok(subjects)
}

/// How far memory grows in two frames of one of those that take part; in a process of its own.
fn ask_growth(options: &Options, place: usize, count: usize) -> Result<Option<u64>> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["--growth", &place.to_string(), "--counts", &count.to_string()]);
    command.args(["--extent", options.extent.name()]);
    if let Some(adapter) = &options.adapter {
        command.args(["--adapter", adapter]);
    }
    // Memory that is given back shall not stay in the process.
    command.envs([("MALLOC_MMAP_THRESHOLD_", "65536"), ("MALLOC_TRIM_THRESHOLD_", "65536")]);
    let output = command.output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "memory cannot be measured: {}", said.trim());
    let said = String::from_utf8_lossy(&output.stdout);
    Ok(serde_json::from_str(said.trim())?)
}

/// The answer to that.
pub(crate) fn growth(gpu: &Gpu, options: &Options, place: usize) -> Result<String> {
    let count = *options.counts.first().context("there is no number of particles")?;
    let desk = desk(gpu, count)?;
    let load = Load::new(count)?;
    let mut subjects = subjects(gpu, &desk, count)?;
    let (_, resting) = subjects.first_mut().context("there are no ways")?;
    // What all ways need is there.
    resting.frame(&load)?;
    let (_, subject) = subjects.get_mut(place).context("there are not so many ways")?;
    let (done, growth) = memory::growth(|| {
        subject.frame(&load)?;
        subject.frame(&load)
    });
    done?;
    Ok(serde_json::to_string(&growth)?)
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

    /// Brings what a frame brings, and draws nothing.
    fn bring(&mut self, load: &Load) -> Result<()> {
        match self {
            Self::Plain(desk, way) => {
                desk.bring(way, bytemuck::cast_slice(load.scene.records.as_slice()))
            }
            Self::Renderer(_) => Ok(()),
        }
    }
}

pub(crate) fn table(rows: &[Row]) -> String {
    let head = [
        "particles",
        "way",
        "frame",
        "bringing alone",
        "MB brought",
        "GB/s",
        "memory grows by at most, MB",
    ];
    let mut table = Table::new("Bringing particles for each frame", head);
    for row in rows {
        table.push(vec![
            row.count.to_string(),
            row.way.to_owned(),
            cell(&row.frames),
            cell(&row.alone),
            number(row.bytes as f64 * 1e-6),
            row.speed().map_or_else(String::new, number),
            row.growth.map_or_else(String::new, |growth| number(growth as f64 * 1e-6)),
        ]);
    }
    table.to_string()
}

impl Row {
    /// Gigabytes a second, without drawing where that is known.
    fn speed(&self) -> Option<f64> {
        let milliseconds = wall(&self.alone).or_else(|| wall(&self.frames))?;
        (self.bytes > 0).then(|| self.bytes as f64 / milliseconds * 1e-6)
    }
}

pub(crate) fn json(rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "way": row.way,
            "particles": row.count,
            "bytes": row.bytes,
            "frame": times(&row.frames),
            "alone": times(&row.alone),
            "memory_growth_bytes": row.growth,
        })
    };
    rows.iter().map(row).collect()
}
