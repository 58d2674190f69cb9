/*!
Screen bounds: the pixels that a box of balls may cover, and a depth in front of which it has no
surface.

All balls of a brick lie in the hull of eight balls around the corners of its box. In perspective, the
slopes of the tangents from the eye to a ball at `(c, z)` on one screen axis, with `s = c / z` and
`p = r / z`, are at most

```text
(s + p sqrt(1 + s² - p²)) / (1 - p²)  <=  max(u, u / (1 - p²)),    u = s + p (1 + s²/2)
```

which needs neither a root nor a second division; the other side is its mirror. Over the hull the
largest slope is that of a corner. The bound is grown by [`SLACK_PIXELS`], ten times as much as the
box of a single sphere, and by the rounding of its corners, so no sphere's box reaches beyond that of
its brick.

Bricks that reach to the near plane or that are nearer than [`DEPTH_RADII_MIN`] radii may cover
anything. They are few.
*/

use crate::{Aabb, Camera};
use glam::{DVec3, f64::DMat3};
use wide::f64x4;

/// By how much bounds are grown.
const SLACK_PIXELS: f64 = 1e-2;

/// The smallest view depth, in radii, of corners that are bounded.
const DEPTH_RADII_MIN: f64 = 4.0;

/// Some pixels, first and last inclusive, and a depth. Without pixels, a first lies above its last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenBound {
    /// The first and the last column.
    pub columns: [u16; 2],
    /// The first and the last row.
    pub rows: [u16; 2],
    /// No surface lies in front of this depth, as it is computed and rounded to `f32`.
    pub nearest: f32,
}

impl ScreenBound {
    /// What is known of nothing.
    pub const UNKNOWN: Self = Self { columns: [0; 2], rows: [0; 2], nearest: f32::NAN };

    /// Whether it is known of what.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        !self.nearest.is_nan()
    }

    /// Whether it has no pixels.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.columns[0] > self.columns[1] || self.rows[0] > self.rows[1]
    }
}

/// Bounds the boxes of a view.
#[derive(Clone, Debug)]
pub struct Bounder<'a> {
    camera: &'a Camera,
    /// Columns that turn offsets into camera coordinates.
    axes: DMat3,
    last: [f64; 2],
    /// Half a picture, in units of slopes, and pixels per such unit.
    middle: [f64; 2],
    per_slope: f64,
    /// The sizes of what is the same in all boxes, for the rounding.
    largest: f64,
}

impl<'a> Bounder<'a> {
    /// For the boxes of a scene before this camera.
    #[must_use]
    pub fn new(camera: &'a Camera) -> Self {
        let [width, height] = camera.size().map(f64::from);
        let axis = |offset: DVec3| camera.turn(offset);
        Self {
            camera,
            axes: DMat3::from_cols(axis(DVec3::X), axis(DVec3::Y), axis(DVec3::Z)),
            last: [width - 1.0, height - 1.0],
            middle: [width * 0.5 - 0.5, height * 0.5 - 0.5],
            per_slope: 1.0 / camera.pixel_size(),
            largest: camera.place(DVec3::ZERO).abs().element_sum(),
        }
    }

    /// The bound of balls of at most this radius around points of a box.
    #[inline]
    #[must_use]
    pub fn bound(&self, bounds: &Aabb, radius: f32) -> ScreenBound {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        let center = self.camera.place(min + half);
        // Far from an origin or the eye, corners are rounded otherwise than the balls that lie there.
        let sizes = self.largest + (min + half).abs().element_sum() + half.element_sum();
        let radius = f64::from(radius) + 16.0 * f64::EPSILON * sizes;
        let near = self.camera.near();
        // How far the box reaches along each axis of the camera.
        let reach = half.x * self.axes.x_axis.abs().z
            + half.y * self.axes.y_axis.abs().z
            + half.z * self.axes.z_axis.abs().z;
        let front = center.z - reach;
        let margin = 1e-6 * (center.z.abs() + reach + radius);
        let nearest = depth_below((front - radius - margin).max(near * (1.0 - 1e-6)));
        let everything = ScreenBound {
            columns: [0, whole(self.last[0])],
            rows: [0, whole(self.last[1])],
            nearest: if nearest.is_nan() { 0.0 } else { nearest },
        };
        let is_perspective = self.camera.is_perspective();
        let is_bounded =
            !is_perspective || front - radius > near && front > DEPTH_RADII_MIN * radius;
        if !(is_bounded && center.is_finite() && half.is_finite() && radius.is_finite()) {
            return everything;
        }
        let [x, y] = if is_perspective {
            self.slopes(center, half, radius, front)
        } else {
            self.extents(center, half, radius)
        };
        let (columns, rows) = (self.pixels(x, 0), self.pixels([-y[1], -y[0]], 1));
        ScreenBound { columns, rows, nearest: everything.nearest }
    }

