/*!
Runs: the records of a brick, relative to a point that is known exactly.

`f32` has 24 bits. Where a sphere is seen must be known to a thousandth of a pixel, so what is
reckoned in `f32` must not be larger than some hundred pixels. Therefore each brick has a point of
reference, the middle of its box. The CPU brings it before the camera in `f64` and says at which pixel
it is seen, as a whole number and a fraction; the GPU places records relative to it. This is the
projection-centred form for a whole brick, and it holds at any distance, angle and origin.

# How exact it is

In units of 2⁻²⁴, an offset turned into camera coordinates is off by 3 of its length, and what becomes
of it in pixels by about 6 more. For a brick that reaches [`EXTENT_PIXELS_MAX`] pixels from its
reference that is 2.8e-4 pixels. The silhouette of a disc is off by 10 units of its radius: for
[`RADIUS_PIXELS_MAX`] pixels, 3e-4. Together this is less than the thousandth that is promised.

Bricks that are larger or nearer than that are *close*. They are few: those around the camera. Each of
their records gets a run of its own, so that nothing is left to be placed, and spheres that are too
large or too near for `f32` are drawn by the CPU (`exact.rs`).
*/

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};
use puncta_core::{Brick, Camera, ScreenBound};

/// How far records may lie from the reference of their run, in pixels.
const EXTENT_PIXELS_MAX: f64 = 512.0;

/// The largest radius, in pixels, of a sphere that is drawn in `f32`.
const RADIUS_PIXELS_MAX: f64 = 512.0;

/// The smallest view depth, in radii, of a sphere that is drawn in `f32`.
const DEPTH_RADII_MIN: f64 = 2.0;

/// Sizes that `f32` holds with room to multiply a few of them.
const SIZES: [f64; 2] = [1e-30, 1e30];

/// `Run` of `place.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Run {
    reference: [f32; 3],
    nearest: f32,
    center: [f32; 3],
    brick: u32,
    slope: [f32; 2],
    whole: [i32; 2],
    fraction: [f32; 2],
    columns: u32,
    rows: u32,
}

impl Run {
    /// The run of what lies around a reference, which is given as stored and in camera coordinates.
    pub(crate) fn new(
        camera: &Camera,
        (reference, center): (Vec3, DVec3),
        bound: &ScreenBound,
        brick: u32,
    ) -> Self {
        let slope =
            if camera.is_perspective() { center.truncate() / center.z } else { DVec2::ZERO };
        let pixel =
            camera.pixel_of(if camera.is_perspective() { slope } else { center.truncate() });
        let whole = pixel.floor();
        let halves = |[first, last]: [u16; 2]| u32::from(first) | u32::from(last) << 16;
        Self {
            reference: reference.to_array(),
            nearest: bound.nearest,
            center: center.as_vec3().to_array(),
            brick,
            slope: slope.as_vec2().to_array(),
            whole: whole.as_ivec2().to_array(),
            fraction: (pixel - whole).as_vec2().to_array(),
            columns: halves(bound.columns),
            rows: halves(bound.rows),
        }
    }

    /// How many pixels it may cover.
    pub(crate) fn pixels(&self) -> u64 {
        let side = |halves: u32| u64::from((halves >> 16).saturating_sub(halves & 0xffff)) + 1;
        side(self.columns) * side(self.rows)
    }

    /// The run of a brick.
    pub(crate) fn of_brick(
        camera: &Camera,
        (index, brick): (u32, &Brick),
        bound: &ScreenBound,
    ) -> Self {
        let reference = middle(brick);
        Self::new(camera, (reference, camera.place(reference.as_dvec3())), bound, index)
    }
}

fn middle(brick: &Brick) -> Vec3 {
    brick.bounds.min * 0.5 + brick.bounds.max * 0.5
}

/// Whether the GPU can draw all of a brick relative to its reference.
pub(crate) fn is_plain(camera: &Camera, brick: &Brick) -> bool {
    let reference = middle(brick);
    // The middle is rounded, and may be nearer to one side than to the other.
    let reach = |corner: Vec3| (corner.as_dvec3() - reference.as_dvec3()).abs();
    let extent = reach(brick.bounds.min).max(reach(brick.bounds.max)).length();
    is_drawable(camera, camera.place(reference.as_dvec3()), (extent, brick.radius_max.into()))
}

/// Whether the GPU can draw a sphere at this place.
pub(crate) fn is_plain_sphere(camera: &Camera, center: DVec3, radius: f64) -> bool {
    is_drawable(camera, center, (0.0, radius))
}

fn is_drawable(camera: &Camera, center: DVec3, (extent, radius): (f64, f64)) -> bool {
    let front = center.z - extent;
    let aside = center.truncate().abs() + extent;
    let is_perspective = camera.is_perspective();
    let spread = if is_perspective { front } else { 1.0 };
    // A pixel of an oblique ray is that much smaller than one in the middle.
    let oblique = if is_perspective { 1.0 + (aside / front).length_squared() } else { 1.0 };
    let pixel = spread * camera.pixel_size();
    let pixels = oblique / pixel;
    front >= DEPTH_RADII_MIN * radius
        && front - radius > camera.near() * (1.0 + 1e-5)
        && extent * pixels <= EXTENT_PIXELS_MAX
        && radius * pixels <= RADIUS_PIXELS_MAX
        && front >= SIZES[0]
        && center.length() <= SIZES[1]
        && (radius == 0.0 || radius >= SIZES[0])
        && [camera.pixel_size(), pixel].iter().all(|size| (SIZES[0]..=SIZES[1]).contains(size))
}

#[cfg(test)]
mod tests;
