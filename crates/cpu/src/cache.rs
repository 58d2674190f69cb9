/*!
The particle cache: which records were seen in the last picture, by brick.

They are the best guess of what the next view shows, so they are drawn first (the thesis, section
4.3). Each must be drawn exactly once. The thesis compares a pixel with its neighbors and leaves
duplicates; here the ids are sorted, after the cheap comparison has dropped most of them. The ids of a
brick are a range, so a merge with the bricks in play finds to which brick each belongs, and leaves
out those whose brick was dropped by a stage.
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
) -> Vec<(VisibleBrick, &'a [u32])> {
    let records = |brick: &VisibleBrick| &bricks[brick.index() as usize].records;
    let held = |brick: &VisibleBrick| {
        let records = records(brick);
        let start = ids.partition_point(|&id| id < records.start);
        let count = ids[start..].partition_point(|&id| id < records.end);
        (count > 0).then(|| (*brick, &ids[start..start + count]))
    };
    // A stage may have repeated a brick.
    let mut runs: Vec<(VisibleBrick, &[u32])> = visible.par_iter().filter_map(held).collect();
    runs.par_sort_unstable_by_key(|(brick, _)| (records(brick).start, brick.index()));
    runs.dedup_by_key(|(brick, _)| brick.index());
    runs
}
