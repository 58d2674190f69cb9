/*!
Arcs: blocks between two radii, two angles and two heights, 32 bytes each.

# No cracks

The circle of a radius is drawn as a polygon whose corners are the multiples of `1 / n` of a turn, where
`n`, a power of two, is [`Sight::ring`] of that radius. A point at any angle lies on this polygon, not on
the circle. So arcs that share a circle share its curve, wherever they start and end, and arcs that share
an angle share a line.

An arc has a breakpoint at its start, at each corner of the outer polygon strictly between its ends, and at
its end. The inner polygon has no more corners than the outer one, and both numbers are powers of two, so
the corners of the inner one are among the breakpoints.

Which corners lie between is exact: a number times a power of two is not rounded, nor are `floor` and
`ceil`. Between two corners, the share of the way is what `floor` leaves, which is exact too; it is below 1,
and 0 at a corner, where the point is the corner itself, bit by bit.
*/

use crate::{Cloud, Fault, Glyph, Sight, Size, circle};
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};
use puncta_core::Record;

#[cfg(test)]
mod tests;

/// A block between two radii, two angles and two heights, around an axis along z: 32 bytes.
///
/// A turn of one or more is a closed ring. If the inner radius is 0, it is a slice of a pie. Nothing is
/// drawn if it ends where it starts or before that, if the outer radius is not larger than the inner
/// one, if the inner one is negative, or if the height is not positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Arc {
    /// The point of the axis at the bottom.
    pub center: [f32; 3],
    /// The inner and the outer radius.
    pub radii: [f32; 2],
    /// Where it starts and where it ends, in turns, counterclockwise from x to y.
    pub turns: [f32; 2],
    /// From the bottom to the top.
    pub height: f32,
}

impl Record for Arc {
    #[inline]
    fn position(&self) -> Vec3 {
        self.center.into()
    }

    #[inline]
    fn radius(&self) -> f32 {
        Vec2::new(self.radii[1], self.height).length() * 1.000_001
    }
}

/// What is drawn of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcForm {
    radii: [f32; 2],
    height: f32,
    /// Start and end.
    turns: [f32; 2],
    /// The corners of both polygons.
    chords: [u32; 2],
    /// The first corner after the start; 0 in a ring.
    first: i32,
    /// 0 if nothing is drawn.
    segments: u32,
    is_ring: bool,
    is_pie: bool,
}

impl Arc {
    fn fault(&self) -> Option<Fault> {
        let Self { center, radii: [inner, outer], turns: [start, end], height } = *self;
        let numbers = [inner, outer, start, end, height];
        if !(center.iter().chain(&numbers).all(|number| number.is_finite())) {
            Some(Fault::NotFinite)
        } else if inner >= 0.0 && outer > inner && end > start && height > 0.0 {
            None
        } else {
            Some(Fault::NoExtent)
        }
    }

    /// The form with these numbers of chords; no segments where something is wrong.
    fn form_of(&self, chords: [u32; 2]) -> ArcForm {
        let Self { radii, turns: [start, end], height, .. } = *self;
        let mut form = ArcForm {
            radii,
            height,
            turns: [start, end],
            chords,
            first: 0,
            segments: 0,
            is_ring: end - start >= 1.0,
            is_pie: radii[0] == 0.0,
        };
        if self.fault().is_some() {
            return form;
        }
        if form.is_ring {
            form.segments = chords[1];
            return form;
        }
        // Whole turns are taken away where that is exact, so that what is left is small.
        let whole = if start.abs() >= 2.0 { start.floor() } else { 0.0 };
        let steps = chords[1] as f32;
        let after = ((start - whole) * steps).floor() + 1.0;
        let until = ((end - whole) * steps).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2^14")]
        {
            form.first = after as i32;
            form.segments = (until - after) as u32 + 1;
        }
        form
    }
}

