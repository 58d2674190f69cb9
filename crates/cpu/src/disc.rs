/*!
Small spheres, eight pixels at a time in `f32`: the projection-centred form.

A form that subtracts a ray and a centre in camera coordinates loses `z 2^-24` of position at the
distance `z`; for a sphere of radius 0.02 seen from 1000 units away that is 0.3 % of the radius. Here
everything is relative to the sphere's own projected centre, in units of its radius, so that nothing
large is ever subtracted. Let `m = (mx, my, 1)` be the sphere's centre divided by its depth `cz`, and
`d = (x, y, 1)` the ray. With

```text
(u, v) = cz / r (d - m)      from the pixel's distance to the projected centre
e      = mx v - my u
a      = d.d
q      = a - (u² + v² + e²)
```

the ray meets the sphere if `q >= 0`, and enters it at `z = cz - r ((u x + v y) + sqrt(q)) / a`. An
orthographic view is the same with `x = y = mx = my = 0` and `(u, v)` in world units divided by `r`.

# How exact it is

In units of 2⁻²⁴: `u` and `v` have relative errors of 3, and the two terms of `e`, which may cancel,
of 4; so `q` has an absolute error of at most `14 a (1 + |m|)`. Where `|q|` is less than that, `f32`
cannot tell whether the ray meets the sphere. The depth is off by one unit from its own rounding, by
half a unit from the small term, which is at most 1/16 of it, and by the error of `sqrt(q)`, which
grows towards the silhouette: `7 / sqrt(q)` in radii. That is more than two units where
`q < 12 (r / cz)²`. Pixels with a `q` below either bound, few as they are, are left to `f64`, and so
are spheres that are larger or nearer than this reckoning allows.
*/

use glam::DVec3;
use puncta_core::{Camera, nearest_depth};
use wide::{f32x8, u32x8};

/// How many pixels are drawn at once.
pub(crate) const LANES: usize = 8;

/// The largest radius, in pixels, of a sphere that is drawn in `f32`.
const RADIUS_PIXELS_MAX: f64 = 64.0;

/// The smallest view depth, in radii, of a sphere that is drawn in `f32`.
const DEPTH_RADII_MIN: f64 = 16.0;

/// A sphere ready to be drawn in `f32`.
#[derive(Clone, Debug)]
pub(crate) struct Disc {
    /// Radii per pixel.
    scale: f32,
    /// The pixel coordinates of the projected centre.
    column: f64,
    row: f64,
    /// The slopes of the ray through the centre.
    mx: f32,
    my: f32,
    radius: f32,
    /// The view depth of the centre, in two parts.
    depth: f32,
    depth_rest: f32,
    /// A view depth in front of which the sphere has no point.
    nearest: f32,
    /// Below this size, `q` says too little about the silhouette or the depth.
    doubt: f32,
    /// The distance between neighboring rays at view depth 1; 0 if they are parallel.
    step: f32,
}

/// The pixels, by bits, that are not settled by drawing a disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Unsettled {
    /// The disc is exactly as deep as what is there.
    pub(crate) ties: u32,
    /// Where the depth must be found in `f64`.
    pub(crate) doubts: u32,
}

/// The part of a disc that is the same for all pixels of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DiscRow {
    v: f32,
    y: f32,
}

