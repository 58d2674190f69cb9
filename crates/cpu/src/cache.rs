/*!
The particle cache: which records were seen in the last picture, by brick.

They are the best guess of what the next view shows, so they are drawn first (the thesis, section
4.3). Each must be drawn exactly once. The thesis compares a pixel with its neighbors and leaves
duplicates; here the ids are sorted, after the cheap comparison has dropped most of them. Grids keep
bricks in the order of their records, so a walk through both finds the brick of each id; what is not
found, in bricks of a user's own order, is drawn later with its brick. Records of bricks that a stage
dropped are left out.
*/

use puncta_core::{Brick, NO_RECORD, VisibleBrick};
use rayon::prelude::*;

/// The ids in a picture, each once, ascending.
pub(crate) fn visible(ids: &[u32]) -> Vec<u32> {
    let mut found: Vec<u32> = ids
        .par_chunks(1 << 14)
        .flat_map_iter(|ids| {
            let mut last = NO_RECORD;
            ids.iter().copied().filter(move |&id| {
                let is_new = id != NO_RECORD && id != last;
                last = id;
                is_new
            })
        })
        .collect();
    found.par_sort_unstable();
    found.dedup();
    found
}

/// The bricks in play that hold any of these ids, which ascend, and which of them.
pub(crate) fn runs<'a>(
    ids: &'a [u32],
    bricks: &[Brick],
    visible: &[VisibleBrick],
) -> Vec<(u32, &'a [u32])> {
    let mut is_in_play = vec![false; bricks.len()];
    for brick in visible {
        is_in_play[brick.index() as usize] = true;
    }
    let (mut runs, mut rest, mut from) = (Vec::new(), ids, 0);
    while let Some(&id) = rest.first() {
        from += gallop(&bricks[from..], |brick| brick.records.end <= id);
        let Some(brick) = bricks.get(from) else { break };
        rest = &rest[gallop(rest, |&id| id < brick.records.start)..];
        let (now, later) = rest.split_at(gallop(rest, |&id| id < brick.records.end));
        if is_in_play[from] && !now.is_empty() {
            runs.push((u32::try_from(from).unwrap_or(u32::MAX), now));
        }
        rest = later;
    }
    runs
}

/// How many of the first items a condition holds for, found in steps that grow.
fn gallop<T>(items: &[T], is_before: impl Fn(&T) -> bool) -> usize {
    let mut step = 1;
    while step <= items.len() && is_before(&items[step - 1]) {
        step *= 2;
    }
    let start = step / 2;
    let end = step.min(items.len());
    start + items[start..end].partition_point(is_before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use puncta_core::{Aabb, View, Visible};

    fn brick(records: std::ops::Range<u32>) -> Brick {
        Brick { records, bounds: Aabb::EMPTY, radius_max: 0.0, density: 0.0 }
    }

    #[test]
    fn each_id_is_there_once() {
        let ids: Vec<u32> = (0..200_000_u32).map(|i| i.wrapping_mul(7) % 1000 + i % 2).collect();
        let mut expected = ids.clone();
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(visible(&ids), expected);
        assert_eq!(visible(&[NO_RECORD; 5]), []);
        assert_eq!(visible(&[3, NO_RECORD, 3, 1, NO_RECORD]), [1, 3]);
    }

    #[test]
    fn ids_are_found_in_their_bricks() {
        let bricks: Vec<Brick> = (0..50).map(|i| brick(i * 10..i * 10 + 8)).collect();
        let view = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y).unwrap();
        let mut visible = Visible::all(&bricks, glam::DVec3::ZERO, &view);
        visible.bricks.retain(|brick| brick.index() % 3 != 0);
        visible.bricks.reverse();
        // Some lie between bricks, some beyond the last.
        let ids: Vec<u32> = (0..600).filter(|id| id % 7 < 3).collect();
        let mut expected: Vec<(u32, Vec<u32>)> = Vec::new();
        for index in (0..50).filter(|index| index % 3 != 0) {
            let range = &bricks[index as usize].records;
            let held: Vec<u32> = ids.iter().copied().filter(|id| range.contains(id)).collect();
            expected.extend((!held.is_empty()).then_some((index, held)));
        }
        let found = runs(&ids, &bricks, &visible.bricks);
        let found: Vec<(u32, Vec<u32>)> = found.iter().map(|(i, run)| (*i, run.to_vec())).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn bricks_in_any_order_do_no_harm() {
        let bricks = [brick(20..30), brick(0..10), brick(10..20), brick(5..25)];
        let view = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y).unwrap();
        let visible = Visible::all(&bricks, glam::DVec3::ZERO, &view);
        let ids: Vec<u32> = (0..40).collect();
        for (index, run) in runs(&ids, &bricks, &visible.bricks) {
            let records = &bricks[index as usize].records;
            assert!(run.iter().all(|id| records.contains(id)), "{index} {run:?}");
        }
    }
}
