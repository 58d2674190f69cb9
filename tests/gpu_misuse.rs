//! What may go wrong on a GPU: typed errors that say what is at fault, no panic, nothing that leaks,
//! and a program's own device is left as it was.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, and shares parts with others"
)]

use glam::DVec3;
use gpu::{bits, draws, gpu, of_everything, open, own, own_instance};
use puncta::{
    Brick, Content, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig, Renderer, Scene, Sphere, View,
    Visible,
    core::Aabb,
    gpu::{Error, Extent, Fragment, Setup, wgpu},
};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scenes::cloud;
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

mod gpu;
mod scenes;

fn scene(count: usize) -> (Scene, Grid) {
    let mut scene = Scene::new(cloud(&mut Pcg64Mcg::seed_from_u64(1), count, 1.0, [0.01, 0.1]));
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(5)).unwrap();
    (scene, grid)
}

fn view() -> View {
    let view = View::look_at(DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO, DVec3::Z).unwrap();
    view.with_size(96, 64).unwrap()
}

fn renderer(gpu: &Gpu) -> GpuRenderer {
    GpuRenderer::new(gpu, GpuConfig::default()).unwrap()
}

fn begin(renderer: &mut GpuRenderer, view: &View) -> Result<(), Error> {
    Renderer::<Sphere>::begin(renderer, view)
}

#[test]
fn what_is_asked_before_a_picture_is_begun_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = scene(100);
    let content = Content { scene: &scene, bricks: grid.bricks(), blocks: &[] };
    let mut visible = Visible::all(grid.bricks(), scene.origin, &view()).bricks;
    let mut renderer = renderer(gpu);
    let not_begun = Error::Core(puncta::core::Error::NotBegun);
    assert_eq!(renderer.draw(&content, &visible), Err(not_begun.clone()));
    assert_eq!(renderer.survey(&content, &mut visible), Err(not_begun.clone()));
    assert_eq!(renderer.finish(&content), Err(not_begun.clone()));
    assert_eq!(renderer.open_pixels(), Err(not_begun));
    assert_eq!(renderer.recall(&content, &visible), Ok(0));
}

#[test]
fn a_picture_shows_one_scene() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = scene(100);
    let view = view();
    let mut renderer = renderer(gpu);
    begin(&mut renderer, &view).unwrap();
    let content = Content { scene: &scene, bricks: grid.bricks(), blocks: &[] };
    let mut visible = Visible::all(grid.bricks(), scene.origin, &view).bricks;
    renderer.draw(&content, &visible).unwrap();
    let picture = renderer.finish(&content).unwrap();
    let moved = Scene { origin: DVec3::X, ..scene.clone() };
    let mut changed = scene.clone();
    changed.records.to_mut()[0].radius *= 0.5;
    let mut renamed = scene.clone();
    renamed.attributes.ids = Some((0..100).rev().collect::<Vec<u32>>().into());
    for other in [&moved, &changed, &renamed] {
        let other = Content { scene: other, ..content };
        assert_eq!(renderer.draw(&other, &visible), Err(Error::OtherContent));
        assert_eq!(renderer.survey(&other, &mut visible), Err(Error::OtherContent));
        assert_eq!(renderer.finish(&other), Err(Error::OtherContent));
    }
    let bricks = grid.bricks().to_vec();
    let other = Content { bricks: &bricks, ..content };
    assert_eq!(renderer.draw(&other, &visible), Err(Error::OtherContent));
    // What was refused has changed nothing.
    assert!(bits(&renderer.finish(&content).unwrap()) == bits(&picture));
}

#[test]
fn bricks_that_are_not_there_are_errors() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5)]);
    let bounds = Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO };
    let good = Brick { records: 0..1, bounds, radius_max: 0.5, density: 1.0 };
    let many = vec![good.clone(); 5];
    let mut renderer = renderer(gpu);
    begin(&mut renderer, &view()).unwrap();
    let unknown = &Visible::all(&many, scene.origin, &view()).bricks[4..];
    let bricks = [good.clone()];
    let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
    assert!(matches!(renderer.draw(&content, unknown), Err(Error::Core(_))));
    for (start, end) in [(1, 0), (0, 2), (5, 5)] {
        let bricks = [Brick { records: start..end, ..good.clone() }];
        let content = Content { bricks: &bricks, ..content };
        let visible = Visible::all(&bricks, scene.origin, &view()).bricks;
        let result = renderer.draw(&content, &visible);
        assert!(matches!(result, Err(Error::Core(_))), "{start}..{end}: {result:?}");
    }
}

