/*!
Levels of detail: how many chords a circle needs so that nobody sees them.

A chord that spans the angle `t` of a circle of radius `R` pixels is off by `2 R sin²(t/4)`, which is
less than `R t² / 8`. So `n` chords around a full circle are off by less than `e` pixels if
`n² >= R pi² / (2 e)`; for small chords this is nearly the exact number. `R` is the radius in the units
of the data divided by the smallest view depth that the brick of the record has: all records of a brick
are drawn as finely as its nearest point needs. Off the middle of the picture a step across the line
of sight is longer, which the largest slope of a ray in the picture allows for.

# Why counts are the same on every machine

Whether `n` chords are enough is decided by `n² depth >= R sharpness`: two products of `f32`, which
all processors round alike. So levels of detail are those of the CPU on any GPU. What is left out because
it surely is not seen ([`Sight::may_see`]) need not be the same: it changes no picture.
*/

use glam::{DVec2, DVec3, Vec3, Vec4};
use puncta_core::Camera;

/// The most chords of a full circle: enough for a radius of 3.4 million pixels at a tolerance of one.
pub const CHORDS_MAX: u32 = 4096;

/// More than what rounding may have moved an eye by, relative to its distance: it is turned and
/// subtracted in `f32` on a GPU, with an error of some 10⁻⁷.
const EYE_ERROR: f32 = 4e-6;

/// What a transfer function knows of the view of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Where the eye is, relative to the position of the record, with a 1 as the last component; the
    /// direction to it and 0 if rays are parallel. It is not exact.
    pub eye: Vec4,
    /// The smallest view depth that the brick of the record may have; 1 if rays are parallel.
    pub nearest: f32,
    /// `pi² / 2`, divided by the tolerance and by what a pixel measures at view depth 1.
    pub sharpness: f32,
    /// What a pixel measures at view depth 1, or everywhere if rays are parallel.
    pub pixel: f32,
}

impl Sight {
    /// From everywhere, with about this many chords around a circle of radius 1. Nothing is left out.
    #[must_use]
    pub const fn everywhere(chords: f32) -> Self {
        Self { eye: Vec4::ZERO, nearest: 1.0, sharpness: chords * chords, pixel: 0.0 }
    }

    /// How many chords a full circle of this radius needs: a power of two, from 4 to [`CHORDS_MAX`].
    ///
    /// So the chords of a finer circle lie within those of a coarser one.
    #[must_use]
    #[inline]
    pub fn ring(&self, radius: f32) -> u32 {
        let wanted = radius * self.sharpness;
        let mut chords = 4;
        while chords < CHORDS_MAX && (chords * chords) as f32 * self.nearest < wanted {
            chords *= 2;
        }
        chords
    }

    /// How many chords a full circle of this radius needs, if they need not fit to others: 3, 4, 6,
    /// 8, 12, 16 and so on up to [`CHORDS_MAX`].
    #[must_use]
    #[inline]
    pub fn sides(&self, radius: f32) -> u32 {
        let wanted = radius * self.sharpness;
        let enough = |chords: u32| (chords * chords) as f32 * self.nearest >= wanted;
        let mut chords = 4;
        while chords < CHORDS_MAX && !enough(chords) {
            chords *= 2;
        }
        let fewer = chords / 4 * 3;
        if enough(fewer) { fewer } else { chords }
    }

    /// The faces of a box around the record's position that may be seen: bit `2 axis + side`, where
    /// side 1 is that of the larger coordinate.
    #[must_use]
    #[inline]
    pub fn faces(&self, half: Vec3) -> u32 {
        let mut faces = 0;
        for axis in 0..3 {
            let (eye, reach) = (self.eye[axis], half[axis]);
            faces |= u32::from(self.may_see(-eye, reach)) << (2 * axis);
            faces |= u32::from(self.may_see(eye, reach)) << (2 * axis + 1);
        }
        faces
    }

