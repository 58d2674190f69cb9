/*!
Bricks, and the working list of a frame.

A brick in play carries bounds of its view depths in `f32`, rounded outwards. Stages reorder and drop
bricks but cannot make any, so a renderer can trust what it reads there: to skip what is hidden it
must know in front of which depth a brick has no surface.
*/

use crate::{Aabb, Bounds, View};
use glam::DVec3;
use std::ops::Range;

/// A run of neighboring records and what is known about them all.
///
/// Renderers trust the box and the radius: a record that is larger, or lies elsewhere, may be missing
/// from the picture. What is larger than need be costs time only.
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

/// A run of neighboring bricks, which are looked at together first.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The bricks, as indices.
    pub bricks: Range<u32>,
    /// The smallest box around the positions of all their records.
    pub bounds: Aabb,
    /// The largest radius among them.
    pub radius_max: f32,
}

impl Block {
    /// How many bricks [`Block::of_runs`] takes together.
    pub const RUN: usize = 64;

    /// The block of a run of bricks, which starts with the brick `first`.
    #[must_use]
    pub fn of_run(first: u32, run: &[Brick]) -> Self {
        let empty = Self { bricks: first..first, bounds: Aabb::EMPTY, radius_max: 0.0 };
        run.iter().fold(empty, |mut block, brick| {
            block.bricks.end = block.bricks.end.saturating_add(1);
            // Not by points: the corners of an empty box lie beyond all others.
            block.bounds.min = block.bounds.min.min(brick.bounds.min);
            block.bounds.max = block.bounds.max.max(brick.bounds.max);
            block.radius_max = block.radius_max.max(brick.radius_max);
            block
        })
    }

    /// Blocks of [`Block::RUN`] bricks each; good if bricks that are near in their order are near in
    /// space.
    #[must_use]
    pub fn of_runs(bricks: &[Brick]) -> Vec<Self> {
        let starts = (0_u32..).step_by(Self::RUN);
        bricks.chunks(Self::RUN).zip(starts).map(|(run, first)| Self::of_run(first, run)).collect()
    }
}

/// What holds bricks: a grid, a list, or a spatial structure of the user's own.
///
/// Bricks may lie in any order, share records, and be empty. A record that is in no brick is not drawn.
pub trait Bricks {
    /// All bricks.
    fn bricks(&self) -> &[Brick];

    /// Blocks of bricks, ascending and without overlap. The box and radius of each must hold those of
    /// its bricks. Bricks that are in no block are looked at one by one.
    fn blocks(&self) -> &[Block] {
        &[]
    }
}

impl Bricks for [Brick] {
    fn bricks(&self) -> &[Brick] {
        self
    }
}

impl<const N: usize> Bricks for [Brick; N] {
    fn bricks(&self) -> &[Brick] {
        self
    }
}

impl Bricks for Vec<Brick> {
    fn bricks(&self) -> &[Brick] {
        self
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
    index: u32,
    near: f32,
    far: f32,
    gain: f32,
}

impl VisibleBrick {
    /// Which brick.
    #[must_use]
    #[inline]
    pub const fn index(&self) -> u32 {
        self.index
    }

    /// A view depth in front of which the brick has no surface.
    #[must_use]
    #[inline]
    pub const fn near(&self) -> f32 {
        self.near
    }

    /// A view depth behind which the brick has no surface.
    #[must_use]
    #[inline]
    pub const fn far(&self) -> f32 {
        self.far
    }

    /// Whether it can still change any pixel, as far as anybody has looked.
    #[must_use]
    #[inline]
    pub const fn is_open(&self) -> bool {
        self.gain != 0.0
    }

    /// How much of the picture it may be expected to change, in pixels: those where there is nothing
    /// yet count fully, others by how far the brick reaches in front of what is there, and at most
    /// half. 0 if it can change none; +inf while nobody has looked.
    #[must_use]
    #[inline]
    pub const fn gain(&self) -> f32 {
        self.gain
    }

    /// Notes how much it may be expected to change, in pixels: 0 only if that it can change none is
    /// certain.
    pub const fn set_gain(&mut self, pixels: f32) {
        self.gain = pixels;
    }
}

impl Visible {
    /// All bricks, with bounds of their view depths.
    #[must_use]
    pub fn all(bricks: &[Brick], origin: DVec3, view: &View) -> Self {
        let mut visible = Self::default();
        visible.refill(bricks, origin, view);
        visible
    }

