//! What tests on a GPU share: the adapter, the renderers that it can run, and pictures as bits.
//!
//! Without an adapter tests fail, unless `PUNCTA_NO_GPU=1` says that there need not be one.
//! `PUNCTA_ADAPTER` names the adapter to test; without it, it is the best one.

use puncta::{
    Depth, FrustumCull, Gpu, GpuConfig, GpuRenderer, Picture, Pipeline, Renderer, Scene, Sphere,
    View, Visible,
    core::{Brick, Content},
    gpu::{Error, Extent, Fragment, Setup, Skipping, wgpu},
};
use std::sync::OnceLock;

/// The device of the adapter to test; `None` where there need not be one.
pub(crate) fn gpu() -> Option<&'static Gpu> {
    static FULL: OnceLock<Option<Gpu>> = OnceLock::new();
    FULL.get_or_init(|| open(Extent::Full)).as_ref()
}

/// A device of its own, with what WebGPU has everywhere or with everything.
pub(crate) fn open(extent: Extent) -> Option<Gpu> {
    if std::env::var_os("PUNCTA_NO_GPU").is_some_and(|value| value == "1") {
        println!("skipped: PUNCTA_NO_GPU is set");
        return None;
    }
    let name = std::env::var("PUNCTA_ADAPTER").ok();
    let gpu = Gpu::new(name.as_deref(), extent).unwrap_or_else(|error| panic!("{error}"));
    println!("{extent:?}: {}", gpu.name());
    Some(gpu)
}

/// Stages and a renderer, as programs use them.
pub(crate) type Draws = Pipeline<(FrustumCull, Depth), GpuRenderer>;

pub(crate) fn draws(renderer: GpuRenderer) -> Draws {
    Pipeline::new((FrustumCull, Depth::default()), renderer)
}

/// All renderers that give exact pictures and that this device can run, with their names.
pub(crate) fn all_exact(gpu: &Gpu) -> Vec<(String, GpuRenderer)> {
    let mut renderers = Vec::new();
    for setup in Setup::ALL {
        for fragment in Fragment::ALL.into_iter().filter(|fragment| fragment.is_exact()) {
            let name = format!("{setup} {fragment}");
            let config =
                GpuConfig { setup: Some(setup), fragment: Some(fragment), ..GpuConfig::default() };
            match GpuRenderer::new(gpu, config) {
                Ok(renderer) => renderers.push((name, renderer)),
                Err(error @ Error::Unsupported { .. }) => println!("without {name}: {error}"),
                Err(error) => panic!("{name}: {error}"),
            }
        }
    }
    assert!(!renderers.is_empty());
    renderers
}

/// Depths and ids.
pub(crate) fn bits(picture: &Picture) -> Vec<(u32, u32)> {
    picture.depth.iter().map(|depth| depth.to_bits()).zip(picture.id.iter().copied()).collect()
}

/// How many pixels of two pictures show another record, or one at another depth.
///
/// Each of two depths may be wrong by 2^-22: see `naive`.
pub(crate) fn differing(a: &Picture, b: &Picture) -> usize {
    let is_near = |a: f32, b: f32| a == b || (a - b).abs() <= b.abs() / 2_097_152.0;
    let pixels = a.id.iter().zip(&b.id).zip(a.depth.iter().zip(&b.depth));
    pixels.filter(|((a, b), (c, d))| a != b || !is_near(**c, **d)).count()
}

/// The picture of all bricks, none of which is left out.
pub(crate) fn of_everything(gpu: &Gpu, scene: &Scene, bricks: &[Brick], view: &View) -> Picture {
    let config = GpuConfig { skipping: Skipping::Nothing, ..GpuConfig::default() };
    let mut renderer = GpuRenderer::new(gpu, config).unwrap();
    let content = Content { scene, bricks, blocks: &[] };
    let all = Visible::all(bricks, scene.origin, view);
    Renderer::<Sphere>::begin(&mut renderer, view).unwrap();
    renderer.draw(&content, &all.bricks).unwrap();
    renderer.finish(&content).unwrap()
}

/// A device as a program would have it that draws other things too: of the adapter to test, with
/// these limits and no feature.
pub(crate) fn own_device(required_limits: &wgpu::Limits) -> Gpu {
    let (device, queue) = own(required_limits);
    Gpu::from_device(device, queue)
}

/// The device and the queue of such a program.
pub(crate) fn own(required_limits: &wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    own_instance(required_limits).1
}

/// The same, and what they were made by.
pub(crate) fn own_instance(
    required_limits: &wgpu::Limits,
) -> (wgpu::Instance, (wgpu::Device, wgpu::Queue)) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let wanted = std::env::var("PUNCTA_ADAPTER").unwrap_or_default().to_lowercase();
    let name = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        format!("{} ({:?}, ", info.name, info.backend).to_lowercase()
    };
    let adapter = adapters.iter().find(|adapter| name(adapter).contains(&wanted)).unwrap();
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("a program's own"),
        required_limits: required_limits.clone(),
        ..Default::default()
    };
    let own = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    (instance, own)
}
