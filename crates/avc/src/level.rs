/*!
Whose nearest point decides how finely a record is drawn.

All records of a brick are drawn as finely as the nearest point of the brick needs: so a level is one
number a brick, and a GPU can have it at hand. But a brick that is nearer to the eye than its own size
holds records whose distances differ by more than a factor of three, and one that holds the eye has no
distance at all. The records of such bricks, which are few, have levels of their own.
*/

use crate::{Cloud, Glyph, Lens};
use puncta_core::{Bounder, Brick, Camera, depth_below, nearest_depth};
use std::collections::BTreeSet;

/// By how much a ball is larger than what it holds: more than rounding.
const AROUND: f64 = 1.00001;

/// Glyphs whose ball holds the eye are drawn as finely as if they were this share of its radius away:
/// nobody knows how near their surface is, and the near plane may be as near as nothing. So what is nearer
/// than that may be coarser than the tolerance.
const NEAR_SHARE: f64 = 1.0 / 256.0;

/// Whose nearest point decides how finely a record is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// That of its brick, which begins at this view depth.
    Brick(f32),
    /// Its own.
    Record,
}

impl Level {
    /// That of the records of a brick, which begins at the view depth `nearest` of its
    /// [`ScreenBound`](puncta_core::ScreenBound).
    #[must_use]
    pub fn of(brick: &Brick, nearest: f32) -> Self {
        let size = (brick.bounds.max - brick.bounds.min).as_dvec3().length();
        let size = size + 2.0 * f64::from(brick.radius_max);
        // Written so that NaN is near.
        if f64::from(nearest) * 2.0 >= size { Self::Brick(nearest) } else { Self::Record }
    }
}

impl Lens<'_> {
    /// The view depth by which a record is drawn: see [`Sight::nearest`](crate::Sight::nearest).
    #[must_use]
    #[inline]
    pub fn nearest<G: Glyph>(&self, level: Level, cloud: &Cloud<'_, G>, index: usize) -> f32 {
        match level {
            Level::Brick(nearest) => nearest,
            Level::Record => {
                let (center, radius) = G::ball(cloud, index);
                let center = self.camera.place(center.as_dvec3());
                let radius = f64::from(radius);
                let depth = nearest_depth(center.z, radius * AROUND).max(radius * NEAR_SHARE);
                depth_below(depth.max(self.camera.near() * (1.0 - 1e-6)))
            }
        }
    }
}

/// The levels of the records of a scene.
#[derive(Clone, Debug)]
pub struct Levels<'a> {
    bounder: Bounder<'a>,
    bricks: &'a [Brick],
    /// Where another brick is the first one that holds a record, and which; `None` if bricks ascend
    /// and share nothing.
    turns: Option<Vec<(u32, Option<u32>)>>,
}

impl<'a> Levels<'a> {
    /// Of a scene that is cut into these bricks.
    #[must_use]
    pub fn new(camera: &'a Camera, bricks: &'a [Brick]) -> Self {
        let is_sound = |brick: &Brick| brick.records.start <= brick.records.end;
        let ascends = bricks.iter().all(is_sound)
            && bricks.windows(2).all(|pair| pair[0].records.end <= pair[1].records.start);
        let turns = (!ascends).then(|| turns(bricks));
        Self { bounder: Bounder::new(camera), bricks, turns }
    }

    /// The level of a record: that of the first brick that holds it, its own if there is none.
    #[must_use]
    pub fn of(&self, record: u32) -> Level {
        let brick = match &self.turns {
            None => {
                let at = self.bricks.partition_point(|brick| brick.records.end <= record);
                self.bricks.get(at).filter(|brick| brick.records.start <= record)
            }
            Some(turns) => {
                let after = turns.partition_point(|(from, _)| *from <= record);
                let turn = after.checked_sub(1).and_then(|at| turns.get(at));
                turn.and_then(|(_, brick)| self.bricks.get((*brick)? as usize))
            }
        };
        brick.map_or(Level::Record, |brick| {
            Level::of(brick, self.bounder.bound(&brick.bounds, brick.radius_max).nearest)
        })
    }
}

/// The records from which on another brick is the first that holds them.
fn turns(bricks: &[Brick]) -> Vec<(u32, Option<u32>)> {
    let mut ends: Vec<(u32, u32, bool)> = Vec::new();
    for (index, brick) in (0_u32..).zip(bricks) {
        let (start, end) = (brick.records.start, brick.records.end);
        if start < end {
            ends.extend([(start, index, true), (end, index, false)]);
        }
    }
    ends.sort_unstable();
    let mut holders = BTreeSet::new();
    let same_place = ends.chunk_by(|a, b| a.0 == b.0);
    same_place
        .map(|ends| {
            for &(_, index, is_start) in ends {
                if is_start {
                    holders.insert(index);
                } else {
                    holders.remove(&index);
                }
            }
            (ends[0].0, holders.first().copied())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use proptest::prelude::*;
    use puncta_core::{Aabb, View};

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        /// It is the first brick that holds a record, whatever their order.
        #[test]
        fn the_first_brick_that_holds_a_record_counts(
            mut ranges in prop::collection::vec((0_u32..40, 0_u32..12), 0..12),
            is_sorted in any::<bool>(),
        ) {
            if is_sorted {
                let mut from = 0;
                for (start, length) in &mut ranges {
                    *start = from + *start % 4;
                    from = *start + *length;
                }
            }
            let brick = |(index, &(start, length)): (usize, &(u32, u32))| {
                let at = Vec3::new(0.0, 0.0, -(index as f32));
                let bounds = Aabb { min: at, max: at };
                Brick { records: start..start + length, bounds, radius_max: 0.1, density: 0.0 }
            };
            let bricks: Vec<Brick> = ranges.iter().enumerate().map(brick).collect();
            let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
            let camera = Camera::new(&view, DVec3::ZERO);
            let levels = Levels::new(&camera, &bricks);
            prop_assert!(!is_sorted || levels.turns.is_none());
            for id in 0..60 {
                let first = bricks.iter().find(|brick| brick.records.contains(&id));
                let expected = first.map_or(Level::Record, |brick| {
                    let bound = Bounder::new(&camera).bound(&brick.bounds, brick.radius_max);
                    Level::of(brick, bound.nearest)
                });
                prop_assert_eq!(levels.of(id), expected);
            }
        }
    }
}
