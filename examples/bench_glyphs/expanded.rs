/*!
Compute expansion: a compute shader leaves out what cannot be seen and writes indices, `glyph << k | vertex`,
for an indirect draw.

Indices are written in parts that fit into one binding. Where each record's indices lie comes from
sums, so their order, and with it the picture, is always the same.
*/

use crate::{
    boxes::Boxes,
    easel::Easel,
    pipes::{READ, Raster, UNIFORM, WRITE, compute, layout},
    way::{Call, Draw, Footprint, Recipe, Room, Step},
};
use anyhow::Result;
use bytemuck::cast_slice;
use puncta::gpu::wgpu::{self, BufferUsages, IndexFormat, ShaderStages};
use std::{ops::Range, rc::Rc};

/// As in `expand.wgsl`.
const GROUP: u32 = 256;

/// The most records that one dispatch counts.
pub(crate) const RECORDS_MAX: u64 = 65_535 * 256;

/// What is expanded.
#[derive(Debug)]
pub(crate) struct Source<'a> {
    /// What comes between the camera and the expansion.
    pub(crate) parts: Vec<&'a str>,
    /// What it reads, at bindings of their own.
    pub(crate) buffers: Vec<(u32, wgpu::Buffer)>,
    /// Bytes of these that grow with the number of glyphs.
    pub(crate) glyph_bytes: u64,
    /// Records that are drawn at a time, the room they need for indices, and how many these are.
    pub(crate) runs: Vec<Run>,
}

/// Records that are drawn at a time.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) records: Range<u32>,
    pub(crate) room: u64,
    pub(crate) expected: Option<u64>,
}

/// The indices that fit into a binding, and a little less than what a number can tell.
pub(crate) fn room_max(easel: &Easel) -> u64 {
    (easel.device.binding_max() / 4).min(1 << 31)
}

/// Boxes of up to 7 vertices.
pub(crate) fn boxes(easel: &Rc<Easel>, boxes: &Boxes) -> Result<Recipe> {
    let bytes = boxes.bytes();
    easel.device.check(&[bytes.len() as u64])?;
    easel.device.check_binding(bytes.len() as u64)?;
    let count = u32::try_from(boxes.len())?;
    let most = u32::try_from((room_max(easel) / 18).min(RECORDS_MAX))?;
    let run = |first: u32| {
        let records = first..(first + most).min(count);
        let room = 18 * u64::from(records.end - records.start);
        Run { records, room, expected: None }
    };
    let records = easel.device.filled("expanded::records", bytes, BufferUsages::STORAGE)?;
    recipe(
        easel,
        &Source {
            parts: vec![
                include_str!("box.wgsl"),
                boxes.kind.wgsl(),
                include_str!("expanded_box.wgsl"),
            ],
            buffers: vec![(1, records)],
            glyph_bytes: bytes.len() as u64,
            runs: (0..count).step_by(most as usize).map(run).collect(),
        },
    )
}

/// The steps of an expansion.
pub(crate) fn recipe(easel: &Rc<Easel>, source: &Source<'_>) -> Result<Recipe> {
    let device = &easel.device;
    let room = source.runs.iter().map(|run| run.room).max().unwrap_or(0);
    device.check(&[4 * room])?;
    let kernels = Kernels::new(easel, source);
    let codes =
        device.buffer("expanded::codes", 4 * room, BufferUsages::STORAGE | BufferUsages::INDEX);
    let groups = |run: &Run| (run.records.end - run.records.start).div_ceil(GROUP);
    let groups_max = source.runs.iter().map(groups).max().unwrap_or(0);
    let sums = device.buffer("expanded::sums", 4 * u64::from(groups_max), BufferUsages::STORAGE);
    let (mut steps, mut rooms) = (Vec::new(), Vec::new());
    for run in &source.runs {
        let part: [u32; 4] = [
            run.records.start,
            run.records.end - run.records.start,
            groups(run),
            u32::try_from(run.room)?,
        ];
        let part = device.filled("expanded::part", cast_slice(&part), BufferUsages::UNIFORM)?;
        let usage = BufferUsages::STORAGE | BufferUsages::INDIRECT | BufferUsages::COPY_SRC;
        let arguments = device.buffer("expanded::arguments", 24, usage);
        let mut buffers = vec![(0, &easel.camera), (2, &part)];
        buffers.extend(source.buffers.iter().map(|(binding, buffer)| (*binding, buffer)));
        let drawn = device.bind(&kernels.read, &buffers);
        buffers.extend([(3, &sums), (4, &codes), (5, &arguments)]);
        let bound = device.bind(&kernels.write, &buffers);
        for (pipeline, groups) in kernels.compute.iter().zip([groups(run), 1, groups(run)]) {
            let (pipeline, bound) = (pipeline.clone(), bound.clone());
            steps.push(Step::Compute { pipeline, bound, groups });
        }
        steps.push(Step::Draw(Box::new(Draw {
            pipeline: kernels.draw.clone(),
            bound: drawn,
            vertices: vec![],
            indices: Some((codes.clone(), IndexFormat::Uint32)),
            call: Call::Indirect(arguments.clone()),
        })));
        rooms.push(Room { arguments, indices: run.room, expected: run.expected });
    }
    let scratch = codes.size() + sums.size();
    let footprint = Footprint { glyphs: source.glyph_bytes, fixed: 0, scratch };
    Ok(Recipe { easel: Rc::clone(easel), footprint, steps, rooms })
}

struct Kernels {
    read: wgpu::BindGroupLayout,
    write: wgpu::BindGroupLayout,
    compute: [wgpu::ComputePipeline; 3],
    draw: wgpu::RenderPipeline,
}

impl Kernels {
    fn new(easel: &Easel, source: &Source<'_>) -> Self {
        let device = &easel.device;
        let mut bindings = vec![(0, UNIFORM), (2, UNIFORM)];
        bindings.extend(source.buffers.iter().map(|(binding, _)| (*binding, READ)));
        let read = layout(device, ShaderStages::VERTEX, &bindings);
        bindings.extend([(3, WRITE), (4, WRITE), (5, WRITE)]);
        let write = layout(device, ShaderStages::COMPUTE, &bindings);
        let mut parts = vec![include_str!("common.wgsl"), include_str!("part.wgsl")];
        parts.extend(&source.parts);
        let draw = Raster { parts: &parts, layout: &read, buffers: &[], strip: None };
        let draw = draw.pipeline(easel);
        parts.push(include_str!("expand.wgsl"));
        let module = device.module("expand", &parts);
        let compute =
            ["count", "scan", "write"].map(|entry| compute(device, &module, &write, entry));
        Self { read, write, compute, draw }
    }
}
