//! Discs become pixels: the strategies, behind one door.

use crate::{
    Error, Fragment, Gpu, Setup,
    kernel::{Kernel, Work, bind, module, options, shader},
};
use wgpu::{CompareFunction, Features, PrimitiveTopology};

/// The format of the depth buffer, which only helps hardware to leave out fragments.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Where the arguments of indirect calls lie.
pub(crate) const DRAW_ARGUMENTS: u64 = 16;
const SPLAT_ARGUMENTS: u64 = 32;
const MESH_ARGUMENTS: u64 = 48;

/// The buffers that discs are drawn from and into.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Canvas<'a> {
    pub(crate) camera: &'a wgpu::Buffer,
    pub(crate) round: &'a wgpu::Buffer,
    pub(crate) discs: &'a wgpu::Buffer,
    pub(crate) counts: &'a wgpu::Buffer,
    pub(crate) arguments: &'a wgpu::Buffer,
    pub(crate) visibility: &'a wgpu::Buffer,
    pub(crate) depth: &'a wgpu::TextureView,
}

/// Draws discs in one way.
#[derive(Debug)]
pub(crate) struct Raster {
    setup: Setup,
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    splat: Option<Kernel>,
    is_wide: bool,
    is_mesh: bool,
}

impl Raster {
    /// The strategy of this name, if the device can do it.
    pub(crate) fn new(gpu: &Gpu, setup: Setup, fragment: Fragment) -> Result<Self, Error> {
        let needs = |feature: Features, what: &str| {
            let unsupported =
                || Error::Unsupported { adapter: gpu.name().to_owned(), what: what.to_owned() };
            gpu.has(feature).then_some(()).ok_or_else(unsupported)
        };
        if setup == Setup::Mesh {
            needs(Features::EXPERIMENTAL_MESH_SHADER, "run mesh shaders")?;
        }
        if fragment == Fragment::SphereEarly {
            needs(Features::SHADER_EARLY_DEPTH_TEST, "test depths before fragments run")?;
        }
        let is_wide = gpu.is_wide();
        gpu.guard("pipelines", || {
            let source = source(setup, fragment, gpu.visibility());
            let module = module(gpu, "Raster::module", &source);
            let is_mesh = setup == Setup::Mesh && fragment != Fragment::Point;
            let pipeline = if is_mesh {
                mesh_pipeline(gpu, &module, fragment)
            } else {
                pipeline(gpu, &module, (setup, fragment))
            };
            let layout = pipeline.get_bind_group_layout(0);
            let splat = (setup == Setup::Compute).then(|| splat(gpu, fragment));
            Self { setup, pipeline, layout, splat, is_wide, is_mesh }
        })
    }

    /// The largest number of pixels of a disc that is drawn by a compute shader.
    pub(crate) fn small(&self, gpu: &Gpu) -> u32 {
        let is_cpu = gpu.is_cpu();
        match self.setup {
            // One lane at a time or all at once: what is large for a lane differs.
            Setup::Compute if is_cpu => 1024,
            Setup::Compute => 128,
            _ => 0,
        }
    }

