//! Promise 1 on the GPU: every set-up gives the same picture, on all that WebGPU has as on all that
//! the adapter has; it is that of the reference in `f64` and that of the renderer on the CPU.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, its numbers are small, and it shares parts with others"
)]

use glam::{DVec3, Vec3};
use gpu::{Draws, all_exact, bits, differing, draws, open};
use proptest::{prelude::*, test_runner::TestRunner};
use puncta::{
    Brick, Content, CpuRenderer, Depth, FrustumCull, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig,
    NO_RECORD, Picture, Pipeline, ReadOptions, Renderer, Scene, Sphere, View, Visible, core::Aabb,
    gpu::Extent,
};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scenes::{cloud, odd_view, scenes};
use std::cell::RefCell;

mod gpu;
mod naive;
mod scenes;

/// What the renderer on the GPU promises: see `naive::Pixels`.
const GPU: naive::Pixels = 1e-3;

fn grid(scene: &mut Scene, cells: u32) -> Grid {
    Grid::sort_scene(scene, &GridConfig::longest_side(cells)).unwrap()
}

fn on_cpu(scene: &Scene, grid: &Grid, view: &View) -> Picture {
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    pipeline.render(scene, grid, view).unwrap()
}

/// The exact renderers of a device.
struct Team {
    members: Vec<(String, Draws)>,
    pixels: usize,
    /// Pixels that differ from those of the CPU's renderer.
    other: usize,
}

impl Team {
    fn new(gpu: &Gpu) -> Self {
        let members = all_exact(gpu).into_iter().map(|(name, one)| (name, draws(one))).collect();
        Self { members, pixels: 0, other: 0 }
    }

    /// The picture that all of them give; it is noted how far it is from the CPU's.
    fn render(&mut self, name: &str, (scene, grid): (&Scene, &Grid), view: &View) -> Picture {
        let mut first: Option<Picture> = None;
        for (member, pipeline) in &mut self.members {
            let picture = pipeline.render(scene, grid, view).unwrap();
            if let Some(first) = &first {
                assert!(bits(first) == bits(&picture), "{name}: {member} gives another picture");
            }
            first.get_or_insert(picture);
        }
        let picture = first.unwrap();
        let other = differing(&picture, &on_cpu(scene, grid, view));
        self.pixels += picture.id.len();
        self.other += other;
        println!("{name:<36} covered {:>6} other {other:>3}", picture.covered_pixels());
        picture
    }

    /// At most one pixel in 100 000 differs from that of the CPU's renderer.
    fn judge(&self) {
        let Self { pixels, other, .. } = self;
        println!("{other} of {pixels} pixels differ from those of the CPU");
        assert!(other * 100_000 <= *pixels, "{other} of {pixels} pixels");
    }
}

fn scenes_agree(extent: Extent) {
    let Some(gpu) = open(extent) else { return };
    let mut team = Team::new(&gpu);
    for (name, mut scene, view) in scenes() {
        let grid = grid(&mut scene, 8);
        let picture = team.render(&name, (&scene, &grid), &view);
        let verdict = naive::compare(&scene, &view, &picture, GPU);
        verdict.unwrap_or_else(|what| panic!("{name}: {what}"));
        assert!(picture.covered_pixels() > 500, "{name} shows too little");
    }
    team.judge();
}

#[test]
fn pictures_agree_with_the_reference() {
    scenes_agree(Extent::Full);
}

#[test]
fn pictures_of_core_webgpu_agree_with_the_reference() {
    scenes_agree(Extent::Core);
}

/// The other interface of this machine, if there is one.
#[test]
fn pictures_of_gl_agree_with_the_cpu() {
    if open(Extent::Core).is_none() {
        return;
    }
    let gpu = match Gpu::new(Some("(Gl,"), Extent::Full) {
        Ok(gpu) => gpu,
        Err(error) => return println!("skipped: {error}"),
    };
    let mut team = Team::new(&gpu);
    for (name, mut scene, view) in scenes().into_iter().step_by(3) {
        let grid = grid(&mut scene, 8);
        team.render(&name, (&scene, &grid), &view);
    }
    team.judge();
}