impl Disc {
    /// The disc of a sphere; `None` if the sphere is too large, too near, or of a size that `f32`
    /// cannot hold.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    pub(crate) fn new(camera: &Camera, center: DVec3, radius: f64) -> Option<Self> {
        let is_perspective = camera.is_perspective();
        let spread = if is_perspective { center.z } else { 1.0 };
        let scale = spread * camera.pixel_size() / radius;
        let is_small = scale * RADIUS_PIXELS_MAX >= 1.0;
        let is_far = center.z >= DEPTH_RADII_MIN * radius;
        let nearest = nearest_depth(center.z, radius);
        if !(is_small && is_far && nearest > camera.near()) {
            return None;
        }
        let ray = center.truncate() / spread;
        let m = if is_perspective { ray } else { glam::DVec2::ZERO };
        let pixel = camera.pixel_of(ray);
        let depth = center.z as f32;
        let disc = Self {
            scale: scale as f32,
            column: pixel.x,
            row: pixel.y,
            mx: m.x as f32,
            my: m.y as f32,
            radius: radius as f32,
            depth,
            depth_rest: (center.z - f64::from(depth)) as f32,
            nearest: nearest as f32,
            doubt: doubt(m.length_squared(), radius / center.z) as f32,
            step: if is_perspective { camera.pixel_size() as f32 } else { 0.0 },
        };
        let is_held = disc.scale.is_normal() && disc.radius.is_normal() && disc.depth.is_normal();
        is_held.then_some(disc)
    }

    /// What all pixels of a row share.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    pub(crate) fn row(&self, camera: &Camera, row: f64) -> DiscRow {
        let y = if camera.is_perspective() { camera.ray(0.0, row).y } else { 0.0 };
        DiscRow { v: (self.row - row) as f32 * self.scale, y: y as f32 }
    }

    /// Draws eight pixels of a row, from `column` on, as far as that can be settled here.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    pub(crate) fn draw(
        &self,
        camera: &Camera,
        row: DiscRow,
        column: f64,
        target: &mut Target<'_>,
    ) -> Unsettled {
        let lanes = f32x8::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let old = f32x8::new(*target.depth);
        let may_win = old.simd_ge(f32x8::splat(self.nearest));
        if may_win.to_bitmask() == 0 {
            return Unsettled::default();
        }
        let x = if self.step == 0.0 { 0.0 } else { camera.ray(column, 0.0).x as f32 };
        let x = f32x8::splat(x) + lanes * f32x8::splat(self.step);
        let y = f32x8::splat(row.y);
        let u = (f32x8::splat((column - self.column) as f32) + lanes) * f32x8::splat(self.scale);
        let v = f32x8::splat(row.v);
        let e = f32x8::splat(self.mx) * v - f32x8::splat(self.my) * u;
        let a = f32x8::splat(1.0) + (x * x + y * y);
        let q = a - (u * u + v * v + e * e);
        let doubt = f32x8::splat(self.doubt);
        let covered = q.simd_ge(-doubt) & may_win;
        if covered.to_bitmask() == 0 {
            return Unsettled::default();
        }
        let reach = f32x8::splat(self.radius) * ((u * x + v * y) + q.sqrt()) / a;
        let depth = f32x8::splat(self.depth) - (reach - f32x8::splat(self.depth_rest));
        let doubts = covered & q.simd_lt(doubt);
        let wins = !doubts & covered & depth.simd_lt(old);
        *target.depth = wins.select(depth, old).to_array();
        *target.id = wins.select(u32x8::splat(target.new_id), u32x8::new(*target.id)).to_array();
        Unsettled {
            ties: (!doubts & covered & depth.simd_eq(old)).to_bitmask(),
            doubts: doubts.to_bitmask(),
        }
    }
}

/// The size of `q` below which a pixel is left to `f64`, for the slope of the centre's ray, squared,
/// and the radius in units of the depth. Over the disc, `a` is at most twice what it is there.
fn doubt(slope_squared: f64, radius_share: f64) -> f64 {
    let silhouette = 2.0 * 14.0 / 16_777_216.0 * (1.0 + slope_squared);
    (silhouette * (1.0 + slope_squared.sqrt())).max(12.0 * radius_share * radius_share)
}

