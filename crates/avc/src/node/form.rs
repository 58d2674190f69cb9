/*!
What is drawn of a node: rings of corners from one end to the other, and what closes the ends.

```text
dome of the start      body      dome of the end
  <  (  (      |  ================  |      )  )  >
```

Rings are numbered from the start; corner k of ring j is vertex `n j + k`, behind them are the tips of the
domes. The body of a piece has two rings, that of a ball one. Without a dome, the end is a flat fan.

# Twist

The corners of the two rings of a body are evenly spread around the way, by frames of their own. Corner k of
the start lies at or after corner `k + shift` of the end, by less than a step. The triangles between them
then span one step at most, so all their points are as near to the surface as a chord.
*/

use super::joint::{End, is_mitred, turns_of};
use crate::{Size, circle};
use glam::Vec3;

/// What is drawn of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeForm {
    pub(super) ends: [End; 2],
    /// The radius at both ends.
    pub(super) radii: [f32; 2],
    /// From the start to the end.
    pub(super) step: Vec3,
    /// How many corners a ring has; 0 if nothing is drawn.
    pub(super) sides: u32,
    /// How many rows of faces a dome has.
    rows: u32,
    shift: u32,
    /// The number of rings of the body.
    bodies: u32,
}

impl NodeForm {
    const NO_END: End =
        End { axis: Vec3::Z, frame: [Vec3::X, Vec3::Y], lean: Vec3::ZERO, has_dome: true };

    pub(super) const NOTHING: Self = Self {
        ends: [Self::NO_END; 2],
        radii: [0.0; 2],
        step: Vec3::ZERO,
        sides: 0,
        rows: 1,
        shift: 0,
        bodies: 1,
    };

    /// A ball around the node.
    pub(super) fn ball(radius: f32, sides: u32) -> Self {
        let mut form = Self { radii: [radius; 2], ..Self::NOTHING };
        if radius > 0.0 {
            form.set_sides(sides);
        }
        form
    }

    /// A piece, from the ways before, along and after it; that before or after may be short. It has no
    /// sides yet.
    pub(super) fn piece([come, step, go]: [Vec3; 3], radius_max: f32) -> Self {
        let start = if is_mitred(come, step, radius_max) {
            End::mitred(come, step)
        } else {
            End::round(step)
        };
        let end =
            if is_mitred(step, go, radius_max) { End::mitred(step, go) } else { End::round(step) };
        Self { ends: [start, end], step, bodies: 2, ..Self::NOTHING }
    }

    pub(super) const fn has_dome(&self) -> bool {
        self.ends[0].has_dome || self.ends[1].has_dome
    }

    /// Sets how many corners a ring has. Nothing is drawn if a radius is not positive.
    pub(super) fn set_sides(&mut self, sides: u32) {
        self.sides = if self.radii[0] > 0.0 && self.radii[1] > 0.0 { sides } else { 0 };
        self.rows = sides.div_ceil(4).max(1);
        let [start, end] = &self.ends;
        if !start.has_dome {
            let corner = start.corner(0.0);
            let turns = turns_of(corner.dot(end.frame[0]), corner.dot(end.frame[1]));
            // It is 0 to n.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
            let shift = (turns * sides as f32).floor() as u32;
            self.shift = shift % sides.max(1);
        }
    }

    /// How many rings the dome of an end has, without that of the body.
    #[inline]
    const fn dome(&self, end: usize) -> u32 {
        if self.ends[end].has_dome { self.rows - 1 } else { 0 }
    }

    /// How many rings there are.
    #[inline]
    const fn rings(&self) -> u32 {
        self.dome(0) + self.bodies + self.dome(1)
    }

    /// How many triangles close an end.
    #[inline]
    const fn cap(&self, end: usize) -> u32 {
        if self.ends[end].has_dome { self.sides } else { self.sides.saturating_sub(2) }
    }

    pub(super) fn size(&self) -> Size {
        if self.sides == 0 {
            return Size::NOTHING;
        }
        let tips = u32::from(self.ends[0].has_dome) + u32::from(self.ends[1].has_dome);
        let bands = 2 * self.sides * (self.rings() - 1);
        Size {
            vertices: self.sides * self.rings() + tips,
            triangles: bands + self.cap(0) + self.cap(1),
        }
    }

    pub(super) fn vertex(&self, vertex: u32) -> Vec3 {
        let n = self.sides.max(1);
        let (ring, side) = (vertex / n, vertex % n);
        // The end it belongs to, and how many rows it is away from the body.
        let (end, row) = if ring >= self.rings() {
            (usize::from(side > 0 || !self.ends[0].has_dome), self.rows)
        } else if ring < self.dome(0) {
            (0, self.dome(0) - ring)
        } else {
            let above = ring - self.dome(0);
            (usize::from(above > 0), (above + 1).saturating_sub(self.bodies))
        };
        let place = &self.ends[end];
        // Along the axis, and across it.
        let height = if row == self.rows {
            (0.0, 1.0)
        } else {
            circle(row as f32 / (4 * self.rows) as f32).into()
        };
        let along = if end == 0 { -height.1 } else { height.1 };
        let corner = place.corner(side as f32 / n as f32);
        let offset = (corner * height.0 + place.axis * along) * self.radii[end];
        if end == 0 { offset } else { self.step + offset }
    }

    pub(super) fn triangle(&self, triangle: u32) -> [u32; 3] {
        let n = self.sides.max(1);
        let bands = 2 * n * (self.rings() - 1);
        if triangle >= bands {
            let rest = triangle - bands;
            return if rest < self.cap(0) {
                self.start(rest)
            } else {
                self.end(rest - self.cap(0))
            };
        }
        let (ring, k) = (triangle / (2 * n), (triangle >> 1) % n);
        let shift = if self.bodies == 2 && ring == self.dome(0) { self.shift } else { 0 };
        let low = n * ring;
        let high = low + n;
        let (far, next) = (high + (k + shift) % n, high + (k + shift + 1) % n);
        let (from, to) = (low + k, low + (k + 1) % n);
        if triangle & 1 == 0 { [from, to, next] } else { [from, next, far] }
    }

    fn start(&self, k: u32) -> [u32; 3] {
        if self.ends[0].has_dome {
            [self.sides * self.rings(), (k + 1) % self.sides.max(1), k]
        } else {
            [0, k + 2, k + 1]
        }
    }

    fn end(&self, k: u32) -> [u32; 3] {
        let last = self.sides * (self.rings() - 1);
        if self.ends[1].has_dome {
            let tip = last + self.sides + u32::from(self.ends[0].has_dome);
            [last + k, last + (k + 1) % self.sides.max(1), tip]
        } else {
            [last, last + k + 1, last + k + 2]
        }
    }
}
