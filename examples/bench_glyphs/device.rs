//! The device that is measured, which can also count what it does.

use anyhow::{Context, Result, ensure};
use puncta::{
    Gpu,
    gpu::{
        Extent,
        wgpu::{self, Features},
    },
};

/// The bytes that are brought in one piece.
const PIECE: usize = 4 << 20;

/// A device, and what may be used of it.
#[derive(Debug)]
pub(crate) struct Device {
    pub(crate) gpu: Gpu,
    /// The most bytes that a representation may have.
    memory: u64,
}

impl Device {
    /// The best adapter, or the first one whose name contains `name`; its device counts vertices if
    /// it can.
    pub(crate) fn new(name: Option<&str>, memory: u64) -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = match name {
            None => pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            }))?,
            Some(name) => {
                let has_name = |adapter: &wgpu::Adapter| {
                    adapter.get_info().name.to_lowercase().contains(&name.to_lowercase())
                };
                let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
                all.into_iter().find(has_name).with_context(|| format!("no adapter {name:?}"))?
            }
        };
        let counting = adapter.features() & Features::PIPELINE_STATISTICS_QUERY;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("bench_glyphs"),
            required_features: Gpu::useful_features(&adapter) | counting,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
        Ok(Self { gpu: Gpu::from_device(device, queue), memory })
    }

    /// The library's own device, if it runs mesh shaders.
    pub(crate) fn with_meshes(name: Option<&str>, memory: u64) -> Result<Option<Self>> {
        let gpu = Gpu::new(name, Extent::Full)?;
        let has_meshes = gpu.device().features().contains(Features::EXPERIMENTAL_MESH_SHADER);
        Ok(has_meshes.then_some(Self { gpu, memory }))
    }

    pub(crate) fn has(&self, features: Features) -> bool {
        self.gpu.device().features().contains(features)
    }

    /// Says why buffers of these sizes cannot be had.
    pub(crate) fn check(&self, buffers: &[u64]) -> Result<()> {
        let most = self.gpu.device().limits().max_buffer_size;
        for bytes in buffers {
            ensure!(*bytes <= most, "a buffer of {bytes} bytes, of {most} that the device has");
        }
        let sum: u64 = buffers.iter().sum();
        ensure!(sum <= self.memory, "{sum} bytes, of {} that may be used", self.memory);
        Ok(())
    }

    /// Says why there cannot be a picture of this size.
    pub(crate) fn check_size(&self, size: [u32; 2]) -> Result<()> {
        let most = self.gpu.device().limits().max_texture_dimension_2d;
        let is_possible = size.iter().all(|side| (1..=most).contains(side));
        ensure!(is_possible, "a picture of {size:?} pixels: its sides must be 1 to {most}");
        Ok(())
    }

    /// Says why a shader cannot see a buffer of this size.
    pub(crate) fn check_binding(&self, bytes: u64) -> Result<()> {
        let most = self.binding_max();
        ensure!(bytes <= most, "a binding of {bytes} bytes, of {most} that the device has");
        Ok(())
    }

    pub(crate) fn binding_max(&self) -> u64 {
        self.gpu.device().limits().max_storage_buffer_binding_size
    }

    /// An empty buffer.
    pub(crate) fn buffer(
        &self,
        label: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.max(16).next_multiple_of(16),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// A buffer with content.
    pub(crate) fn filled(
        &self,
        label: &str,
        bytes: &[u8],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer> {
        let buffer = self.buffer(label, bytes.len() as u64, usage);
        self.fill(&buffer, &mut 0, bytes)?;
        Ok(buffer)
    }

    /// Writes at a place and moves on, in pieces so that staging memory stays small.
    pub(crate) fn fill(&self, buffer: &wgpu::Buffer, at: &mut u64, bytes: &[u8]) -> Result<()> {
        for piece in bytes.chunks(PIECE) {
            self.gpu.queue().write_buffer(buffer, *at, piece);
            self.gpu.queue().submit([]);
            self.gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
            *at += piece.len() as u64;
        }
        Ok(())
    }

    pub(crate) fn module(&self, label: &str, parts: &[&str]) -> wgpu::ShaderModule {
        self.gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(parts.concat().into()),
        })
    }

    /// A bind group of the buffers at these bindings.
    pub(crate) fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = buffers
            .iter()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("bench_glyphs"),
            layout,
            entries: &entries,
        })
    }

    /// What a buffer holds, as words.
    pub(crate) fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>> {
        let staging = self.gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("Device::read"),
            size: buffer.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.gpu.device().create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
        self.gpu.queue().submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        self.gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
        let view = staging.get_mapped_range(..)?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}
