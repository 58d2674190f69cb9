//! Mesh shaders: vertices are made by groups, and live only there.

use crate::{
    boxes::Boxes,
    easel::{Easel, ID_FORMAT},
    pipes::{READ, UNIFORM, depth, layout, pipeline_layout, primitive},
    way::{Call, Draw, Footprint, Recipe, Step},
};
use anyhow::{Result, ensure};
use bytemuck::cast_slice;
use puncta::gpu::wgpu::{self, BufferUsages, ShaderStages};
use std::rc::Rc;

/// As in `mesh.wgsl`: the boxes of a group.
const GLYPHS: u32 = 32;

/// As in `mesh_glyph.wgsl`: the triangles of a group.
pub(crate) const SLICE: u32 = 84;

/// Boxes of 7 vertices; the device of the easel can run mesh shaders.
pub(crate) fn boxes(easel: &Rc<Easel>, boxes: &Boxes) -> Result<Recipe> {
    let device = &easel.device;
    let bytes = boxes.bytes();
    device.check(&[bytes.len() as u64])?;
    device.check_binding(bytes.len() as u64)?;
    let parts = [include_str!("box.wgsl"), boxes.kind.wgsl(), include_str!("mesh.wgsl")];
    let records = device.filled("mesh::records", bytes, BufferUsages::STORAGE)?;
    let count = u32::try_from(boxes.len())?;
    let steps = steps(easel, &parts, (&[(1, records)], count, (GLYPHS, 1)))?;
    let footprint = Footprint { glyphs: bytes.len() as u64, fixed: 0, scratch: 0 };
    Ok(Recipe { easel: Rc::clone(easel), footprint, steps, rooms: vec![] })
}

/// What is drawn: buffers, the number of glyphs, and how many of them make a group or the groups that a
/// glyph has.
type Groups<'a> = (&'a [(u32, wgpu::Buffer)], u32, (u32, u32));

/// Draws of as many groups as there may be at a time.
pub(crate) fn steps(
    easel: &Easel,
    parts: &[&str],
    (buffers, count, (glyphs, slices)): Groups<'_>,
) -> Result<Vec<Step>> {
    let device = &easel.device;
    let limits = device.gpu.device().limits();
    let side = limits.max_mesh_workgroups_per_dimension;
    ensure!(slices > 0 && slices <= side, "{slices} groups of a glyph, of {side}");
    let groups = side.min(limits.max_mesh_workgroup_total_count / slices);
    let most = groups.saturating_mul(glyphs);
    let mut bindings = vec![(0, UNIFORM), (2, UNIFORM)];
    bindings.extend(buffers.iter().map(|(binding, _)| (*binding, READ)));
    let layout = layout(device, ShaderStages::MESH, &bindings);
    let pipeline = pipeline(easel, parts, &layout);
    let mut steps = Vec::new();
    for first in (0..count).step_by(most as usize) {
        let here = most.min(count - first);
        let part: [u32; 4] = [first, here, 0, 0];
        let part = device.filled("mesh::part", cast_slice(&part), BufferUsages::UNIFORM)?;
        let mut bound = vec![(0, &easel.camera), (2, &part)];
        bound.extend(buffers.iter().map(|(binding, buffer)| (*binding, buffer)));
        steps.push(Step::Draw(Box::new(Draw {
            pipeline: pipeline.clone(),
            bound: device.bind(&layout, &bound),
            vertices: vec![],
            indices: None,
            call: Call::Meshes(here.div_ceil(glyphs), slices),
        })));
    }
    Ok(steps)
}

fn pipeline(easel: &Easel, parts: &[&str], layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let device = &easel.device;
    let common = [include_str!("common.wgsl"), include_str!("part.wgsl")];
    let head = ["enable wgpu_mesh_shader;\n"];
    let module = device.module("mesh", &[&head[..], &common, parts].concat());
    device.gpu.device().create_mesh_pipeline(&wgpu::MeshPipelineDescriptor {
        label: Some("mesh"),
        layout: Some(&pipeline_layout(device, layout)),
        task: None,
        mesh: wgpu::MeshState {
            module: &module,
            entry_point: Some("glyphs_of_group"),
            compilation_options: wgpu::PipelineCompilationOptions {
                zero_initialize_workgroup_memory: false,
                ..Default::default()
            },
        },
        primitive: primitive(),
        depth_stencil: Some(depth()),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(ID_FORMAT.into())],
        }),
        multiview: None,
        cache: None,
    })
}
