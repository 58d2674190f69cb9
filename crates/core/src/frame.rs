//! The place from which balls fill a picture.

use glam::{DVec2, DVec3};

/// How far balls reach to the right, left, top and bottom of a picture, in camera coordinates.
///
/// With the slope `t` of a side plane, a ball around `p` lies inside of the plane through the eye `e`
/// if `p.x + r sqrt(1 + t²) - t p.z <= e.x - t e.z`. So the largest left side is all there is to know
/// of the balls; it is kept for each of the four sides, with slope 0 if rays are parallel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    slopes: DVec2,
    /// The largest left side for the right and top planes, and for the left and bottom planes.
    above: DVec2,
    below: DVec2,
    /// The largest and the least extent along the line of sight.
    far: f64,
    near: f64,
}

impl Frame {
    pub(crate) fn around(balls: impl Iterator<Item = (DVec3, f64)>, slopes: DVec2) -> Self {
        let stretch = (slopes * slopes + 1.0).map(f64::sqrt);
        let mut frame = Self {
            slopes,
            above: DVec2::NEG_INFINITY,
            below: DVec2::NEG_INFINITY,
            far: f64::NEG_INFINITY,
            near: f64::INFINITY,
        };
        for (center, radius) in balls {
            let inward = stretch * radius - slopes * center.z;
            frame.above = frame.above.max(inward + center.truncate());
            frame.below = frame.below.max(inward - center.truncate());
            frame.far = frame.far.max(center.z + radius);
            frame.near = frame.near.min(center.z - radius);
        }
        frame
    }

    /// The place in the middle of those from which everything is seen.
    pub(crate) fn middle(&self) -> DVec2 {
        (self.above - self.below) * 0.5
    }

    /// The depth of the middle.
    pub(crate) fn depth(&self) -> f64 {
        self.near + (self.far - self.near) * 0.5
    }

    /// The largest depth from which everything is seen.
    pub(crate) fn apex(&self) -> f64 {
        ((self.above + self.below) * -0.5 / self.slopes).min_element()
    }

    /// The place at depth `back` from which the picture lies in the middle, or nearly so.
    ///
    /// Where one pair of sides binds, the other leaves room. The eye is moved by as much as would put
    /// balls at a middling depth into the middle, as far as everything is still seen.
    pub(crate) fn centered(&self, balls: impl Iterator<Item = (DVec3, f64)>, back: f64) -> DVec2 {
        let middle = self.middle();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (center, radius) in balls {
            let depth = center.z - back;
            low = low.min((center.truncate() - middle - radius) / depth);
            high = high.max((center.truncate() - middle + radius) / depth);
        }
        let moved = middle + (low + high) * 0.5 * (self.depth() - back);
        let room = (self.above + self.slopes * back, -self.below - self.slopes * back);
        let is_seen = room.0.cmple(room.1);
        DVec2::select(is_seen & moved.cmpeq(moved), moved.max(room.0).min(room.1), middle)
    }

    /// The lengths along right, up and forward, where rays are parallel.
    pub(crate) fn sides(&self) -> DVec3 {
        (self.above + self.below).extend(self.far - self.near)
    }
}
