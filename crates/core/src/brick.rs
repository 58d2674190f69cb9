//! Bricks, and the working list of a frame.

use crate::{Aabb, Bounds, View};
use glam::DVec3;
use std::ops::Range;

/// A run of neighboring records and what is known about them all.
#[derive(Clone, Debug, PartialEq)]
pub struct Brick {
    /// The records, as indices into those of the scene.
    pub records: Range<u32>,
    /// The smallest box around their positions.
    pub bounds: Aabb,
    /// The largest radius among them.
    pub radius_max: f32,
    /// The sum of the volumes of balls of their radii, divided by the volume of the brick's cell,
    /// each side of which counts as at least one diameter and as long as that of the box; 0 where
    /// that is no number.
    pub density: f32,
}

impl Brick {
    /// The world box that holds all records of the brick, radii included.
    #[must_use]
    pub fn world_bounds(&self, origin: DVec3) -> Bounds {
        self.bounds.to_world(origin, self.radius_max)
    }
}

/// The bricks still in play for a frame, in the order in which they are to be drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Visible {
    /// The bricks in play.
    pub bricks: Vec<VisibleBrick>,
}

/// A brick in play.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleBrick {
    /// Which brick.
    pub index: u32,
    /// A view depth in front of which the brick has no surface.
    pub near: f64,
    /// A view depth behind which the brick has no surface.
    pub far: f64,
}

impl Visible {
    /// All bricks, with bounds of their view depths.
    #[must_use]
    pub fn all(bricks: &[Brick], origin: DVec3, view: &View) -> Self {
        let to_origin = origin - view.eye();
        let bricks = (0_u32..).zip(bricks).map(|(index, brick)| {
            let (min, max) = (brick.bounds.min.as_dvec3(), brick.bounds.max.as_dvec3());
            let half = (max - min) * 0.5;
            let middle = view.forward().dot(to_origin + (min + half));
            let reach = view.forward().abs().dot(half) + f64::from(brick.radius_max);
            // Twice the rounding of the terms above, so that the bounds hold.
            let slack = 8.0 * f64::EPSILON * (to_origin.length() + middle.abs() + reach);
            VisibleBrick { index, near: middle - reach - slack, far: middle + reach + slack }
        });
        Self { bricks: bricks.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn depth_bounds_hold_the_grown_box() {
        let bounds = Aabb { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(1.0, 3.0, 2.5) };
        let brick = Brick { records: 0..1, bounds, radius_max: 0.25, density: 0.0 };
        let origin = DVec3::new(1e7, -1e7, 1e7);
        let eye = origin + DVec3::new(5.0, 4.0, -8.0);
        let view = View::look_at(eye, origin, DVec3::Y).unwrap();
        let visible = Visible::all(std::slice::from_ref(&brick), origin, &view).bricks[0];
        for corner in bounds.to_world(origin, 0.0).corners() {
            let depth = view.to_camera(corner - eye).z;
            assert!(visible.near <= depth - 0.25 && depth + 0.25 <= visible.far);
        }
        assert!(visible.far - visible.near < 2.0 * (bounds.max - bounds.min).length() as f64);
    }
}
