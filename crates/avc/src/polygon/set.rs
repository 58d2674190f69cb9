//! Makes records and a table of the rings of polygons.

use super::{CORNERS_MAX, Polygon, pack, reach, triangulation::triangulate};
use glam::{DVec2, Vec2};

/// Polygons and their table.
///
/// # Examples
///
/// ```
/// use puncta_avc::{Glyphs, Polygon, PolygonSet};
///
/// let mut set = PolygonSet::default();
/// let yard = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]];
/// let well = [[4.0, 4.0], [5.0, 4.0], [5.0, 5.0], [4.0, 5.0]];
/// set.push(&[yard, well], 0.0, 2.5)?;
/// let glyphs = Glyphs::<Polygon>::new([]).with_table(set.table);
/// assert_eq!(glyphs.faults(&set.records).sum(), 0);
/// # Ok::<(), puncta_avc::PolygonError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonSet {
    /// The records of the polygons that could be made, in the order in which they came.
    pub records: Vec<Polygon>,
    /// The table that they refer to: see [`Glyphs::with_table`](crate::Glyphs::with_table).
    pub table: Vec<u32>,
    /// The polygons that could not be made.
    pub failures: Vec<PolygonFailure>,
}

/// A polygon that could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("polygon {polygon}: {error}")]
pub struct PolygonFailure {
    /// Which one it was of those that came, from 0.
    pub polygon: usize,
    /// What is wrong.
    pub error: PolygonError,
}

/// What is wrong with a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// A number is NaN or infinite, or becomes so in `f32`.
    #[error("a number is not finite")]
    NotFinite,
    /// The height is not positive.
    #[error("its height is not positive")]
    NoExtent,
    /// There are no rings, or one has no area: fewer than three corners, or all on a line.
    #[error("ring {ring} has no area")]
    NoArea {
        /// Which ring.
        ring: usize,
    },
    /// A ring crosses itself or another one, or a hole is not within the outer ring.
    #[error("its rings cross")]
    NotSimple,
    /// There are more than 2²¹ corners.
    #[error("it has more than {CORNERS_MAX} corners")]
    TooManyCorners,
    /// The table has no room for it: it can have 2³² words.
    #[error("the table is full")]
    TableFull,
}

impl PolygonSet {
    /// Adds a polygon: an outer ring and holes, in any direction, closed or not by a corner that is the
    /// first one again. Coordinates are relative to the origin of the scene, the bottom lies at z =
    /// `bottom`.
    ///
    /// Corners are rounded to `f32` relative to the middle of the outer ring's box. Corners on a
    /// straight line between others, and those that are there twice in a row, are left out.
    ///
    /// # Errors
    ///
    /// What is wrong with it, which is kept in [`PolygonSet::failures`], too. Nothing is added then.
    pub fn push<R: AsRef<[[f64; 2]]>>(
        &mut self,
        rings: &[R],
        bottom: f64,
        height: f32,
    ) -> Result<(), PolygonError> {
        let made = self.try_push(rings, bottom, height);
        if let Err(error) = made {
            let polygon = self.records.len() + self.failures.len();
            self.failures.push(PolygonFailure { polygon, error });
        }
        made
    }

