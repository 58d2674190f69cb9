//! What pictures are drawn on, and the camera before it.

use crate::{boxes::ANY_FACE, device::Device};
use anyhow::Result;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, DVec4};
use puncta::{
    View,
    gpu::wgpu::{self, Features},
};
use std::rc::Rc;

pub(crate) const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A pixel that shows nothing.
pub(crate) const NOTHING: u32 = u32::MAX;

/// As in `common.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Camera {
    clip: [[f32; 4]; 4],
    planes: [[f32; 4]; 5],
    eye: [f32; 3],
    away: f32,
    sharpness: f32,
    pixel: f32,
    side: u32,
    pad: u32,
}

/// Where the picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sight {
    /// Before the camera.
    Here,
    /// Beside the picture: all vertices are made, and no pixel is.
    Away,
}

/// A picture of ids, a depth buffer and a camera.
#[derive(Debug)]
pub(crate) struct Easel {
    pub(crate) device: Rc<Device>,
    pub(crate) camera: wgpu::Buffer,
    uniforms: Camera,
    size: [u32; 2],
    ids: wgpu::Texture,
    ids_view: wgpu::TextureView,
    depth: wgpu::TextureView,
}

impl Easel {
    /// For a perspective view; `side` is that of a world of blocks, and `sharpness` is that of curves.
    pub(crate) fn new(device: Rc<Device>, view: &View, (side, sharpness): (u32, f32)) -> Self {
        let size = [view.width(), view.height()];
        let texture = |format, usage| {
            device.gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("Easel"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let ids = texture(ID_FORMAT, wgpu::TextureUsages::COPY_SRC);
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::empty());
        let uniforms = Camera { side, sharpness, ..camera(view) };
        let camera =
            device.buffer("Easel::camera", size_of::<Camera>() as u64, wgpu::BufferUsages::UNIFORM);
        Self {
            camera,
            uniforms,
            size,
            ids_view: ids.create_view(&Default::default()),
            depth: depth.create_view(&Default::default()),
            ids,
            device,
        }
    }

    pub(crate) fn look(&self, sight: Sight) {
        let away = if sight == Sight::Away { 4.0 } else { 0.0 };
        let uniforms = Camera { away, ..self.uniforms };
        self.device.gpu.queue().write_buffer(&self.camera, 0, bytemuck::bytes_of(&uniforms));
    }

    /// A pass on what is there already, or on nothing.
    pub(crate) fn pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        is_first: bool,
    ) -> wgpu::RenderPass<'a> {
        let nothing = wgpu::Color { r: f64::from(NOTHING), g: 0.0, b: 0.0, a: 0.0 };
        let load = if is_first { wgpu::LoadOp::Clear(nothing) } else { wgpu::LoadOp::Load };
        let far = if is_first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
        let store = wgpu::StoreOp::Store;
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Easel::pass"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.ids_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: far, store }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// What pixels show: `8 id + face`.
    pub(crate) fn words(&self) -> Result<Vec<u32>> {
        let [width, height] = self.size;
        let row = (4 * width).next_multiple_of(256);
        let bytes = u64::from(row) * u64::from(height);
        let buffer = self.device.buffer("Easel::words", bytes, wgpu::BufferUsages::COPY_SRC);
        let mut encoder = self.device.gpu.device().create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.ids.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            self.ids.size(),
        );
        self.device.gpu.queue().submit([encoder.finish()]);
        let words = self.device.read(&buffer)?;
        let rows = words.chunks_exact(row as usize / 4).take(height as usize);
        Ok(rows.flat_map(|row| &row[..width as usize]).copied().collect())
    }

    pub(crate) fn can_count(&self) -> bool {
        self.device.has(Features::PIPELINE_STATISTICS_QUERY)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn camera(view: &View) -> Camera {
    let (eye, pixel) = (view.eye(), view.pixel_size());
    let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(eye) * scale);
    let x = row(view.right(), 2.0 / (pixel * f64::from(view.width())));
    let y = row(view.up(), 2.0 / (pixel * f64::from(view.height())));
    let w = row(view.forward(), 1.0);
    // Inverse depths, all of a float's range: anything from near to infinity.
    let near = view.near().max(1e-3);
    let z = DVec4::new(0.0, 0.0, 0.0, near);
    let narrow = |v: DVec4| v.as_vec4().to_array();
    let column = |k: usize| [x[k], y[k], z[k], w[k]].map(|value| value as f32);
    let planes = [w + x, w - x, w + y, w - y, w - z];
    Camera {
        clip: [0, 1, 2, 3].map(column),
        planes: planes.map(narrow),
        eye: eye.as_vec3().to_array(),
        away: 0.0,
        sharpness: 0.0,
        pixel: pixel as f32,
        side: 1,
        pad: 0,
    }
}

/// The number of pixels that tell different things; a face that is not told may be any.
pub(crate) fn differing(a: &[u32], b: &[u32]) -> usize {
    let same = |&(a, b): &(&u32, &u32)| {
        let open = |word: u32| word & 7 == ANY_FACE && word != NOTHING;
        if open(*a) || open(*b) {
            a >> 3 == b >> 3 && *a != NOTHING && *b != NOTHING
        } else {
            a == b
        }
    };
    a.iter().zip(b).filter(|pair| !same(pair)).count() + a.len().abs_diff(b.len())
}
