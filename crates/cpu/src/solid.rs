/*!
Solids: glyphs, drawn as the facets of their surfaces.

A record becomes geometry once for each band that it may lie in, and nothing of it is kept. Most
triangles of a large scene cover no centre of a pixel, or lie in another band; these are left out by
where their corners lie, before anything else is computed of them. Of the others, [`Facet`] says which
pixels they cover, and at which depth.
*/

use crate::{
    band::Band,
    disc::{LANES, Target},
    shape::{Brush, Shape},
};
use glam::{DVec2, DVec3};
use puncta_avc::{Cloud, DepthRow, Facet, Glyph, Glyphs, Lens, Level};
use puncta_core::{Camera, depth_below};

/// The largest side, in pixels, of a facet that is not looked at by tiles before it is drawn.
const LARGE: i64 = 16;

/// By how much balls are grown: far more than the rounding of what they hold.
const BALL_SLACK: f64 = 1e-5;

impl<G: Glyph> Shape<G> for Glyphs<G> {
    type Brush<'a> = GlyphBrush<'a, G>;

    fn brush<'a>(&'a self, camera: &'a Camera, records: &'a [G]) -> GlyphBrush<'a, G> {
        GlyphBrush {
            cloud: self.cloud(records),
            lens: Lens::new(camera, self.tolerance),
            corners: Vec::new(),
        }
    }
}

/// Draws glyphs.
#[derive(Debug)]
pub(crate) struct GlyphBrush<'a, G: Glyph> {
    cloud: Cloud<'a, G>,
    lens: Lens<'a>,
    /// The vertices of the record at hand.
    corners: Vec<Corner>,
}

/// A vertex, in camera coordinates and on the screen.
#[derive(Clone, Copy, Debug)]
struct Corner {
    place: DVec3,
    /// In pixels; NaN in front of the near plane.
    pixel: DVec2,
}

impl Corner {
    /// What no triangle can have.
    const NOTHING: Self = Self { place: DVec3::NAN, pixel: DVec2::NAN };

    /// The pixel is that of [`Facet`], bit by bit.
    #[inline]
    fn new(camera: &Camera, place: DVec3) -> Self {
        let spread = if camera.is_perspective() { place.z } else { 1.0 };
        let pixel = if place.z >= camera.near() {
            camera.pixel_of(place.truncate() / spread)
        } else {
            DVec2::NAN
        };
        Self { place, pixel }
    }
}

impl<G: Glyph> Brush for GlyphBrush<'_, G> {
    fn draw(&mut self, band: &mut Band<'_>, id: u32, level: Level) {
        let index = id as usize;
        let camera = self.lens.camera;
        let (center, radius) = G::ball(&self.cloud, index);
        let center = camera.place(center.as_dvec3());
        let radius = f64::from(radius) * (1.0 + BALL_SLACK);
        // Written so that NaN is not hidden here; the form knows what is drawn of it.
        if center.z + radius < camera.near() || band.is_hidden(center, radius) {
            return;
        }
        let position = self.cloud.get(index).position();
        let nearest = self.lens.nearest(level, &self.cloud, index);
        let form = G::form(&self.cloud, index, &self.lens.sight(position, nearest));
        let size = G::size(&form);
        if size.triangles == 0 {
            return;
        }
        let position = position.as_dvec3();
        let place = |vertex| camera.place(position + G::vertex(&form, vertex).as_dvec3());
        self.corners.clear();
        self.corners.extend((0..size.vertices).map(|vertex| Corner::new(camera, place(vertex))));
        for triangle in 0..size.triangles {
            // A vertex that is not there draws nothing.
            let corner = |vertex| self.corners.get(vertex as usize).copied();
            let corners = G::triangle(&form, triangle)
                .map(|vertex| corner(vertex).unwrap_or(Corner::NOTHING));
            if band.may_show(corners.map(|corner| corner.pixel)) {
                let places = corners.map(|corner| corner.place);
                Facet::cut(camera, places, |facet| band.draw_facet(&facet, id));
            }
        }
    }
}

