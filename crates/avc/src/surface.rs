//! Surfaces: what is seen of one glyph, in `f64`.

use crate::{Cloud, Facet, Glyph, Lens, Level};
use glam::DVec3;

/// The facets of a glyph, as they are seen in a picture. It can be used for one glyph after the other.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    vertices: Vec<DVec3>,
    facets: Vec<Facet>,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The view depth.
    pub depth: f64,
    /// How much the surface faces the ray: the cosine of the angle between its normal and the ray's way
    /// back.
    pub facing: f64,
    /// The outward unit normal, in camera coordinates.
    pub normal: DVec3,
}

impl Surface {
    /// Makes it that of a record, at a level of detail.
    pub fn fill<G: Glyph>(
        &mut self,
        lens: &Lens<'_>,
        cloud: &Cloud<'_, G>,
        index: usize,
        level: Level,
    ) {
        self.vertices.clear();
        self.facets.clear();
        let position = cloud.get(index).position();
        let nearest = lens.nearest(level, cloud, index);
        let form = G::form(cloud, index, &lens.sight(position, nearest));
        let size = G::size(&form);
        if size.triangles == 0 {
            return;
        }
        let (camera, position) = (lens.camera, position.as_dvec3());
        let place = |vertex| camera.place(position + G::vertex(&form, vertex).as_dvec3());
        self.vertices.extend((0..size.vertices).map(place));
        for triangle in 0..size.triangles {
            let corners = G::triangle(&form, triangle).map(|vertex| {
                // A vertex that is not there draws nothing.
                self.vertices.get(vertex as usize).copied().unwrap_or(DVec3::NAN)
            });
            Facet::cut(camera, corners, |facet| self.facets.push(facet));
        }
    }

    /// The facets that are seen from in front.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The view depth of the nearest point where the ray of a pixel meets it.
    #[must_use]
    pub fn depth(&self, column: f64, row: f64) -> Option<f64> {
        self.facets.iter().filter_map(|facet| facet.depth(column, row)).reduce(f64::min)
    }

    /// The same for the ray of a pixel or, if that meets nothing, for those of the eight points around it
    /// at a distance of `hair` pixels.
    #[must_use]
    pub fn depth_around(&self, column: f64, row: f64, hair: f64) -> Option<f64> {
        let diagonal = hair * std::f64::consts::FRAC_1_SQRT_2;
        let straight = [(hair, 0.0), (-hair, 0.0), (0.0, hair), (0.0, -hair)];
        let across = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let around = straight.into_iter().chain(across.map(|(x, y)| (x * diagonal, y * diagonal)));
        let near = |(x, y): (f64, f64)| self.depth(column + x, row + y);
        self.depth(column, row).or_else(|| around.filter_map(near).reduce(f64::min))
    }

    /// The nearest point where the ray of a pixel meets it.
    #[must_use]
    pub fn meet(&self, lens: &Lens<'_>, column: f64, row: f64) -> Option<Meeting> {
        let meets = |facet: &Facet| facet.depth(column, row).map(|depth| (depth, facet.normal()));
        let nearest = self.facets.iter().filter_map(meets).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(depth, normal)| {
            let back = if lens.camera.is_perspective() {
                -lens.camera.ray(column, row).extend(1.0).normalize()
            } else {
                DVec3::NEG_Z
            };
            Meeting { depth, facing: normal.dot(back), normal }
        })
    }
}
