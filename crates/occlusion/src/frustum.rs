/*!
Culling against the planes of the view.

A record can be seen only if some point of its ball lies on the inner side of each side plane of the
view and not in front of the near plane; there is no far plane. All balls of a brick lie in its box
grown by the largest radius. For a plane with unit normal `n` through the eye, the largest signed
distance of a point of the box with centre `c` and half sides `h` is `n.c + |n|.h`; the box grown by
the ball is outside if that is less than `-r`. This test is exact for each plane.

The planes are those of the picture's edges, half a pixel outside of the outermost rays. Everything
is done in `f64` relative to the eye. What remains of rounding is covered by a slack of a few units
in the last place of the largest term, so that no brick is dropped that can be seen.
*/

use glam::DVec3;
use puncta_core::{Brick, Frame, Projection, Stage, View, Visible};

/// Drops the bricks that lie outside of the view.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrustumCull;

impl<G: AsRef<[Brick]> + ?Sized> Stage<G> for FrustumCull {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        let planes = planes(frame.view);
        let to_origin = frame.origin - frame.view.eye();
        let bricks = frame.bricks.as_ref();
        visible.bricks.retain(|brick| {
            let keeps = |brick| planes.iter().all(|plane| plane.keeps(brick, to_origin));
            bricks.get(brick.index as usize).is_some_and(keeps)
        });
    }
}

/// Half a space: the points `p`, relative to the eye, with `normal.p + distance >= 0`.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    distance: f64,
}

impl Plane {
    /// Whether some ball of the brick may reach into the half space.
    fn keeps(&self, brick: &Brick, to_origin: DVec3) -> bool {
        let (min, max) = (brick.bounds.min.as_dvec3(), brick.bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        let center = to_origin + (min + half);
        let reach = self.normal.abs().dot(half) + f64::from(brick.radius_max);
        let largest = to_origin.length() + center.length() + self.distance.abs() + reach;
        let slack = 16.0 * f64::EPSILON * largest;
        let inside = self.normal.dot(center) + self.distance + reach + slack;
        // A box beyond all numbers, which makes NaN, is kept.
        inside >= 0.0 || inside.is_nan()
    }
}

/// The four side planes and the near plane.
fn planes(view: &View) -> [Plane; 5] {
    let half_height = view.pixel_size() * f64::from(view.height()) * 0.5;
    let half_width = view.pixel_size() * f64::from(view.width()) * 0.5;
    let (right, up, forward) = (view.right(), view.up(), view.forward());
    let side = |outward: DVec3, half: f64| match view.projection() {
        Projection::Perspective { .. } => {
            let normal = (forward * half - outward) / half.hypot(1.0);
            Plane { normal, distance: 0.0 }
        }
        Projection::Orthographic { .. } => Plane { normal: -outward, distance: half },
    };
    [
        side(right, half_width),
        side(-right, half_width),
        side(up, half_height),
        side(-up, half_height),
        Plane { normal: forward, distance: -view.near() },
    ]
}
