//! Vertex pulling: records that shaders read, and the same indices for each chunk of them.

use crate::{
    boxes::Boxes,
    easel::Easel,
    pipes::{READ, Raster, UNIFORM, layout},
    way::{Call, Draw, Footprint, Recipe, Step},
};
use anyhow::Result;
use bytemuck::cast_slice;
use puncta::gpu::wgpu::{BufferUsages, IndexFormat, ShaderStages};
use std::rc::Rc;

/// As in `pulled.wgsl`: as many as codes of 16 bits can name.
const CHUNK: u32 = 8192;

/// The three faces around the nearest corner, as in `box.wgsl`.
pub(crate) fn pattern() -> [u16; 18] {
    let face = |axis: u16| {
        let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        [a | b, a, 0, a | b, 0, b]
    };
    let mut all = [0; 18];
    for axis in 0..3 {
        all[6 * usize::from(axis)..][..6].copy_from_slice(&face(axis));
    }
    all
}

/// Boxes of 7 vertices.
pub(crate) fn boxes(easel: &Rc<Easel>, boxes: &Boxes) -> Result<Recipe> {
    let device = &easel.device;
    let bytes = boxes.bytes();
    device.check(&[bytes.len() as u64])?;
    device.check_binding(bytes.len() as u64)?;
    let count = u32::try_from(boxes.len())?;
    let chunk: u16 = u16::try_from(CHUNK.min(count))?;
    let codes: Vec<u16> =
        (0..chunk).flat_map(|glyph| pattern().map(|corner| glyph << 3 | corner)).collect();
    let codes: &[u8] = cast_slice(&codes);
    let layout = layout(device, ShaderStages::VERTEX, &[(0, UNIFORM), (1, READ)]);
    let pipeline = Raster {
        parts: &[
            include_str!("common.wgsl"),
            include_str!("box.wgsl"),
            boxes.kind.wgsl(),
            include_str!("pulled.wgsl"),
        ],
        layout: &layout,
        buffers: &[],
        strip: None,
    }
    .pipeline(easel);
    let records = device.filled("pulled::records", bytes, BufferUsages::STORAGE)?;
    let indices = device.filled("pulled::codes", codes, BufferUsages::INDEX)?;
    let bound = device.bind(&layout, &[(0, &easel.camera), (1, &records)]);
    let draw = |count: u32, chunks| {
        Step::Draw(Box::new(Draw {
            pipeline: pipeline.clone(),
            bound: bound.clone(),
            vertices: vec![],
            indices: Some((indices.clone(), IndexFormat::Uint16)),
            call: Call::Indices(18 * count, chunks),
        }))
    };
    let (chunks, rest) = (count / CHUNK, count % CHUNK);
    let steps = vec![draw(CHUNK, 0..chunks), draw(rest, chunks..chunks + 1)];
    let sizes = [chunks, rest];
    let steps = steps.into_iter().zip(sizes).filter(|(_, size)| *size > 0).map(|(step, _)| step);
    let footprint = Footprint { glyphs: bytes.len() as u64, fixed: codes.len() as u64, scratch: 0 };
    Ok(Recipe { easel: Rc::clone(easel), footprint, steps: steps.collect(), rooms: vec![] })
}
