/*!
Rays and spheres in camera coordinates, in `f64`: the definition of what a picture shows.

Camera coordinates are right, up and forward, relative to the eye. The ray of a pixel is
`(x, y, 1) z` in perspective and `(x, y, z)` in an orthographic view, so that its parameter `z` is
the view depth. A sphere has centre `c` and radius `r`.

# Where a ray enters a sphere

*Perspective*, with `d = (x, y, 1)` and `a = d.d`. The squared distance between ray and centre, times
`a`, is `|c x d|²`; so the ray meets the sphere if `q = a r² - |c x d|² >= 0`. The roots of
`a z² - 2 z (c.d) + k = 0`, where `k = |c|² - r²`, are written without a difference of large numbers:

```text
z = k / (c.d + sqrt(q))       (the near root, for c.d > 0)
```

The eye is outside the sphere if `k > 0`; then both roots have the sign of `c.d`. If `k <= 0` the
sphere holds the eye and no ray enters it. *Orthographic*: `q = r² - (x - cx)² - (y - cy)²` and
`z = cz - sqrt(q)`.

The surface is seen if `z >= near`.

# The screen box of a sphere

After Mara and McGuire, *2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere*, JCGT
2(2), 2013. On each screen axis the silhouette is bounded by the two tangents from the eye to a
circle in the plane of that axis and the forward axis. With `t² = cx² + cz² - r²`, their slopes are
`(cx cz ± r t) / (cz² - r²)` while the sphere lies in front of the eye's plane. Only the one of larger
size is computed like that; the other follows from their product, `(cx² - r²) / (cz² - r²)`, so that
no difference of nearly equal numbers is taken. A tangent point in front of the near plane is replaced
by the point where the circle meets that plane.
*/

use crate::View;
use glam::{DVec2, DVec3};
use std::ops::RangeInclusive;

/// By how much screen boxes are grown: far more than rounding needs, far less than matters.
const SLACK_PIXELS: f64 = 1e-3;

/// The smallest view depth, in radii, of a ball that has an outline.
const OUTLINE_RADII_MIN: f64 = 4.0;

/// A view, ready to place spheres of a scene before it.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The origin of the scene, in camera coordinates.
    origin: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    is_perspective: bool,
    near: f64,
    /// The distance between neighboring rays, and the number of pixels per such unit.
    pixel: f64,
    per_pixel: f64,
    /// Half the number of columns and rows, less half a pixel: where the line of sight meets.
    middle: DVec2,
    width: u32,
    height: u32,
}

/// Where a ray enters a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The view depth.
    pub depth: f64,
    /// The outward unit normal, in camera coordinates.
    pub normal: DVec3,
    /// How much the surface faces the ray: the cosine of the angle between the normal and the ray's
    /// way back.
    pub facing: f64,
}

/// The columns and rows of the pixels that a sphere may cover. Empty ranges are possible.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenBox {
    /// The columns, from the left.
    pub columns: RangeInclusive<i64>,
    /// The rows, from the top.
    pub rows: RangeInclusive<i64>,
}

/// A view depth in front of which a sphere has no point, whether computed in `f64` or in `f32`, whose
/// rounding errors are a tenth of the margin.
#[must_use]
#[inline]
pub fn nearest_depth(center_depth: f64, radius: f64) -> f64 {
    center_depth - radius - 1e-6 * (center_depth.abs() + radius)
}

impl Camera {
    /// A camera for scenes with this origin.
    #[must_use]
    pub fn new(view: &View, origin: DVec3) -> Self {
        let size = DVec2::new(f64::from(view.width()), f64::from(view.height()));
        Self {
            origin: view.to_camera(origin - view.eye()),
            right: view.right(),
            up: view.up(),
            forward: view.forward(),
            is_perspective: view.is_perspective(),
            near: view.near(),
            pixel: view.pixel_size(),
            per_pixel: 1.0 / view.pixel_size(),
            middle: size * 0.5 - 0.5,
            width: view.width(),
            height: view.height(),
        }
    }

    /// The camera coordinates of a stored position.
    #[inline]
    #[must_use]
    pub fn place(&self, offset: DVec3) -> DVec3 {
        let along = |axis: DVec3| axis.dot(offset);
        self.origin + DVec3::new(along(self.right), along(self.up), along(self.forward))
    }

