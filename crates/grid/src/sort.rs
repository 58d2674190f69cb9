/*!
The in-place histogram sort: bounds, count, permute.

Counting gives each cell a run of the array. The permutation walks over the cells; where the record
at the head of a cell's unsorted rest belongs elsewhere, it is swapped to the head of the rest of the
cell where it belongs. Each swap brings one record to its final place, so there are at most as many
swaps as records. The result depends on the input alone.
*/

use crate::{Cells, Error};
use puncta_core::{Aabb, MAX_RECORDS, Record, Scene};

/// The box of all positions; every record must be one that a grid can hold.
pub(crate) fn bounds<R: Record>(records: &[R]) -> Result<Aabb, Error> {
    if records.len() > MAX_RECORDS {
        return Err(puncta_core::Error::TooManyRecords { records: records.len() }.into());
    }
    let mut bounds = Aabb::EMPTY;
    for (index, record) in records.iter().enumerate() {
        let (position, radius) = (record.position(), record.radius());
        if !position.is_finite() {
            return Err(Error::Position { index, position });
        }
        if !(0.0..f32::INFINITY).contains(&radius) {
            return Err(Error::Radius { index, radius });
        }
        bounds.add(position);
    }
    Ok(bounds)
}

/// The number of records in each cell.
pub(crate) fn count<R: Record>(records: &[R], cells: &Cells) -> Vec<u32> {
    let mut counts = vec![0; cells.count()];
    for record in records {
        counts[cells.index(record.position())] += 1;
    }
    counts
}

/// Records that can change places.
pub(crate) trait Swap<R> {
    fn record(&self, index: usize) -> &R;
    fn swap(&mut self, a: usize, b: usize);
}

impl<R> Swap<R> for [R] {
    fn record(&self, index: usize) -> &R {
        &self[index]
    }

    fn swap(&mut self, a: usize, b: usize) {
        <[R]>::swap(self, a, b);
    }
}

impl<R: Record> Swap<R> for Scene<R> {
    fn record(&self, index: usize) -> &R {
        &self.records[index]
    }

    fn swap(&mut self, a: usize, b: usize) {
        Self::swap(self, a, b);
    }
}

/// Puts records in the order of their cells, of which `counts` tells the sizes.
pub(crate) fn permute<R, S: Swap<R> + ?Sized>(
    records: &mut S,
    counts: &[u32],
    cell: impl Fn(&R) -> usize,
) {
    let starts = counts.iter().scan(0_u32, |start, &count| {
        let this = *start;
        *start += count;
        Some(this)
    });
    let mut heads: Vec<u32> = starts.collect();
    let mut end = 0;
    for here in 0..counts.len() {
        end += counts[here];
        while heads[here] < end {
            let head = heads[here];
            let there = cell(records.record(head as usize));
            if there != here {
                records.swap(head as usize, heads[there] as usize);
            }
            heads[there] += 1;
        }
    }
}