    /// Draws all discs; `is_kept` says whether the depth buffer holds what was drawn before.
    pub(crate) fn draw(&self, work: &mut Work<'_>, canvas: &Canvas<'_>, load: wgpu::LoadOp<f32>) {
        if let Some(splat) = &self.splat {
            let mut bindings = vec![
                (0, canvas.camera.as_entire_binding()),
                (2, canvas.round.as_entire_binding()),
                (6, canvas.discs.as_entire_binding()),
                (7, canvas.counts.as_entire_binding()),
                (9, canvas.visibility.as_entire_binding()),
            ];
            bindings.sort_by_key(|(binding, _)| *binding);
            splat.run_indirect(work, &bindings, (canvas.arguments, SPLAT_ARGUMENTS));
        }
        let mut bindings = vec![
            (0, canvas.camera.as_entire_binding()),
            (6, canvas.discs.as_entire_binding()),
            (9, canvas.visibility.as_entire_binding()),
        ];
        if !self.is_wide {
            bindings.push((2, canvas.round.as_entire_binding()));
        }
        if self.is_mesh {
            bindings.push((7, canvas.counts.as_entire_binding()));
        }
        let bound = bind(work.gpu, "Raster::draw", &self.layout, &bindings);
        let attachment = wgpu::RenderPassDepthStencilAttachment {
            view: canvas.depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let mut pass = work.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Raster::draw"),
            depth_stencil_attachment: Some(attachment),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        if self.is_mesh {
            pass.draw_mesh_tasks_indirect(canvas.arguments, MESH_ARGUMENTS);
        } else {
            pass.draw_indirect(canvas.arguments, DRAW_ARGUMENTS);
        }
    }
}

/// The number of vertices of a disc, and whether each disc is an instance.
pub(crate) const fn vertices(setup: Setup, fragment: Fragment) -> (u32, bool) {
    match (setup, fragment) {
        (_, Fragment::Point) => (1, false),
        (Setup::Instanced, _) => (4, true),
        (Setup::Pulled, _) => (6, false),
        _ => (3, false),
    }
}

pub(crate) fn source(setup: Setup, fragment: Fragment, visibility: &str) -> String {
    let head = if setup == Setup::Mesh { "enable wgpu_mesh_shader;\n" } else { "" };
    let early = match fragment {
        Fragment::SphereEarly => {
            shader!("early").replace("@fragment EARLY", "@fragment @early_depth_test(less_equal)")
        }
        _ => String::new(),
    };
    let mesh = if setup == Setup::Mesh { shader!("mesh") } else { "" };
    let common = shader!("camera", "disc", "work", "geometry", "fragment");
    [head, common, visibility, &early, mesh].concat()
}

pub(crate) fn splat_source(visibility: &str) -> String {
    [shader!("camera", "disc", "work", "splat"), visibility].concat()
}

fn splat(gpu: &Gpu, fragment: Fragment) -> Kernel {
    let entry = match fragment {
        Fragment::Point => "splat_point",
        Fragment::Proxy => "splat_proxy",
        _ => "splat",
    };
    Kernel::new(gpu, "Raster::splat", (&splat_source(gpu.visibility()), entry), &[])
}

fn entries(setup: Setup, fragment: Fragment) -> (&'static str, &'static str) {
    let vertex = match (setup, fragment) {
        (_, Fragment::Point) => "point",
        (Setup::Instanced, _) => "quad_instance",
        (Setup::Pulled, _) => "quad_pulled",
        _ => "triangle",
    };
    (vertex, fragment_entry(fragment))
}

const fn fragment_entry(fragment: Fragment) -> &'static str {
    match fragment {
        Fragment::Point | Fragment::Proxy => "proxy",
        Fragment::Sphere => "sphere",
        Fragment::SphereEarly => "sphere_early",
    }
}

fn depth_state(fragment: Fragment) -> wgpu::DepthStencilState {
    let is_early = fragment == Fragment::SphereEarly;
    let compare = if is_early { CompareFunction::GreaterEqual } else { CompareFunction::Always };
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(is_early),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    (setup, fragment): (Setup, Fragment),
) -> wgpu::RenderPipeline {
    let (vertex, entry) = entries(setup, fragment);
    let topology = match (setup, fragment) {
        (_, Fragment::Point) => PrimitiveTopology::PointList,
        (Setup::Instanced, _) => PrimitiveTopology::TriangleStrip,
        _ => PrimitiveTopology::TriangleList,
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("Raster::pipeline"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: options(&[]),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { topology, ..Default::default() },
        depth_stencil: Some(depth_state(fragment)),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: options(&[]),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn mesh_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    fragment: Fragment,
) -> wgpu::RenderPipeline {
    gpu.device.create_mesh_pipeline(&wgpu::MeshPipelineDescriptor {
        label: Some("Raster::mesh_pipeline"),
        layout: None,
        task: None,
        mesh: wgpu::MeshState {
            module,
            entry_point: Some("quads_of_group"),
            compilation_options: wgpu::PipelineCompilationOptions {
                zero_initialize_workgroup_memory: false,
                ..Default::default()
            },
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth_state(fragment)),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment_entry(fragment)),
            compilation_options: options(&[]),
            targets: &[],
        }),
        multiview: None,
        cache: None,
    })
}