impl Band<'_> {
    /// Whether a triangle may cover the centre of a pixel of this band, and may look to the front. One
    /// with a corner in front of the near plane, which is NaN, may.
    #[inline]
    fn may_show(&self, [a, b, c]: [DVec2; 3]) -> bool {
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let is_known = a.is_finite() && b.is_finite() && c.is_finite();
        let (first, last) = (self.first_row as f64, self.last_row() as f64);
        let width = f64::from(self.camera.size()[0]);
        let is_beside = !holds_whole(low.x.max(0.0), high.x.min(width - 1.0))
            || !holds_whole(low.y.max(first), high.y.min(last))
            // As a facet has it, where rows run downwards.
            || (b - a).perp_dot(c - a) >= 0.0;
        !(is_known && is_beside)
    }

    /// Draws a facet of a record.
    fn draw_facet(&mut self, facet: &Facet, id: u32) {
        let spans = facet.spans(self.camera.size());
        let [first, last] = spans.rows();
        let rows = [first.max(self.first_row), last.min(self.last_row())];
        let columns = spans.columns();
        if self.is_facet_hidden(facet, columns, rows) {
            return;
        }
        for row in rows[0]..=rows[1] {
            let span = spans.of(row as f64);
            if span[0] <= span[1]
                && self.draw_span(&facet.depth_of_row(row as f64), (row, span), id)
            {
                self.touch(span, row);
            }
        }
    }

    /// Whether a facet covers nothing of this band, or a large one lies behind what is there.
    #[inline]
    fn is_facet_hidden(&mut self, facet: &Facet, columns: [i64; 2], rows: [i64; 2]) -> bool {
        let sides = [columns[1] - columns[0], rows[1] - rows[0]];
        if sides[0] < 0 || sides[1] < 0 {
            return true;
        }
        (sides[0] > LARGE || sides[1] > LARGE)
            && self.hides(columns, rows, depth_below(facet.depths()[0]))
    }

    /// Draws the pixels of a row from the first to the last; whether any depth changed.
    #[inline]
    fn draw_span(
        &mut self,
        depths: &DepthRow,
        (row, [first, last]): (i64, [i64; 2]),
        id: u32,
    ) -> bool {
        let mut has_changed = false;
        for column in (first..=last).step_by(LANES) {
            has_changed |= self.draw_lanes(depths, (row, column), (last + 1 - column, id));
        }
        has_changed
    }

    /// Draws up to eight pixels; whether any depth changed.
    #[inline]
    fn draw_lanes(
        &mut self,
        depths: &DepthRow,
        (row, column): (i64, i64),
        (count, id): (i64, u32),
    ) -> bool {
        let Some(Target { depth: old, id: ids, .. }) = self.target(row, column, id) else {
            return false;
        };
        let from = column as f64;
        let at = |lane: usize| rounded(depths.at(from + lane as f64));
        let new: [f32; LANES] =
            std::array::from_fn(
                |lane| if (lane as i64) < count { at(lane) } else { f32::INFINITY },
            );
        let (mut has_changed, mut is_tie) = (false, false);
        for lane in 0..LANES {
            let is_nearer = new[lane] < old[lane];
            is_tie |= (new[lane] == old[lane]) & (ids[lane] != id) & (new[lane] < f32::INFINITY);
            has_changed |= is_nearer;
            old[lane] = if is_nearer { new[lane] } else { old[lane] };
            ids[lane] = if is_nearer { id } else { ids[lane] };
        }
        if is_tie {
            // What has just been drawn has this id already, and stays as it is.
            for (lane, depth) in (0_i64..).zip(new) {
                let pixel = self.pixel(row, column + lane);
                if depth == self.depth[pixel] && depth.is_finite() {
                    self.break_tie((row, column + lane), id);
                }
            }
        }
        has_changed
    }
}

/// Whether there is a whole number between two that are not negative.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "casts saturate")]
fn holds_whole(low: f64, high: f64) -> bool {
    // Cutting off digits is rounding down.
    let last = (high as i64) as f64;
    last >= low && high >= low
}

/// A depth as pictures have it.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn rounded(depth: f64) -> f32 {
    depth as f32
}
