/*!
The sort: partition into buckets in place, then each bucket into bricks, within the cache.

The floor is the memory: every record must be read once to be counted, read and written once to get
into its bucket, and once more to get from there into its brick. What lies between is done on records
that are in the cache.
*/

use crate::{
    Cells, census,
    codes::Layout,
    leaf::{Bricks, How, Leaf, Scratch},
    partition::partition,
    rows::Rows,
};
use puncta_core::Record;
use std::{
    collections::BTreeMap,
    ops::Range,
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Buckets of more rows than this are split by all threads together.
const SHARED_ROWS: usize = 1 << 20;

/// How many bytes a row needs in the buffers beside its record.
const SCRATCH_BYTES: usize = 24;

/// The largest number of buckets a partition is made of, as a power of two: more would not fit the
/// translation buffers of processors.
const BUCKETS_MAX: u32 = 11;

/// Sorts rows into bricks; `counts` tells how many there are in each block.
pub(crate) fn sort<R: Record>(mut rows: Rows<'_, R>, how: How, counts: &[u32]) -> Bricks {
    let mut buckets = Vec::new();
    let bits = how.layout.bits() - how.layout.block_bits();
    Split { counts, base: 0, bits }.run(&mut rows, how, &mut buckets);
    finish(rows, how, buckets)
}

/// How many rows a bucket may have to be sorted in the cache: what is best, and what is the most.
///
/// The buffers of a thread are as large as a bucket. So these numbers must not be larger than the
/// bricks justify. They do not depend on the number of threads: the order of rows depends on them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafRows {
    best: usize,
    most: usize,
}

impl LeafRows {
    pub(crate) fn new<R>(cells: &Cells, records: usize) -> Self {
        // What stays in a cache of 2 MiB beside the rows themselves, and what still nearly does.
        let (best, most) = (3 << 19, 5 << 19);
        let bytes = cells.count().min(records).saturating_mul(32).saturating_add(96 << 10);
        let rows = |bytes: usize| (bytes / (size_of::<R>() + SCRATCH_BYTES)).max(64);
        Self { best: rows(bytes.min(best)), most: rows(bytes.min(most)) }
    }
}

/// Where the bits of codes are best for the sort of this many records.
pub(crate) fn layout<R>(cells: &Cells, records: usize) -> Layout {
    let bits = Layout::new(cells.dims(), 0).bits();
    // Codes are more than cells: some blocks are cut by the ends of the grid.
    let codes = (records as u128) << bits;
    let rows = usize::try_from(codes / cells.count().max(1) as u128).unwrap_or(usize::MAX / 4);
    let leaf = LeafRows::new::<R>(cells, records);
    Layout::new(cells.dims(), split_bits(rows, leaf, bits))
}

/// With how many bits to partition this many rows whose codes differ in `bits` bits.
fn split_bits(rows: usize, leaf: LeafRows, bits: u32) -> u32 {
    // A bucket of the mean number of rows is well below the limit, as some have more.
    let buckets = rows.div_ceil(leaf.best * 3 / 4).max(1).next_power_of_two().ilog2();
    // A bucket whose cells are too many for its counts is no good either.
    let least = bits.saturating_sub(14);
    buckets.max(least).min(BUCKETS_MAX).min(bits)
}

/// A run of rows that are yet to be sorted into bricks.
struct Bucket {
    rows: u32,
    base: u32,
    bits: u32,
}

/// How rows are partitioned.
struct Split<'a> {
    /// The number of rows in each bucket.
    counts: &'a [u32],
    /// The code where the first bucket starts.
    base: u32,
    /// How many bits the codes of a bucket differ in.
    bits: u32,
}

impl Split<'_> {
    /// Partitions rows into buckets, and those that are very large again.
    fn run<R: Record>(&self, rows: &mut Rows<'_, R>, how: How, buckets: &mut Vec<Bucket>) {
        let mut rest = self.partition(rows, how);
        for (base, &count) in self.bases().zip(self.counts).filter(|&(_, &count)| count > 0) {
            let mut inside = rest.split_off_front(count as usize);
            if inside.len() > SHARED_ROWS && self.bits > 0 {
                again(&mut inside, how, (base, self.bits), |rows, how, split| {
                    split.run(rows, how, buckets);
                });
            } else {
                buckets.push(Bucket { rows: count, base, bits: self.bits });
            }
        }
    }

    /// Moves rows into buckets.
    fn partition<'r, R: Record>(&self, rows: &'r mut Rows<'_, R>, how: How) -> Rows<'r, R> {
        let homes = self.counts.iter().scan(0, |start: &mut u32, &count| {
            *start += count;
            Some(*start - count..*start)
        });
        let homes: Vec<Range<u32>> = homes.collect();
        if homes.len() > 1 {
            partition(rows, &how.coder, &homes);
        }
        rows.reborrow()
    }

    /// The code where each bucket starts.
    fn bases(&self) -> impl Iterator<Item = u32> + use<> {
        let (base, bits) = (self.base, self.bits);
        (0_u32..).map(move |bucket| base + (bucket << bits))
    }
}

/// Splits a bucket by some more of the `bits` bits that its codes differ in.
fn again<R: Record>(
    rows: &mut Rows<'_, R>,
    how: How,
    (base, bits): (u32, u32),
    split: impl FnOnce(&mut Rows<'_, R>, How, &Split<'_>),
) {
    let below = bits - split_bits(rows.len(), how.leaf, bits).max(1);
    let how = How { coder: how.coder.with(how.layout.digit(below..bits)), ..how };
    let counts = &census::count(rows.records, &how.coder);
    split(rows, how, &Split { counts, base, bits: below });
}