/// A point of the polygon that stands for the unit circle, at an angle in turns.
#[inline]
fn polygon(chords: u32, angle: f32) -> Vec2 {
    let steps = chords as f32;
    let at = (angle - angle.floor()) * steps;
    let corner = at.floor();
    let share = at - corner;
    let from = circle(corner / steps);
    from + (circle((corner + 1.0) / steps) - from) * share
}

impl ArcForm {
    /// How many breakpoints it has.
    #[inline]
    const fn breaks(&self) -> u32 {
        self.segments + !self.is_ring as u32
    }

    /// The angle of a breakpoint, in turns.
    #[inline]
    fn angle(&self, index: u32) -> f32 {
        if !self.is_ring && index == 0 {
            return self.turns[0];
        }
        if !self.is_ring && index == self.segments {
            return self.turns[1];
        }
        let corner = self.first.wrapping_add_unsigned(index).wrapping_sub(!self.is_ring as i32);
        (corner.cast_unsigned() & (self.chords[1] - 1)) as f32 / self.chords[1] as f32
    }

    /// The vertex at a breakpoint: at the outer bottom, the outer top, the inner top, the inner bottom.
    #[inline]
    const fn corner(&self, index: u32, corner: u32) -> u32 {
        if !self.is_pie {
            4 * index + corner
        } else if corner < 2 {
            2 * index + corner
        } else {
            2 * self.breaks() + corner - 2
        }
    }
}

impl Glyph for Arc {
    type Style = [u32; 0];
    type Form<'a> = ArcForm;
    const WGSL: &'static str = include_str!("../shader/arc.wgsl");

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> ArcForm {
        let arc = cloud.get(index);
        arc.form_of(arc.radii.map(|radius| sight.ring(radius)))
    }

    #[inline]
    fn size(form: &ArcForm) -> Size {
        if form.segments == 0 {
            return Size::NOTHING;
        }
        let (vertices, triangles) = if form.is_pie {
            (2 * form.breaks() + 2, 4 * form.segments)
        } else {
            (4 * form.breaks(), 8 * form.segments)
        };
        Size { vertices, triangles: triangles + if form.is_ring { 0 } else { 4 } }
    }

    #[inline]
    fn vertex(form: &ArcForm, vertex: u32) -> Vec3 {
        let (index, corner) = if !form.is_pie {
            (vertex >> 2, vertex & 3)
        } else if vertex < 2 * form.breaks() {
            (vertex >> 1, vertex & 1)
        } else {
            (0, vertex - 2 * form.breaks() + 2)
        };
        let z = if corner == 1 || corner == 2 { form.height } else { 0.0 };
        let side = usize::from(corner < 2);
        (polygon(form.chords[side], form.angle(index)) * form.radii[side]).extend(z)
    }

    #[inline]
    fn triangle(form: &ArcForm, triangle: u32) -> [u32; 3] {
        let faces = if form.is_pie { 4 } else { 8 };
        let (index, face) = (triangle / faces, triangle % faces);
        if index == form.segments {
            // The ends: two triangles of the profile each.
            let break_ = if face < 2 { 0 } else { form.segments };
            let [a, b, c] = [0, 1 + (face & 1), 2 + (face & 1)].map(|k| form.corner(break_, k));
            return if face < 2 { [a, b, c] } else { [a, c, b] };
        }
        let next = if index + 1 == form.breaks() { 0 } else { index + 1 };
        if form.is_pie && face >= 2 {
            let (side, axis) = if face == 2 { (1, 2) } else { (0, 3) };
            let [a, b] = [index, next].map(|at| form.corner(at, side));
            let c = form.corner(0, axis);
            return if face == 2 { [a, b, c] } else { [b, a, c] };
        }
        let (low, high) = (face >> 1, ((face >> 1) + 1) & 3);
        let (from, to) = (form.corner(index, low), form.corner(next, high));
        if face & 1 == 0 {
            [from, form.corner(next, low), to]
        } else {
            [from, to, form.corner(index, high)]
        }
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        cloud.get(index).fault()
    }
}
