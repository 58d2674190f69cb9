/*!
Facets: triangles before a camera, in `f64`, and what the ray of a pixel meets of them.

A pixel shows a facet if the ray through its centre meets the triangle, edges included, from in front.
That an edge belongs to both of its triangles leaves no gap between them; where both are met, depth and
id decide as always. So that rounding opens no gap either, the side of an edge on which a pixel lies is
computed from the same numbers for both: corners relative to the pixel.

Depths come from the plane of the triangle, relative to its first corner. In perspective the inverse
depth is linear over the picture: with the normal `N`, the corner `c` and the ray `d` it is
`(N.d) / (N.c)`.
*/

use crate::Spans;
use glam::{DVec2, DVec3};
use puncta_core::Camera;

/// A triangle, or what the near plane leaves of it, as it is seen in a picture.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// The corners in pixel coordinates; what is inside lies at the left of each edge if rows run
    /// upwards, at the right in a picture.
    corners: [DVec2; 3],
    /// The inverse depth (the depth if rays are parallel) at the first corner, and per pixel.
    base: f64,
    slope: DVec2,
    /// The smallest and the largest depth of the corners.
    depths: [f64; 2],
    near: f64,
    is_perspective: bool,
    /// The outward normal, not of length 1, in camera coordinates.
    normal: DVec3,
}

/// Whether a pixel lies inside of a triangle, or on its edge.
///
/// The side of an edge is a difference of two products, which are the same two for the edge from `b` to
/// `a`: so it is exactly the opposite number there.
#[inline]
pub(crate) fn covers(corners: &[DVec2; 3], column: f64, row: f64) -> bool {
    let pixel = DVec2::new(column, row);
    let [a, b, c] = corners.map(|corner| corner - pixel);
    (a.perp_dot(b) >= 0.0) & (b.perp_dot(c) >= 0.0) & (c.perp_dot(a) >= 0.0)
}

