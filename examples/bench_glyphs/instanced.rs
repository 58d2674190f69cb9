//! Hardware instancing: a cube in memory, as a strip of 14 vertices, and a record for each instance.

use crate::{
    baked::{STRIP, STRIP_FACES, normal, pick},
    boxes::{Boxes, Kind},
    easel::Easel,
    pipes::{Raster, UNIFORM, layout},
    way::{Call, Draw, Footprint, Recipe, Step},
};
use anyhow::Result;
use bytemuck::cast_slice;
use glam::Vec3;
use puncta::gpu::wgpu::{self, BufferUsages, ShaderStages, VertexAttribute, VertexStepMode};
use std::rc::Rc;

const BLOCK: [VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Uint16x4];
const CUBOID: [VertexAttribute; 2] = wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3];
const CORNER: [VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];

/// A cube for each box.
pub(crate) fn boxes(easel: &Rc<Easel>, boxes: &Boxes) -> Result<Recipe> {
    let (source, attributes): (_, &[VertexAttribute]) = match boxes.kind {
        Kind::Block { .. } => (include_str!("instanced_block.wgsl"), &BLOCK),
        Kind::Cuboid => (include_str!("instanced_cuboid.wgsl"), &CUBOID),
    };
    let device = &easel.device;
    let bytes = boxes.bytes();
    device.check(&[bytes.len() as u64])?;
    let corner = |(corner, face)| {
        [pick(corner, Vec3::splat(-0.5), Vec3::splat(0.5)), normal(face)].map(|v| v.to_array())
    };
    let cube: Vec<_> = STRIP.into_iter().zip(STRIP_FACES).map(corner).collect();
    let cube: &[u8] = cast_slice(&cube);
    let layout = layout(device, ShaderStages::VERTEX, &[(0, UNIFORM)]);
    let buffer = |array_stride, step_mode, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
    };
    let pipeline = Raster {
        parts: &[include_str!("common.wgsl"), source],
        layout: &layout,
        buffers: &[
            buffer(24, VertexStepMode::Vertex, &CORNER),
            buffer(boxes.kind.bytes() as u64, VertexStepMode::Instance, attributes),
        ],
        strip: Some(None),
    }
    .pipeline(easel);
    let draw = Draw {
        pipeline,
        bound: device.bind(&layout, &[(0, &easel.camera)]),
        vertices: vec![
            device.filled("instanced::cube", cube, BufferUsages::VERTEX)?,
            device.filled("instanced::records", bytes, BufferUsages::VERTEX)?,
        ],
        indices: None,
        call: Call::Vertices(14, 0..u32::try_from(boxes.len())?),
    };
    let footprint = Footprint { glyphs: bytes.len() as u64, fixed: cube.len() as u64, scratch: 0 };
    let steps = vec![Step::Draw(Box::new(draw))];
    Ok(Recipe { easel: Rc::clone(easel), footprint, steps, rooms: vec![] })
}
