//! The box of a frame, which scaled coordinates are fractions of.

use crate::{
    error::{Fault, Place, quote},
    text::{Lines, columns, number},
};
use glam::DVec3;

/// A parallelepiped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    origin: DVec3,
    /// The edges from the origin.
    edges: [DVec3; 3],
}

impl Cell {
    /// Reads the three lines behind `ITEM: BOX BOUNDS`, whose rest is `kind`.
    pub(super) fn read(lines: &mut Lines<'_, '_>, kind: &[u8]) -> Result<Self, Fault> {
        let is_general = columns(kind).next() == Some(b"abc");
        let is_tilted = columns(kind).next() == Some(b"xy");
        let mut rows = [[0.0; 4]; 3];
        let mut tilted = None;
        for row in &mut rows {
            lines.expect("the box bounds")?;
            let count = numbers(lines.text(), lines.place(), row)?;
            let expected = match (is_general, is_tilted, tilted) {
                (true, ..) => 4,
                (_, true, _) | (_, _, Some(true)) => 3,
                (_, _, Some(false)) => 2,
                (_, _, None) => count.clamp(2, 3),
            };
            if count != expected {
                let what = format!("the box bounds must be {expected} numbers in each line");
                return Err(Fault::invalid(lines.place(), what, quote(lines.text())));
            }
            tilted = Some(expected == 3);
        }
        Ok(if is_general { Self::general(rows) } else { Self::restricted(rows) })
    }

    /// The box of three vectors and an origin.
    fn general([a, b, c]: [[f64; 4]; 3]) -> Self {
        let edge = |row: [f64; 4]| DVec3::new(row[0], row[1], row[2]);
        Self { origin: DVec3::new(a[3], b[3], c[3]), edges: [edge(a), edge(b), edge(c)] }
    }

    /// The box of bounds and tilts, which are zero for a straight box.
    fn restricted([x, y, z]: [[f64; 4]; 3]) -> Self {
        let (xy, xz, yz) = (x[2], y[2], z[2]);
        let corners = [0.0, xy, xz, xy + xz];
        let (low, high) = corners
            .iter()
            .fold((0.0_f64, 0.0_f64), |(low, high), corner| (low.min(*corner), high.max(*corner)));
        let origin = DVec3::new(x[0] - low, y[0] - yz.min(0.0), z[0]);
        let end = DVec3::new(x[1] - high, y[1] - yz.max(0.0), z[1]);
        let sides = end - origin;
        let edges = [
            DVec3::new(sides.x, 0.0, 0.0),
            DVec3::new(xy, sides.y, 0.0),
            DVec3::new(xz, yz, sides.z),
        ];
        Self { origin, edges }
    }

    /// Whether the edges lie along the axes, so that each axis can be scaled by itself.
    pub(super) fn is_straight(&self) -> bool {
        let [a, b, c] = self.edges;
        let off_axis = [a.y, a.z, b.x, b.z, c.x, c.y];
        off_axis == [0.0; 6]
    }

    /// The position of these fractions of the edges.
    pub(super) fn position(&self, fractions: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.edges;
        (self.origin + a * fractions[0] + b * fractions[1] + c * fractions[2]).to_array()
    }

    /// The coordinate of a fraction along one axis of a straight box.
    pub(super) fn coordinate(&self, axis: usize, fraction: f64) -> f64 {
        let edges = self.edges.get(axis).map_or(DVec3::ZERO, |edge| *edge);
        let (origin, edge) = (self.origin.to_array(), edges.to_array());
        origin.get(axis).zip(edge.get(axis)).map_or(f64::NAN, |(low, side)| low + side * fraction)
    }
}

/// Reads the numbers of a line; returns how many there are.
fn numbers(line: &[u8], place: Place, row: &mut [f64; 4]) -> Result<usize, Fault> {
    let mut count = 0;
    for text in columns(line) {
        let Some(value) = number(text).filter(|value| value.is_finite()) else {
            return Err(Fault::invalid(place, "the box bounds must be numbers", quote(text)));
        };
        if let Some(slot) = row.get_mut(count) {
            *slot = value;
        }
        count += 1;
    }
    Ok(count)
}
