/*!
Framing: the place from which a box, balls, or the records of a scene fill the picture.

`frame.rs` has the geometry. Here is what is framed, and the view that comes of it.
*/

use super::{NEAR_SHARE, Projection, View};
use crate::{
    Bounds, Brick, Record, Scene,
    frame::{Frame, Group},
};
use glam::{DVec2, DVec3};

/// The share of the picture that a fitted scene fills.
const FIT_SHARE: f64 = 0.95;

impl View {
    /// The same direction from a place where the whole box is seen; nothing changes if it is empty.
    ///
    /// An orthographic view gets a new height; the near plane is set as in [`View::look_at`].
    #[must_use]
    pub fn fitted(self, bounds: &Bounds) -> Self {
        if bounds.is_empty() {
            return self;
        }
        self.framing(bounds.corners().into_iter().map(|corner| (corner, 0.0)))
    }

    /// As [`View::fitted`], for balls in world coordinates. Those that are not finite do not count.
    ///
    /// The balls touch a margin of the picture at two opposite sides, and lie in the middle of the
    /// other two, or nearly so.
    #[must_use]
    pub fn framing<I>(self, balls: I) -> Self
    where
        I: IntoIterator<Item = (DVec3, f64)>,
        I::IntoIter: Clone,
    {
        let finite = |(center, radius): &(DVec3, f64)| center.is_finite() && radius.is_finite();
        let balls = balls.into_iter().filter(finite);
        // A place among them that does not depend on their order.
        let Some(start) = balls.clone().map(|(center, _)| center).reduce(DVec3::min) else {
            return self;
        };
        self.framing_groups(start, std::iter::once(Alone(balls)))
    }

    /// As [`View::framing`], for the records of a scene that lie within a box: the very same view,
    /// but most records are not looked at.
    ///
    /// Bricks that lie behind others need no look at their records, so a scene in a mapped file is
    /// framed without being loaded. All positions and radii must be finite, and records must lie in
    /// the boxes of their bricks.
    ///
    /// # Panics
    ///
    /// When a brick is not made of records of the scene.
    #[must_use]
    pub fn framing_bricks<R: Record>(
        self,
        scene: &Scene<R>,
        bricks: &[Brick],
        within: &Bounds,
    ) -> Self {
        let records = scene.records.as_slice();
        let group = |brick: &Brick| Inside {
            records: &records[brick.records.start as usize..brick.records.end as usize],
            centers: brick.bounds.to_world(scene.origin, 0.0),
            radius: f64::from(brick.radius_max),
            origin: scene.origin,
            within: *within,
        };
        let groups = bricks.iter().map(group);
        let mut groups: Vec<_> = groups.filter(|group| within.overlaps(&group.centers)).collect();
        let mut start = None::<DVec3>;
        for group in &groups {
            // The box of the centers touches some of them, unless it is cut by that to look at.
            if within.contains(group.centers.min) && within.contains(group.centers.max) {
                start = Some(start.map_or(group.centers.min, |at| at.min(group.centers.min)));
            } else {
                group.each(|center, _| start = Some(start.map_or(center, |at| at.min(center))));
            }
        }
        let Some(start) = start else { return self };
        // Outer ones first: most of the others lie within their frame.
        let middle = within.center();
        let outward = |group: &Inside<'_, R>| (group.centers.center() - middle).length_squared();
        groups.sort_by(|a, b| outward(b).total_cmp(&outward(a)));
        self.framing_groups(start, groups.iter())
    }

    /// As [`View::framing`], for balls in groups; `start` is a place among them.
    fn framing_groups<G: Group>(
        self,
        start: DVec3,
        groups: impl Iterator<Item = G> + Clone,
    ) -> Self {
        let aspect = f64::from(self.width) / f64::from(self.height);
        let slopes = match self.projection {
            Projection::Perspective { fov_y } => {
                (fov_y * 0.5).tan() * FIT_SHARE * DVec2::new(aspect, 1.0)
            }
            Projection::Orthographic { .. } => DVec2::ZERO,
        };
        let place = |center: DVec3| self.to_camera(center - start);
        let frame = Frame::around(groups.clone(), slopes, place);
        let mut view = self.clone();
        let (middle, distance) = match view.projection {
            Projection::Perspective { .. } => {
                let back = frame.apex();
                (frame.centered(groups, back, place), frame.depth() - back)
            }
            Projection::Orthographic { .. } => {
                let height = frame.sides().y.max(frame.sides().x / aspect) / FIT_SHARE;
                if height.is_normal() {
                    view.projection = Projection::Orthographic { height };
                }
                (frame.middle(), frame.sides().length())
            }
        };
        // Balls without extent give no scale: one unit is as good as any other.
        let distance = if distance.is_normal() && distance > 0.0 { distance } else { 1.0 };
        let back = frame.depth() - distance;
        view.eye = start + view.right * middle.x + view.up * middle.y + view.forward * back;
        view.near = (distance * NEAR_SHARE).max(f64::MIN_POSITIVE);
        // Balls beyond all numbers cannot be framed.
        if view.eye.is_finite() { view } else { self }
    }
}

/// Balls of which nothing is known together.
#[derive(Clone)]
struct Alone<I>(I);

impl<I: Iterator<Item = (DVec3, f64)> + Clone> Group for Alone<I> {
    fn hull(&self) -> Option<[(DVec3, f64); 8]> {
        None
    }

