/*!
Vertices that lie in memory: lists, lists with indices, strips.

A vertex has 28 bytes: point, normal, number of the glyph. (In the paper they have 40: the place in the
grid is apart from the corner.) WebGPU gives a triangle what its *first* vertex tells, OpenGL the last:
so the normals of a strip are moved by two against those of the paper.
*/

use crate::{
    boxes::Boxes,
    easel::Easel,
    pipes::{Raster, UNIFORM, layout},
    way::{Call, Draw, Footprint, Recipe, Step},
};
use anyhow::Result;
use bytemuck::{Pod, Zeroable, cast_slice};
use glam::Vec3;
use puncta::gpu::wgpu::{self, BufferUsages, IndexFormat, ShaderStages};
use std::rc::Rc;

/// A vertex in memory.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    pub(crate) point: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) id: u32,
}

/// A vertex in memory without a normal.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Plain {
    pub(crate) point: [f32; 3],
    pub(crate) id: u32,
}

/// How vertices become triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    List,
    Indexed,
    Strip,
}

/// Glyphs that are made at a time.
const CHUNK: usize = 1 << 14;

/// The corners of a cube as a strip; bit k tells the side on axis k.
pub(crate) const STRIP: [usize; 14] = [2, 6, 3, 7, 5, 6, 4, 2, 0, 3, 1, 5, 0, 4];

/// The faces of the triangles of the strip, told by the first vertex; the last two tell none.
pub(crate) const STRIP_FACES: [usize; 14] = [3, 3, 1, 5, 5, 0, 0, 4, 4, 1, 2, 2, 0, 0];

/// The corners of two triangles of a face, counterclockwise seen from outside.
fn face_corners(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let (b, c) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    let (b, c) = if side == 1 { (b, c) } else { (c, b) };
    let base = side << axis;
    [base, base | b, base | b | c, base | c]
}

pub(crate) fn normal(face: usize) -> Vec3 {
    let mut normal = Vec3::ZERO;
    normal[face / 2] = if face % 2 == 1 { 1.0 } else { -1.0 };
    normal
}

/// A side for each bit.
pub(crate) fn pick(corner: usize, low: Vec3, high: Vec3) -> Vec3 {
    let side = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
    Vec3::new(side(0), side(1), side(2))
}

impl Shape {
    /// The number of vertices and indices of a box.
    const fn counts(self) -> (u64, u64) {
        match self {
            Self::List => (36, 0),
            Self::Indexed => (24, 36),
            Self::Strip => (14, 15),
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::List => "triangles",
            Self::Indexed => "indexed triangles",
            Self::Strip => "strips",
        }
    }

    fn push_vertices(self, boxes: &Boxes, index: usize, vertices: &mut Vec<Vertex>) {
        let solid = boxes.get(index);
        let mut push = |corner: usize, face: usize| {
            let point = pick(corner, solid.low, solid.high).to_array();
            vertices.push(Vertex { point, normal: normal(face).to_array(), id: solid.id });
        };
        match self {
            Self::List | Self::Indexed => {
                for face in 0..6 {
                    let corners = face_corners(face);
                    let order: &[usize] =
                        if self == Self::List { &[0, 1, 2, 0, 2, 3] } else { &[0, 1, 2, 3] };
                    order.iter().for_each(|&k| push(corners[k], face));
                }
            }
            Self::Strip => {
                STRIP.into_iter().zip(STRIP_FACES).for_each(|(corner, face)| push(corner, face));
            }
        }
    }

    fn push_indices(self, first: u32, indices: &mut Vec<u32>) {
        match self {
            Self::List => {}
            Self::Indexed => indices
                .extend((0..6).flat_map(|face| [0, 1, 2, 0, 2, 3].map(|k| first + 4 * face + k))),
            Self::Strip => indices.extend((first..first + 14).chain([u32::MAX])),
        }
    }
}

