//! Promise 2 under hostile scenes, views, bricks and stages: what is skipped never changes the
//! picture, bit by bit, and nothing panics.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use puncta::{
    Brick, Bricks, CpuRenderer, Depth, Frame, FrustumCull, Picture, Pipeline, Record, Scene,
    Sphere, Stage, View, Visible,
    core::{Aabb, Block, VisibleBrick},
};
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;
use std::ops::Range;

const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Bricks of a user's own, in any order, and blocks of them.
#[derive(Clone, Debug)]
struct Own {
    bricks: Vec<Brick>,
    blocks: Vec<Block>,
}

impl Bricks for Own {
    fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}

/// Turns the list around and has each brick twice; drops some of the rest at each step.
#[derive(Clone, Copy, Debug)]
struct Twice;

impl<G: ?Sized> Stage<G> for Twice {
    fn apply(&mut self, _: &Frame<'_, G>, visible: &mut Visible) {
        let again: Vec<VisibleBrick> = visible.bricks.iter().rev().copied().collect();
        visible.bricks.extend(again);
    }

    fn refine(&mut self, _: &Frame<'_, G>, visible: &mut Visible) {
        let again: Vec<VisibleBrick> = visible.bricks.iter().rev().step_by(2).copied().collect();
        visible.bricks.extend(again);
        visible.bricks.reverse();
        visible.bricks.sort_by_key(VisibleBrick::index);
        visible.bricks.dedup_by_key(|brick| brick.index());
    }
}

fn brick(scene: &Scene, records: Range<u32>) -> Brick {
    let (mut bounds, mut radius_max) = (Aabb::EMPTY, 0.0_f32);
    for record in &scene.records[records.start as usize..records.end as usize] {
        bounds.add(record.position());
        radius_max = radius_max.max(record.radius());
    }
    Brick { records, bounds, radius_max, density: 0.5 }
}

/// Bricks that overlap, are empty or as large as all space, in any order; each record is in one.
fn own_bricks(scene: &Scene, random: &mut Pcg64Mcg) -> Own {
    let count = u32::try_from(scene.records.len()).unwrap();
    let (mut bricks, mut start) = (Vec::new(), 0);
    while start < count {
        let end = (start + random.random_range(0..12)).min(count);
        bricks.push(brick(scene, start..end));
        start = end;
    }
    for _ in 0..random.random_range(0..5) {
        let (a, b) = (random.random_range(0..=count), random.random_range(0..=count));
        let mut more = brick(scene, a.min(b)..a.max(b));
        if random.random() {
            more.bounds = EVERYWHERE;
        }
        bricks.push(more);
    }
    if random.random() {
        bricks.shuffle(random);
    }
    let (mut blocks, mut first) = (Vec::new(), 0);
    while first < bricks.len() {
        let end = (first + random.random_range(0..9)).min(bricks.len());
        if random.random_range(0..4) > 0 {
            blocks.push(Block::of_run(u32::try_from(first).unwrap(), &bricks[first..end]));
        }
        first = end.max(first + 1);
    }
    Own { bricks, blocks }
}

/// Spheres with radii over many decades, some of them the same, at a scale and around a place that
/// may be far from the origin of the scene, which may be far from that of the world.
fn scene(random: &mut Pcg64Mcg) -> (Scene, DVec3) {
    let count = random.random_range(1..400);
    let scale = [1e-6_f32, 1.0, 1.0, 1e6][random.random_range(0..4)];
    let around = [0.0_f32, 0.0, 1e3, 1e7][random.random_range(0..4)] * scale;
    let decades = random.random_range(0.0_f32..6.0);
    let largest = [0.02_f32, 0.2, 3.0][random.random_range(0..3)] * scale;
    let mut sphere = || {
        let center = [0; 3].map(|_| around + (random.random::<f32>() * 2.0 - 1.0) * scale);
        Sphere { center, radius: largest * 10_f32.powf(-decades * random.random::<f32>()) }
    };
    let mut records: Vec<Sphere> = (0..count).map(|_| sphere()).collect();
    records[0].radius = 0.0;
    let again = records[count / 2];
    records[count - 1] = again;
    let mut scene = Scene::new(records);
    scene.origin = DVec3::splat([0.0, 1e7][random.random_range(0..2)]);
    let target = scene.position(random.random_range(0..count));
    (scene, target)
}

/// A view of a target, from anywhere, with any angle, in a picture of any shape: of one sphere, or of
/// much of the scene.
fn view(random: &mut Pcg64Mcg, (scene, target): (&Scene, DVec3)) -> Option<View> {
    let all = brick(scene, 0..scene.records.len() as u32);
    let is_wide = random.random_range(0..3) > 0;
    let side = (all.bounds.max - all.bounds.min).max_element();
    let scale = f64::from(if is_wide { side } else { all.radius_max });
    let mut axis = || DVec3::from([0; 3].map(|_| random.random::<f64>() * 2.0 - 1.0));
    let (direction, up) = (axis(), axis());
    let mut power = |from: f64, to: f64| 10_f64.powf(random.random_range(from..to));
    let eye =
        target + direction * scale * if is_wide { power(-2.0, 1.0) } else { power(-4.0, 3.0) };
    let near = scale * power(-9.0, 0.5);
    let height = scale * if is_wide { power(-1.0, 1.0) } else { power(-7.0, 8.0) };
    let angle = power(if is_wide { -1.0 } else { -9.0 }, 0.4969);
    let sizes = [(1, 1), (1, 300), (300, 1), (97, 41), (40, 130), (8, 8), (64, 31)];
    let (width, height_pixels) = sizes[random.random_range(0..sizes.len())];
    let view = View::look_at(eye, target, up).ok()?.with_size(width, height_pixels).ok()?;
    let view = if random.random() { view.with_near(near).ok()? } else { view };
    if random.random() { view.with_perspective(angle) } else { view.with_orthographic(height) }.ok()
}

