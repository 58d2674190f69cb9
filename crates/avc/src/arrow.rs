//! Arrows and cones: from a point along a vector, of 36 bytes each.

use crate::{
    Cloud, Fault, Glyph, Sight, Size, circle,
    extent::{self, BALL_SLACK, EXTENT_MAX, EXTENT_MIN, are_finite, has_extent, largest},
    frame::frame,
};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_core::Record;

/// An arrow from a point along a vector, as round as the view needs: 36 bytes.
///
/// The head ends where the vector ends, and is no longer than it. Without a shaft only the head is left:
/// a cone. Nothing is drawn without a vector or a head.
///
/// # Examples
///
/// ```
/// use puncta_avc::{Arrow, Glyph, Glyphs, Mesh, Sight};
///
/// // It stands on a circle of radius 1 and is 3 high, so it holds pi.
/// let cone = [Arrow::cone([0.0; 3], [0.0, 0.0, 3.0], 1.0)];
/// let form = Arrow::form(&Glyphs::new([]).cloud(&cone), 0, &Sight::everywhere(1e4));
/// let volume = Mesh::of::<Arrow>(&form).volume();
/// assert!((volume - std::f64::consts::PI).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Arrow {
    /// Where it starts.
    pub start: [f32; 3],
    /// What leads from there to the tip.
    pub vector: [f32; 3],
    /// The radius of the shaft; 0 for none.
    pub shaft_radius: f32,
    /// The radius of the head where it is widest.
    pub head_radius: f32,
    /// How long the head is.
    pub head_length: f32,
}

/// Longer than any vector that is drawn.
const LENGTH_MAX: f32 = 2e18;

impl Arrow {
    /// An arrow of a usual form: the head is twice as wide as the shaft, and as long as it is wide.
    #[must_use]
    pub const fn new(start: [f32; 3], vector: [f32; 3], shaft_radius: f32) -> Self {
        let head = 2.0 * shaft_radius;
        Self { start, vector, shaft_radius, head_radius: head, head_length: 2.0 * head }
    }

    /// A cone that stands on a circle around `start`.
    #[must_use]
    pub const fn cone(start: [f32; 3], vector: [f32; 3], radius: f32) -> Self {
        Self {
            start,
            vector,
            shaft_radius: 0.0,
            head_radius: radius,
            // Longer than any vector that is drawn, so the head is all there is.
            head_length: LENGTH_MAX,
        }
    }

    /// The same with another head.
    #[must_use]
    pub const fn with_head(mut self, radius: f32, length: f32) -> Self {
        (self.head_radius, self.head_length) = (radius, length);
        self
    }

    /// Where it starts and ends, relative to the position. The position is rounded, but the start stays
    /// where it is: this is what the rounding has left of it.
    #[inline]
    fn ends(&self) -> [Vec3; 2] {
        let tail = Vec3::from(self.start) - self.position();
        [tail, tail + Vec3::from(self.vector)]
    }
}

impl Record for Arrow {
    #[inline]
    fn position(&self) -> Vec3 {
        Vec3::from(self.start) + Vec3::from(self.vector) * 0.5
    }

    #[inline]
    fn radius(&self) -> f32 {
        let [tail, tip] = self.ends();
        // Centres of rings lie between the ends, and their points are as far from them as they are wide.
        let reach = tail.length().max(tip.length());
        (reach + self.shaft_radius.max(self.head_radius)) * BALL_SLACK
    }
}

/// What is drawn of an [`Arrow`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrowForm {
    /// How many chords a ring has; 0 if there is nothing.
    chords: u32,
    /// How many rings there are: 3, or 1 if there is no shaft.
    rings: u32,
    tail: Vec3,
    /// Where the head begins.
    neck: Vec3,
    tip: Vec3,
    right: Vec3,
    up: Vec3,
    shaft: f32,
    head: f32,
}

