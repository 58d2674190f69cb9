/*!
Extruded polygons: a record of 32 bytes each, and corners in a table that all share.

A polygon may be concave and have holes. Its words in the table are

* for each corner, ring after ring, x and y relative to the position: two words;
* for each hole, the number of its first corner: one word;
* the triangles of its roof: if there are at most 1024 corners, one word each with three corners of ten
  bits, the first one lowest; otherwise two words with three corners of 21 bits.

There are `corners + 2 rings - 4` triangles. So a polygon of n corners without holes takes `12 n - 8` bytes
of the table, or `16 n - 16` with more than 1024 corners. The outer ring is counterclockwise and holes are
clockwise, so the inside is at the left of every edge.
*/

use crate::{Cloud, Fault, Glyph, Sight, Size};
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};
use puncta_core::Record;

mod set;
#[cfg(test)]
mod tests;
mod triangulation;

pub use set::{PolygonError, PolygonFailure, PolygonSet};

/// A polygon between two heights: 32 bytes. [`PolygonSet`] makes them, and the table they refer to.
///
/// Nothing is drawn if the height is not positive, or if its words in the table cannot be its own: if they
/// name corners that are not there, or corners that its ball does not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Polygon {
    /// Where it stands: the middle of its box, at the bottom.
    pub position: [f32; 3],
    /// The radius of a ball around the position that holds it.
    pub radius: f32,
    /// From the bottom to the top.
    pub height: f32,
    /// Its first word in the table.
    pub first: u32,
    /// How many corners it has, on all rings.
    pub corners: u32,
    /// How many rings it has: one, and one for each hole.
    pub rings: u32,
}

/// The most corners of a polygon whose triangles take a word each.
const NARROW: u32 = 1 << 10;
/// The most corners of any polygon.
const CORNERS_MAX: u32 = 1 << 21;

impl Record for Polygon {
    #[inline]
    fn position(&self) -> Vec3 {
        self.position.into()
    }

    #[inline]
    fn radius(&self) -> f32 {
        self.radius
    }
}

impl Polygon {
    /// The number of triangles of its roof.
    const fn roof(&self) -> u32 {
        self.corners + 2 * self.rings - 4
    }

    /// Its words in the table, unless they are not there.
    fn words<'a>(&self, table: &'a [u32]) -> Option<&'a [u32]> {
        let Self { first, corners, rings, .. } = *self;
        if !(3..=CORNERS_MAX).contains(&corners) || rings == 0 || rings > corners / 3 {
            return None;
        }
        let words = if corners <= NARROW { self.roof() } else { 2 * self.roof() };
        let count = (2 * corners + rings - 1 + words) as usize;
        table.get(first as usize..)?.get(..count)
    }

    fn is_finite(&self) -> bool {
        let numbers = [self.radius, self.height];
        self.position.iter().chain(&numbers).all(|number| number.is_finite())
    }
}

/// What is drawn of a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonForm<'a> {
    /// Its words in the table; none if nothing is drawn.
    words: &'a [u32],
    height: f32,
    corners: u32,
    rings: u32,
    roof: u32,
}

impl<'a> PolygonForm<'a> {
    fn new(polygon: &Polygon, words: &'a [u32]) -> Self {
        let Polygon { height, corners, rings, .. } = *polygon;
        Self { words, height, corners, rings, roof: polygon.roof() }
    }

    #[inline]
    fn word(&self, index: u32) -> u32 {
        self.words.get(index as usize).copied().unwrap_or(0)
    }

    /// The first corner of a ring, and behind the last ring how many corners there are.
    #[inline]
    fn start(&self, ring: u32) -> u32 {
        match ring {
            0 => 0,
            ring if ring >= self.rings => self.corners,
            ring => self.word(2 * self.corners + ring - 1),
        }
    }

    /// The corner after one, on its ring.
    #[inline]
    fn next(&self, corner: u32) -> u32 {
        let (mut ring, mut above) = (0, self.rings);
        while above - ring > 1 {
            let middle = u32::midpoint(ring, above);
            if self.start(middle) <= corner {
                ring = middle;
            } else {
                above = middle;
            }
        }
        let next = corner + 1;
        if next >= self.start(ring + 1) { self.start(ring) } else { next }
    }

