/*!
Trajectories: a record of 24 bytes for each node.

The glyph of a node is the piece from it to the next node of its trajectory. What it looks like is a matter
of the style: a line, a tube or a ball, by attributes, distance and selection.

# Joints

At a joint, a piece ends in the plane that halves the angle, with the corners of the one prism that both
pieces are cut from; each piece is closed by a flat cap. Both compute the ring from the same three nodes by
the same steps, so its offsets from the node are the same bits. Where the turn is too sharp for the
length of the pieces, or more than 90 degrees, and at both ends of a trajectory, a piece ends with a
dome, so joints are round there.

Whether a joint is sharp decides how many triangles there are, so it must be the same on every machine:
directions are rounded to 14 bits, and compared in whole numbers. `joint.rs` has the reckoning.

The number of sides comes from the largest radius of the style, not from that of the node: so the rings of
all joints fit.
*/

use crate::{Cloud, Fault, Glyph, Sight, Size};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use half::f16;
use puncta_core::Record;

mod builder;
mod form;
mod joint;
#[cfg(test)]
mod tests;

pub use builder::{Trajectories, TrajectoryFaults};
pub use form::NodeForm;
use joint::{FAR, SHORT, delta, extent, is_short};

/// A node of a trajectory: 24 bytes.
///
/// Nodes of a trajectory lie one after the other in the order of their times. They must stay so: see
/// [`Runs`](crate::Runs). The radius of the [`Record`] is 0, as it cannot know the next node;
/// [`Glyph::ball`] does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    /// Where it is.
    pub position: [f32; 3],
    /// The trajectory's id and 1; 0 for none.
    pub trajectory: u32,
    /// When it is there.
    pub time: f32,
    /// Speed and acceleration as `f16`, the speed in the lower half.
    pub motion: u32,
}

impl Node {
    /// The node of a trajectory. Speed and acceleration are rounded to `f16`; those beyond its range
    /// become the largest ones, and those that are not normal numbers (below 6e-5) become 0.
    #[must_use]
    pub fn new(position: [f32; 3], trajectory: u32, time: f32, motion: [f32; 2]) -> Self {
        let [speed, acceleration] = motion.map(|value| {
            let value = f16::from_f32(value.clamp(-f16::MAX.to_f32(), f16::MAX.to_f32()));
            if value.is_normal() || value.is_nan() { value.to_bits() } else { 0 }
        });
        let motion = u32::from(speed) | u32::from(acceleration) << 16;
        Self { position, trajectory: trajectory.saturating_add(1), time, motion }
    }

    /// The speed.
    #[must_use]
    #[inline]
    pub fn speed(&self) -> f32 {
        half_of(self.motion)
    }

    /// The acceleration.
    #[must_use]
    #[inline]
    pub fn acceleration(&self) -> f32 {
        half_of(self.motion >> 16)
    }

    fn is_finite(&self) -> bool {
        let is_motion_finite =
            [self.motion, self.motion >> 16].iter().all(|bits| bits & 0x7c00 != 0x7c00);
        self.position.iter().all(|x| x.is_finite()) && self.time.is_finite() && is_motion_finite
    }

    /// Whether a piece leads from it to another.
    #[inline]
    fn leads_to(&self, next: &Self) -> bool {
        self.trajectory != 0
            && self.trajectory == next.trajectory
            && self.is_finite()
            && next.is_finite()
            && extent(delta(self, next)) <= FAR
    }
}

/// The number in the lower 16 bits; 0 if it is not normal, as it is on some GPUs.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
fn half_of(bits: u32) -> f32 {
    if bits & 0x7c00 == 0 { 0.0 } else { f16::from_bits(bits as u16).to_f32() }
}

/// What is drawn of nodes: 48 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct NodeStyle {
    /// The radii of tubes where they are slowest and fastest. Both must be 1e-18 to 1e18, or
    /// nothing is drawn.
    pub radii: [f32; 2],
    /// The speeds that count as slowest and fastest.
    pub speeds: [f32; 2],
    /// The width of lines, in pixels. A line is never wider than the tube.
    pub width: f32,
    /// The radius of balls.
    pub ball: f32,
    /// What is drawn: one of the constants of this type.
    pub kind: u32,
    /// Lines become tubes in bricks that begin nearer than this view depth. Without perspective, all
    /// bricks begin at 1.
    pub near: f32,
    /// Nodes whose acceleration is at least this large are special.
    pub acceleration: f32,
    /// What is drawn of special nodes.
    pub special: u32,
    /// The trajectory that is selected: its id and 1; 0 for none.
    pub selected: u32,
    /// What is drawn of it.
    pub selection: u32,
}

impl NodeStyle {
    /// Nothing is drawn.
    pub const NOTHING: u32 = 0;
    /// A line of a width in pixels: a prism of three or four sides.
    pub const LINE: u32 = 1;
    /// A tube.
    pub const TUBE: u32 = 2;
    /// A ball at each node.
    pub const BALL: u32 = 3;

    /// Tubes of this radius. Nothing is special or selected.
    #[must_use]
    pub const fn tubes(radius: f32) -> Self {
        Self {
            radii: [radius; 2],
            speeds: [0.0, 1.0],
            width: 1.5,
            ball: radius * 2.0,
            kind: Self::TUBE,
            near: 0.0,
            acceleration: f32::MAX,
            special: Self::TUBE,
            selected: 0,
            selection: Self::TUBE,
        }
    }