    /// Whether a face in the plane at `reach` along a direction may be seen, if the eye lies at `eye`
    /// along it. What is told to be hidden surely is, however the eye was rounded.
    #[must_use]
    #[inline]
    pub fn may_see(&self, eye: f32, reach: f32) -> bool {
        let size = self.eye.x.abs().max(self.eye.y.abs()).max(self.eye.z.abs());
        eye + EYE_ERROR * size >= reach * self.eye.w
    }
}

/// A camera, and how finely glyphs are drawn before it.
#[derive(Clone, Debug)]
pub struct Lens<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// See [`Sight::sharpness`].
    pub sharpness: f32,
    /// See [`Sight::pixel`].
    pub pixel: f32,
    eye: DVec3,
}

impl<'a> Lens<'a> {
    /// For a tolerance in pixels.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    pub fn new(camera: &'a Camera, tolerance: f32) -> Self {
        let pixel = camera.pixel_size();
        let tolerance = f64::from(tolerance.max(f32::MIN_POSITIVE));
        let stretch = if camera.is_perspective() {
            let [width, height] = camera.size().map(f64::from);
            (1.0 + (DVec2::new(width, height) * 0.5 * pixel).length_squared()).sqrt()
        } else {
            1.0
        };
        let square = std::f64::consts::PI * std::f64::consts::PI;
        let sharpness = square / 2.0 * stretch / (tolerance * pixel);
        Self {
            camera,
            sharpness: (sharpness as f32).next_up().min(f32::MAX),
            pixel: pixel as f32,
            eye: camera.eye(),
        }
    }

    /// What there is to know for a record at a stored position, in a brick that begins at a view depth.
    #[must_use]
    #[inline]
    pub fn sight(&self, position: Vec3, nearest: f32) -> Sight {
        let is_perspective = self.camera.is_perspective();
        let eye = if is_perspective {
            (self.eye - position.as_dvec3()).as_vec3().extend(1.0)
        } else {
            (-self.camera.forward()).as_vec3().extend(0.0)
        };
        let nearest = if is_perspective { nearest } else { 1.0 };
        Sight { eye, nearest, sharpness: self.sharpness, pixel: self.pixel }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use puncta_core::View;

    proptest! {
        /// The chords of a circle that is seen from straight ahead are off by no more than the
        /// tolerance, and there are not many more of them than are needed.
        #[test]
        fn chords_are_within_the_tolerance(
            radius in 1e-3_f32..1e4,
            depth in 1e-2_f32..1e6,
            tolerance in 0.05_f32..4.0,
        ) {
            let view = View::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y).unwrap();
            let view = view.with_size(640, 480).unwrap();
            let camera = Camera::new(&view, DVec3::ZERO);
            let lens = Lens::new(&camera, tolerance);
            let sight = lens.sight(Vec3::ZERO, depth);
            let pixels = f64::from(radius) / f64::from(depth) / camera.pixel_size();
            let error = |chords: u32| {
                2.0 * pixels * (std::f64::consts::PI / (2.0 * f64::from(chords))).sin().powi(2)
            };
            for (chords, least) in [(sight.ring(radius), 4), (sight.sides(radius), 3)] {
                prop_assert!(chords == CHORDS_MAX || error(chords) <= f64::from(tolerance));
                prop_assert!(chords == least || error(chords / 3) > 0.9 * f64::from(tolerance));
            }
        }
    }

    #[test]
    fn an_eye_outside_sees_at_most_three_faces_and_one_inside_none() {
        let mut sight = Sight::everywhere(1.0);
        assert_eq!(sight.faces(Vec3::ONE), 63);
        sight.eye = Vec4::new(5.0, -5.0, 5.0, 1.0);
        assert_eq!(sight.faces(Vec3::ONE), 0b10_01_10);
        sight.eye = Vec4::new(0.5, 0.0, 0.0, 1.0);
        assert_eq!(sight.faces(Vec3::ONE), 0);
        // Within a plane both answers are right, and the face is drawn.
        sight.eye = Vec4::new(1.0, 0.0, 0.0, 0.0);
        assert_eq!(sight.faces(Vec3::ONE), 0b11_11_10);
    }
}
