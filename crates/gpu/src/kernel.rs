//! Shaders: how they are put together and run.

use crate::{Error, Gpu};
use std::collections::HashMap;

macro_rules! shader {
    ($($name:literal),+) => {
        concat!($(include_str!(concat!("../shader/", $name, ".wgsl")), "\n"),+)
    };
}
pub(crate) use shader;

/// How many invocations make a group.
const GROUP: u32 = 64;

/// The largest number of groups along one side of a dispatch.
const SIDE_MAX: u32 = 65_535;

/// A compute shader that is ready to run.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    label: &'static str,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

impl Kernel {
    /// The kernel of an entry point; `label` names it.
    pub(crate) fn new(
        gpu: &Gpu,
        label: &'static str,
        (source, entry): (&str, &str),
        constants: &[(&str, f64)],
    ) -> Self {
        let module = module(gpu, label, source);
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: options(constants),
            cache: None,
        });
        let layout = pipeline.get_bind_group_layout(0);
        Self { label, pipeline, layout }
    }

    /// Runs it for this many items.
    pub(crate) fn run(
        &self,
        work: &mut Work<'_>,
        bindings: &[(u32, wgpu::BindingResource<'_>)],
        items: u32,
    ) {
        let groups = items.div_ceil(GROUP);
        if groups == 0 {
            return;
        }
        let down = groups.div_ceil(SIDE_MAX);
        let across = groups.div_ceil(down);
        let bound = bind(work.gpu, self.label, &self.layout, bindings);
        let mut pass = work.begin(self.label);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.dispatch_workgroups(across, down, 1);
    }

    /// Runs one group of it.
    pub(crate) fn run_once(
        &self,
        work: &mut Work<'_>,
        bindings: &[(u32, wgpu::BindingResource<'_>)],
    ) {
        self.run(work, bindings, 1);
    }

    /// Runs it for as many groups as are written in `arguments`.
    pub(crate) fn run_indirect(
        &self,
        work: &mut Work<'_>,
        bindings: &[(u32, wgpu::BindingResource<'_>)],
        (arguments, offset): (&wgpu::Buffer, u64),
    ) {
        let bound = bind(work.gpu, self.label, &self.layout, bindings);
        let mut pass = work.begin(self.label);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.dispatch_workgroups_indirect(arguments, offset);
    }
}

/// Commands that are being put together.
#[derive(Debug)]
pub(crate) struct Work<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) encoder: wgpu::CommandEncoder,
}

impl<'a> Work<'a> {
    pub(crate) fn new(gpu: &'a Gpu, label: &'static str) -> Self {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some(label) };
        Self { gpu, encoder: gpu.device.create_command_encoder(&descriptor) }
    }

    fn begin(&mut self, label: &'static str) -> wgpu::ComputePass<'_> {
        self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: None,
        })
    }

    pub(crate) fn submit(self) {
        self.gpu.queue.submit([self.encoder.finish()]);
    }
}

/// A shader module. Its sources are checked by tests; so loops are known to end and indices to hold.
pub(crate) fn module(gpu: &Gpu, label: &'static str, source: &str) -> wgpu::ShaderModule {
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

pub(crate) fn options<'a>(constants: &'a [(&'a str, f64)]) -> wgpu::PipelineCompilationOptions<'a> {
    wgpu::PipelineCompilationOptions { constants, ..Default::default() }
}

pub(crate) fn bind(
    gpu: &Gpu,
    label: &'static str,
    layout: &wgpu::BindGroupLayout,
    bindings: &[(u32, wgpu::BindingResource<'_>)],
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = bindings
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: resource.clone(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// A buffer for shaders that can be written, cleared and read back.
pub(crate) fn storage(gpu: &Gpu, label: &'static str, bytes: u64) -> Result<wgpu::Buffer, Error> {
    let usage = wgpu::BufferUsages::STORAGE
        | wgpu::BufferUsages::COPY_DST
        | wgpu::BufferUsages::COPY_SRC
        | wgpu::BufferUsages::INDIRECT;
    buffer(gpu, label, (bytes, usage))
}

/// A buffer; its size is rounded up to what can be bound and cleared.
pub(crate) fn buffer(
    gpu: &Gpu,
    label: &'static str,
    (bytes, usage): (u64, wgpu::BufferUsages),
) -> Result<wgpu::Buffer, Error> {
    let size = bytes.max(16).div_ceil(16) * 16;
    gpu.guard(label, || {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    })
}

/// A uniform buffer of these bytes.
pub(crate) fn uniform(gpu: &Gpu, label: &'static str, bytes: u64) -> Result<wgpu::Buffer, Error> {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    buffer(gpu, label, (bytes, usage))
}

/// Buffers that grow with what is put into them, by their labels.
#[derive(Debug, Default)]
pub(crate) struct Pool(HashMap<&'static str, wgpu::Buffer>);

impl Pool {
    /// A storage buffer of at least this size. What it holds is lost when it grows.
    pub(crate) fn storage(
        &mut self,
        gpu: &Gpu,
        label: &'static str,
        bytes: u64,
    ) -> Result<wgpu::Buffer, Error> {
        if let Some(known) = self.0.get(label).filter(|buffer| buffer.size() >= bytes) {
            return Ok(known.clone());
        }
        let limit = gpu.binding_bytes_max();
        let grown = storage(gpu, label, bytes.max((bytes * 3 / 2).min(limit)))?;
        self.0.insert(label, grown.clone());
        Ok(grown)
    }

    /// The same, filled with values.
    pub(crate) fn filled<T: bytemuck::Pod>(
        &mut self,
        gpu: &Gpu,
        label: &'static str,
        values: &[T],
    ) -> Result<wgpu::Buffer, Error> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let buffer = self.storage(gpu, label, bytes.len() as u64)?;
        gpu.guard(label, || gpu.queue.write_buffer(&buffer, 0, bytes))?;
        Ok(buffer)
    }
}

/// What some buffers hold, read back in one go.
pub(crate) fn read(
    gpu: &Gpu,
    pool: &mut Pool,
    parts: &[(&wgpu::Buffer, std::ops::Range<u64>)],
) -> Result<Vec<u8>, Error> {
    let bytes: u64 = parts.iter().map(|(_, range)| range.end - range.start).sum();
    let label = "read::staging";
    let staging = match pool.0.get(label).filter(|buffer| buffer.size() >= bytes) {
        Some(known) => known.clone(),
        None => {
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let made = buffer(gpu, label, (bytes, usage))?;
            pool.0.insert(label, made.clone());
            made
        }
    };
    let mut work = Work::new(gpu, label);
    let mut place = 0;
    for (source, range) in parts {
        let size = range.end - range.start;
        work.encoder.copy_buffer_to_buffer(source, range.start, &staging, place, size);
        place += size;
    }
    gpu.guard("reading back", || work.submit())?;
    let (sender, receiver) = std::sync::mpsc::channel();
    gpu.guard("reading back", || {
        staging.map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
            sender.send(result).ok();
        });
    })?;
    gpu.wait()?;
    let lost = |what: String| Error::Lost { reason: what };
    match receiver.recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(lost(error.to_string())),
        Err(error) => return Err(lost(error.to_string())),
    }
    let view = staging.get_mapped_range(0..bytes).map_err(|error| lost(error.to_string()))?;
    let result = view.to_vec();
    drop(view);
    staging.unmap();
    Ok(result)
}
