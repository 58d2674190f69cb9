/*!
Views: where the camera is, where it looks, and how the picture is made of rays.

The camera stands at `eye` (world coordinates, `f64`) and has three orthonormal axes, *right*, *up*
and *forward*. [`View::to_camera`] turns an offset from the eye into coordinates along these axes;
the third is the view depth. Everything that a renderer does in `f32` starts from there, so the
distance of a scene from the world's origin costs no accuracy.

The ray of the pixel in column `c` and row `r` passes, at view depth 1 (perspective) or at every
view depth (orthographic), through the point

```text
x = s (c + 1/2 - width/2)      y = s (height/2 - r - 1/2)      s = pixel_size()
```

in camera coordinates, where `s` is `2 tan(fov_y / 2) / height` or, for an orthographic view, the
height of the picture in world units divided by the number of rows.
*/

mod framing;

use crate::Error;
use glam::{DQuat, DVec2, DVec3};

/// The largest number of rows or columns of a picture.
pub const MAX_SIDE: u32 = 16_384;

/// The share of the distance to the target at which the near plane lies by default.
const NEAR_SHARE: f64 = 1e-9;

/// How rays spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// The angle between the lower and the upper edge of the picture, in radians.
        fov_y: f64,
    },
    /// All rays are parallel to the forward axis.
    Orthographic {
        /// The height of the picture in world units.
        height: f64,
    },
}

/// A camera and the size of its picture.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use puncta_core::View;
///
/// let view = View::look_at(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO, DVec3::Z)?
///     .with_size(640, 480)?
///     .with_perspective(60_f64.to_radians())?;
/// assert_eq!(view.to_camera(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, 3.0, 2.0));
/// # Ok::<(), puncta_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    projection: Projection,
    width: u32,
    height: u32,
    near: f64,
}

impl View {
    /// A view from `eye` to `target`, with `up` pointing up in the picture.
    ///
    /// It starts as a perspective view of 45 degrees and 1024 x 1024 pixels, with the near plane at
    /// a billionth of the distance to the target.
    ///
    /// # Errors
    ///
    /// [`Error::DegenerateView`] when the points are not finite, coincide, or when `up` lies along
    /// the line of sight.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Result<Self, Error> {
        let degenerate = |reason| Error::DegenerateView { eye, target, up, reason };
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(degenerate("a coordinate is not finite"));
        }
        let sight = target - eye;
        if !sight.is_finite() {
            return Err(degenerate("their distance is too small or too large for a number"));
        }
        let forward = direction(sight).ok_or_else(|| degenerate("the eye is at the target"))?;
        let up_unit = direction(up).ok_or_else(|| degenerate("up has no length"))?;
        // Below this sine of the angle between them, up says too little about left and right.
        let right = forward.cross(up_unit);
        if right.length() < 1e-9 {
            return Err(degenerate("up lies along the line of sight"));
        }
        let distance = length(sight);
        if !distance.is_normal() {
            return Err(degenerate("their distance is too small or too large for a number"));
        }
        let right = right / right.length();
        Ok(Self {
            eye,
            right,
            up: right.cross(forward),
            forward,
            projection: Projection::Perspective { fov_y: 45_f64.to_radians() },
            width: 1024,
            height: 1024,
            near: (distance * NEAR_SHARE).max(f64::MIN_POSITIVE),
        })
    }

    /// The same view with another number of columns and rows.
    ///
    /// # Errors
    ///
    /// [`Error::PictureSize`] when a side is zero or above [`MAX_SIDE`].
    pub fn with_size(self, width: u32, height: u32) -> Result<Self, Error> {
        if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(Error::PictureSize { width, height });
        }
        Ok(Self { width, height, ..self })
    }

    /// The same view in perspective, with a vertical angle of `fov_y` radians.
    ///
    /// # Errors
    ///
    /// [`Error::ViewSetting`] when the angle is not between 0 and pi.
    pub fn with_perspective(self, fov_y: f64) -> Result<Self, Error> {
        let range = "between 0 and 180 degrees (in radians)";
        if !(fov_y > 0.0 && fov_y < std::f64::consts::PI && (fov_y * 0.5).tan().is_normal()) {
            return Err(Error::ViewSetting { name: "fov_y", range, value: fov_y });
        }
        Ok(Self { projection: Projection::Perspective { fov_y }, ..self })
    }

    /// The same view with parallel rays, `height` world units high.
    ///
    /// # Errors
    ///
    /// [`Error::ViewSetting`] when the height is not positive and finite.
    pub fn with_orthographic(self, height: f64) -> Result<Self, Error> {
        if !(height > 0.0 && height.is_normal()) {
            let range = "positive and finite";
            return Err(Error::ViewSetting { name: "orthographic height", range, value: height });
        }
        Ok(Self { projection: Projection::Orthographic { height }, ..self })
    }

    /// The same view with another near plane: surfaces at a smaller view depth are not seen.
    ///
    /// # Errors
    ///
    /// [`Error::ViewSetting`] when the depth is not positive and finite.
    pub fn with_near(self, near: f64) -> Result<Self, Error> {
        if !(near > 0.0 && near.is_normal()) {
            let range = "positive and finite";
            return Err(Error::ViewSetting { name: "near", range, value: near });
        }
        Ok(Self { near, ..self })
    }

    /// The view from an eye that was turned around `pivot`: by `yaw` radians around the up axis
    /// (to the right), then by `pitch` around the right axis (upwards). Nothing changes if a number is
    /// not finite.
    #[must_use]
    pub fn orbited(self, pivot: DVec3, yaw: f64, pitch: f64) -> Self {
        let turn = DQuat::from_axis_angle(self.up, yaw);
        let lift = DQuat::from_axis_angle(turn * self.right, -pitch);
        let rotation = lift * turn;
        let forward = (rotation * self.forward).normalize_or(self.forward);
        let right = forward.cross(rotation * self.up).normalize_or(self.right);
        let eye = pivot + rotation * (self.eye - pivot);
        if !(eye.is_finite() && right.is_finite() && forward.is_finite()) {
            return self;
        }
        Self { eye, right, up: right.cross(forward), forward, ..self }
    }

    /// The place of the camera.
    #[must_use]
    pub const fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The unit vector to the right of the picture.
    #[must_use]
    pub const fn right(&self) -> DVec3 {
        self.right
    }

    /// The unit vector to the top of the picture.
    #[must_use]
    pub const fn up(&self) -> DVec3 {
        self.up
    }

    /// The unit vector along the line of sight.
    #[must_use]
    pub const fn forward(&self) -> DVec3 {
        self.forward
    }

    /// How rays spread.
    #[must_use]
    pub const fn projection(&self) -> Projection {
        self.projection
    }

    /// The number of columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// The smallest view depth at which surfaces are seen.
    #[must_use]
    pub const fn near(&self) -> f64 {
        self.near
    }

    /// Whether all rays start at the eye.
    #[must_use]
    pub const fn is_perspective(&self) -> bool {
        matches!(self.projection, Projection::Perspective { .. })
    }

    /// The distance between neighboring rays: at view depth 1 in perspective, else in world units.
    #[must_use]
    pub fn pixel_size(&self) -> f64 {
        let height = match self.projection {
            Projection::Perspective { fov_y } => 2.0 * (fov_y * 0.5).tan(),
            Projection::Orthographic { height } => height,
        };
        height / f64::from(self.height)
    }

    /// Where the ray of a pixel passes (see the module's text): camera x and y.
    ///
    /// The pixel's centre has whole coordinates here: `(0, 0)` is the one at the top left.
    #[must_use]
    pub fn ray(&self, column: f64, row: f64) -> DVec2 {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        self.pixel_size() * DVec2::new(column + 0.5 - width * 0.5, height * 0.5 - row - 0.5)
    }

    /// The coordinates along right, up and forward of an offset from the eye.
    #[must_use]
    #[inline]
    pub fn to_camera(&self, offset: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(offset), self.up.dot(offset), self.forward.dot(offset))
    }
}