    #[inline]
    fn each(&self, mut add: impl FnMut(DVec3, f64)) {
        self.0.clone().for_each(|(center, radius)| add(center, radius));
    }
}

/// The records of a brick that lie within a box.
struct Inside<'a, R> {
    records: &'a [R],
    centers: Bounds,
    radius: f64,
    origin: DVec3,
    within: Bounds,
}

impl<R: Record> Group for &Inside<'_, R> {
    fn hull(&self) -> Option<[(DVec3, f64); 8]> {
        Some(self.centers.corners().map(|corner| (corner, self.radius)))
    }

    fn each(&self, mut add: impl FnMut(DVec3, f64)) {
        for record in self.records {
            let center = self.origin + record.position().as_dvec3();
            if self.within.contains(center) {
                add(center, f64::from(record.radius()));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aabb, Sphere};

    fn front() -> View {
        View::look_at(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, DVec3::Y).unwrap()
    }

    #[test]
    fn a_fitted_box_touches_the_margin_and_no_more() {
        let bounds = Bounds { min: DVec3::new(1.0, 2.0, 3.0), max: DVec3::new(4.0, 8.0, 5.0) };
        let wide = front().with_size(200, 100).unwrap();
        for view in [wide.clone(), wide.with_orthographic(1.0).unwrap()] {
            let view = view.orbited(DVec3::ZERO, 0.5, 0.3).fitted(&bounds);
            let half = view.pixel_size() * 50.0;
            let reach = bounds.corners().map(|corner| {
                let p = view.to_camera(corner - view.eye());
                assert!(p.z > view.near());
                let depth = if view.is_perspective() { p.z } else { 1.0 };
                (p.x.abs() / 2.0).max(p.y.abs()) / (depth * half)
            });
            let reach = reach.into_iter().fold(0.0, f64::max);
            assert!((reach - FIT_SHARE).abs() < 1e-9, "{reach}");
        }
    }

    #[test]
    fn framed_balls_lie_in_the_view_wherever_they_are() {
        let ball = |i: u32| (DVec3::new(1e7 + f64::from(i % 7), f64::from(i % 3), 5.0), 0.5);
        for view in [front(), front().with_orthographic(1.0).unwrap()] {
            let view = view.orbited(DVec3::ZERO, 1.0, 0.4).framing((0..50).map(ball));
            let half = view.pixel_size() * 512.0;
            for (center, radius) in (0..50).map(ball) {
                let p = view.to_camera(center - view.eye());
                let (slope, stretch) =
                    if view.is_perspective() { (half, half.hypot(1.0)) } else { (0.0, 1.0) };
                let room = if view.is_perspective() { slope * p.z } else { half };
                assert!(p.x.abs().max(p.y.abs()) + radius * stretch <= room);
                assert!(p.z - radius > view.near());
            }
        }
        assert_eq!(front().framing([(DVec3::NAN, 1.0)]), front());
        let point = front().framing([(DVec3::ONE, 0.0)]);
        assert_eq!(point.eye(), DVec3::new(1.0, 1.0, 2.0));
    }

    #[test]
    fn bricks_are_framed_as_their_records() {
        // Scattered, some far off, and of different sizes; neighbors are bricks.
        let coordinate = |i: u32, k: u32| (i.wrapping_mul(k) % 1009) as f32 - 504.0;
        let mut records: Vec<Sphere> = (0..4000_u32)
            .map(|i| [coordinate(i, 7919), coordinate(i, 104_729), coordinate(i, 1_299_709)])
            .zip([0.1, 3.0, 0.0, 40.0].into_iter().cycle())
            .map(|(center, radius)| Sphere::new(center, radius))
            .collect();
        let place = |sphere: &Sphere| sphere.center.map(|x| (x / 150.0).floor());
        records.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap());
        records[17].center[1] = 1e5;
        let mut scene = Scene::new(records);
        scene.origin = DVec3::new(1e6, 0.25, -3.0);
        let bricks: Vec<Brick> = (0..4000_u32)
            .step_by(20)
            .map(|start| {
                let members = &scene.records[start as usize..start as usize + 20];
                let mut bounds = Aabb::EMPTY;
                members.iter().for_each(|sphere| bounds.add(sphere.position()));
                let radius_max = members.iter().map(|sphere| sphere.radius).fold(0.0, f32::max);
                Brick { records: start..start + 20, bounds, radius_max, density: 0.0 }
            })
            .collect();
        let near = Bounds {
            min: scene.origin - DVec3::splat(300.0),
            max: scene.origin + DVec3::new(350.0, 500.5, 1e9),
        };
        let wide = front().with_size(300, 100).unwrap();
        for view in [wide.clone(), wide.with_orthographic(1.0).unwrap()] {
            for turn in [0.0, 0.4, 2.0] {
                let view = view.clone().orbited(DVec3::ZERO, turn, 0.3 - turn / 3.0);
                for within in [scene.bounds(), near] {
                    let balls =
                        (0..4000).map(|i| (scene.position(i), scene.records[i].radius.into()));
                    let framed = view.clone().framing(balls.filter(|(at, _)| within.contains(*at)));
                    assert_eq!(view.clone().framing_bricks(&scene, &bricks, &within), framed);
                }
            }
        }
        assert_eq!(front().framing_bricks(&scene, &[], &near), front());
    }
}