    /// From where to where the balls reach along right and up.
    fn extents(&self, center: DVec3, half: DVec3, radius: f64) -> [[f64; 2]; 2] {
        let axes = DMat3::from_cols(
            self.axes.x_axis.abs(),
            self.axes.y_axis.abs(),
            self.axes.z_axis.abs(),
        );
        let reach = axes * half + radius;
        [0, 1].map(|axis| [center[axis] - reach[axis], center[axis] + reach[axis]])
    }

    /// Bounds of the slopes of the balls around the corners, along right and up.
    #[inline]
    fn slopes(&self, center: DVec3, half: DVec3, radius: f64, front: f64) -> [[f64; 2]; 2] {
        let (i, j, k) =
            (self.axes.x_axis * half.x, self.axes.y_axis * half.y, self.axes.z_axis * half.z);
        let face = |axis: usize| {
            let (c, i, j) = (center[axis], i[axis], j[axis]);
            f64x4::new([c - i - j, c + i - j, c - i + j, c + i + j])
        };
        let one = f64x4::splat(1.0);
        let corners = |axis: usize| {
            let (face, k) = (face(axis), f64x4::splat(k[axis]));
            [face - k, face + k]
        };
        let inverse = corners(2).map(|z| one / z);
        let share = radius / front;
        let stretch = f64x4::splat(1.0 / (1.0 - share * share));
        let along = |axis: usize| {
            let corners = corners(axis);
            let reach = |z: usize| {
                let s = corners[z] * inverse[z];
                let p = f64x4::splat(radius) * inverse[z];
                let spread = p * (one + f64x4::splat(0.5) * s * s);
                let (low, high) = (s - spread, s + spread);
                (low.min(low * stretch), high.max(high * stretch))
            };
            let (a, b) = (reach(0), reach(1));
            let (low, high) = (a.0.min(b.0).to_array(), a.1.max(b.1).to_array());
            [
                low.into_iter().fold(f64::INFINITY, f64::min),
                high.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        [along(0), along(1)]
    }

    /// The pixels with centres between two slopes; `[1, 0]` if there are none.
    #[inline]
    fn pixels(&self, [low, high]: [f64; 2], axis: usize) -> [u16; 2] {
        let (middle, last) = (self.middle[axis], self.last[axis]);
        let first = (middle + low * self.per_slope - SLACK_PIXELS).ceil().max(0.0);
        let end = (middle + high * self.per_slope + SLACK_PIXELS).floor().min(last);
        if first <= end { [whole(first), whole(end)] } else { [1, 0] }
    }
}

/// The number of a row or column, which is below 2^14.
#[inline]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in range")]
fn whole(x: f64) -> u16 {
    x as u16
}

/// The largest `f32` that is not above a number.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
pub fn depth_below(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) > x { rounded.next_down() } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{View, nearest_depth};
    use glam::Vec3;
    use proptest::prelude::*;

    fn view(eye: DVec3, opening: f64, is_perspective: bool) -> Option<View> {
        let view = View::look_at(eye, DVec3::new(0.1, 0.2, 0.3), DVec3::Z).ok()?;
        let view = view.with_size(300, 200).ok()?.with_near(0.05).ok()?;
        if is_perspective {
            view.with_perspective(opening).ok()
        } else {
            view.with_orthographic(4.0 * opening).ok()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// The boxes and depths of balls anywhere in a box lie within its bound.
        #[test]
        fn balls_lie_in_the_bound_of_their_box(
            eye in [-6.0..6.0, -6.0..6.0, -6.0..6.0],
            opening in 0.001_f64..3.0,
            is_perspective in any::<bool>(),
            min in [-5.0_f32..5.0, -5.0_f32..5.0, -5.0_f32..5.0],
            sides in [0.0_f32..2.0, 0.0_f32..2.0, 0.0_f32..2.0],
            radius in 1e-4_f32..1.0,
            shift in prop_oneof![Just(0.0), Just(1e7)],
            balls in prop::collection::vec([0.0_f32..=1.0, 0.0_f32..=1.0, 0.0_f32..=1.0, 0.0_f32..=1.0], 8),
        ) {
            let Some(view) = view(DVec3::from(eye), opening, is_perspective) else {
                return Ok(());
            };
            // The scene stays where it is; only the numbers become larger.
            let camera = Camera::new(&view, DVec3::splat(shift) - DVec3::splat(shift));
            let bounds = Aabb { min: Vec3::from(min), max: Vec3::from(min) + Vec3::from(sides) };
            let bound = Bounder::new(&camera).bound(&bounds, radius);
            prop_assert!(bound.is_known());
            for [x, y, z, r] in balls {
                // Corners and large balls are the hard cases.
                let share = Vec3::new(x, y, z).map(|t| if t < 0.3 { 0.0 } else if t > 0.7 { 1.0 } else { t });
                let center = bounds.min + share * (bounds.max - bounds.min);
                let center = center.min(bounds.max);
                let center = camera.place(center.as_dvec3());
                let r = f64::from(if r > 0.5 { radius } else { radius * r });
                let Some(screen) = camera.screen_box(center, r) else { continue };
                if screen.columns.is_empty() || screen.rows.is_empty() {
                    continue;
                }
                if let Some(around) = camera.outline(center, r) {
                    for (around, range) in around.iter().zip([&screen.columns, &screen.rows]) {
                        prop_assert!(around[0] <= *range.start() as f64 + 1e-9);
                        prop_assert!(around[1] >= *range.end() as f64 - 1e-9);
                    }
                }
                let inside = |[first, last]: [u16; 2], range: &std::ops::RangeInclusive<i64>| {
                    i64::from(first) <= *range.start() && *range.end() <= i64::from(last)
                };
                prop_assert!(inside(bound.columns, &screen.columns), "{:?} {:?}", bound, screen);
                prop_assert!(inside(bound.rows, &screen.rows), "{:?} {:?}", bound, screen);
                let seen = nearest_depth(center.z, r).max(view.near());
                prop_assert!(f64::from(bound.nearest) <= seen);
            }
        }
    }

    #[test]
    fn depths_are_rounded_to_the_front() {
        for x in [0.1, -0.1, 1e300, -1e300, 1e-300, -1e-300, f64::INFINITY, 1.0, 0.0, 16_777_217.0]
        {
            assert!(f64::from(depth_below(x)) <= x, "{x}");
        }
        assert_eq!(depth_below(16_777_217.0), 16_777_216.0);
        assert_eq!(depth_below(1e300), f32::MAX);
    }

    #[test]
    fn bounds_are_tight() {
        let view = view(DVec3::new(10.0, 0.2, 0.3), 0.5, true).unwrap();
        let camera = Camera::new(&view, DVec3::ZERO);
        let place = Vec3::new(0.0, 0.2, 0.3);
        let bounds = Aabb { min: place - 0.5, max: place + 0.5 };
        let bound = Bounder::new(&camera).bound(&bounds, 0.1);
        // The front face lies at depth 9.5; half a side and a radius make 0.6.
        let half = 0.6 / 9.5 / view.pixel_size();
        let width = f64::from(bound.columns[1] - bound.columns[0] + 1);
        assert!((width - 2.0 * half).abs() < 2.0, "{width} of {}", 2.0 * half);
        assert!((bound.nearest - 9.4).abs() < 1e-4);
    }

    #[test]
    fn what_cannot_be_bounded_may_be_anywhere() {
        let view = view(DVec3::new(1.0, 0.0, 0.0), 0.5, true).unwrap();
        let camera = Camera::new(&view, DVec3::ZERO);
        let bounder = Bounder::new(&camera);
        let huge = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        let around = Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) };
        for bounds in [huge, around] {
            let bound = bounder.bound(&bounds, 0.1);
            assert_eq!((bound.columns, bound.rows), ([0, 299], [0, 199]));
            assert!(bound.is_known() && f64::from(bound.nearest) <= view.near());
        }
        let aside = Aabb { min: Vec3::new(-9.0, 50.0, 0.0), max: Vec3::new(-8.0, 51.0, 1.0) };
        assert!(bounder.bound(&aside, 0.1).is_empty());
    }
}
