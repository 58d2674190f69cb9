//! Prisms: columns that stand on the ground, angular or round, of 28 bytes each.

use crate::{
    Cloud, Fault, Glyph, Sight, Size, circle,
    extent::{self, BALL_SLACK, are_finite, has_extent},
};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_core::Record;

/// A column over a regular polygon, standing on its base, with the z axis up: 28 bytes.
///
/// Nothing is drawn of one whose radius or height is not positive, or that has 1, 2 or more than 64
/// sides.
///
/// # Examples
///
/// ```
/// use puncta_avc::{Glyph, Glyphs, Prism, Sight};
///
/// let bars = [Prism::new([0.0; 3], 0.5, 2.0), Prism::new([4.0, 0.0, 0.0], 0.5, 3.0).with_sides(6)];
/// let glyphs = Glyphs::new([]);
/// let size = |index| Prism::size(&Prism::form(&glyphs.cloud(&bars), index, &Sight::everywhere(32.0)));
/// assert_eq!((size(0).vertices, size(1).vertices), (48, 12));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Prism {
    /// The centre of the base.
    pub base: [f32; 3],
    /// How far the corners are from the axis.
    pub radius: f32,
    /// How far the top is above the base.
    pub height: f32,
    /// How many sides it has, 3 to [`Prism::SIDES_MAX`]; 0 if it is round, which takes as many as the
    /// view needs.
    pub sides: u32,
    /// Where the first corner is, in turns counterclockwise from the x axis.
    pub turn: f32,
}

impl Prism {
    /// The most sides that a record can ask for.
    pub const SIDES_MAX: u32 = 64;

    /// A round column.
    #[must_use]
    pub const fn new(base: [f32; 3], radius: f32, height: f32) -> Self {
        Self { base, radius, height, sides: 0, turn: 0.0 }
    }

    /// The same with a number of sides.
    #[must_use]
    pub const fn with_sides(mut self, sides: u32) -> Self {
        self.sides = sides;
        self
    }

    /// The same, turned to have its first corner there, in turns.
    #[must_use]
    pub const fn with_turn(mut self, turns: f32) -> Self {
        self.turn = turns;
        self
    }

    /// Where the base and the top are, relative to the position. The position is rounded, but the base
    /// stays where it is: this is what the rounding has left of it.
    #[inline]
    fn ends(&self) -> [f32; 2] {
        let bottom = self.base[2] - self.position().z;
        [bottom, bottom + self.height]
    }

    #[inline]
    const fn has_sides(&self) -> bool {
        matches!(self.sides, 0 | 3..=Self::SIDES_MAX)
    }
}

impl Record for Prism {
    #[inline]
    fn position(&self) -> Vec3 {
        let [x, y, z] = self.base;
        Vec3::new(x, y, z + self.height * 0.5)
    }

    #[inline]
    fn radius(&self) -> f32 {
        let [bottom, top] = self.ends();
        let reach = (-bottom).max(top);
        (self.radius * self.radius + reach * reach).sqrt() * BALL_SLACK
    }
}

/// What is drawn of a [`Prism`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrismForm {
    /// How many sides there are; 0 if there is nothing.
    sides: u32,
    radius: f32,
    turn: f32,
    bottom: f32,
    top: f32,
    /// Bit 0 if the base is drawn, bit 1 if the top is.
    caps: u32,
}

impl Glyph for Prism {
    type Style = [u32; 0];
    type Form<'a> = PrismForm;
    const WGSL: &'static str =
        concat!(include_str!("../shader/extent.wgsl"), include_str!("../shader/prism.wgsl"));

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> PrismForm {
        let record = cloud.get(index);
        let Self { radius, height, turn, .. } = record;
        let [bottom, top] = record.ends();
        let is_there = are_finite(&record.base)
            && are_finite(&[radius, height, turn])
            && has_extent(radius)
            && has_extent(height)
            && record.has_sides();
        if !is_there {
            return PrismForm { sides: 0, radius, turn: 0.0, bottom, top, caps: 0 };
        }
        let sides = if record.sides == 0 { sight.sides(radius) } else { record.sides };
        let sees_base = sight.may_see(-sight.eye.z, -bottom);
        let sees_top = sight.may_see(sight.eye.z, top);
        let caps = u32::from(sees_base) | u32::from(sees_top) << 1;
        PrismForm { sides, radius, turn: turn - turn.floor(), bottom, top, caps }
    }

    #[inline]
    fn size(form: &PrismForm) -> Size {
        let PrismForm { sides, caps, .. } = *form;
        if sides == 0 {
            return Size::NOTHING;
        }
        Size { vertices: 2 * sides, triangles: 2 * sides + caps.count_ones() * (sides - 2) }
    }

    /// The ring of the base, then that of the top.
    #[inline]
    fn vertex(form: &PrismForm, vertex: u32) -> Vec3 {
        let sides = form.sides.max(3);
        let corner = vertex % sides;
        let point = circle(form.turn + corner as f32 / sides as f32) * form.radius;
        point.extend(if vertex < sides { form.bottom } else { form.top })
    }

    /// Two for each side, then the fans of what is seen of base and top.
    #[inline]
    fn triangle(form: &PrismForm, triangle: u32) -> [u32; 3] {
        let sides = form.sides.max(3);
        if triangle / 2 < sides {
            let here = triangle / 2;
            let next = (here + 1) % sides;
            return if triangle & 1 == 0 {
                [here, next, sides + next]
            } else {
                [here, sides + next, sides + here]
            };
        }
        let rest = triangle - 2 * sides;
        let corner = 1 + rest % (sides - 2);
        let is_top = form.caps == 2 || rest >= sides - 2;
        if is_top { [sides, sides + corner, sides + corner + 1] } else { [0, corner + 1, corner] }
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let record = cloud.get(index);
        let ([x, y, z], Self { radius, height, turn, .. }) = (record.base, record);
        let fault = extent::fault(&[x, y, z, radius, height, turn], &[radius, height]);
        fault.or_else(|| (!record.has_sides()).then_some(Fault::NoExtent))
    }
}

#[cfg(test)]
mod tests;
