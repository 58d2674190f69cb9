//! Culling never drops what can be seen; the depth order is one.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use puncta_core::{Aabb, Block, Brick, Bricks, Frame, Stage, View, Visible};
use puncta_occlusion::{Depth, FrustumCull};

fn point(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from)
}

fn brick() -> impl Strategy<Value = Brick> {
    (point(5.0), [0.0_f32..2.0, 0.0_f32..2.0, 0.0_f32..2.0], 1e-3_f32..1.0).prop_map(
        |(min, sides, radius_max)| {
            let min = min.as_vec3();
            let bounds = Aabb { min, max: min + Vec3::from(sides) };
            Brick { records: 0..0, bounds, radius_max, density: 0.0 }
        },
    )
}

fn view() -> impl Strategy<Value = View> {
    (point(6.0), point(6.0), 0.01_f64..3.0, 1e-6_f64..2.0, any::<bool>()).prop_filter_map(
        "a degenerate view",
        |(eye, target, opening, near, is_perspective)| {
            let view = View::look_at(eye, target, DVec3::Z).ok()?;
            let view = view.with_size(40, 30).ok()?.with_near(near).ok()?;
            if is_perspective {
                view.with_perspective(opening).ok()
            } else {
                view.with_orthographic(4.0 * opening).ok()
            }
        },
    )
}

/// Whether a point lies in the view, with a small margin against rounding here.
fn is_inside(view: &View, origin: DVec3, point: DVec3) -> bool {
    let p = view.to_camera((origin - view.eye()) + point);
    let depth = if view.is_perspective() { p.z } else { 1.0 };
    let half = view.pixel_size() * depth * (1.0 - 1e-9);
    p.z >= view.near() * (1.0 + 1e-9) && p.x.abs() <= 20.0 * half && p.y.abs() <= 15.0 * half
}

/// Points of the balls around corners and other points of the box of a brick.
fn points(brick: &Brick) -> Vec<DVec3> {
    let (min, max) = (brick.bounds.min.as_dvec3(), brick.bounds.max.as_dvec3());
    let grid = |n: usize| [n % 3, n / 3 % 3, n / 9].map(|i| i as f64 * 0.5);
    let directions = (0..27).map(grid).map(|g| (DVec3::from(g) * 2.0 - 1.0).normalize_or_zero());
    let directions: Vec<DVec3> = directions.collect();
    let bases = (0..27).map(grid).map(|g| min + (max - min) * DVec3::from(g));
    let around = |base: DVec3| {
        directions.iter().map(move |direction| base + *direction * f64::from(brick.radius_max))
    };
    bases.flat_map(around).collect()
}

struct Blocked {
    bricks: Vec<Brick>,
    blocks: Vec<Block>,
}

impl Bricks for Blocked {
    fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn nothing_that_can_be_seen_is_culled(
        view in view(),
        bricks in prop::collection::vec(brick(), 1..8),
        shift in prop_oneof![Just(0.0), Just(1e7)],
    ) {
        let origin = DVec3::splat(shift);
        // The view moves with the scene.
        let target = origin + view.eye() + view.forward();
        let moved = View::look_at(origin + view.eye(), target, view.up()).unwrap()
            .with_size(view.width(), view.height()).unwrap().with_near(view.near()).unwrap();
        let view = match view.projection() {
            puncta_core::Projection::Perspective { fov_y } => moved.with_perspective(fov_y),
            puncta_core::Projection::Orthographic { height } => moved.with_orthographic(height),
        }.unwrap();
        let mut visible = Visible::all(&bricks, origin, &view);
        FrustumCull.apply(&Frame { view: &view, origin, bricks: &bricks }, &mut visible);
        for (index, brick) in (0_u32..).zip(&bricks) {
            let kept = visible.bricks.iter().any(|visible| visible.index() == index);
            if points(brick).into_iter().any(|point| is_inside(&view, origin, point)) {
                prop_assert!(kept, "{:?} was culled", brick);
            }
        }
    }