/// Odd views in which few pixels show much: each by one renderer of all and by one of core WebGPU.
#[test]
fn odd_views_agree_with_the_reference() {
    let (Some(full), Some(core)) = (open(Extent::Full), open(Extent::Core)) else { return };
    let renderer = |gpu| draws(GpuRenderer::new(gpu, GpuConfig::default()).unwrap());
    let renderers = RefCell::new([renderer(&full), renderer(&core)]);
    let mut runner = TestRunner::new(ProptestConfig {
        failure_persistence: None,
        max_shrink_iters: 100,
        ..ProptestConfig::with_cases(300)
    });
    let strategy = (odd_view(), any::<u64>(), -3.0_f32..5.0, 1_u32..9);
    let result = runner.run(&strategy, |(view, seed, largest, cells)| {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut scene = Scene::new(cloud(&mut random, 40, 2.0, [1e-4, 10_f32.powf(largest)]));
        let grid = grid(&mut scene, cells);
        for pipeline in renderers.borrow_mut().iter_mut() {
            let picture = pipeline.render(&scene, &grid, &view).unwrap();
            let verdict = naive::compare(&scene, &view, &picture, GPU);
            prop_assert!(verdict.is_ok(), "{:?} {:?}", verdict, view);
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

/// Just beside the eye: one tangent is nearly along the line of sight, the other nearly across it.
#[test]
fn a_sphere_that_nearly_touches_the_eye_is_drawn_whole() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut pipeline = draws(GpuRenderer::new(gpu, GpuConfig::default()).unwrap());
    let mut covered = 0;
    for (altitude, degrees) in [(1e-9, 0.01), (1e-10, 0.1), (1e-10, 0.01), (1e-7, 20.0)] {
        for step in (0..60).step_by(5) {
            let eye = DVec3::new(0.0, 0.0, 1.0 + altitude);
            let view = View::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
            let view = view.with_size(300, 3).unwrap().with_near(altitude * 0.5).unwrap();
            let view = view.with_perspective(f64::to_radians(degrees / 100.0)).unwrap();
            let reach = f64::to_radians(degrees * 0.5).tan() as f32;
            let aside = 1.0 + reach * (step as f32 / 30.0 - 1.0);
            let mut scene = Scene::new(vec![Sphere::new([aside, 0.0, 0.0], 1.0)]);
            let grid = grid(&mut scene, 1);
            let picture = pipeline.render(&scene, &grid, &view).unwrap();
            let verdict = naive::compare(&scene, &view, &picture, GPU);
            assert!(verdict.is_ok(), "{altitude} {degrees} {step}: {verdict:?}");
            covered += picture.covered_pixels();
        }
    }
    assert!(covered > 1000, "{covered} pixels tell little");
}

#[test]
fn a_moved_scene_gives_the_same_picture() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut scene = Scene::new(cloud(&mut random, 2000, 1.0, [0.01, 0.1]));
    let grid = grid(&mut scene, 9);
    let mut pipeline = draws(GpuRenderer::new(gpu, GpuConfig::default()).unwrap());
    // 1e7 and the eye are multiples of 2^-10, so that the view is exactly the same one.
    let mut draw = |origin: DVec3| {
        let eye = origin + DVec3::new(3.0, 1.0, 2.0);
        let view = View::look_at(eye, origin, DVec3::Z).unwrap().with_size(120, 120).unwrap();
        scene.origin = origin;
        bits(&pipeline.render(&scene, &grid, &view).unwrap())
    };
    assert!(draw(DVec3::ZERO) == draw(DVec3::new(1e7, -1e7, 1e7)));
}

/// A brick with these bounds, which need not be tight.
fn brick(records: std::ops::Range<u32>, half: f32) -> Brick {
    let bounds = Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) };
    Brick { records, bounds, radius_max: 1.0, density: 1.0 }
}

#[test]
fn coincident_spheres_show_the_lower_id() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut scene = Scene::new(vec![Sphere::new([0.1, 0.2, 0.3], 0.5); 50]);
    let grid = grid(&mut scene, 3);
    let mut ids: Vec<u32> =
        scene.attributes.ids.as_deref().map_or((0..50).collect(), <[_]>::to_vec);
    ids.reverse();
    scene.attributes.ids = Some(ids.into());
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let view = View::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap().with_size(64, 64).unwrap();
    for (name, renderer) in all_exact(gpu) {
        let picture = draws(renderer).render(&scene, &grid, &view).unwrap();
        assert!(picture.covered_pixels() > 100);
        let is_lowest = |&id: &u32| id == 0 || id == NO_RECORD;
        assert!(picture.original_ids(&scene).iter().all(is_lowest), "{name}");
    }
}

#[test]
fn a_sphere_that_holds_the_camera_is_not_drawn() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut pipeline = draws(GpuRenderer::new(gpu, GpuConfig::default()).unwrap());
    for radius in [1.0, 2.0, 1e3] {
        let mut scene = Scene::new(vec![
            Sphere::new([0.0, 0.0, 0.5], radius),
            Sphere::new([0.0, 0.0, -2000.0], 100.0),
        ]);
        let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
        let view = view.with_size(64, 64).unwrap();
        let grid = grid(&mut scene, 1);
        let ids = pipeline.render(&scene, &grid, &view).unwrap().original_ids(&scene);
        assert!(ids.contains(&1) && !ids.contains(&0), "radius {radius}");
    }
}

