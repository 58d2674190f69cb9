//! Spheres below the size of a pixel: never lost, if that is asked for, and drawn exactly otherwise.

#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic and talk")]

use glam::DVec3;
use puncta::{
    CpuRenderer, Depth, FrustumCull, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig, NO_RECORD,
    Pipeline, Scene, Sphere, View, gpu::Extent,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Half the diagonal of a pixel, rounded up: a disc of this radius holds a pixel's centre.
const MIN: f32 = 0.7072;

fn gpu() -> Option<Gpu> {
    if std::env::var_os("PUNCTA_NO_GPU").is_some() {
        println!("PUNCTA_NO_GPU is set: no GPU is tried");
        return None;
    }
    Some(Gpu::new(None, Extent::Full).unwrap())
}

fn renderer(gpu: &Gpu, radius_min_pixels: f32) -> GpuRenderer {
    GpuRenderer::new(gpu, GpuConfig { radius_min_pixels, ..GpuConfig::default() }).unwrap()
}

fn cloud(seed: u64, count: usize, radii: [f32; 2]) -> Scene {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut sphere = || {
        let center = [0; 3].map(|_| random.random::<f32>() * 2.0 - 1.0);
        Sphere { center, radius: radii[0] + (radii[1] - radii[0]) * random.random::<f32>() }
    };
    Scene::new((0..count).map(|_| sphere()).collect::<Vec<_>>())
}

fn view() -> View {
    let view = View::look_at(DVec3::new(1.0, 2.0, 4.0), DVec3::ZERO, DVec3::Y).unwrap();
    view.with_size(200, 150).unwrap()
}

/// With parallel rays, a least radius in pixels is one in the world: the picture is that of a scene
/// in which no sphere is smaller.
#[test]
fn small_spheres_are_drawn_as_the_smallest_that_are_allowed() {
    let Some(gpu) = gpu() else { return };
    let view = view().with_orthographic(3.0).unwrap();
    let least = f64::from(MIN) * view.pixel_size();
    for (seed, radii) in [(1, [1e-5, 1e-4]), (2, [1e-3, 0.05])] {
        let mut scene = cloud(seed, 4000, radii);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(9)).unwrap();
        let stages = || (FrustumCull, Depth::default());
        let renderer = renderer(&gpu, MIN);
        let picture = Pipeline::new(stages(), renderer).render(&scene, &grid, &view).unwrap();
        let mut grown = scene.clone();
        for sphere in grown.records.to_mut() {
            #[expect(clippy::cast_possible_truncation, reason = "it is what is compared with")]
            let least = least as f32;
            sphere.radius = sphere.radius.max(least);
        }
        let grid = Grid::sort_scene(&mut grown, &GridConfig::longest_side(9)).unwrap();
        let cpu = CpuRenderer::default();
        let expected = Pipeline::new(stages(), cpu).render(&grown, &grid, &view).unwrap();
        let ids = (picture.original_ids(&scene), expected.original_ids(&grown));
        let differ = ids.0.iter().zip(&ids.1).filter(|(a, b)| a != b).count();
        assert!(expected.covered_pixels() > 2000);
        // A radius that was rounded to `f32` may decide a pixel in 100,000.
        assert!(differ <= 1, "{differ} pixels differ");
    }
}

/// A sphere alone is seen wherever it lies in the picture, in one pixel or a few; without a least
/// radius it is nearly always lost.
#[test]
fn no_sphere_in_view_is_lost() {
    let Some(gpu) = gpu() else { return };
    let mut exact = Pipeline::new((), renderer(&gpu, 0.0));
    let mut never_lost = Pipeline::new((), renderer(&gpu, MIN));
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let (mut lost, mut largest) = (0, 0);
    for _ in 0..60 {
        let view = view();
        let pixel = [200.0, 150.0].map(|side: f64| 1.0 + (side - 2.0) * random.random::<f64>());
        let ray = view.ray(pixel[0] - 0.5, pixel[1] - 0.5);
        let depth = 0.1 + 50.0 * random.random::<f64>();
        let at = view.eye() + (view.right() * ray.x + view.up() * ray.y + view.forward()) * depth;
        let scene = Scene::new(vec![Sphere::new(at.as_vec3().to_array(), 1e-6)]);
        let bounds = puncta::core::Aabb { min: at.as_vec3(), max: at.as_vec3() };
        let brick = puncta::Brick { records: 0..1, bounds, radius_max: 1e-6, density: 0.0 };
        let bricks = vec![brick];
        let count = |pipeline: &mut Pipeline<(), GpuRenderer>| {
            let picture = pipeline.render(&scene, &bricks, &view).unwrap();
            picture.id.iter().filter(|id| **id != NO_RECORD).count()
        };
        lost += usize::from(count(&mut exact) == 0);
        let covered = count(&mut never_lost);
        assert!(covered >= 1, "{at} is lost");
        largest = largest.max(covered);
    }
    assert!(lost > 50 && largest <= 4, "{lost} {largest}");
}