impl Glyph for Arrow {
    type Style = [u32; 0];
    type Form<'a> = ArrowForm;
    const WGSL: &'static str = concat!(
        include_str!("../shader/extent.wgsl"),
        include_str!("../shader/frame.wgsl"),
        include_str!("../shader/arrow.wgsl")
    );

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> ArrowForm {
        let record = cloud.get(index);
        let vector = Vec3::from(record.vector);
        let (shaft, head) = (record.shaft_radius, record.head_radius);
        let [tail, tip] = record.ends();
        let size = largest(vector);
        let numbers = [shaft, head, record.head_length];
        let is_there = are_finite(&record.start)
            && are_finite(&record.vector)
            && are_finite(&numbers)
            && has_extent(size)
            && has_extent(head)
            && record.head_length >= EXTENT_MIN
            && shaft > -EXTENT_MIN
            && shaft <= EXTENT_MAX;
        let zero = Vec3::ZERO;
        if !is_there {
            let (right, up) = (zero, zero);
            return ArrowForm {
                chords: 0,
                rings: 0,
                tail,
                neck: tail,
                tip,
                right,
                up,
                shaft,
                head,
            };
        }
        let scaled = vector / size;
        let head_length = record.head_length.min(LENGTH_MAX);
        let share = (1.0 - head_length / size / scaled.dot(scaled).sqrt()).max(0.0);
        let [right, up] = frame(vector);
        ArrowForm {
            chords: sight.sides(shaft.max(head)),
            rings: if shaft >= EXTENT_MIN { 3 } else { 1 },
            tail,
            neck: tail + vector * share,
            tip,
            right,
            up,
            shaft,
            head,
        }
    }

    #[inline]
    fn size(form: &ArrowForm) -> Size {
        match form.rings * form.chords {
            0 => Size::NOTHING,
            points => Size { vertices: points + 2, triangles: 2 * points },
        }
    }

    /// The middle of the end, the rings (around the end, around the neck as wide as the shaft, around
    /// the neck as wide as the head; of these only the last if there is no shaft), the tip.
    #[inline]
    fn vertex(form: &ArrowForm, vertex: u32) -> Vec3 {
        let chords = form.chords.max(3);
        let has_shaft = form.rings == 3;
        if vertex == 0 {
            return if has_shaft { form.tail } else { form.neck };
        }
        let ring = (vertex - 1) / chords;
        if ring >= form.rings {
            return form.tip;
        }
        let center = if has_shaft && ring == 0 { form.tail } else { form.neck };
        let radius = if has_shaft && ring < 2 { form.shaft } else { form.head };
        let point = circle(((vertex - 1) % chords) as f32 / chords as f32) * radius;
        center + (form.right * point.x + form.up * point.y)
    }

    /// The fan of the end, two bands between each two rings, the fan of the tip.
    #[inline]
    fn triangle(form: &ArrowForm, triangle: u32) -> [u32; 3] {
        let chords = form.chords.max(3);
        let (here, next) = (1 + triangle % chords, 1 + (triangle % chords + 1) % chords);
        let band = triangle / chords;
        if band == 0 {
            return [0, next, here];
        }
        // Between two rings there are two bands of triangles.
        let below = (band - 1) / 2 * chords;
        if band + 1 == 2 * form.rings {
            return [below + here, below + next, form.rings * chords + 1];
        }
        let above = below + chords;
        if band & 1 == 1 {
            [below + here, below + next, above + next]
        } else {
            [below + here, above + next, above + here]
        }
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let record = cloud.get(index);
        let ([x, y, z], [a, b, c]) = (record.start, record.vector);
        let Self { shaft_radius: shaft, head_radius: head, head_length, .. } = record;
        let numbers = [x, y, z, a, b, c, shaft, head, head_length];
        let length = head_length.min(EXTENT_MAX);
        let fault = extent::fault(&numbers, &[largest(record.vector.into()), head, length]);
        fault.or_else(|| match shaft {
            shaft if shaft > EXTENT_MAX => Some(Fault::NotFinite),
            shaft if shaft <= -EXTENT_MIN => Some(Fault::NoExtent),
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests;
