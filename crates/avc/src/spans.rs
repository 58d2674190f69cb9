//! Spans: the pixels of each row that a facet covers.

use crate::facet::covers;
use glam::DVec2;

/// Up to this size, coordinates in pixels have digits enough for [`FINE`].
const SMALL: f64 = 1e9;

/// How far a crossing of an edge and a row may be off, in pixels, if coordinates are [`SMALL`].
const FINE: f64 = 1e-3;

/// The pixels that a facet covers, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Spans {
    corners: [DVec2; 3],
    columns: [i64; 2],
    rows: [i64; 2],
    /// How many columns each edge moves per row; 0 if it lies along the row.
    steps: [f64; 3],
    /// How far crossings may be off.
    slack: f64,
}

impl Spans {
    /// In a picture of so many columns and rows.
    #[inline]
    pub(crate) fn new(corners: [DVec2; 3], [width, height]: [u32; 2]) -> Self {
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let step = |edge: DVec2| if edge.y == 0.0 { 0.0 } else { edge.x / edge.y };
        let largest = low.abs().max(high.abs()).max_element();
        Self {
            corners,
            columns: within([low.x, high.x], width),
            rows: within([low.y, high.y], height),
            steps: [step(b - a), step(c - b), step(a - c)],
            slack: if largest < SMALL { FINE } else { 1.0 },
        }
    }

    /// The rows that it may cover, first and last. Empty if the first is larger.
    #[must_use]
    #[inline]
    pub const fn rows(&self) -> [i64; 2] {
        self.rows
    }

    /// The columns that it may cover in any row, first and last. Empty if the first is larger.
    #[must_use]
    #[inline]
    pub const fn columns(&self) -> [i64; 2] {
        self.columns
    }

    /// The columns that it covers in a row, first and last. Empty if the first is larger.
    ///
    /// Where edges meet a row is a guess, which is put right by the test of
    /// [`Facet::covers`](crate::Facet::covers).
    #[must_use]
    #[inline]
    pub fn of(&self, row: f64) -> [i64; 2] {
        let [mut first, mut last] = self.columns;
        for i in 0..3 {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % 3]);
            let x = a.x + self.steps[i] * (row - a.y);
            // Inside is where the cross product of the edge and what leads to the pixel is positive.
            // Columns are not negative, so that cutting off digits is rounding down.
            #[expect(clippy::cast_possible_truncation, reason = "casts saturate")]
            if b.y < a.y {
                first = first.max((x + (1.0 - self.slack)) as i64);
            } else if b.y > a.y {
                // Of NaN nothing follows.
                let end = if x >= 0.0 { (x + self.slack) as i64 } else { -1 };
                last = if x.is_nan() { last } else { last.min(end) };
            }
        }
        while first <= last && !covers(&self.corners, first as f64, row) {
            first += 1;
        }
        while first < last && !covers(&self.corners, last as f64, row) {
            last -= 1;
        }
        [first, last]
    }
}

/// The whole numbers between two, within a picture of `count` pixels.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "casts saturate")]
fn within([low, high]: [f64; 2], count: u32) -> [i64; 2] {
    // Of numbers that are not negative, cutting off digits is rounding down.
    let low = low.max(0.0);
    let first = low as i64;
    let first = first.saturating_add(i64::from((first as f64) < low));
    let last = if high < 0.0 { -1 } else { high as i64 };
    [first, last.min(i64::from(count) - 1)]
}
