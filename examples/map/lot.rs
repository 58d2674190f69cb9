//! Lots: rectangles of a straight grid, and how they are bent.

use glam::DVec2;

/// How long the pieces are into which edges are cut, so that they bend.
const PIECE: f64 = 12.0;

/// Where a point of the straight grid lies in the town.
pub(crate) fn bend(p: DVec2) -> DVec2 {
    let turn = 0.16 * (p.y / 900.0).sin() + 0.10 * (p.x / 700.0).cos();
    let turned = DVec2::from_angle(turn).rotate(p);
    turned + DVec2::new(70.0 * (p.y / 520.0).sin(), 55.0 * (p.x / 610.0).sin())
}

/// An outline in the straight grid, cut into short pieces and bent.
pub(crate) fn outline(corners: &[DVec2]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let pieces = ((b - a).length() / PIECE).ceil().max(1.0);
        let mut k = 0.0;
        while k < pieces {
            points.push(bend(a.lerp(b, k / pieces)).to_array());
            k += 1.0;
        }
    }
    points
}

/// A rectangle of the straight grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lot {
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
}

impl Lot {
    pub(crate) fn corners(self) -> Vec<DVec2> {
        let Self { min, max } = self;
        vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]
    }

    /// Its corners, cut off.
    pub(crate) fn chamfered(self, cut: f64) -> Vec<DVec2> {
        let corners = self.corners();
        let corner = |i: usize| {
            let (a, b, c) = (corners[(i + 3) % 4], corners[i], corners[(i + 1) % 4]);
            let off = |to: DVec2| b + (to - b).normalize_or_zero() * cut;
            [off(a), off(c)]
        };
        (0..4).flat_map(corner).collect()
    }

    pub(crate) fn inset(self, margin: f64) -> Self {
        Self { min: self.min + margin, max: self.max - margin }
    }

    /// Cuts it across, at a share of its length along an axis.
    pub(crate) fn cut(self, axis: usize, share: f64) -> [Self; 2] {
        let middle = self.min[axis] + (self.max[axis] - self.min[axis]) * share;
        let (mut low, mut high) = (self, self);
        low.max[axis] = middle;
        high.min[axis] = middle;
        [low, high]
    }

    pub(crate) fn size(self) -> DVec2 {
        self.max - self.min
    }
}