#[test]
fn pictures_that_are_too_large_are_errors_with_figures() {
    let Some(gpu) = open(Extent::Core) else { return };
    let mut renderer = renderer(&gpu);
    begin(&mut renderer, &view()).unwrap();
    let huge = view().with_size(16_384, 16_384).unwrap();
    let error = begin(&mut renderer, &huge).unwrap_err();
    let limit = wgpu::Limits::default().max_storage_buffer_binding_size;
    match &error {
        Error::PictureTooLarge { width: 16_384, height: 16_384, bytes, limit: l, adapter } => {
            assert_eq!((*bytes, *l, adapter.as_str()), (1 << 31, limit, gpu.name()));
        }
        other => panic!("{other:?}"),
    }
    assert!(error.to_string().contains("16384 x 16384"), "{error}");
    // Few pixels, but more in a row than a depth buffer has: what is said must be true.
    let long = begin(&mut renderer, &view().with_size(16_384, 1).unwrap()).unwrap_err();
    assert!(matches!(long, Error::PictureTooWide { width: 16_384, limit: 8192, .. }), "{long:?}");
    // Nothing was begun, and the next one can be.
    let (scene, grid) = scene(100);
    let content = Content { scene: &scene, bricks: grid.bricks(), blocks: &[] };
    assert!(renderer.finish(&content).is_err());
    let picture = draws(renderer).render(&scene, &grid, &view()).unwrap();
    assert!(picture.covered_pixels() > 0);
}

#[test]
fn what_cannot_be_had_is_said() {
    let Some(gpu) = open(Extent::Core) else { return };
    let with = |config| GpuRenderer::new(&gpu, config).map(|_| ());
    let small = GpuConfig { record_bytes: 24_575, ..GpuConfig::default() };
    assert_eq!(with(small), Err(Error::Budget { bytes: 24_575, least: 24_576 }));
    let mesh = GpuConfig { setup: Some(Setup::Mesh), ..GpuConfig::default() };
    let early = GpuConfig { fragment: Some(Fragment::SphereEarly), ..GpuConfig::default() };
    for config in [mesh, early] {
        let error = with(config).unwrap_err();
        assert!(matches!(error, Error::Unsupported { .. }), "{error:?}");
        assert!(error.to_string().starts_with(gpu.name()), "{error}");
    }
    let error = Gpu::new(Some("an abacus"), Extent::Full).unwrap_err();
    match &error {
        Error::NoAdapter { wanted, known, .. } => {
            assert!(wanted.contains("an abacus") && !known.is_empty(), "{error}");
            assert!(Gpu::adapters().iter().all(|name| known.contains(name)), "{error}");
        }
        other => panic!("{other:?}"),
    }
}

/// What is asked of a renderer, until the device is gone, and again after it.
fn all_calls_fail(gpu: &Gpu) {
    let (scene, grid) = scene(5000);
    let (more, other_grid) = self::scene(9000);
    let view = view();
    let content = Content { scene: &scene, bricks: grid.bricks(), blocks: &[] };
    let other = Content { scene: &more, bricks: other_grid.bricks(), blocks: &[] };
    let mut visible = Visible::all(grid.bricks(), scene.origin, &view).bricks;
    let all = Visible::all(other_grid.bricks(), more.origin, &view).bricks;
    let [mut never, mut drawn, mut open, mut seen] = [(); 4].map(|()| renderer(gpu));
    begin(&mut never, &view).unwrap();
    for renderer in [&mut drawn, &mut open, &mut seen] {
        begin(renderer, &view).unwrap();
        renderer.draw(&content, &visible).unwrap();
    }
    open.survey(&content, &mut visible).unwrap();
    begin(&mut seen, &view).unwrap();
    gpu.device().destroy();
    let is_lost = |what: &str, error: Option<Error>| {
        assert!(matches!(error, Some(Error::Lost { .. })), "{what}: {error:?}");
    };
    is_lost("finish", drawn.finish(&content).err());
    is_lost("finish again", drawn.finish(&content).err());
    is_lost("draw", never.draw(&other, &all).err());
    is_lost("draw on", open.draw(&content, &visible).err());
    is_lost("survey", open.survey(&content, &mut visible).err());
    is_lost("open pixels", open.open_pixels().err());
    is_lost("recall", seen.recall(&content, &visible).err());
    is_lost("begin", begin(&mut drawn, &view.clone().with_size(70, 70).unwrap()).err());
    is_lost("a new one", GpuRenderer::new(gpu, GpuConfig::default()).err());
}