/// The length of a vector, even if the squares of its coordinates are no numbers.
fn length(vector: DVec3) -> f64 {
    let largest = vector.abs().max_element();
    largest * (vector / largest).length()
}

/// The unit vector along `vector`, however long or short it is; `None` if it has no length.
fn direction(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    (largest > 0.0 && largest.is_finite()).then(|| {
        let scaled = vector / largest;
        scaled / scaled.length()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bounds;

    fn front() -> View {
        View::look_at(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, DVec3::Y).unwrap()
    }

    #[test]
    fn degenerate_views_are_refused() {
        let at = |eye, target, up| View::look_at(eye, target, up).is_err();
        assert!(at(DVec3::ONE, DVec3::ONE, DVec3::Y));
        assert!(at(DVec3::ONE, DVec3::ZERO, DVec3::ZERO));
        assert!(at(DVec3::Y, DVec3::ZERO, DVec3::NEG_Y));
        assert!(at(DVec3::splat(1e308), DVec3::splat(-1e308), DVec3::Y));
        let far = Bounds { min: DVec3::splat(-1.7e308), max: DVec3::splat(1.7e308) };
        assert_eq!(front().fitted(&far), front());
        assert_eq!(front().orbited(DVec3::ZERO, f64::NAN, 0.0), front());
        assert!(at(DVec3::NAN, DVec3::ZERO, DVec3::Y));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, std::f64::consts::PI] {
            assert!(front().with_perspective(wrong).is_err(), "{wrong}");
        }
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(front().with_orthographic(wrong).is_err(), "{wrong}");
            assert!(front().with_near(wrong).is_err(), "{wrong}");
        }
        assert!(front().with_size(0, 1).is_err());
    }

    #[test]
    fn tiny_and_huge_lines_of_sight_have_a_direction() {
        for scale in [1e-200, 1e200] {
            let view = View::look_at(DVec3::Z * scale, DVec3::ZERO, DVec3::Y * scale).unwrap();
            assert_eq!(view.forward(), DVec3::NEG_Z);
            assert_eq!(view.right(), DVec3::X);
            assert!(view.near().is_normal());
        }
    }

    #[test]
    fn pixels_lie_around_the_middle() {
        let view = front().with_size(4, 2).unwrap().with_orthographic(2.0).unwrap();
        assert_eq!(view.ray(0.0, 0.0), DVec2::new(-1.5, 0.5));
        assert_eq!(view.ray(3.0, 1.0), DVec2::new(1.5, -0.5));
    }

    #[test]
    fn an_orbit_keeps_the_pivot_in_place() {
        let pivot = DVec3::new(1.0, -2.0, 3.0);
        let view = front();
        let before = view.to_camera(pivot - view.eye());
        let turned = view.orbited(pivot, 1.0, -0.7);
        let after = turned.to_camera(pivot - turned.eye());
        assert!((before - after).length() < 1e-12);
        assert!(turned.right().dot(turned.up()).abs() < 1e-15);
        // To the right: the eye moves along the right axis, so the pivot's other side shows.
        assert!(front().orbited(DVec3::ZERO, 0.1, 0.0).eye().x > 0.0);
        assert!(front().orbited(DVec3::ZERO, 0.0, 0.1).eye().y > 0.0);
    }
}