/// The picture of all records, in one brick that can be anywhere: nothing is skipped.
fn complete(scene: &Scene, view: &View) -> Picture {
    let brick = Brick { bounds: EVERYWHERE, ..brick(scene, 0..scene.records.len() as u32) };
    let mut pipeline = Pipeline::new((), CpuRenderer::default());
    pipeline.render(scene, &vec![brick], view).unwrap()
}

fn bits(picture: &Picture) -> Vec<(u32, u32)> {
    picture.depth.iter().map(|depth| depth.to_bits()).zip(picture.id.iter().copied()).collect()
}

/// Draws with these stages, and checks that what is not open does not change.
fn check<S: Stage<Own>>(
    pipeline: &mut Pipeline<S, CpuRenderer>,
    (scene, bricks): (&Scene, &Own),
    view: &View,
    budget: u64,
) -> Result<(), TestCaseError> {
    let expected = bits(&complete(scene, view));
    let mut steps = pipeline.progressive(scene, bricks, view, budget).unwrap();
    let width = view.width() as usize;
    let mut count = 0;
    while let Some(progress) = steps.next() {
        let progress = progress.unwrap();
        let now = bits(&steps.picture().unwrap());
        for (pixel, expected) in expected.iter().enumerate() {
            let [column, row] = [pixel % width, pixel / width].map(|x| x as u32);
            let is_open = steps.renderer().is_open(column, row) && !progress.settled();
            prop_assert!(is_open || now[pixel] == *expected, "pixel {} of step {}", pixel, count);
        }
        count += 1;
        prop_assert!(count <= 2 * bricks.bricks.len() + 2, "there is no end");
    }
    prop_assert!(steps.progress().settled());
    prop_assert!(bits(&steps.picture().unwrap()) == expected);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 100, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn nothing_hostile_changes_a_picture(
        seed in any::<u64>(),
        budget in prop_oneof![Just(1_u64), 2_u64..300],
    ) {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let (scene, target) = scene(&mut random);
        let own = own_bricks(&scene, &mut random);
        let mut view = || view(&mut random, (&scene, target));
        let (Some(first), Some(second)) = (view(), view()) else { return Ok(()) };
        let mut plain = Pipeline::new((), CpuRenderer::default());
        let mut ordered = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
        let mut twice = Pipeline::new((FrustumCull, Twice), CpuRenderer::default());
        for view in [first, second] {
            check(&mut plain, (&scene, &own), &view, budget)?;
            check(&mut ordered, (&scene, &own), &view, budget)?;
            check(&mut twice, (&scene, &own), &view, budget)?;
        }
    }
}

/// Far from the origin of the scene, the corners of a box are rounded otherwise than the spheres that
/// lie there; through a narrow angle that is many pixels.
#[test]
fn bounds_hold_where_numbers_are_coarse() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut covered = 0;
    for round in 0..400 {
        let mut axis = || random.random::<f32>() * 2.0 - 1.0;
        let at = Vec3::new(axis(), axis(), axis()) * 1e7;
        let other = at + Vec3::new(axis(), axis(), axis()) * 3.0;
        let eye = at.as_dvec3() + DVec3::new(axis().into(), axis().into(), axis().into()) * 50.0;
        let (near_one, other) = (Sphere::new(at.into(), 1e-8), Sphere::new(other.into(), 1e-8));
        let scene = Scene::new(vec![near_one, other]);
        let view = View::look_at(eye, at.as_dvec3(), DVec3::Z).unwrap().with_size(90, 90).unwrap();
        let view = if round % 2 == 0 {
            view.with_perspective(1e-9).unwrap()
        } else {
            view.with_orthographic(4e-8).unwrap()
        };
        let whole = Own { bricks: vec![brick(&scene, 0..2)], blocks: vec![] };
        let expected = complete(&scene, &view);
        covered += expected.covered_pixels();
        let mut pipeline = Pipeline::new(FrustumCull, CpuRenderer::default());
        let picture = pipeline.render(&scene, &whole, &view).unwrap();
        assert!(bits(&picture) == bits(&expected), "round {round}");
    }
    assert!(covered > 10_000, "{covered}");
}

/// Records that no grid takes, in a picture of one band.
#[test]
fn negative_radii_do_no_harm() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], -1.0), Sphere::new([0.0; 3], 0.5)]);
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(64, 30).unwrap();
    for view in [view.clone(), view.with_orthographic(3.0).unwrap()] {
        assert_eq!(complete(&scene, &view).visible_records(), [1]);
    }
}

/// The records that were seen are those of another scene by now.
#[test]
fn a_scene_may_change_between_pictures() {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let mut recalled = 0;
    for _ in 0..200 {
        let (scene, target) = scene(&mut random);
        let own = own_bricks(&scene, &mut random);
        let Some(view) = view(&mut random, (&scene, target)) else { continue };
        let mut steps = pipeline.progressive(&scene, &own, &view, 100).unwrap();
        steps.by_ref().for_each(|step| recalled += step.unwrap().recalled);
        assert!(bits(&steps.picture().unwrap()) == bits(&complete(&scene, &view)));
    }
    assert!(recalled > 100);
}