#[test]
fn records_without_a_picture_do_no_harm() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut pipeline = draws(GpuRenderer::new(gpu, GpuConfig::default()).unwrap());
    let odd = [
        Sphere::new([0.0, 0.0, 0.0], 0.0),
        Sphere::new([0.3, 0.0, 0.0], 1e-38),
        Sphere::new([1e38, 1e38, 1e38], 1e30),
        Sphere::new([-3e38, 0.0, 0.0], 3e38),
        Sphere::new([-3e38, 3e38, -3e38], 3e38),
        Sphere::new([0.5, 0.0, 0.0], 0.2),
    ];
    let mut scene = Scene::new(odd.to_vec());
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(64, 64).unwrap();
    let grid = grid(&mut scene, 2);
    let picture = pipeline.render(&scene, &grid, &view).unwrap();
    naive::compare(&scene, &view, &picture, GPU).unwrap();
    assert!(picture.original_ids(&scene).contains(&5));
    // A depth that f32 cannot hold is not seen, and does not tie with what is not there.
    scene.origin = DVec3::new(0.0, 0.0, -1e39);
    assert_eq!(pipeline.render(&scene, &grid, &view).unwrap().covered_pixels(), 0);
}

/// Records that are no spheres, in a brick that does not tell, in plain bricks and in close ones.
#[test]
fn records_that_no_grid_takes_do_no_harm() {
    let Some(gpu) = gpu::gpu() else { return };
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0];
    let mut records = vec![Sphere::new([0.0; 3], 0.5)];
    for value in bad {
        records.push(Sphere::new([value, 0.0, 0.0], 0.5));
        records.push(Sphere::new([0.0, 0.0, value], 0.5));
        records.push(Sphere::new([0.0, 0.0, 0.0], value));
    }
    let scene = Scene::new(records);
    let count = scene.records.len() as u32;
    let far = View::look_at(DVec3::Z * 50.0, DVec3::ZERO, DVec3::Y).unwrap();
    let near = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let views = [far.clone(), far.with_orthographic(3.0).unwrap(), near];
    for (name, mut renderer) in all_exact(gpu) {
        for view in &views {
            let view = view.clone().with_size(64, 64).unwrap();
            let bricks = [brick(0..count, 1.0)];
            let visible = Visible::all(&bricks, scene.origin, &view);
            Renderer::<Sphere>::begin(&mut renderer, &view).unwrap();
            let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
            renderer.draw(&content, &visible.bricks).unwrap();
            let picture = renderer.finish(&content).unwrap();
            // Those at the places -1 and 0 are as good as any.
            let is_good = |id: &u32| [0, 10, 11, 13, 14].contains(id);
            let ids = picture.visible_records();
            assert!(!ids.is_empty() && ids.iter().all(is_good), "{name}: {ids:?}");
            assert!(picture.depth.iter().all(|depth| *depth > 0.0), "{name}");
        }
    }
}

/// Real files, if the folder that `PUNCTA_DATA` names has them.
#[test]
fn real_files_agree_with_the_cpu() {
    let Some(folder) = std::env::var_os("PUNCTA_DATA").map(std::path::PathBuf::from) else {
        return println!("skipped: PUNCTA_DATA is not set");
    };
    let (Some(full), Some(core)) = (open(Extent::Full), open(Extent::Core)) else { return };
    let mut teams = [Team::new(&full), Team::new(&core)];
    for name in ["bace_membrane.pdb", "ges2.xyz", "sph_hilbert_18856.vtk", "bun_zipper.ply"] {
        let mut loaded = ReadOptions::default().strict(true).read(folder.join(name)).unwrap();
        let grid = Grid::sort_scene(&mut loaded.scene, &GridConfig::default()).unwrap();
        let view = View::look_at(DVec3::new(1.0, -2.0, 1.5), DVec3::ZERO, DVec3::Z).unwrap();
        let view = view.with_size(160, 120).unwrap().fitted(&loaded.scene.bounds());
        let pictures =
            teams.each_mut().map(|team| team.render(name, (&loaded.scene, &grid), &view));
        assert!(bits(&pictures[0]) == bits(&pictures[1]), "{name}: full and core");
        assert!(pictures[0].covered_pixels() > 2000, "{name}");
    }
    teams.iter().for_each(Team::judge);
}