    /// The coordinates along right, up and forward of a difference of positions.
    #[must_use]
    pub fn turn(&self, offset: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(offset), self.up.dot(offset), self.forward.dot(offset))
    }

    /// The stored coordinates of the eye: the inverse of [`Camera::place`], of the origin.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        let DVec3 { x, y, z } = -self.origin;
        self.right * x + self.up * y + self.forward * z
    }

    /// The direction of the line of sight.
    #[must_use]
    pub const fn forward(&self) -> DVec3 {
        self.forward
    }

    /// The number of columns and rows.
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Where the ray of a pixel passes: camera x and y, at view depth 1 in perspective.
    #[inline]
    #[must_use]
    pub fn ray(&self, column: f64, row: f64) -> DVec2 {
        self.pixel * DVec2::new(column - self.middle.x, self.middle.y - row)
    }

    /// Where the ray through `ray` enters a sphere that is seen there (see the module's text).
    #[inline]
    #[must_use]
    pub fn hit(&self, ray: DVec2, center: DVec3, radius: f64) -> Option<Hit> {
        let depth = self.depth(ray, center, radius)?;
        let (point, back) = if self.is_perspective {
            let direction = ray.extend(1.0);
            (direction * depth, -direction / direction.length())
        } else {
            (ray.extend(depth), DVec3::NEG_Z)
        };
        let normal = (point - center) / radius;
        Some(Hit { depth, normal, facing: normal.dot(back) })
    }

    /// The view depth of [`Camera::hit`].
    #[inline]
    #[must_use]
    pub fn depth(&self, ray: DVec2, center: DVec3, radius: f64) -> Option<f64> {
        let depth = if self.is_perspective {
            let direction = ray.extend(1.0);
            let along = center.dot(direction);
            let length = center.length();
            let k = (length - radius) * (length + radius);
            let away = center.cross(direction).length_squared();
            let q = direction.length_squared() * (radius * radius) - away;
            // Written so that NaN is a miss.
            if !(q >= 0.0 && k > 0.0 && along > 0.0) {
                return None;
            }
            k / (along + q.sqrt())
        } else {
            let q = radius * radius - (ray - center.truncate()).length_squared();
            if !(q >= 0.0 && radius > 0.0) {
                return None;
            }
            center.z - q.sqrt()
        };
        (depth >= self.near).then_some(depth)
    }

    /// The pixels that a sphere may cover; `None` if it lies in front of the near plane.
    #[inline]
    #[must_use]
    pub fn screen_box(&self, center: DVec3, radius: f64) -> Option<ScreenBox> {
        // Written so that NaN is not drawn.
        if !(center.z + radius >= self.near && radius > 0.0) {
            return None;
        }
        let (x, y) = if !self.is_perspective {
            let extent = |c: f64| (c - radius, c + radius);
            (extent(center.x), extent(center.y))
        } else if center.z - radius > self.near {
            let t = (center.z - radius) * (center.z + radius);
            let slopes = |c: f64| {
                let c_abs = c.abs();
                let larger = c_abs * center.z + radius * (c * c + t).sqrt();
                let (low, high) = ((c_abs - radius) * (c_abs + radius) / larger, larger / t);
                if c < 0.0 { (-high, -low) } else { (low, high) }
            };
            (slopes(center.x), slopes(center.y))
        } else {
            (self.clipped(center.x, center.z, radius), self.clipped(center.y, center.z, radius))
        };
        let columns = (self.middle.x + x.0 * self.per_pixel, self.middle.x + x.1 * self.per_pixel);
        let rows = (self.middle.y - y.1 * self.per_pixel, self.middle.y - y.0 * self.per_pixel);
        Some(ScreenBox { columns: pixels(columns, self.width), rows: pixels(rows, self.height) })
    }

    /// Columns and rows, first and last, around the pixels of [`Self::screen_box`]: a little too many,
    /// but found quickly. `None` if they cannot be, which is rare.
    ///
    /// The bound is that of `bound.rs`, for one ball.
    #[inline]
    #[must_use]
    pub fn outline(&self, center: DVec3, radius: f64) -> Option<[[f64; 2]; 2]> {
        let spread = |middle: f64, pixels: f64| [middle - pixels, middle + pixels];
        if !self.is_perspective {
            let pixels = radius * self.per_pixel + SLACK_PIXELS;
            let at = self.pixel_of(center.truncate());
            return Some([spread(at.x, pixels), spread(at.y, pixels)]);
        }
        if !(center.z > OUTLINE_RADII_MIN * radius && center.z - radius > self.near) {
            return None;
        }
        let inverse = 1.0 / center.z;
        let (s, p) = (center.truncate() * inverse, radius * inverse);
        let stretch = 1.0 / (1.0 - OUTLINE_RADII_MIN.powi(-2));
        // `s` is stretched as well, by `stretch` at most; so is what is around it.
        let reach = (p * (1.0 + 0.5 * s * s)) * stretch + s.abs() * (p * p * stretch);
        let (at, pixels) = (self.pixel_of(s), reach * self.per_pixel + SLACK_PIXELS);
        Some([spread(at.x, pixels.x), spread(at.y, pixels.y)])
    }

    /// The slopes of the tangents to the part beyond the near plane of a circle that crosses it.
    fn clipped(&self, c: f64, z: f64, radius: f64) -> (f64, f64) {
        let squared = c * c + z * z;
        let t2 = squared - radius * radius;
        let (cos, sin) = (t2.max(0.0).sqrt() / squared.sqrt(), radius / squared.sqrt());
        let offset = z - self.near;
        let chord = ((radius - offset) * (radius + offset)).max(0.0).sqrt();
        let slope = |sign: f64| {
            let depth = cos * (cos * z - sign * sin * c);
            if t2 > 0.0 && depth >= self.near {
                cos * (cos * c + sign * sin * z) / depth
            } else {
                (c + sign * chord) / self.near
            }
        };
        (slope(-1.0), slope(1.0))
    }

    /// Whether rays start at one point.
    #[must_use]
    pub const fn is_perspective(&self) -> bool {
        self.is_perspective
    }

    /// The smallest view depth at which surfaces are seen.
    #[must_use]
    pub const fn near(&self) -> f64 {
        self.near
    }

    /// The distance between neighboring rays.
    #[must_use]
    pub const fn pixel_size(&self) -> f64 {
        self.pixel
    }

    /// The pixel coordinates where a ray passes.
    #[must_use]
    pub fn pixel_of(&self, ray: DVec2) -> DVec2 {
        DVec2::new(self.middle.x + ray.x * self.per_pixel, self.middle.y - ray.y * self.per_pixel)
    }
}

/// The pixels with centres between two coordinates, within a picture of `count` pixels.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "casts from f64 saturate, and NaN covers all")]
fn pixels((low, high): (f64, f64), count: u32) -> RangeInclusive<i64> {
    let last = f64::from(count) - 1.0;
    let first = (low - SLACK_PIXELS).ceil().max(0.0);
    let end = (high + SLACK_PIXELS).floor().min(last);
    first as i64..=end as i64
}
