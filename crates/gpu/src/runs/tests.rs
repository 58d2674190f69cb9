//! What `place.wgsl` and `disc.wgsl` reckon in `f32`, reckoned here in `f32` as well, against `f64`.

#![expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is tested")]

use super::*;
use crate::{kernels::CULL, shaders::assert_same_layout};
use glam::{IVec2, Vec2};
use proptest::prelude::*;
use puncta_core::{Aabb, Bounder, View};
use std::f64::consts::PI;

#[test]
fn a_run_is_that_of_the_shaders() {
    assert_same_layout!(
        CULL,
        "Run",
        Run { reference, nearest, center, brick, slope, whole, fraction, columns, rows }
    );
}

/// `Camera` of `camera.wgsl`.
struct Eye {
    axes: [Vec3; 3],
    middle: Vec2,
    last: IVec2,
    step: f32,
    pixel: f32,
    per_pixel: f32,
    is_perspective: bool,
}

impl Eye {
    fn new(view: &View) -> Self {
        let size = Vec2::new(view.width() as f32, view.height() as f32);
        let pixel = view.pixel_size();
        Self {
            axes: [view.right(), view.up(), view.forward()].map(|axis| axis.as_vec3()),
            middle: size * 0.5 - 0.5,
            last: size.as_ivec2() - 1,
            step: if view.is_perspective() { pixel as f32 } else { 0.0 },
            pixel: pixel as f32,
            per_pixel: (1.0 / pixel) as f32,
            is_perspective: view.is_perspective(),
        }
    }
}

/// `Disc` of `disc.wgsl`.
#[derive(Debug)]
struct Disc {
    fraction: Vec2,
    scale: f32,
    depth: f32,
    slope: Vec2,
    radius: f32,
    whole: IVec2,
    /// The first and the last pixel; `None` if there are none.
    pixels: Option<[IVec2; 2]>,
}

/// `place` and `outline` of `place.wgsl`.
fn place(eye: &Eye, run: &Run, position: Vec3, radius: f32) -> Disc {
    let offset = position - Vec3::from(run.reference);
    let local = Vec3::from(eye.axes.map(|axis| axis.dot(offset)));
    let center = Vec3::from(run.center) + local;
    let (mut spread, mut slope) = (1.0, Vec2::ZERO);
    if eye.is_perspective {
        spread = center.z;
        slope = center.truncate() / center.z;
    }
    let aside = (local.truncate() - Vec2::from(run.slope) * local.z) * (eye.per_pixel / spread);
    let at = Vec2::from(run.fraction) + Vec2::new(aside.x, -aside.y);
    let fraction = at - at.floor();
    let whole = IVec2::from(run.whole) + at.floor().as_ivec2();
    let scale = spread * eye.pixel / radius;
    let mut reach = Vec2::splat(1.0 / scale);
    if eye.is_perspective {
        let (share, slope) = (radius / center.z, slope.abs());
        let stretch = 1.0 / (1.0 - share * share);
        reach = (share * (1.0 + 0.5 * slope * slope) + slope * (share * share)) * stretch;
        reach *= eye.per_pixel;
    }
    reach = reach * 1.00001 + 0.01;
    let first = (whole + (fraction - reach).ceil().as_ivec2()).max(IVec2::ZERO);
    let end = (whole + (fraction + reach).floor().as_ivec2()).min(eye.last);
    let is_empty = first.cmpgt(end).any() || !(reach.x < 4096.0 && reach.y < 4096.0);
    let pixels = (!is_empty).then_some([first, end]);
    Disc { fraction, scale, depth: center.z, slope, radius, whole, pixels }
}

/// The discriminant and the depth of `hit` of `disc.wgsl`.
fn hit(eye: &Eye, disc: &Disc, pixel: IVec2) -> (f32, f32) {
    let at = pixel.as_vec2();
    let ray = Vec2::new(at.x - eye.middle.x, eye.middle.y - at.y) * eye.step;
    let offset = ((pixel - disc.whole).as_vec2() - disc.fraction) * disc.scale;
    let (u, v) = (offset.x, -offset.y);
    let e = disc.slope.x * v - disc.slope.y * u;
    let a = 1.0 + (ray.x * ray.x + ray.y * ray.y);
    let q = a - (u * u + v * v + e * e);
    (q, disc.depth - disc.radius * ((u * ray.x + v * ray.y) + q.sqrt()) / a)
}

/// The same discriminant in `f64`, from the camera's definition of what is seen.
fn discriminant(camera: &Camera, at: DVec2, center: DVec3, radius: f64) -> f64 {
    let ray = camera.ray(at.x, at.y);
    if camera.is_perspective() {
        let direction = ray.extend(1.0);
        let away = center.cross(direction).length_squared();
        direction.length_squared() - away / (radius * radius)
    } else {
        1.0 - (ray - center.truncate()).length_squared() / (radius * radius)
    }
}

#[derive(Clone, Debug)]
struct Case {
    view: View,
    brick: Brick,
    /// Where in the box the sphere lies.
    share: Vec3,
    radius: f32,
}