#[test]
fn a_lost_device_is_an_error() {
    let Some(gpu) = open(Extent::Full) else { return };
    all_calls_fail(&gpu);
}

#[test]
fn a_lost_device_of_a_program_is_an_error() {
    if open(Extent::Core).is_none() {
        return;
    }
    let (device, queue) = own(&wgpu::Limits::default());
    all_calls_fail(&Gpu::from_device(device, queue));
}

/// Errors of the program come to the program, and none of ours do.
#[test]
fn a_programs_own_device_is_left_as_it_was() {
    if open(Extent::Core).is_none() {
        return;
    }
    let (device, queue) = own(&wgpu::Limits::default());
    let (heard, gone) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
    let count = |of: &Arc<AtomicUsize>| {
        let of = Arc::clone(of);
        move || {
            of.fetch_add(1, Ordering::Relaxed);
        }
    };
    let (hear, go) = (count(&heard), count(&gone));
    device.on_uncaptured_error(Arc::new(move |_| hear()));
    device.set_device_lost_callback(move |_, _| go());
    let wrong = || {
        let descriptor = wgpu::BufferDescriptor {
            label: None,
            size: 1 << 40,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        };
        device.create_buffer(&descriptor)
    };
    let (scene, grid) = scene(3000);
    let gpu = Gpu::from_device(device.clone(), queue);
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mut pipeline = draws(renderer(&gpu));
    let picture = pipeline.render(&scene, &grid, &view()).unwrap();
    assert!(bits(&picture) == bits(&of_everything(&gpu, &scene, grid.bricks(), &view())));
    assert!(pipeline.render(&scene, &grid, &view().with_size(9000, 2).unwrap()).is_err());
    assert!(pollster::block_on(scope.pop()).is_none());
    assert_eq!(heard.load(Ordering::Relaxed), 0);
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    wrong();
    pipeline.render(&scene, &grid, &view()).unwrap();
    assert!(pollster::block_on(scope.pop()).is_some(), "the program's scope was taken away");
    wrong();
    assert_eq!(heard.load(Ordering::Relaxed), 1, "the program's handler was taken away");
    device.destroy();
    device.poll(wgpu::PollType::wait_indefinitely()).ok();
    assert_eq!(gone.load(Ordering::Relaxed), 1, "the program's callback was taken away");
}

/// Bytes of this process that lie in memory, where that can be known.
fn resident() -> Option<usize> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(text.split_whitespace().nth(1)?.parse::<usize>().ok()? * 4096)
}

/// What wgpu keeps for whoever made it.
fn kept(instance: &wgpu::Instance) -> Vec<usize> {
    let report = instance.generate_report().unwrap();
    let hub = report.hub_report();
    let kinds = [
        &hub.buffers,
        &hub.textures,
        &hub.texture_views,
        &hub.bind_groups,
        &hub.bind_group_layouts,
        &hub.command_encoders,
        &hub.command_buffers,
        &hub.shader_modules,
        &hub.compute_pipelines,
        &hub.render_pipelines,
    ];
    kinds.map(|kind| kind.num_kept_from_user).to_vec()
}

/// A thousand views, some of them of other sizes or half drawn.
#[test]
fn changes_of_view_leak_nothing() {
    if open(Extent::Core).is_none() {
        return;
    }
    let (instance, (device, queue)) = own_instance(&wgpu::Limits::default());
    let gpu = Gpu::from_device(device, queue);
    let (scene, grid) = scene(5000);
    let mut pipeline = draws(renderer(&gpu));
    let mut turn = |count: u32| {
        for i in 0..count {
            let size = if i % 10 == 9 { (32, 48) } else { (48, 32) };
            let view = view().orbited(DVec3::ZERO, 0.05 * f64::from(i), 0.0);
            let view = view.with_size(size.0, size.1).unwrap();
            let mut steps = pipeline.progressive(&scene, &grid, &view, 2000).unwrap();
            let taken = steps.by_ref().take(2).map(Result::unwrap).count();
            assert!(taken > 0);
            if i % 50 == 0 {
                steps.picture().unwrap();
            }
        }
    };
    turn(100);
    let (objects, bytes) = (kept(&instance), resident());
    turn(1000);
    assert_eq!(kept(&instance), objects);
    let (Some(before), Some(after)) = (bytes, resident()) else { return };
    println!("{} KiB, after 1000 views {} KiB", before / 1024, after / 1024);
    // 32 KiB for each view: half of what the runs of a single picture take. Other tests run beside
    // this one.
    let slack = 32 << 20;
    assert!(after < before + slack, "{before} bytes have become {after}");
}