    #[test]
    fn blocks_change_nothing(
        view in view(),
        bricks in prop::collection::vec(brick(), 0..400),
        seed in any::<u32>(),
    ) {
        let cull = |visible: &mut Visible| {
            let blocks = Block::of_runs(&bricks);
            let blocked = Blocked { bricks: bricks.clone(), blocks };
            let mut expected = visible.clone();
            let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &bricks };
            FrustumCull.apply(&frame, &mut expected);
            let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &blocked };
            FrustumCull.apply(&frame, visible);
            expected
        };
        let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
        let expected = cull(&mut visible);
        prop_assert_eq!(&visible, &expected);
        // In another order, too.
        let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
        visible.bricks.sort_by_key(|brick| brick.index().wrapping_mul(seed | 1));
        let expected = cull(&mut visible);
        prop_assert_eq!(&visible, &expected);
    }

    #[test]
    fn the_depth_order_ascends(view in view(), bricks in prop::collection::vec(brick(), 0..50)) {
        let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
        let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &bricks };
        Depth::default().apply(&frame, &mut visible);
        prop_assert_eq!(visible.bricks.len(), bricks.len());
        prop_assert!(visible.bricks.is_sorted_by(|a, b| (a.near(), a.index()) <= (b.near(), b.index())));
    }
}

/// For each plane of each view, a ball that just does not reach it must go, one that just does must
/// stay: the test is exact, not only safe.
#[test]
fn culling_is_exact_at_every_plane() {
    let front = View::look_at(DVec3::new(3.0, -2.0, 1.0), DVec3::ZERO, DVec3::Z).unwrap();
    let front = front.with_size(400, 300).unwrap().with_near(0.5).unwrap();
    for view in [front.clone(), front.with_orthographic(3.0).unwrap()] {
        let is_perspective = view.is_perspective();
        let half = view.pixel_size() * DVec3::new(200.0, 150.0, 0.0);
        let depth = 2.0;
        let spread = if is_perspective { depth } else { 1.0 };
        let side = |outward: DVec3, half: f64| {
            let normal = if is_perspective { outward - view.forward() * half } else { outward };
            (view.forward() * depth + outward * half * spread, normal.normalize())
        };
        let planes = [
            side(view.right(), half.x),
            side(-view.right(), half.x),
            side(view.up(), half.y),
            side(-view.up(), half.y),
            (view.forward() * view.near(), -view.forward()),
        ];
        for (on_plane, outward) in planes {
            let keeps = |distance: f64| {
                let place = (view.eye() + on_plane + outward * distance).as_vec3();
                let bounds = Aabb { min: place, max: place };
                let bricks = [Brick { records: 0..0, bounds, radius_max: 0.25, density: 0.0 }];
                let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
                let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &bricks };
                FrustumCull.apply(&frame, &mut visible);
                !visible.bricks.is_empty()
            };
            // Places are stored as f32: a few units in the last place are lost.
            assert!(keeps(0.25 - 1e-6) && !keeps(0.25 + 1e-6), "{outward}");
        }
    }
}

#[test]
fn boxes_beyond_all_numbers_are_kept() {
    let view = View::look_at(DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
    let bounds = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    let bricks = [Brick { records: 0..0, bounds, radius_max: 1.0, density: 0.0 }];
    let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
    let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &bricks };
    FrustumCull.apply(&frame, &mut visible);
    assert_eq!(visible.bricks.len(), 1);
}

#[test]
fn what_lies_aside_or_behind_is_culled() {
    let view = View::look_at(DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
    let at = |x: f32, y: f32, radius_max| {
        let place = Vec3::new(x, y, 0.0);
        let bounds = Aabb { min: place - 0.5, max: place + 0.5 };
        Brick { records: 0..0, bounds, radius_max, density: 0.0 }
    };
    let bricks =
        vec![at(10.0, 0.0, 0.1), at(-10.0, 0.0, 0.1), at(10.0, 9.0, 0.1), at(10.0, 9.0, 6.0)];
    let mut visible = Visible::all(&bricks, DVec3::ZERO, &view);
    let frame = Frame { view: &view, origin: DVec3::ZERO, bricks: &bricks };
    FrustumCull.apply(&frame, &mut visible);
    let kept: Vec<u32> = visible.bricks.iter().map(|brick| brick.index()).collect();
    assert_eq!(kept, [0, 3]);
}
