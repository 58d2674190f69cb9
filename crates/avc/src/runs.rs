//! Bricks of records that must keep their order.

use crate::{Cloud, Glyph};
use puncta_core::{Aabb, Block, Brick, Bricks};
use rayon::prelude::*;
use std::ops::Range;

/// Bricks of records that lie one after the other, for glyphs that look at their neighbors.
///
/// Boxes and radii come from [`Glyph::ball`]: so they depend on the style and the table, and must be
/// made anew when these change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Runs {
    bricks: Vec<Brick>,
    blocks: Vec<Block>,
}

impl Runs {
    /// How many records a brick has at most in [`Runs::new`].
    pub const LENGTH: usize = 64;

    /// Bricks of [`Runs::LENGTH`] records each.
    #[must_use]
    pub fn new<G: Glyph>(cloud: &Cloud<'_, G>) -> Self {
        Self::with_length(cloud, Self::LENGTH)
    }

    /// Bricks of this many records each, at least one. Records whose ball is not finite are not drawn,
    /// and boxes do not hold them. Records from number 2³² on are in no brick.
    #[must_use]
    pub fn with_length<G: Glyph>(cloud: &Cloud<'_, G>, length: usize) -> Self {
        let length = u32::try_from(length).unwrap_or(u32::MAX).max(1);
        let count = u32::try_from(cloud.records.len()).unwrap_or(u32::MAX);
        let brick = |run: u32| {
            let start = run * length;
            brick(cloud, start..start.saturating_add(length).min(count))
        };
        let bricks: Vec<Brick> = (0..count.div_ceil(length)).into_par_iter().map(brick).collect();
        let blocks = Block::of_runs(&bricks);
        Self { bricks, blocks }
    }
}

impl Bricks for Runs {
    fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}

fn brick<G: Glyph>(cloud: &Cloud<'_, G>, records: Range<u32>) -> Brick {
    let (mut bounds, mut radius_max, mut volume) = (Aabb::EMPTY, 0.0_f32, 0.0);
    for index in records.clone() {
        let index = index as usize;
        let position = cloud.get(index).position();
        let (center, radius) = G::ball(cloud, index);
        if position.is_finite() && center.is_finite() && radius.is_finite() {
            bounds.add(position);
            bounds.add(center);
            radius_max = radius_max.max(radius);
            volume += f64::from(radius).powi(3) * (std::f64::consts::PI * 4.0 / 3.0);
        }
    }
    let least = f64::from(radius_max) * 2.0;
    let sides = (bounds.max - bounds.min).as_dvec3().max(glam::DVec3::splat(least));
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
    let density = (volume / sides.element_product()) as f32;
    Brick { records, bounds, radius_max, density: if density.is_finite() { density } else { 0.0 } }
}
