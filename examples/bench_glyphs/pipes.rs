//! Pipelines and their layouts: what all representations have in common.

use crate::{
    device::Device,
    easel::{DEPTH_FORMAT, Easel, ID_FORMAT},
};
use puncta::gpu::wgpu::{self, BufferBindingType, ShaderStages};

/// A uniform, records that are read, and what a compute shader writes.
pub(crate) const UNIFORM: BufferBindingType = BufferBindingType::Uniform;
pub(crate) const READ: BufferBindingType = BufferBindingType::Storage { read_only: true };
pub(crate) const WRITE: BufferBindingType = BufferBindingType::Storage { read_only: false };

/// A layout with buffers at these bindings.
pub(crate) fn layout(
    device: &Device,
    visibility: ShaderStages,
    bindings: &[(u32, BufferBindingType)],
) -> wgpu::BindGroupLayout {
    let entry = |&(binding, ty): &(u32, BufferBindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let entries: Vec<_> = bindings.iter().map(entry).collect();
    device.gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("bench_glyphs"),
        entries: &entries,
    })
}

pub(crate) fn pipeline_layout(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
) -> wgpu::PipelineLayout {
    device.gpu.device().create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("bench_glyphs"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    })
}

/// What differs between the pipelines that draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Raster<'a> {
    pub(crate) parts: &'a [&'a str],
    pub(crate) layout: &'a wgpu::BindGroupLayout,
    pub(crate) buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    /// Strips instead of a list; the format of indices where they can end a strip.
    pub(crate) strip: Option<Option<wgpu::IndexFormat>>,
}

impl Raster<'_> {
    pub(crate) fn pipeline(&self, easel: &Easel) -> wgpu::RenderPipeline {
        let device = &easel.device;
        let module = device.module("bench_glyphs", self.parts);
        let topology = match self.strip {
            Some(_) => wgpu::PrimitiveTopology::TriangleStrip,
            None => wgpu::PrimitiveTopology::TriangleList,
        };
        device.gpu.device().create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("bench_glyphs"),
            layout: Some(&pipeline_layout(device, self.layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology,
                strip_index_format: self.strip.flatten(),
                ..primitive()
            },
            depth_stencil: Some(depth()),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(ID_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// What is seen from behind is not drawn.
pub(crate) fn primitive() -> wgpu::PrimitiveState {
    wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() }
}

/// Inverse depths: what is nearer is larger.
pub(crate) fn depth() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Greater),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

pub(crate) fn compute(
    device: &Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry: &str,
) -> wgpu::ComputePipeline {
    device.gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&pipeline_layout(device, layout)),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
