//! Promise 1: against a brute-force reference in `f64`, ids and depths differ nowhere but where the
//! answer hangs on a hair.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    reason = "a test may panic and talk, and its numbers are small"
)]

use glam::{DVec3, Vec3};
use naive::{CPU, Verdict};
use proptest::prelude::*;
use puncta::{
    CpuRenderer, Depth, FrustumCull, Grid, GridConfig, Picture, Pipeline, Scene, Sphere, View,
};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scenes::{cloud, odd_view, scenes};

mod naive;
mod scenes;

fn render(scene: &mut Scene, view: &View, cells: u32) -> Picture {
    let grid = Grid::sort_scene(scene, &GridConfig::longest_side(cells)).unwrap();
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    pipeline.render(scene, &grid, view).unwrap()
}

fn check(name: &str, mut scene: Scene, view: &View) -> Verdict {
    let picture = render(&mut scene, view, 8);
    let verdict =
        naive::compare(&scene, view, &picture, CPU).unwrap_or_else(|what| panic!("{name}: {what}"));
    println!("{name:<36} covered {:>6} undecided {:>4}", verdict.covered, verdict.undecided);
    verdict
}

#[test]
fn pictures_agree_with_the_reference() {
    let mut total = Verdict::default();
    let scenes = scenes();
    assert_eq!(scenes.len(), 20);
    for (name, scene, view) in scenes {
        let verdict = check(&name, scene, &view);
        assert!(verdict.covered > 500, "{name} shows too little");
        total.pixels += verdict.pixels;
        total.covered += verdict.covered;
        total.undecided += verdict.undecided;
    }
    let share = total.undecided as f64 / total.pixels as f64;
    println!(
        "{} of {} pixels were undecided in the reference ({:.4} %), {} show a record",
        total.undecided,
        total.pixels,
        100.0 * share,
        total.covered
    );
    assert!(share < 5e-4);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn odd_views_agree_with_the_reference(
        view in odd_view(),
        seed in any::<u64>(),
        largest in -3.0_f32..5.0,
        cells in 1_u32..9,
    ) {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let spheres = cloud(&mut random, 40, 2.0, [1e-4, 10_f32.powf(largest)]);
        let mut scene = Scene::new(spheres);
        let picture = render(&mut scene, &view, cells);
        let verdict = naive::compare(&scene, &view, &picture, CPU);
        prop_assert!(verdict.is_ok(), "{:?} {:?}", verdict, view);
    }
}

/// Just beside the eye: one tangent is nearly along the line of sight, the other nearly across it.
#[test]
fn a_sphere_that_nearly_touches_the_eye_is_drawn_whole() {
    for (altitude, degrees) in [(1e-9, 0.01), (1e-10, 0.1), (1e-10, 0.01), (1e-7, 20.0)] {
        let mut covered = 0;
        for step in 0..60 {
            let eye = DVec3::new(0.0, 0.0, 1.0 + altitude);
            let view = View::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
            // Three rows of many columns: `degrees` is about the horizontal angle.
            let view = view.with_size(300, 3).unwrap().with_near(altitude * 0.5).unwrap();
            let view = view.with_perspective(f64::to_radians(degrees / 100.0)).unwrap();
            let reach = f64::to_radians(degrees * 0.5).tan() as f32;
            let aside = 1.0 + reach * (step as f32 / 30.0 - 1.0);
            let mut scene = Scene::new(vec![Sphere::new([aside, 0.0, 0.0], 1.0)]);
            let picture = render(&mut scene, &view, 1);
            let verdict = naive::compare(&scene, &view, &picture, CPU);
            assert!(verdict.is_ok(), "{altitude} {degrees} {step}: {verdict:?}");
            covered += picture.covered_pixels();
        }
        assert!(covered > 1000, "{covered} pixels tell little");
    }
}

#[test]
fn threads_and_grids_do_not_change_a_byte() {
    for (name, scene, view) in scenes().into_iter().step_by(3) {
        let draw = |threads, cells| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut scene = scene.clone();
            let picture = pool.install(|| render(&mut scene, &view, cells));
            let depths: Vec<u32> = picture.depth.iter().map(|depth| depth.to_bits()).collect();
            (picture.original_ids(&scene), depths)
        };
        let first = draw(1, 1);
        for (threads, cells) in [(2, 1), (1, 7), (3, 40)] {
            assert!(draw(threads, cells) == first, "{name}: {threads} threads, {cells} cells");
        }
    }
}