impl Facet {
    /// The facets of a triangle whose corners are given in camera coordinates, counterclockwise from
    /// outside: none if it is not seen from in front, two if the near plane cuts off one corner.
    pub fn cut(camera: &Camera, corners: [DVec3; 3], mut emit: impl FnMut(Self)) {
        let near = camera.near();
        let is_beyond = corners.map(|corner| corner.z >= near);
        if is_beyond == [true; 3] {
            if let Some(facet) = Self::new(camera, corners, corners) {
                emit(facet);
            }
        } else if is_beyond != [false; 3] {
            let mut polygon = [DVec3::ZERO; 4];
            let mut count = 0;
            let mut push = |point: DVec3| {
                polygon[count & 3] = point;
                count += 1;
            };
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % 3];
                if a.z >= near {
                    push(a);
                }
                if (a.z >= near) != (b.z >= near) {
                    push(crossing(a, b, near));
                }
            }
            for i in 1..count.min(4) - 1 {
                let part = [polygon[0], polygon[i], polygon[i + 1]];
                if let Some(facet) = Self::new(camera, corners, part) {
                    emit(facet);
                }
            }
        }
    }

    /// The facet of a part, beyond the near plane, of a triangle.
    fn new(camera: &Camera, triangle: [DVec3; 3], part: [DVec3; 3]) -> Option<Self> {
        let is_perspective = camera.is_perspective();
        let spread = |corner: DVec3| if is_perspective { corner.z } else { 1.0 };
        let corners = part.map(|corner| camera.pixel_of(corner.truncate() / spread(corner)));
        // In a picture, where rows run downwards, what is counterclockwise turns the other way round.
        let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
        // Written so that NaN is not drawn.
        if !(area < 0.0 && area.is_finite()) {
            return None;
        }
        // Camera coordinates are left-handed, so this points outwards when it is turned around.
        let normal = (triangle[2] - triangle[0]).cross(triangle[1] - triangle[0]);
        let first = part[0];
        let pixel = camera.pixel_size();
        let (base, slope) = if is_perspective {
            (1.0 / first.z, normal.truncate() * (pixel / normal.dot(first)))
        } else {
            (first.z, -normal.truncate() * (pixel / normal.z))
        };
        let depths = part.map(|corner| corner.z);
        Some(Self {
            corners: [corners[0], corners[2], corners[1]],
            base,
            slope: DVec2::new(slope.x, -slope.y),
            depths: [
                depths.into_iter().fold(f64::INFINITY, f64::min),
                depths.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ],
            near: camera.near(),
            is_perspective,
            normal,
        })
    }

    /// The view depth at which the ray of a pixel meets it.
    #[must_use]
    #[inline]
    pub fn depth(&self, column: f64, row: f64) -> Option<f64> {
        self.covers(column, row).then(|| self.depth_of_row(row).at(column))
    }

    /// Whether the ray of a pixel meets it.
    #[must_use]
    #[inline]
    pub fn covers(&self, column: f64, row: f64) -> bool {
        covers(&self.corners, column, row)
    }

    /// What the depths of a row need.
    #[must_use]
    #[inline]
    pub fn depth_of_row(&self, row: f64) -> DepthRow {
        DepthRow {
            base: self.base + self.slope.y * (row - self.corners[0].y),
            slope: self.slope.x,
            from: self.corners[0].x,
            depths: [self.depths[0].max(self.near), self.depths[1].max(self.near)],
            is_perspective: self.is_perspective,
        }
    }

    /// The smallest and the largest view depth.
    #[must_use]
    pub const fn depths(&self) -> [f64; 2] {
        self.depths
    }

    /// The outward unit normal, in camera coordinates.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal.normalize_or_zero()
    }

    /// The pixels that it covers in a picture of so many columns and rows.
    #[must_use]
    #[inline]
    pub fn spans(&self, size: [u32; 2]) -> Spans {
        Spans::new(self.corners, size)
    }

    /// The rows that it may cover, first and last, in a picture of `height` rows. Empty if the first
    /// is larger.
    #[must_use]
    #[inline]
    pub fn rows(&self, height: u32) -> [i64; 2] {
        self.spans([1, height]).rows()
    }

    /// The columns that it may cover.
    #[must_use]
    #[inline]
    pub fn columns(&self, width: u32) -> [i64; 2] {
        self.spans([width, 1]).columns()
    }

    /// The columns that it covers in a row, first and last. Empty if the first is larger.
    #[must_use]
    #[inline]
    pub fn span(&self, row: f64, width: u32) -> [i64; 2] {
        self.spans([width, 1]).of(row)
    }
}

/// Where the edge from `a` to `b` meets the near plane: the same point for that from `b` to `a`.
fn crossing(a: DVec3, b: DVec3, near: f64) -> DVec3 {
    let (a, b) = if a.z < b.z { (a, b) } else { (b, a) };
    let share = (near - a.z) / (b.z - a.z);
    (a + (b - a) * share).truncate().extend(near)
}

/// The depths of a row of a facet.
#[derive(Clone, Copy, Debug)]
pub struct DepthRow {
    base: f64,
    slope: f64,
    from: f64,
    depths: [f64; 2],
    is_perspective: bool,
}