    /// The largest radius of tubes, unless the radii are of no use.
    fn radius_max(&self) -> Option<f32> {
        let is_of_use = |&radius: &f32| (SHORT..=FAR).contains(&radius);
        let larger = if self.radii[1] > self.radii[0] { self.radii[1] } else { self.radii[0] };
        self.radii.iter().all(is_of_use).then_some(larger)
    }

    /// The radius of balls; 0 if it is of no use.
    fn ball(&self) -> f32 {
        if (SHORT..=FAR).contains(&self.ball) { self.ball } else { 0.0 }
    }

    /// What is drawn of a node.
    fn kind_of(&self, node: &Node, sight: &Sight) -> u32 {
        let mut kind = self.kind;
        if node.acceleration() >= self.acceleration {
            kind = self.special;
        }
        if kind == Self::LINE && sight.nearest < self.near {
            kind = Self::TUBE;
        }
        if self.selected != 0 && node.trajectory == self.selected { self.selection } else { kind }
    }

    /// The radius of a tube at a node.
    fn radius_at(&self, node: &Node) -> f32 {
        let [slow, fast] = self.speeds;
        let width = fast - slow;
        let share = if width > 0.0 { (node.speed() - slow) / width } else { 0.0 };
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        self.radii[0] + (self.radii[1] - self.radii[0]) * share
    }
}

impl Record for Node {
    #[inline]
    fn position(&self) -> Vec3 {
        self.position.into()
    }

    #[inline]
    fn radius(&self) -> f32 {
        0.0
    }
}

impl Glyph for Node {
    type Style = NodeStyle;
    type Form<'a> = NodeForm;
    const WGSL: &'static str = include_str!("../shader/node.wgsl");
    const HAS_NEIGHBORS: bool = true;

    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> NodeForm {
        let (style, node) = (cloud.style, cloud.get(index));
        let Some(radius_max) = style.radius_max() else { return NodeForm::NOTHING };
        if node.trajectory == 0 || !node.is_finite() {
            return NodeForm::NOTHING;
        }
        let kind = style.kind_of(&node, sight);
        if kind == NodeStyle::BALL {
            let radius = style.ball();
            return NodeForm::ball(radius, sight.sides(2.0 * radius));
        }
        let is_line = kind == NodeStyle::LINE;
        if !is_line && kind != NodeStyle::TUBE {
            return NodeForm::NOTHING;
        }
        let thin = style.width * 0.5 * sight.pixel * sight.nearest;
        let radius = |node: &Self| {
            let radius = style.radius_at(node);
            if is_line && thin < radius { thin.max(0.0) } else { radius }
        };
        let sides = |radius: f32| {
            let sides = sight.sides(radius);
            if is_line { sides.min(4) } else { sides }
        };
        let (before, next) = (cloud.before(index), cloud.get(index.saturating_add(1)));
        let is_led_to = before.leads_to(&node);
        if !node.leads_to(&next) {
            // The piece before ends here. A trajectory of one node is a ball.
            return if is_led_to {
                NodeForm::NOTHING
            } else {
                NodeForm::ball(radius(&node), sides(2.0 * radius_max))
            };
        }
        let step = delta(&node, &next);
        if is_short(step) {
            return NodeForm::ball(radius(&node), sides(2.0 * radius_max));
        }
        let after = cloud.get(index.saturating_add(2));
        let come = if is_led_to { delta(&before, &node) } else { Vec3::ZERO };
        let go = if next.leads_to(&after) { delta(&next, &after) } else { Vec3::ZERO };
        let mut form = NodeForm::piece([come, step, go], radius_max);
        form.radii = [radius(&node), radius(&next)];
        form.set_sides(sides(if form.has_dome() { 2.0 * radius_max } else { radius_max }));
        form
    }

    #[inline]
    fn size(form: &NodeForm) -> Size {
        form.size()
    }

    #[inline]
    fn vertex(form: &NodeForm, vertex: u32) -> Vec3 {
        form.vertex(vertex)
    }

    #[inline]
    fn triangle(form: &NodeForm, triangle: u32) -> [u32; 3] {
        form.triangle(triangle)
    }

    /// The ball around the whole piece. Corners of a mitred joint are up to 1.415 radii away.
    fn ball(cloud: &Cloud<'_, Self>, index: usize) -> (Vec3, f32) {
        let (node, next) = (cloud.get(index), cloud.get(index.saturating_add(1)));
        let step = if node.leads_to(&next) { delta(&node, &next) } else { Vec3::ZERO };
        let step = if is_short(step) { Vec3::ZERO } else { step };
        let reach = (cloud.style.radius_max().unwrap_or(0.0) * 1.42).max(cloud.style.ball());
        let center = node.position() + step * 0.5;
        // The centre is rounded, on three axes.
        let rounding = extent(center) * 1.2e-7;
        (center, (step.length() * 0.5 + reach) * 1.000_01 + rounding)
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let node = cloud.get(index);
        if !node.is_finite() {
            Some(Fault::NotFinite)
        } else if cloud.style.radius_max().is_none() {
            Some(Fault::NoExtent)
        } else if node.trajectory == 0 {
            Some(Fault::Unknown)
        } else {
            None
        }
    }
}