/// Eight pixels of a picture.
#[derive(Debug)]
pub(crate) struct Target<'a> {
    pub(crate) depth: &'a mut [f32; LANES],
    pub(crate) id: &'a mut [u32; LANES],
    /// The record that is to be seen where it is nearer.
    pub(crate) new_id: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use puncta_core::View;

    /// The distance grows and the angle shrinks, so that the sphere stays five pixels wide: the
    /// silhouette and the depth must agree with `f64` all the way.
    #[test]
    fn distance_does_not_spoil_a_sphere() {
        for distance in [1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6] {
            let radius = 0.02;
            let fov_y = 2.0 * (radius * 100.0 / 2.5 / distance * 0.5_f64).atan();
            for (offset, roll) in [(0.0, 0.0), (0.3, 0.1), (-0.37, 0.77)] {
                let eye = DVec3::new(distance, offset, roll);
                let view = View::look_at(eye, DVec3::ZERO, DVec3::Z).unwrap();
                let view = view.with_size(100, 100).unwrap().with_perspective(fov_y).unwrap();
                let camera = Camera::new(&view, DVec3::ZERO);
                let at = DVec3::new(0.0, 0.1 * radius, -0.77 * radius);
                let center = camera.place(at);
                let disc = Disc::new(&camera, center, radius).expect("it is small and far");
                assert!(check(100, &camera, &disc, (center, radius)) > 10);
            }
        }
    }

    /// As large and as near as it gets, in many places: here the rim needs `f64`.
    #[test]
    fn the_largest_and_nearest_discs_are_exact_too() {
        for place in 0..60 {
            let (turn, radius) = (f64::from(place) * 0.7, 0.01 * 1.3_f64.powi(place));
            let distance = (DEPTH_RADII_MIN + 0.3) * radius;
            let eye = DVec3::new(distance, 0.0, 0.0);
            let fov_y = 2.0 * (50.0 / (63.0 * 16.0_f64)).atan();
            let view = View::look_at(eye, DVec3::ZERO, DVec3::Z).unwrap();
            let view = view.with_size(100, 100).unwrap().with_perspective(fov_y).unwrap();
            let camera = Camera::new(&view, DVec3::ZERO);
            let at = 0.2 * radius * DVec3::new(0.0, turn.cos() - 0.3, turn.sin());
            let center = camera.place(at);
            let disc = Disc::new(&camera, center, radius).expect("it is small and far enough");
            assert!(check(100, &camera, &disc, (center, radius)) > 1000);
        }
    }

    /// Discs in the corner of very wide views, where rays are most oblique.
    #[test]
    fn wide_views_are_exact_too() {
        for fov_y in [95.0, 120.0, 150.0, 170.0_f64].map(f64::to_radians) {
            let mut covered = 0;
            for place in 0..40 {
                let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
                let view = view.with_size(300, 300).unwrap().with_perspective(fov_y).unwrap();
                let camera = Camera::new(&view, DVec3::ZERO);
                let at = camera.ray(20.0 + 1.37 * f64::from(place), 280.0 - 5.9 * f64::from(place));
                let center = at.extend(1.0) * 3.0;
                let radius = center.z * camera.pixel_size() * 8.0;
                if let Some(disc) = Disc::new(&camera, center, radius) {
                    covered += check(300, &camera, &disc, (center, radius));
                }
                let radius = center.z / (DEPTH_RADII_MIN + 0.1);
                let disc = Disc::new(&camera, center, radius).expect("it is small and far enough");
                covered += check(300, &camera, &disc, (center, radius));
            }
            assert!(covered > 100, "{covered} pixels tell little");
        }
    }

    /// Compares a disc with `f64`; returns how many of its pixels `f32` settled.
    fn check(size: u32, camera: &Camera, disc: &Disc, (center, radius): (DVec3, f64)) -> usize {
        let mut covered = 0;
        for row in 0..size {
            let row_of_disc = disc.row(camera, f64::from(row));
            for column in (0..size - 7).step_by(LANES) {
                let (mut depth, mut id) = ([f32::INFINITY; LANES], [9; LANES]);
                let mut target = Target { depth: &mut depth, id: &mut id, new_id: 3 };
                let left = disc.draw(camera, row_of_disc, f64::from(column), &mut target);
                for lane in (0..LANES).filter(|lane| left.doubts >> lane & 1 == 0) {
                    let ray = camera.ray(f64::from(column) + lane as f64, f64::from(row));
                    let exact = camera.depth(ray, center, radius);
                    // What is not left to `f64` must be right without any hair.
                    assert_eq!(id[lane] == 3, exact.is_some());
                    if let (Some(exact), 3) = (exact, id[lane]) {
                        let error = (f64::from(depth[lane]) - exact).abs();
                        assert!(error <= exact * 2_f64.powi(-22), "{error} at {exact}");
                        covered += 1;
                    }
                }
            }
        }
        covered
    }
}
