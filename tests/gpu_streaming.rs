//! Scenes that are larger than what is kept of them on the GPU: the same pictures, within the budget,
//! and what is there is not brought again.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, its numbers are small, and it shares parts with others"
)]

use glam::DVec3;
use gpu::{Draws, bits, draws, gpu, of_everything};
use puncta::{
    Gpu, GpuConfig, GpuRenderer, Grid, GridConfig, Scene, Sphere, View,
    gpu::{Extent, Setup, wgpu},
};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scenes::cloud;

mod gpu;
mod scenes;

/// The smallest budget: 1024 records of 24 bytes.
const LEAST: u64 = 24_576;

/// What they take without colors.
const SEGMENT: u64 = 20_480;

fn sorted(seed: u64, count: usize, radii: [f32; 2]) -> (Scene, Grid) {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut scene = Scene::new(cloud(&mut random, count, 1.0, radii));
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(7)).unwrap();
    (scene, grid)
}

fn view(eye: [f64; 3]) -> View {
    let view = View::look_at(DVec3::from(eye), DVec3::ZERO, DVec3::Z).unwrap();
    view.with_size(120, 90).unwrap()
}

fn renderer(gpu: &Gpu, setup: Option<Setup>, segments: u64) -> Draws {
    let record_bytes = segments * LEAST;
    draws(GpuRenderer::new(gpu, GpuConfig { setup, record_bytes, ..GpuConfig::default() }).unwrap())
}

fn larger_than_the_budget(gpu: &Gpu) {
    let (scene, grid) = sorted(1, 12_000, [3e-3, 0.05]);
    // From outside, and from a place where some bricks are looked at record by record.
    let views = [view([3.0, 1.0, 2.0]), view([0.3, 0.1, 0.2]), view([-2.0, 2.0, 0.5])];
    let expected =
        views.clone().map(|view| bits(&of_everything(gpu, &scene, grid.bricks(), &view)));
    for setup in [Setup::Triangle, Setup::Compute] {
        for segments in [1, 2, 3, 7] {
            let mut pipeline = renderer(gpu, Some(setup), segments);
            for (view, expected) in views.iter().zip(&expected) {
                let mut steps = pipeline.progressive(&scene, &grid, view, 3000).unwrap();
                while let Some(step) = steps.next() {
                    step.unwrap();
                    let bytes = steps.renderer().record_bytes();
                    assert!((SEGMENT..=segments * SEGMENT).contains(&bytes), "{bytes}");
                }
                assert!(bits(&steps.picture().unwrap()) == *expected, "{setup} {segments}");
            }
            assert!(pipeline.renderer().brought_bytes() > 12 * SEGMENT, "nothing was exchanged");
        }
    }
}

#[test]
fn scenes_may_be_larger_than_the_budget() {
    let Some(gpu) = gpu() else { return };
    larger_than_the_budget(gpu);
}

#[test]
fn scenes_may_be_larger_than_the_budget_on_core_webgpu() {
    let Some(gpu) = gpu::open(Extent::Core) else { return };
    larger_than_the_budget(&gpu);
}

#[test]
fn what_is_there_is_not_brought_again() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = sorted(2, 12_000, [1e-3, 0.01]);
    let mut pipeline = renderer(gpu, None, 100);
    pipeline.render(&scene, &grid, &view([3.0, 1.0, 2.0])).unwrap();
    let renderer = pipeline.renderer();
    let (bytes, brought) = (renderer.record_bytes(), renderer.brought_bytes());
    // 12 000 records lie in 12 segments.
    assert_eq!([bytes, brought], [12 * SEGMENT, 12 * SEGMENT]);
    for eye in [[1.0, -3.0, 2.0], [-2.0, 2.0, 2.0], [3.0, 1.0, 2.0]] {
        let picture = pipeline.render(&scene, &grid, &view(eye)).unwrap();
        assert!(bits(&picture) == bits(&of_everything(gpu, &scene, grid.bricks(), &view(eye))));
    }
    assert_eq!(pipeline.renderer().brought_bytes(), brought);
    assert_eq!(pipeline.renderer().record_bytes(), bytes);
}

#[test]
fn changed_records_are_seen() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, grid) = sorted(3, 3000, [1e-3, 0.01]);
    let view = view([3.0, 1.0, 2.0]);
    let mut pipeline = renderer(gpu, None, 100);
    let before = pipeline.render(&scene, &grid, &view).unwrap();
    let id = before.visible_records()[0] as usize;
    // Small enough for the brick to tell the truth still.
    scene.records.to_mut()[id].radius *= 0.1;
    let after = pipeline.render(&scene, &grid, &view).unwrap();
    assert!(bits(&after) != bits(&before));
    assert!(bits(&after) == bits(&of_everything(gpu, &scene, grid.bricks(), &view)));
    // Ids as well: of two spheres at one place the other one is seen.
    let mut twins = Scene::new(vec![Sphere::new([0.0; 3], 0.5), Sphere::new([0.0; 3], 0.5)]);
    let grid = Grid::sort_scene(&mut twins, &GridConfig::longest_side(1)).unwrap();
    for ids in [[7, 9], [9, 7]] {
        twins.attributes.ids = Some(ids.to_vec().into());
        let picture = pipeline.render(&twins, &grid, &view).unwrap();
        let shown = ids.iter().position(|&id| id == 7).unwrap() as u32;
        assert_eq!(picture.visible_records(), [shown]);
    }
}

#[test]
fn scenes_may_take_turns() {
    let Some(gpu) = gpu() else { return };
    let scenes =
        [sorted(4, 9000, [3e-3, 0.05]), sorted(5, 2000, [3e-3, 0.05]), sorted(6, 0, [1.0; 2])];
    let view = view([3.0, 1.0, 2.0]);
    for segments in [2, 50] {
        let mut pipeline = renderer(gpu, None, segments);
        for _ in 0..3 {
            for (scene, grid) in &scenes {
                let picture = pipeline.render(scene, grid, &view).unwrap();
                let expected = bits(&of_everything(gpu, scene, grid.bricks(), &view));
                assert!(bits(&picture) == expected, "{} records", scene.records.len());
                assert!(pipeline.renderer().record_bytes() <= segments * SEGMENT);
            }
        }
    }
}

/// More records than a shader sees in one piece, and more than the staging buffers hold.
#[test]
fn scenes_may_be_larger_than_a_binding() {
    let Some(whole) = gpu() else { return };
    // What WebGPU promises is four times as much; so fewer records do.
    let limit = 32 << 20;
    let required_limits =
        wgpu::Limits { max_storage_buffer_binding_size: limit, ..wgpu::Limits::default() };
    let gpu = gpu::own_device(&required_limits);
    let count = 2_300_000;
    assert!(count as u64 * 16 > limit);
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut scene = Scene::new(cloud(&mut random, count, 1.0, [1e-4, 3e-3]));
    let grid = Grid::sort_scene(&mut scene, &GridConfig::default()).unwrap();
    let view = view([3.0, 1.0, 2.0]);
    let mut pipeline = renderer(&gpu, None, 4000);
    let picture = pipeline.render(&scene, &grid, &view).unwrap();
    let expected = renderer(whole, None, 4000).render(&scene, &grid, &view).unwrap();
    assert!(picture.covered_pixels() > 1000);
    assert!(bits(&picture) == bits(&expected));
    println!("{} of {} bytes", pipeline.renderer().record_bytes(), count * 20);
}
