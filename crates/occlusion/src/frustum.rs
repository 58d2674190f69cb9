/*!
Culling against the planes of the view.

A record can be seen only if some point of its ball lies on the inner side of each side plane of the
view and not in front of the near plane; there is no far plane. All balls of a brick lie in its box
grown by the largest radius. For a plane with unit normal `n` through the eye, the largest signed
distance of a point of the box with centre `c` and half sides `h` is `n.c + |n|.h`; the box grown by
the ball is outside if that is less than `-r`. This test is exact for each plane. In the same way all
of the box lies inside if the smallest signed distance is more than `r`.

Whole blocks of bricks are looked at first: only those that a plane cuts are opened. The four side
planes are tested at once, in the lanes of a vector. For the near plane there are the bounds of the
view depth that each brick in play carries.

The planes are those of the picture's edges, half a pixel outside of the outermost rays. Everything
is done in `f64` relative to the eye. What remains of rounding is covered by a slack of a few units
in the last place of the largest term, so that no brick is dropped that can be seen.
*/

use glam::DVec3;
use puncta_core::{Aabb, Block, Bricks, Frame, Projection, Stage, View, Visible};
use wide::f64x4;

/// Drops the bricks that lie outside of the view.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrustumCull;

/// Where a box lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Inside,
    Across,
    Outside,
}

impl<G: Bricks + ?Sized> Stage<G> for FrustumCull {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        let sides = Sides::new(frame.view, frame.origin);
        let (bricks, blocks) = (frame.bricks.bricks(), frame.bricks.blocks());
        let place = |block: &Block| sides.place(&block.bounds, block.radius_max);
        let places: Vec<Place> = blocks.iter().map(place).collect();
        let mut cursor = Cursor { blocks, at: 0 };
        visible.bricks.retain(|brick| {
            if f64::from(brick.far()) < frame.view.near() {
                return false;
            }
            match cursor.find(brick.index()).map(|block| places[block]) {
                Some(Place::Inside) => true,
                Some(Place::Outside) => false,
                Some(Place::Across) | None => {
                    let brick = bricks.get(brick.index() as usize);
                    brick.is_some_and(|b| sides.place(&b.bounds, b.radius_max) != Place::Outside)
                }
            }
        });
    }
}

/// Finds the blocks of bricks, quickly if they are asked for in their order.
struct Cursor<'a> {
    blocks: &'a [Block],
    at: usize,
}

impl Cursor<'_> {
    #[inline]
    fn find(&mut self, brick: u32) -> Option<usize> {
        let holds = |at: usize| self.blocks.get(at).is_some_and(|b| b.bricks.contains(&brick));
        if !holds(self.at) {
            self.at = if holds(self.at + 1) {
                self.at + 1
            } else {
                self.blocks.partition_point(|block| block.bricks.end <= brick)
            };
        }
        holds(self.at).then_some(self.at)
    }
}

/// The four side planes, in lanes: the points `p`, relative to the eye, with
/// `normal.p + distance >= 0` lie inside.
struct Sides {
    normal: [f64x4; 3],
    reaching: [f64x4; 3],
    distance: f64x4,
    to_origin: DVec3,
    /// The sizes of what is the same in all boxes, for the slack.
    largest: f64,
}

impl Sides {
    fn new(view: &View, origin: DVec3) -> Self {
        let planes = planes(view);
        let lanes = |value: fn(&(DVec3, f64)) -> f64| {
            let [a, b, c, d] = &planes;
            f64x4::new([value(a), value(b), value(c), value(d)])
        };
        let normal = [lanes(|p| p.0.x), lanes(|p| p.0.y), lanes(|p| p.0.z)];
        let to_origin = origin - view.eye();
        Self {
            normal,
            reaching: normal.map(f64x4::abs),
            distance: lanes(|p| p.1),
            to_origin,
            largest: to_origin.length() + planes.iter().map(|p| p.1.abs()).fold(0.0, f64::max),
        }
    }

    #[inline]
    fn place(&self, bounds: &Aabb, radius: f32) -> Place {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        let center = self.to_origin + (min + half);
        let radius = f64::from(radius);
        let dot = |a: &[f64x4; 3], b: DVec3| {
            a[0] * f64x4::splat(b.x) + a[1] * f64x4::splat(b.y) + a[2] * f64x4::splat(b.z)
        };
        let middle = dot(&self.normal, center) + self.distance;
        let reach = dot(&self.reaching, half) + f64x4::splat(radius);
        // The sum of the coordinates is at least the length.
        let sizes = self.largest + center.abs().element_sum() + half.element_sum() + radius;
        let slack = f64x4::splat(16.0 * f64::EPSILON * sizes);
        // A box beyond all numbers, which makes NaN, is neither inside nor outside.
        if (middle + reach).simd_lt(-slack).to_bitmask() != 0 {
            Place::Outside
        } else if (middle - reach).simd_gt(slack).to_bitmask() == 0b1111 {
            Place::Inside
        } else {
            Place::Across
        }
    }
}

/// The unit normals and distances of the four side planes.
fn planes(view: &View) -> [(DVec3, f64); 4] {
    let half_height = view.pixel_size() * f64::from(view.height()) * 0.5;
    let half_width = view.pixel_size() * f64::from(view.width()) * 0.5;
    let (right, up, forward) = (view.right(), view.up(), view.forward());
    let side = |outward: DVec3, half: f64| match view.projection() {
        Projection::Perspective { .. } => ((forward * half - outward) / half.hypot(1.0), 0.0),
        Projection::Orthographic { .. } => (-outward, half),
    };
    [
        side(right, half_width),
        side(-right, half_width),
        side(up, half_height),
        side(-up, half_height),
    ]
}