    /// Makes this the list of [`Visible::all`], in the memory that it has.
    pub fn refill(&mut self, bricks: &[Brick], origin: DVec3, view: &View) {
        let to_origin = origin - view.eye();
        let (forward, base) = (view.forward(), view.forward().dot(to_origin));
        let distance = to_origin.abs().element_sum();
        let place = |(index, brick): (u32, &Brick)| {
            let (a, b) =
                (forward * brick.bounds.min.as_dvec3(), forward * brick.bounds.max.as_dvec3());
            let (x, y, z) = (ordered(a.x, b.x), ordered(a.y, b.y), ordered(a.z, b.z));
            let radius = f64::from(brick.radius_max);
            let size = |[low, high]: [f64; 2]| if -low > high { -low } else { high };
            // Twice the rounding of the terms below, so that the bounds hold.
            let slack = 8.0 * f64::EPSILON * (distance + size(x) + size(y) + size(z) + radius);
            let near = base + (x[0] + y[0] + z[0]) - (radius + slack);
            let far = base + (x[1] + y[1] + z[1]) + (radius + slack);
            VisibleBrick { index, near: below(near), far: -below(-far), gain: f32::INFINITY }
        };
        self.bricks.clear();
        self.bricks.extend((0_u32..).zip(bricks).map(place));
    }
}

/// Two numbers in ascending order; of a number and NaN, which comes of an infinite side across the line
/// of sight, twice the number.
#[inline]
fn ordered(a: f64, b: f64) -> [f64; 2] {
    let b = if b.is_nan() { a } else { b };
    [if a < b { a } else { b }, if a > b { a } else { b }]
}

/// An `f32` that is not above a number, and at most two units in the last place below it; that below
/// all numbers for NaN.
///
/// Which way a number is rounded is as good as random, so there is no branch for it.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
fn below(x: f64) -> f32 {
    const UNIT: f64 = f32::EPSILON as f64;
    // More than half a unit, even where numbers are no longer normal.
    let rounded = (x - x.abs() * UNIT - 1.5e-45) as f32;
    if rounded <= f32::MAX {
        rounded
    } else if rounded.is_nan() {
        f32::NEG_INFINITY
    } else {
        f32::MAX
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
        let (near, far) = (f64::from(visible.near()), f64::from(visible.far()));
        for corner in bounds.to_world(origin, 0.0).corners() {
            let depth = view.to_camera(corner - eye).z;
            assert!(near <= depth - 0.25 && depth + 0.25 <= far);
        }
        assert!(far - near < 2.0 * (bounds.max - bounds.min).length() as f64);
    }

    #[test]
    fn infinite_boxes_may_be_anywhere() {
        let view = View::look_at(DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
        let bounds = |bounds: Aabb| {
            let brick = Brick { records: 0..0, bounds, radius_max: 1.0, density: 0.0 };
            let visible = Visible::all(&[brick], DVec3::ZERO, &view).bricks[0];
            [visible.near(), visible.far()]
        };
        let everywhere = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        assert_eq!(bounds(everywhere), [f32::NEG_INFINITY, f32::INFINITY]);
        // Across the line of sight: its depth is known, or taken to be anything.
        for (low, high) in [(f32::NEG_INFINITY, 5.0), (5.0, f32::INFINITY)] {
            let sheet = Aabb { min: Vec3::new(2.0, low, 0.0), max: Vec3::new(3.0, high, 0.0) };
            let [near, far] = bounds(sheet);
            assert!(near <= 1.0 && far >= 4.0, "{near} {far}");
        }
    }

    #[test]
    fn depth_bounds_are_rounded_outwards() {
        for x in [0.1, -0.1, 1e300, -1e300, 1e-300, -1e-300, f64::INFINITY, 1.0, 0.0] {
            assert!(f64::from(below(x)) <= x, "{x}");
            assert!(f64::from(below(x).next_up().next_up()) >= x || x > 1e299, "{x}");
        }
        assert_eq!(below(1e300), f32::MAX);
        assert_eq!(below(f64::NAN), f32::NEG_INFINITY);
    }

    #[test]
    fn blocks_hold_their_bricks() {
        let brick = |i: u8| {
            let at = Vec3::splat(f32::from(i));
            let bounds = Aabb { min: at, max: at + 1.0 };
            Brick { records: 0..0, bounds, radius_max: f32::from(i % 7), density: 0.0 }
        };
        let bricks: Vec<Brick> = (0..150).map(brick).collect();
        let blocks = Block::of_runs(&bricks);
        assert_eq!(
            blocks.iter().map(|b| b.bricks.clone()).collect::<Vec<_>>(),
            [0..64, 64..128, 128..150]
        );
        assert_eq!(blocks[1].bounds, Aabb { min: Vec3::splat(64.0), max: Vec3::splat(128.0) });
        assert_eq!(blocks[1].radius_max, 6.0);
        // Empty ones do not stretch a block.
        let mut run = bricks[64..128].to_vec();
        run.push(Brick { bounds: Aabb::EMPTY, ..brick(0) });
        assert_eq!(Block::of_run(64, &run).bounds, blocks[1].bounds);
    }
}