#[test]
fn a_moved_scene_gives_the_same_picture() {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let scene = Scene::new(cloud(&mut random, 2000, 1.0, [0.01, 0.1]));
    let (eye, target) = (DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO);
    // 1e7 and the eye are multiples of 2^-10, so that the view is exactly the same one.
    let draw = |origin: DVec3| {
        let view = View::look_at(origin + eye, origin + target, DVec3::Z).unwrap();
        let mut scene = Scene { origin, ..scene.clone() };
        let picture = render(&mut scene, &view.with_size(200, 200).unwrap(), 9);
        (picture.original_ids(&scene), picture.depth)
    };
    assert!(draw(DVec3::ZERO) == draw(DVec3::new(1e7, -1e7, 1e7)));
}

#[test]
fn coincident_spheres_show_the_lower_id() {
    let mut scene = Scene::new(vec![Sphere::new([0.1, 0.2, 0.3], 0.5); 50]);
    scene.records.to_mut().reverse();
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let view = View::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap().with_size(64, 64).unwrap();
    let picture = render(&mut scene, &view, 3);
    let ids = picture.original_ids(&scene);
    assert!(picture.covered_pixels() > 100);
    assert!(ids.iter().all(|&id| id == 0 || id == puncta::NO_RECORD));
}

#[test]
fn a_sphere_that_holds_the_camera_is_not_drawn() {
    for radius in [1.0, 2.0, 1e3] {
        let mut scene = Scene::new(vec![
            Sphere::new([0.0, 0.0, 0.5], radius),
            Sphere::new([0.0, 0.0, -2000.0], 100.0),
        ]);
        let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
        let view = view.with_size(64, 64).unwrap();
        let picture = render(&mut scene, &view, 1);
        let ids = picture.original_ids(&scene);
        assert!(ids.contains(&1) && !ids.contains(&0), "radius {radius}");
    }
}

#[test]
fn records_without_a_picture_do_no_harm() {
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
    let picture = render(&mut scene, &view, 2);
    naive::compare(&scene, &view, &picture, CPU).unwrap();
    assert!(picture.original_ids(&scene).contains(&5));
    // A depth that f32 cannot hold is not seen, and does not tie with what is not there.
    scene.origin = DVec3::new(0.0, 0.0, -1e39);
    assert_eq!(render(&mut scene, &view, 2).covered_pixels(), 0);
}

#[test]
fn a_renderer_survives_records_that_no_grid_takes() {
    use puncta::{Brick, Content, Renderer, Visible, core::Aabb};
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0];
    let mut records = vec![Sphere::new([0.0; 3], 0.5)];
    for value in bad {
        records.push(Sphere::new([value, 0.0, 0.0], 0.5));
        records.push(Sphere::new([0.0, 0.0, value], 0.5));
        records.push(Sphere::new([0.0, 0.0, 0.0], value));
    }
    let scene = Scene::new(records);
    let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let count = scene.records.len() as u32;
    let brick = Brick { records: 0..count, bounds, radius_max: 1.0, density: 1.0 };
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    for view in [view.clone(), view.with_orthographic(3.0).unwrap()] {
        let view = view.with_size(64, 64).unwrap();
        let bricks = [brick.clone()];
        let visible = Visible::all(&bricks, scene.origin, &view);
        let mut renderer = CpuRenderer::default();
        Renderer::<Sphere>::begin(&mut renderer, &view).unwrap();
        let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
        renderer.draw(&content, &visible.bricks).unwrap();
        let more = vec![brick.clone(); 8];
        let wrong = &Visible::all(&more, scene.origin, &view).bricks[7..];
        assert!(renderer.draw(&content, wrong).is_err(), "a brick that is not there");
        let inverted = [Brick { records: count..count + 1, ..brick.clone() }];
        let content = Content { bricks: &inverted, ..content };
        assert!(renderer.draw(&content, &visible.bricks).is_err(), "records that are not there");
        let picture = renderer.finish(&content).unwrap();
        // Records 0 and, at depths -1 and at x = -1, those of the last round can be seen.
        assert!(picture.visible_records().iter().all(|&id| id == 0 || id >= 10));
        assert!(picture.depth.iter().all(|depth| *depth > 0.0));
    }
}
