/*!
Ways to bring particles to a device, each a frame at a time.

All bring the same bytes to the same buffer, and then the device reads all of them: it draws them as
points beside the picture, as the thesis does.
*/

use crate::ring::Ring;
use anyhow::{Context, Result};
use puncta::{
    Gpu,
    gpu::wgpu::{self, util::StagingBelt},
};
use std::num::NonZero;

/// The bytes that are brought in one piece, where there are pieces.
pub(crate) const PIECE: usize = 4 << 20;

/// A way.
#[derive(Debug)]
pub(crate) enum Way {
    /// Nothing is brought.
    Static,
    /// One call of `Queue::write_buffer`.
    Write,
    /// A call for each piece, and a submission after each.
    Pieces,
    /// The staging belt of wgpu, with chunks of the size of a piece.
    Belt(Box<StagingBelt>),
    /// A ring of mapped buffers that a thread fills.
    Ring(Ring),
}

impl Way {
    /// All there are, not begun.
    pub(crate) fn all(gpu: &Gpu) -> [(&'static str, Self); 5] {
        [
            ("static buffer", Self::Static),
            ("write_buffer", Self::Write),
            ("write_buffer, 4 MiB pieces", Self::Pieces),
            (
                "staging belt",
                Self::Belt(StagingBelt::new(gpu.device().clone(), PIECE as u64).into()),
            ),
            ("mapped ring, filled by a thread", Self::Ring(Ring::new(gpu))),
        ]
    }

    fn bring(&mut self, gpu: &Gpu, target: &wgpu::Buffer, bytes: &[u8]) -> Result<()> {
        let (device, queue) = (gpu.device(), gpu.queue());
        let pieces = (0_u64..).step_by(PIECE).zip(bytes.chunks(PIECE));
        match self {
            Self::Static => {}
            Self::Write => queue.write_buffer(target, 0, bytes),
            Self::Pieces => {
                for (offset, piece) in pieces {
                    queue.write_buffer(target, offset, piece);
                    queue.submit([]);
                    device.poll(wgpu::PollType::Poll)?;
                }
            }
            Self::Belt(belt) => {
                let mut encoder = device.create_command_encoder(&Default::default());
                for (offset, piece) in pieces {
                    let size = NonZero::new(piece.len() as u64).context("an empty piece")?;
                    belt.write_buffer(&mut encoder, target, offset, size).copy_from_slice(piece);
                }
                belt.finish();
                queue.submit([encoder.finish()]);
                belt.recall();
            }
            Self::Ring(ring) => ring.bring(gpu, target, bytes)?,
        }
        Ok(())
    }
}

/// A buffer of particles, and how they are drawn beside the picture.
#[derive(Debug)]
pub(crate) struct Desk {
    gpu: Gpu,
    target: wgpu::Buffer,
    pipeline: wgpu::RenderPipeline,
    picture: wgpu::TextureView,
}

const POINTS: &str = "
@vertex
fn beside(@location(0) sphere: vec4<f32>) -> @builtin(position) vec4<f32> {
    // Beyond the right side, wherever the sphere is; finite numbers are assumed.
    return vec4(2.0 + abs(sphere.x), sphere.y + sphere.z, 0.0 * sphere.w, 1.0);
}

@fragment
fn white() -> @location(0) vec4<f32> {
    return vec4(1.0);
}
";

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Desk {
    pub(crate) fn new(gpu: &Gpu, bytes: u64) -> Result<Self> {
        let device = gpu.device();
        let target = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Desk::target"),
            size: bytes,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        // Memory is given when it is first written.
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&target, 0, None);
        gpu.queue().submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely())?;
        let (pipeline, picture) = (pipeline(device), picture(device));
        Ok(Self { gpu: gpu.clone(), target, pipeline, picture })
    }

    /// Brings particles, and waits until that is done.
    pub(crate) fn bring(&self, way: &mut Way, bytes: &[u8]) -> Result<()> {
        way.bring(&self.gpu, &self.target, bytes)?;
        self.gpu.queue().submit([]);
        self.gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
        Ok(())
    }

    /// Brings particles and draws them, and waits until that is done.
    pub(crate) fn frame(&self, way: &mut Way, bytes: &[u8]) -> Result<()> {
        way.bring(&self.gpu, &self.target, bytes)?;
        let device = self.gpu.device();
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Desk::frame"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.picture,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, self.target.slice(..));
        pass.draw(0..u32::try_from(bytes.len() / 16)?, 0..1);
        drop(pass);
        self.gpu.queue().submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(())
    }
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("Desk::points"),
        source: wgpu::ShaderSource::Wgsl(POINTS.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("Desk::pipeline"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("beside"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 16,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x4],
            })],
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::PointList,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("white"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn picture(device: &wgpu::Device) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("Desk::picture"),
        size: wgpu::Extent3d { width: 1024, height: 1024, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
