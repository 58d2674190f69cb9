//! The place from which balls fill a picture.

use glam::{DVec2, DVec3};

/// More than rounding can amount to, relative to what is rounded.
const SLACK: f64 = 1e-9;

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

/// Balls that lie together, in world coordinates.
pub(crate) trait Group {
    /// Balls whose hull holds them all, if such are known.
    fn hull(&self) -> Option<[(DVec3, f64); 8]>;

    /// The balls themselves.
    fn each(&self, add: impl FnMut(DVec3, f64));
}

impl Frame {
    /// The frame of all balls of some groups; `place` gives camera coordinates.
    ///
    /// The balls of a group whose hull lies within the frame so far are not looked at.
    pub(crate) fn around<G: Group>(
        groups: impl Iterator<Item = G>,
        slopes: DVec2,
        place: impl Fn(DVec3) -> DVec3,
    ) -> Self {
        let stretch = (slopes * slopes + 1.0).map(f64::sqrt);
        let mut frame = Self::empty(slopes);
        for group in groups {
            if let Some(hull) = group.hull() {
                let (mut around, mut largest) = (Self::empty(slopes), 0.0_f64);
                for (center, radius) in hull {
                    let center = place(center);
                    around.add(center, radius, stretch);
                    largest = largest.max(center.abs().max_element() + radius);
                }
                if frame.holds(&around, largest * SLACK * stretch.max_element()) {
                    continue;
                }
            }
            group.each(|center, radius| frame.add(place(center), radius, stretch));
        }
        frame
    }

    /// The frame of nothing.
    fn empty(slopes: DVec2) -> Self {
        let none = DVec2::NEG_INFINITY;
        Self { slopes, above: none, below: none, far: f64::NEG_INFINITY, near: f64::INFINITY }
    }

    #[inline]
    fn add(&mut self, center: DVec3, radius: f64, stretch: DVec2) {
        let inward = stretch * radius - self.slopes * center.z;
        self.above = self.above.max(inward + center.truncate());
        self.below = self.below.max(inward - center.truncate());
        self.far = self.far.max(center.z + radius);
        self.near = self.near.min(center.z - radius);
    }

    /// Whether another frame reaches no further, not even if it were larger by `slack`.
    fn holds(&self, other: &Self, slack: f64) -> bool {
        (other.above + slack).cmple(self.above).all()
            && (other.below + slack).cmple(self.below).all()
            && other.far + slack <= self.far
            && other.near - slack >= self.near
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
    pub(crate) fn centered<G: Group>(
        &self,
        groups: impl Iterator<Item = G>,
        back: f64,
        place: impl Fn(DVec3) -> DVec3,
    ) -> DVec2 {
        let middle = self.middle();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        // The directions in which a ball is seen, and how far it is away.
        let seen = |center: DVec3, radius: f64| {
            let center = place(center);
            let (depth, aside) = (center.z - back, center.truncate() - middle);
            ((aside - radius) / depth, (aside + radius) / depth, depth)
        };
        for group in groups {
            let is_inside = |(center, radius): (DVec3, f64)| {
                let (left, right, depth) = seen(center, radius);
                let slack = SLACK * (left.abs() + right.abs() + 1.0);
                depth > SLACK * (self.far - self.near + radius)
                    && (left - slack).cmpge(low).all()
                    && (right + slack).cmple(high).all()
            };
            // Over a hull in front of the eye, quotients are largest at its corners.
            if group.hull().is_some_and(|hull| hull.into_iter().all(is_inside)) {
                continue;
            }
            group.each(|center, radius| {
                let (left, right, _) = seen(center, radius);
                (low, high) = (low.min(left), high.max(right));
            });
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
