//! Levels: how finely a record was drawn, which depends on the brick that holds it.

use puncta_core::{Bounder, Brick, Camera};
use std::collections::BTreeSet;

/// Where each record's brick begins.
#[derive(Debug)]
pub(crate) struct Levels<'a> {
    bounder: Bounder<'a>,
    bricks: &'a [Brick],
    /// Where another brick is the first one that holds a record, and which; `None` if bricks ascend
    /// and share nothing.
    turns: Option<Vec<(u32, Option<u32>)>>,
    /// For what is in no brick.
    finest: f32,
}

impl<'a> Levels<'a> {
    pub(crate) fn new(camera: &'a Camera, bricks: &'a [Brick]) -> Self {
        let is_sound = |brick: &Brick| brick.records.start <= brick.records.end;
        let ascends = bricks.iter().all(is_sound)
            && bricks.windows(2).all(|pair| pair[0].records.end <= pair[1].records.start);
        let turns = (!ascends).then(|| turns(bricks));
        let finest = puncta_core::depth_below(camera.near());
        Self { bounder: Bounder::new(camera), bricks, turns, finest }
    }

    /// The view depth at which the first brick that holds a record begins, as renderers have it.
    pub(crate) fn nearest(&self, id: u32) -> f32 {
        let brick = match &self.turns {
            None => {
                let at = self.bricks.partition_point(|brick| brick.records.end <= id);
                self.bricks.get(at).filter(|brick| brick.records.start <= id)
            }
            Some(turns) => {
                let after = turns.partition_point(|(from, _)| *from <= id);
                let turn = after.checked_sub(1).and_then(|at| turns.get(at));
                turn.and_then(|(_, brick)| self.bricks.get((*brick)? as usize))
            }
        };
        brick.map_or(self.finest, |brick| {
            self.bounder.bound(&brick.bounds, brick.radius_max).nearest
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
                let expected = first.map_or(levels.finest, |brick| {
                    Bounder::new(&camera).bound(&brick.bounds, brick.radius_max).nearest
                });
                prop_assert_eq!(levels.nearest(id), expected);
            }
        }
    }
}