    /// The corners of a triangle of the roof.
    #[inline]
    fn roof_triangle(&self, triangle: u32) -> [u32; 3] {
        let base = 2 * self.corners + self.rings - 1;
        if self.corners <= NARROW {
            let word = self.word(base + triangle);
            return [word & 1023, word >> 10 & 1023, word >> 20 & 1023];
        }
        let low = self.word(base + 2 * triangle);
        let high = self.word(base + 2 * triangle + 1);
        let mask = CORNERS_MAX - 1;
        [low & mask, (low >> 21 | high << 11) & mask, high >> 10 & mask]
    }
}

/// The words of a triangle of the roof.
fn pack([a, b, c]: [u32; 3], corners: u32) -> impl Iterator<Item = u32> {
    let is_narrow = corners <= NARROW;
    let low = if is_narrow { a | b << 10 | c << 20 } else { a | b << 21 };
    let high = if is_narrow { None } else { Some(b >> 11 | c << 10) };
    std::iter::once(low).chain(high)
}

impl Glyph for Polygon {
    type Style = [u32; 0];
    type Form<'a> = PolygonForm<'a>;
    const WGSL: &'static str = include_str!("../shader/polygon.wgsl");

    #[inline]
    fn form<'a>(cloud: &Cloud<'a, Self>, index: usize, _: &Sight) -> PolygonForm<'a> {
        let polygon = cloud.get(index);
        match (Self::fault(cloud, index), polygon.words(cloud.table)) {
            (None, Some(words)) => PolygonForm::new(&polygon, words),
            _ => PolygonForm { words: &[], height: 0.0, corners: 0, rings: 0, roof: 0 },
        }
    }

    #[inline]
    fn size(form: &PolygonForm<'_>) -> Size {
        Size { vertices: 2 * form.corners, triangles: 2 * (form.roof + form.corners) }
    }

    #[inline]
    fn vertex(form: &PolygonForm<'_>, vertex: u32) -> Vec3 {
        let is_top = vertex >= form.corners;
        let corner = if is_top { vertex - form.corners } else { vertex };
        let [x, y] = [2 * corner, 2 * corner + 1].map(|at| f32::from_bits(form.word(at)));
        Vec3::new(x, y, if is_top { form.height } else { 0.0 })
    }

    #[inline]
    fn triangle(form: &PolygonForm<'_>, triangle: u32) -> [u32; 3] {
        if triangle < form.roof {
            return form.roof_triangle(triangle).map(|corner| corner + form.corners);
        }
        if triangle < 2 * form.roof {
            let [a, b, c] = form.roof_triangle(triangle - form.roof);
            return [a, c, b];
        }
        let half = triangle - 2 * form.roof;
        let from = half >> 1;
        let to = form.next(from);
        if half & 1 == 0 {
            [from, to, to + form.corners]
        } else {
            [from, to + form.corners, from + form.corners]
        }
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let polygon = cloud.get(index);
        if !polygon.is_finite() {
            return Some(Fault::NotFinite);
        }
        if polygon.height.is_nan() || polygon.height <= 0.0 {
            return Some(Fault::NoExtent);
        }
        let Some(words) = polygon.words(cloud.table) else {
            return Some(Fault::Unknown);
        };
        let (corners, rest) = words.split_at(2 * polygon.corners as usize);
        let form = PolygonForm::new(&polygon, words);
        let starts = &rest[..polygon.rings as usize - 1];
        let are_known = (0..form.roof)
            .all(|triangle| form.roof_triangle(triangle).iter().all(|&at| at < form.corners))
            && starts.iter().all(|&start| start < form.corners)
            && starts.is_sorted();
        let number = |word: u32| f32::from_bits(word);
        let are_finite = corners.iter().all(|&word| number(word).is_finite());
        // More than rounding: corners that it does not reach are not its own.
        let is_within = || {
            let all = corners.chunks_exact(2).map(|at| Vec2::new(number(at[0]), number(at[1])));
            reach(all, polygon.height) <= polygon.radius * 1.000_01
        };
        match (are_finite, are_known && is_within()) {
            (false, _) => Some(Fault::NotFinite),
            (true, false) => Some(Fault::Unknown),
            (true, true) => None,
        }
    }
}

/// The radius of a ball around the position that holds corners relative to it, and those above them.
fn reach(corners: impl Iterator<Item = Vec2>, height: f32) -> f32 {
    let widest = corners.fold(0.0, |widest: f32, corner| widest.max(corner.length_squared()));
    Vec2::new(widest.sqrt(), height).length() * 1.000_001
}