    fn try_push<R: AsRef<[[f64; 2]]>>(
        &mut self,
        rings: &[R],
        bottom: f64,
        height: f32,
    ) -> Result<(), PolygonError> {
        let points =
            || rings.iter().flat_map(|ring| ring.as_ref()).map(|&point| DVec2::from(point));
        let bottom = narrow(bottom);
        if !(bottom.is_finite() && height.is_finite() && points().all(DVec2::is_finite)) {
            return Err(PolygonError::NotFinite);
        }
        if height <= 0.0 {
            return Err(PolygonError::NoExtent);
        }
        let outer = rings.first().map_or(&[][..], |ring| ring.as_ref());
        if outer.is_empty() {
            return Err(PolygonError::NoArea { ring: 0 });
        }
        let [low, high] =
            outer.iter().fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], &p| {
                [low.min(p.into()), high.max(p.into())]
            });
        let middle = (low * 0.5 + high * 0.5).as_vec2();
        let place = |&point: &[f64; 2]| (DVec2::from(point) - middle.as_dvec2()).as_vec2();
        if !(middle.is_finite()
            && rings.iter().flat_map(|r| r.as_ref()).all(|p| place(p).is_finite()))
        {
            return Err(PolygonError::NotFinite);
        }
        let mut corners: Vec<Vec2> = Vec::new();
        let mut starts: Vec<u32> = Vec::new();
        for (ring, points) in rings.iter().enumerate() {
            let mut own = clean(points.as_ref().iter().map(place));
            let area = area(&own);
            if own.len() < 3 || area == 0.0 {
                return Err(PolygonError::NoArea { ring });
            }
            if (area > 0.0) != (ring == 0) {
                own.reverse();
            }
            starts.push(within(corners.len())?);
            corners.append(&mut own);
        }
        within(corners.len())?;
        let reach = reach(corners.iter().copied(), height);
        if !reach.is_finite() {
            return Err(PolygonError::NotFinite);
        }
        let wide: Vec<DVec2> = corners.iter().map(|corner| corner.as_dvec2()).collect();
        let roof = triangulate(&wide, &starts).ok_or(PolygonError::NotSimple)?;
        let record = Polygon {
            position: [middle.x, middle.y, bottom],
            radius: reach,
            height,
            first: u32::try_from(self.table.len()).map_err(|_| PolygonError::TableFull)?,
            corners: within(corners.len())?,
            rings: within(starts.len())?,
        };
        let words = corners.iter().flat_map(|corner| corner.to_array().map(f32::to_bits));
        let holes = starts.iter().skip(1).copied();
        let roof = roof.into_iter().flat_map(|triangle| pack(triangle, record.corners));
        self.table.extend(words.chain(holes).chain(roof));
        if u32::try_from(self.table.len()).is_err() {
            self.table.truncate(record.first as usize);
            return Err(PolygonError::TableFull);
        }
        self.records.push(record);
        Ok(())
    }
}

/// A number of corners, if there may be so many.
fn within(count: usize) -> Result<u32, PolygonError> {
    let count = u32::try_from(count).ok().filter(|&count| count <= CORNERS_MAX);
    count.ok_or(PolygonError::TooManyCorners)
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
const fn narrow(x: f64) -> f32 {
    x as f32
}

/// Whether the way from a point to a third does not turn at the second.
fn is_straight(a: Vec2, b: Vec2, c: Vec2) -> bool {
    // Differences and products of two `f32` of like size are exact in `f64`.
    let (u, v) = (b.as_dvec2() - a.as_dvec2(), c.as_dvec2() - b.as_dvec2());
    u.perp_dot(v) == 0.0
}

/// A ring without corners on straight lines; none twice in a row.
fn clean(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut ring: Vec<Vec2> = Vec::new();
    for point in points {
        while let [.., a, b] = ring[..]
            && is_straight(a, b, point)
        {
            ring.pop();
        }
        if ring.last() != Some(&point) {
            ring.push(point);
        }
    }
    // Where its ends meet.
    let mut start = 0;
    loop {
        match ring[start..] {
            [first, .., last] if first == last => _ = ring.pop(),
            [first, .., a, last] if is_straight(a, last, first) => _ = ring.pop(),
            [first, second, .., last] if is_straight(last, first, second) => start += 1,
            _ => return ring.split_off(start),
        }
    }
}

/// Twice the area of a ring; negative if it is clockwise.
fn area(ring: &[Vec2]) -> f64 {
    let Some(&first) = ring.first() else { return 0.0 };
    let from_first = |point: Vec2| point.as_dvec2() - first.as_dvec2();
    ring.windows(2).map(|pair| from_first(pair[0]).perp_dot(from_first(pair[1]))).sum()
}