/// Bricks of whatever size in the picture, at distances over six decades, seen so that a radius of
/// 0.01 is 5 pixels.
fn case() -> impl Strategy<Value = Case> {
    let direction = [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from);
    let look = (0.0_f64..6.0, direction, any::<bool>(), [-400.0..400.0, -400.0..400.0, -1.0..1.0]);
    let sides = [-1.0_f64..3.0, -1.0..3.0, -1.0..3.0];
    let share = [0.0_f32..=1.0, 0.0..=1.0, 0.0..=1.0];
    let radii = (-1.0_f64..2.7, -1.0_f64..2.7);
    (look, sides, share, radii).prop_filter_map("no such view", |(look, sides, share, radii)| {
        let (distance, direction, is_perspective, aside) = look;
        let distance = 10_f64.powf(distance);
        let world = 0.002;
        let target = DVec3::from(aside) * world;
        let eye = target + direction.try_normalize()? * distance;
        let view = View::look_at(eye, DVec3::ZERO, DVec3::new(0.3, 0.5, 0.8)).ok()?;
        let view = view.with_size(900, 700).ok()?.with_near(1e-3).ok()?;
        let view = if is_perspective {
            view.with_perspective(2.0 * (350.0 * world / distance).atan()).ok()?
        } else {
            view.with_orthographic(700.0 * world).ok()?
        };
        let sides = sides.map(|side| (10_f64.powf(side) * world) as f32);
        let [radius, largest] = [radii.0, radii.1].map(|x| (10_f64.powf(x) * world) as f32);
        let min = target.as_vec3() - Vec3::from(sides) * 0.5;
        let bounds = Aabb { min, max: min + Vec3::from(sides) };
        let brick = Brick { records: 0..1, bounds, radius_max: radius.max(largest), density: 1.0 };
        Some(Case { view, brick, share: Vec3::from(share), radius })
    })
}

/// A sphere in a brick that is plain: what `f32` makes of it, and where it is.
fn placed(case: &Case) -> Option<(Camera, Eye, Disc, DVec3)> {
    let camera = Camera::new(&case.view, DVec3::ZERO);
    if !is_plain(&camera, &case.brick) {
        return None;
    }
    let bounds = &case.brick.bounds;
    let bound = Bounder::new(&camera).bound(bounds, case.brick.radius_max);
    let run = Run::of_brick(&camera, (0, &case.brick), &bound);
    let position = (bounds.min + case.share * (bounds.max - bounds.min)).min(bounds.max);
    let eye = Eye::new(&case.view);
    let disc = place(&eye, &run, position, case.radius);
    let center = camera.place(position.as_dvec3());
    Some((camera, eye, disc, center))
}

proptest! {
    #![proptest_config(ProptestConfig {
        max_global_rejects: 200_000,
        ..ProptestConfig::with_cases(4000)
    })]

    /// Silhouettes are off by no more than the text says (2.8e-4 and 3e-4 pixels), and so are depths.
    #[test]
    fn silhouettes_are_exact(case in case(), turns in prop::collection::vec(-PI..PI, 16)) {
        let Some((camera, eye, disc, center)) = placed(&case) else {
            return Err(TestCaseError::reject("a close brick"));
        };
        let radius = f64::from(case.radius);
        let spread = if camera.is_perspective() { center.z } else { 1.0 };
        let middle = center.truncate() / spread;
        for turn in turns {
            let rim = camera.pixel_of(middle + DVec2::from_angle(turn) * radius / spread);
            let pixel = rim.round().as_ivec2();
            if pixel.cmplt(IVec2::ZERO).any() || pixel.cmpgt(eye.last).any() {
                continue;
            }
            let at = pixel.as_dvec2();
            let (q, depth) = hit(&eye, &disc, pixel);
            let exact = discriminant(&camera, at, center, radius);
            // The discriminant tells how far the ray is from the rim, as seen from the centre.
            let a = if camera.is_perspective() {
                camera.ray(at.x, at.y).length_squared() + 1.0
            } else {
                1.0
            };
            let distance = |q: f64| ((a - q) / a).sqrt() * radius / (spread * camera.pixel_size());
            let off = (distance(q.into()) - distance(exact)).abs();
            prop_assert!(off <= 5.8e-4, "{} pixels of {:?}", off, disc);
            let seen = camera.depth(camera.ray(at.x, at.y), center, radius);
            if let Some(seen) = seen.filter(|_| exact > 0.05) {
                let error = (f64::from(depth) - seen).abs() / seen;
                prop_assert!(error < 2.0_f64.powi(-21), "{} of {}", error, seen);
            }
        }
    }

    /// The pixels that a disc may cover are all that it covers.
    #[test]
    fn no_pixel_is_left_out(case in case()) {
        let Some((camera, _, disc, center)) = placed(&case) else {
            return Err(TestCaseError::reject("a close brick"));
        };
        let Some(around) = camera.screen_box(center, case.radius.into()) else { return Ok(()) };
        if around.columns.is_empty() || around.rows.is_empty() {
            return Ok(());
        }
        prop_assert!(disc.pixels.is_some(), "{:?} {:?}", around, disc);
        let [first, last] = disc.pixels.unwrap_or_default().map(|at| at.as_i64vec2());
        prop_assert!(first.x <= *around.columns.start() && *around.columns.end() <= last.x);
        prop_assert!(first.y <= *around.rows.start() && *around.rows.end() <= last.y);
    }
}