/// Boxes whose vertices all lie in memory.
pub(crate) fn boxes(easel: &Rc<Easel>, boxes: &Boxes, shape: Shape) -> Result<Recipe> {
    let count = boxes.len() as u64;
    let (vertices, indices) = shape.counts();
    let bytes = [count * vertices * size_of::<Vertex>() as u64, count * indices * 4];
    let device = &easel.device;
    device.check(&bytes)?;
    let buffers = Buffers::new(easel, bytes);
    let (mut at, mut at_index) = (0, 0);
    let (mut list, mut numbers) = (Vec::new(), Vec::new());
    for first in (0..boxes.len()).step_by(CHUNK) {
        list.clear();
        numbers.clear();
        for index in first..(first + CHUNK).min(boxes.len()) {
            shape.push_vertices(boxes, index, &mut list);
            shape.push_indices(u32::try_from(index as u64 * vertices)?, &mut numbers);
        }
        device.fill(&buffers.vertices, &mut at, cast_slice(&list))?;
        device.fill(&buffers.indices, &mut at_index, cast_slice(&numbers))?;
    }
    let strip = (shape == Shape::Strip).then_some(Some(IndexFormat::Uint32));
    let call = if indices == 0 {
        Call::Vertices(u32::try_from(count * vertices)?, 0..1)
    } else {
        Call::Indices(u32::try_from(count * indices)?, 0..1)
    };
    Ok(buffers.recipe(easel, (strip, call)))
}

/// The memory of vertices and indices.
#[derive(Debug)]
pub(crate) struct Buffers {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    bytes: [u64; 2],
}

impl Buffers {
    pub(crate) fn new(easel: &Easel, bytes: [u64; 2]) -> Self {
        let device = &easel.device;
        Self {
            vertices: device.buffer("Buffers::vertices", bytes[0], BufferUsages::VERTEX),
            indices: device.buffer("Buffers::indices", bytes[1], BufferUsages::INDEX),
            bytes,
        }
    }

    /// Draws vertices with normals.
    fn recipe(
        self,
        easel: &Rc<Easel>,
        (strip, call): (Option<Option<IndexFormat>>, Call),
    ) -> Recipe {
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32];
        let buffer = vertex_buffer(size_of::<Vertex>(), &attributes);
        self.draw(easel, (include_str!("baked.wgsl"), buffer), (strip, call))
    }

    /// Draws vertices without.
    pub(crate) fn plain(self, easel: &Rc<Easel>, call: Call) -> Recipe {
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 2 => Uint32];
        let buffer = vertex_buffer(size_of::<Plain>(), &attributes);
        self.draw(easel, (include_str!("plain.wgsl"), buffer), (None, call))
    }

    fn draw(
        self,
        easel: &Rc<Easel>,
        (source, buffer): (&str, wgpu::VertexBufferLayout<'_>),
        (strip, call): (Option<Option<IndexFormat>>, Call),
    ) -> Recipe {
        let device = &easel.device;
        let layout = layout(device, ShaderStages::VERTEX, &[(0, UNIFORM)]);
        let pipeline = Raster {
            parts: &[include_str!("common.wgsl"), source],
            layout: &layout,
            buffers: &[Some(buffer)],
            strip,
        }
        .pipeline(easel);
        let indices = (self.bytes[1] > 0).then_some((self.indices, IndexFormat::Uint32));
        let draw = Draw {
            pipeline,
            bound: device.bind(&layout, &[(0, &easel.camera)]),
            vertices: vec![self.vertices],
            indices,
            call,
        };
        let footprint = Footprint { glyphs: self.bytes.iter().sum(), fixed: 0, scratch: 0 };
        let steps = vec![Step::Draw(Box::new(draw))];
        Recipe { easel: Rc::clone(easel), footprint, steps, rooms: vec![] }
    }
}

fn vertex_buffer(
    stride: usize,
    attributes: &[wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'_> {
    let step_mode = wgpu::VertexStepMode::Vertex;
    wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes }
}
