/*!
Joints: which are sharp, and the frames of rings.

# Which are sharp

Be `a` and `b` the ways to and from the joint, and `t` the turn between them. The plane that halves the
angle cuts a tube of radius `r` up to `r tan(t/2)` before the joint. If that is at most half of either
piece, the planes of both its ends do not cross within it. `tan(t/2)` is `|a×b| / (|a||b| + a.b)`.

`A` and `B` are `a` and `b`, scaled by powers of two so that their largest coordinates are 2¹³ to 2¹⁴ and cut
to whole numbers. Their products are at most 2²⁸, so `A.B` and `A×B` are exact in 32 bits. Cutting changes
each coordinate by less than 1, so each coordinate of the cross product by less than 2¹⁶. With the largest
coordinate `C` of `A×B` and the largest ones `M` and `N` of `A` and `B`,
`tan(t/2) <= sqrt(3) (C + 2¹⁶) / (M N + A.B)`, but for what cutting does to `A.B`, which is less than a
500th of `M N`. So `4 r (C + 2¹⁶) <= l (M N + A.B)` is enough, where `l` is the largest coordinate of the
shorter way: the 4 is twice 2, which is more than `sqrt(3)` by what is left. Both sides are single
products of `f32`, of whole numbers of 24 bits.

That `A.B >= 0` allows for turns a little beyond 90 degrees, up to 0.0015 of a radian. There a corner is at
most 1.4153 radii from the joint.
*/

use super::Node;
use crate::circle;
use glam::{IVec3, Vec3};

/// Nodes farther apart on an axis are not joined.
pub(super) const FAR: f32 = 1e18;
/// Nodes nearer than this on all axes are in the same place.
pub(super) const SHORT: f32 = 1e-18;

/// The way from a node to another.
#[inline]
pub(super) fn delta(from: &Node, to: &Node) -> Vec3 {
    Vec3::from(to.position) - Vec3::from(from.position)
}

/// The largest coordinate of a way.
#[inline]
pub(super) fn extent(way: Vec3) -> f32 {
    way.abs().max_element()
}

/// Whether a way leads nowhere.
#[inline]
pub(super) fn is_short(way: Vec3) -> bool {
    extent(way) < SHORT
}

/// A way, times the power of two that makes its largest coordinate 1 to 2.
#[inline]
fn scaled(way: Vec3) -> Vec3 {
    let exponent = extent(way).to_bits() >> 23;
    way * f32::from_bits((254 - exponent.clamp(1, 253)) << 23)
}

/// The direction of a way that is not short.
#[inline]
pub(super) fn direction(way: Vec3) -> Vec3 {
    let way = scaled(way);
    way / way.length()
}

/// Whether two pieces meet in the plane that halves their angle.
pub(super) fn is_mitred(a: Vec3, b: Vec3, radius: f32) -> bool {
    if is_short(a) || is_short(b) {
        return false;
    }
    let [p, q] = [a, b].map(|way| (scaled(way) * 8192.0).as_ivec3());
    let along = p.dot(q);
    if along < 0 {
        return false;
    }
    let largest = |v: IVec3| v.abs().max_element();
    let cross = (largest(p.cross(q)) >> 6) + 1025;
    let product = (largest(p) * largest(q) + along) >> 6;
    let (m, n) = (extent(a), extent(b));
    let shorter = if n < m { n } else { m };
    radius * (4 * cross) as f32 <= shorter * product as f32
}

/// Two unit vectors across a way, and across each other: with the direction they are right-handed.
///
/// The first lies across the axis on which the way is shortest.
#[inline]
pub(super) fn frame(way: Vec3, direction: Vec3) -> [Vec3; 2] {
    let size = way.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        Vec3::X
    } else if size.y <= size.z {
        Vec3::Y
    } else {
        Vec3::Z
    };
    let across = direction.cross(axis);
    let u = across / across.length();
    [u, direction.cross(u)]
}

/// An end of a piece: where its ring lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// The direction across which the corners are evenly spread.
    pub(super) axis: Vec3,
    pub(super) frame: [Vec3; 2],
    /// Corners are moved along the axis, by the product with this, into the plane of the joint.
    pub(super) lean: Vec3,
    pub(super) has_dome: bool,
}

impl End {
    /// An end across a way, with a dome.
    pub(super) fn round(way: Vec3) -> Self {
        let axis = direction(way);
        Self { axis, frame: frame(way, axis), lean: Vec3::ZERO, has_dome: true }
    }

    /// An end at a joint.
    pub(super) fn mitred(a: Vec3, b: Vec3) -> Self {
        let (axis, next) = (direction(a), direction(b));
        let lean = next / (1.0 + axis.dot(next));
        Self { axis, frame: frame(a, axis), lean, has_dome: false }
    }

    /// Where a corner lies, in radii from the node.
    #[inline]
    pub(super) fn corner(&self, turns: f32) -> Vec3 {
        let point = circle(turns);
        let e = self.frame[0] * point.x + self.frame[1] * point.y;
        e - self.axis * e.dot(self.lean)
    }
}

/// The angle of a direction in turns, 0 to 1, to about 2⁻²¹ (Cephes, `atanf`).
#[inline]
pub(super) fn turns_of(x: f32, y: f32) -> f32 {
    const EIGHTH: f32 = std::f32::consts::FRAC_PI_4;
    let (low, high) = if y.abs() < x.abs() { (y.abs(), x.abs()) } else { (x.abs(), y.abs()) };
    let ratio = if high > 0.0 { low / high } else { 0.0 };
    let is_steep = ratio > 0.414_213_57;
    let t = if is_steep { (ratio - 1.0) / (ratio + 1.0) } else { ratio };
    let square = t * t;
    let series = (((0.080_537_44 * square - 0.138_776_86) * square + 0.199_777_11) * square
        - 0.333_329_5)
        * square
        * t
        + t;
    let angle = (if is_steep { EIGHTH } else { 0.0 } + series) * std::f32::consts::FRAC_1_PI * 0.5;
    let angle = if y.abs() < x.abs() { angle } else { 0.25 - angle };
    let angle = if x < 0.0 { 0.5 - angle } else { angle };
    if y < 0.0 { 1.0 - angle } else { angle }
}