/// Sorts a bucket into bricks; one that is too large for the cache is split first.
fn sort_bucket<R: Record>(
    scratch: &mut Scratch<R>,
    mut leaf: Leaf<'_, R>,
    how: How,
    found: &mut Bricks,
) {
    if leaf.rows.len() <= how.leaf.most || leaf.bits == 0 {
        scratch.sort(leaf, how, found);
        return;
    }
    let mut start = leaf.start;
    again(&mut leaf.rows, how, (leaf.base, leaf.bits), |rows, how, split| {
        let mut rest = split.partition(rows, how);
        for (base, &count) in split.bases().zip(split.counts).filter(|&(_, &count)| count > 0) {
            let rows = rest.split_off_front(count as usize);
            sort_bucket(scratch, Leaf { rows, start, base, bits: split.bits }, how, found);
            start += count;
        }
    });
}

/// Sorts buckets into bricks, in parallel.
fn finish<R: Record>(mut rows: Rows<'_, R>, how: How, buckets: Vec<Bucket>) -> Bricks {
    let mut start = 0;
    let leaves = buckets.into_iter().enumerate().map(|(index, bucket)| {
        let Bucket { rows: count, base, bits } = bucket;
        let leaf = Leaf { rows: rows.split_off_front(count as usize), start, base, bits };
        start += count;
        (index, leaf)
    });
    let (leaves, found) = (Mutex::new(leaves), Ordered::default());
    rayon::scope(|scope| {
        for _ in 0..rayon::current_num_threads() {
            scope.spawn(|_| {
                let (mut scratch, mut bricks) = (Scratch::new(), Bricks::default());
                while let Some((index, leaf)) = next(&leaves) {
                    sort_bucket(&mut scratch, leaf, how, &mut bricks);
                    bricks = found.add(index, bricks);
                }
            });
        }
    });
    found.into_all()
}

/// The next value of an iterator that threads share.
fn next<I: Iterator>(iterator: &Mutex<I>) -> Option<I::Item> {
    iterator.lock().unwrap_or_else(PoisonError::into_inner).next()
}

/// Bricks of buckets that are ready in any order, and are appended in theirs.
///
/// Appending takes a while, as the memory is new. Whoever has bricks ready while another thread
/// appends leaves them to that one and goes on.
#[derive(Default)]
struct Ordered {
    ready: Mutex<Ready>,
    all: Mutex<Bricks>,
}

/// Bricks that wait to be appended.
#[derive(Default)]
struct Ready {
    waiting: BTreeMap<usize, Bricks>,
    /// The index of the bucket whose bricks are appended next.
    next: usize,
    spare: Vec<Bricks>,
}

impl Ordered {
    /// Adds the bricks of a bucket; gives buffers for those of another.
    fn add(&self, index: usize, bricks: Bricks) -> Bricks {
        self.ready().waiting.insert(index, bricks);
        if let Ok(mut all) = self.all.try_lock() {
            loop {
                let next = self.ready().take();
                let Some(mut bricks) = next else { break };
                append(&mut all, &mut bricks);
                self.ready().spare.push(bricks);
            }
        }
        self.ready().spare.pop().unwrap_or_default()
    }

    fn ready(&self) -> MutexGuard<'_, Ready> {
        self.ready.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All bricks, in the order of their buckets.
    fn into_all(self) -> Bricks {
        let mut all = self.all.into_inner().unwrap_or_else(PoisonError::into_inner);
        let ready = self.ready.into_inner().unwrap_or_else(PoisonError::into_inner);
        ready.waiting.into_values().for_each(|mut bricks| append(&mut all, &mut bricks));
        all.bricks.shrink_to_fit();
        all.codes.shrink_to_fit();
        all.colors.shrink_to_fit();
        all
    }
}

impl Ready {
    /// The bricks that come next, if they are ready.
    fn take(&mut self) -> Option<Bricks> {
        let bricks = self.waiting.remove(&self.next)?;
        self.next += 1;
        Some(bricks)
    }
}

fn append(all: &mut Bricks, bricks: &mut Bricks) {
    // Not twice as much at once: in the end, the bricks are most of what the sort needs.
    make_room(&mut all.bricks, bricks.bricks.len());
    all.bricks.append(&mut bricks.bricks);
    make_room(&mut all.codes, bricks.codes.len());
    all.codes.append(&mut bricks.codes);
    all.colors.append(&mut bricks.colors);
}

/// Makes room for `count` more values, and for a quarter more if that needs more room.
fn make_room<T>(values: &mut Vec<T>, count: usize) {
    if values.capacity() - values.len() < count {
        values.reserve_exact(count.max(values.len() / 4));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bricks_that_come_while_others_are_appended_are_not_forgotten() {
        let ordered = Ordered::default();
        let bricks = |code: u32| Bricks { codes: vec![code], ..Bricks::default() };
        ordered.add(1, bricks(1));
        let appending = ordered.all.lock().unwrap();
        for index in [0, 3, 2] {
            ordered.add(index, bricks(u32::try_from(index).unwrap()));
        }
        assert!(appending.codes.is_empty());
        drop(appending);
        assert_eq!(ordered.into_all().codes, [0, 1, 2, 3]);
    }
}
