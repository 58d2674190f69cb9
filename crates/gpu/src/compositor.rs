/*!
Shaded images in a program's own render pass, beside what the program draws itself.

This is the middleware pattern of wgpu: `new` once, `prepare` when there is another image, `render` in a
pass. The image fills the pass's viewport. If the pass has a depth buffer, the image takes part in it:
spheres hide, and are hidden by, what the program draws.
*/

use crate::{
    Error, Gpu, Shaded,
    kernel::{bind, module, options, shader, uniform},
};
use bytemuck::{Pod, Zeroable};

pub(crate) const SOURCE: &str = shader!("compositor");

/// A pass that images are drawn in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompositorConfig {
    /// The format of the colors. If it is one of sRGB, what is written is linear.
    pub format: wgpu::TextureFormat,
    /// The number of samples.
    pub samples: u32,
    /// The depth buffer, if there is one.
    pub depth: Option<CompositorDepth>,
}

/// A depth buffer that images take part in.
///
/// The depth at a view depth `t` is `(z[0] t + z[1]) / (w[0] t + w[1])`: for a projection matrix whose
/// camera looks along its third axis, `z` and `w` are the last two elements of its rows 3 and 4 (the
/// first of each negated, if the camera looks against its third axis).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompositorDepth {
    /// Its format.
    pub format: wgpu::TextureFormat,
    /// What is drawn: that which compares like this with what is there.
    pub compare: wgpu::CompareFunction,
    /// Factor and constant of the numerator.
    pub z: [f32; 2],
    /// Factor and constant of the denominator.
    pub w: [f32; 2],
}

/// Draws shaded images.
#[derive(Debug)]
pub struct Compositor {
    gpu: Gpu,
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    data: wgpu::Buffer,
    constants: CompositeData,
    bound: Option<wgpu::BindGroup>,
}

/// `Composite` of `compositor.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct CompositeData {
    z: [f32; 2],
    w: [f32; 2],
    size: [f32; 2],
    is_linear: u32,
    spare: u32,
}

impl CompositorDepth {
    /// Depths that are 1 at `near` and 0 at infinity, in perspective: `near / t`, of the format
    /// `Depth32Float`.
    #[must_use]
    pub const fn reversed(near: f32) -> Self {
        Self {
            format: wgpu::TextureFormat::Depth32Float,
            compare: wgpu::CompareFunction::GreaterEqual,
            z: [0.0, near],
            w: [1.0, 0.0],
        }
    }
}

impl Compositor {
    /// For passes of this kind.
    ///
    /// # Errors
    ///
    /// What the device says of the formats.
    pub fn new(gpu: &Gpu, config: &CompositorConfig) -> Result<Self, Error> {
        let data = uniform(gpu, "Compositor::data", size_of::<CompositeData>() as u64)?;
        let pipeline = gpu.guard("pipelines", || pipeline(gpu, config))?;
        let [z, w] = config.depth.map_or([[0.0, 0.0], [1.0, 0.0]], |depth| [depth.z, depth.w]);
        let is_linear = u32::from(config.format.is_srgb());
        let constants = CompositeData { z, w, size: [0.0; 2], is_linear, spare: 0 };
        let layout = pipeline.get_bind_group_layout(0);
        Ok(Self { gpu: gpu.clone(), pipeline, layout, data, constants, bound: None })
    }

    /// The image that is drawn from now on.
    ///
    /// # Errors
    ///
    /// What the device says.
    pub fn prepare(&mut self, shaded: &Shaded) -> Result<(), Error> {
        let size = shaded.size().map(|side| side as f32);
        let data = CompositeData { size, ..self.constants };
        let gpu = &self.gpu;
        let bound = gpu.guard("an image", || {
            gpu.queue.write_buffer(&self.data, 0, bytemuck::bytes_of(&data));
            let bindings = [
                (0, self.data.as_entire_binding()),
                (1, wgpu::BindingResource::TextureView(shaded.color())),
                (2, wgpu::BindingResource::TextureView(shaded.depth())),
            ];
            bind(gpu, "Compositor::prepare", &self.layout, &bindings)
        })?;
        self.bound = Some(bound);
        Ok(())
    }

    /// Draws the image over the whole viewport; nothing before the first [`prepare`](Self::prepare).
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(bound) = &self.bound {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, bound, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

fn pipeline(gpu: &Gpu, config: &CompositorConfig) -> wgpu::RenderPipeline {
    let module = module(gpu, "Compositor::module", SOURCE);
    let sampled = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    let constants = wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: std::num::NonZero::new(size_of::<CompositeData>() as u64),
        },
        count: None,
    };
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("Compositor::layout"),
        entries: &[constants, sampled(1), sampled(2)],
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("Compositor::pipeline_layout"),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let target = wgpu::ColorTargetState {
        format: config.format,
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("Compositor::pipeline"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: options(&[]),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: config.depth.map(|depth| wgpu::DepthStencilState {
            format: depth.format,
            depth_write_enabled: Some(true),
            depth_compare: Some(depth.compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: config.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(if config.depth.is_some() { "deep" } else { "flat" }),
            compilation_options: options(&[]),
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::assert_same_layout;

    #[test]
    fn structs_are_those_of_the_shaders() {
        assert_same_layout!(SOURCE, "Composite", CompositeData { z, w, size, is_linear, spare });
    }
}