impl DepthRow {
    /// The view depth at a column.
    #[must_use]
    #[inline]
    pub fn at(&self, column: f64) -> f64 {
        let linear = self.base + self.slope * (column - self.from);
        let depth = if self.is_perspective { 1.0 / linear } else { linear };
        // Of a facet that is seen edge-on, the plane says nothing; nor does NaN, which becomes the farthest.
        depth.min(self.depths[1]).max(self.depths[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use puncta_core::View;

    fn camera(is_perspective: bool, near: f64) -> Camera {
        let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
        let view = view.with_size(40, 30).unwrap().with_near(near).unwrap();
        let view = if is_perspective { view } else { view.with_orthographic(6.0).unwrap() };
        Camera::new(&view, DVec3::ZERO)
    }

    fn facets(camera: &Camera, corners: [DVec3; 3]) -> Vec<Facet> {
        let mut facets = Vec::new();
        Facet::cut(camera, corners, |facet| facets.push(facet));
        facets
    }

    /// Where a ray meets a triangle, by Cramer's rule, and how far that is from hanging on a hair.
    fn meet(camera: &Camera, [a, b, c]: [DVec3; 3], [column, row]: [f64; 2]) -> (f64, f64) {
        let ray = camera.ray(column, row);
        let (start, direction) = if camera.is_perspective() {
            (DVec3::ZERO, ray.extend(1.0))
        } else {
            (ray.extend(0.0), DVec3::Z)
        };
        let (u, v, from) = (b - a, c - a, start - a);
        let determinant = direction.dot(u.cross(v));
        let s = direction.dot(from.cross(v)) / determinant;
        let t = direction.dot(u.cross(from)) / determinant;
        let depth = -from.dot(u.cross(v)) / determinant;
        // Camera coordinates are left-handed, so entries have a positive determinant.
        let inside = s.min(t).min(1.0 - s - t).min(depth - camera.near());
        (depth, if determinant > 0.0 { inside } else { -1.0 })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        /// Facets say what a ray meets of a triangle, and spans what each pixel says.
        #[test]
        fn facets_are_what_rays_meet(
            is_perspective in any::<bool>(),
            near in prop_oneof![Just(1e-3), Just(1.0)],
            corners in [[-3.0..3.0, -3.0..3.0, -1.0..6.0], [-3.0..3.0, -3.0..3.0, -1.0..6.0],
                [-3.0..3.0, -3.0..3.0, -1.0..6.0_f64]],
        ) {
            let camera = camera(is_perspective, near);
            let corners = corners.map(DVec3::from);
            let facets = facets(&camera, corners);
            for row in 0..30_u8 {
                let spans: Vec<[i64; 2]> = facets.iter().map(|f| f.span(row.into(), 40)).collect();
                for column in 0..40_u8 {
                    let at = [f64::from(column), f64::from(row)];
                    let found = facets.iter().find_map(|facet| facet.depth(at[0], at[1]));
                    for (facet, span) in facets.iter().zip(&spans) {
                        let is_in = span[0] <= column.into() && i64::from(column) <= span[1];
                        prop_assert_eq!(facet.covers(at[0], at[1]), is_in);
                    }
                    let (depth, inside) = meet(&camera, corners, at);
                    if inside.abs() > 1e-9 {
                        prop_assert_eq!(found.is_some(), inside > 0.0, "{:?} {}", at, inside);
                    }
                    if let Some(found) = found.filter(|_| inside > 1e-6) {
                        prop_assert!((found - depth).abs() <= 1e-9 * depth, "{} {}", found, depth);
                    }
                }
            }
        }

        /// Whatever lies between two triangles that share an edge belongs to one of them.
        #[test]
        fn there_is_no_gap_along_an_edge(
            corners in [[-3.0..3.0, -3.0..3.0, 0.5..6.0], [-3.0..3.0, -3.0..3.0, 0.5..6.0],
                [-3.0..3.0, -3.0..3.0, 0.5..6.0_f64]],
            share in 0.0..1.0_f64,
        ) {
            let camera = camera(true, 1e-3);
            let [a, b, c] = corners.map(DVec3::from);
            let middle = a + (b - a) * share;
            let whole = facets(&camera, [a, b, c]);
            let mut parts = facets(&camera, [a, middle, c]);
            parts.extend(facets(&camera, [middle, b, c]));
            for (row, column) in (0..30_u8).flat_map(|row| (0..40_u8).map(move |column| (row, column))) {
                let (x, y) = (f64::from(column), f64::from(row));
                let is_deep = |facet: &Facet| {
                    let corners = facet.corners.map(|corner| corner - DVec2::new(x, y));
                    (0..3).all(|i| {
                        let (a, b) = (corners[i], corners[(i + 1) % 3]);
                        a.perp_dot(b) > 1e-9 * (1.0 + (b - a).length())
                    })
                };
                if whole.iter().any(is_deep) {
                    prop_assert!(parts.iter().any(|facet| facet.covers(x, y)), "{} {}", x, y);
                }
            }
        }
    }
}
