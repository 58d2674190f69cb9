/*!
The last step: the rows of a part are sorted in memory.

The sort of the grid brings the rows of a brick together. Then those of each brick are sorted by
their ids, which makes their order one that depends on nothing else, and the brick is measured. A
brick that continues in the next part is measured on from there.
*/

use crate::{
    census,
    dispatch::lanes_of,
    leaf::{Bricks, How, describe},
    rows::{Lane, Rows},
    sort,
};
use puncta_core::{Brick, Scene, Sphere};
use rayon::prelude::*;
use std::ops::Range;
use wide::f32x4;

/// About how many rows a thread sorts by ids at once.
const GROUP: usize = 1 << 15;

/// Measures the records of a brick.
#[derive(Clone, Copy, Debug)]
struct Tally {
    least: f32x4,
    most: f32x4,
    /// The sum of cubes of up to 256 records: short sums in `f32` lose little.
    cubes: f32x4,
    count: u32,
    volume: f64,
}

impl Tally {
    const NONE: Self = Self {
        least: f32x4::new([f32::INFINITY; 4]),
        most: f32x4::new([f32::NEG_INFINITY; 4]),
        cubes: f32x4::ZERO,
        count: 0,
        volume: 0.0,
    };

    fn of(members: &[Sphere]) -> Self {
        let mut tally = Self::NONE;
        tally.add(members);
        tally
    }

    fn add(&mut self, members: &[Sphere]) {
        for record in members {
            let lanes = lanes_of(record);
            self.least = lanes.fast_min(self.least);
            self.most = lanes.fast_max(self.most);
            self.cubes += lanes * lanes * lanes;
            self.count += 1;
            if self.count.is_multiple_of(256) {
                self.volume += f64::from(self.cubes.to_array()[3]);
                self.cubes = f32x4::ZERO;
            }
        }
    }

    fn finish(self, start: u32, sides: f32x4) -> Brick {
        let volume = self.volume + f64::from(self.cubes.to_array()[3]);
        describe(start..start + self.count, [self.least, self.most], volume, sides)
    }
}

/// Sorts part after part, and collects their bricks.
pub(crate) struct Arranger {
    how: How,
    found: Bricks,
    /// The code of the last brick and what was measured of it.
    open: Option<(u32, Tally)>,
    /// The first row of that brick.
    start: u32,
}

impl Arranger {
    /// An arranger of the first part; the coder's digit is that of the blocks.
    pub(crate) fn new(how: How) -> Self {
        Self { how, found: Bricks::default(), open: None, start: 0 }
    }

    /// Sorts the rows of the next part: the first ones of a block.
    pub(crate) fn arrange(&mut self, block: &mut Scene, count: usize) {
        let mut all = Rows::of_scene(block);
        let mut rows = all.split_off_front(count);
        let counts = census::count(rows.records, &self.how.coder);
        let Bricks { bricks, codes } = sort::sort(rows.reborrow(), self.how, &counts);
        let tallies = measure(groups(rows, &bricks));
        for ((code, tally), brick) in codes.into_iter().zip(tallies).zip(&bricks) {
            match &mut self.open {
                Some((open, tally)) if *open == code => {
                    let members = brick.records.start as usize..brick.records.end as usize;
                    tally.add(&block.records[members]);
                }
                _ => {
                    self.close();
                    self.open = Some((code, tally));
                }
            }
        }
    }

    /// Adds the brick that is complete.
    fn close(&mut self) {
        if let Some((code, tally)) = self.open.take() {
            self.found.bricks.push(tally.finish(self.start, self.how.sides));
            self.found.codes.push(code);
            self.start += tally.count;
        }
    }

    /// All bricks.
    pub(crate) fn finish(mut self) -> Bricks {
        self.close();
        self.found
    }
}

/// Rows of some bricks, and where these are in them.
struct Group<'a> {
    rows: Rows<'a, Sphere>,
    bricks: Vec<Range<usize>>,
}

/// Cuts rows into groups of whole bricks.
fn groups<'a>(mut rows: Rows<'a, Sphere>, bricks: &[Brick]) -> Vec<Group<'a>> {
    let (mut groups, mut inside, mut count) = (Vec::new(), Vec::new(), 0);
    for (index, brick) in bricks.iter().enumerate() {
        inside.push(count..count + brick.records.len());
        count += brick.records.len();
        if count >= GROUP || index + 1 == bricks.len() {
            let bricks = std::mem::take(&mut inside);
            groups.push(Group { rows: rows.split_off_front(count), bricks });
            count = 0;
        }
    }
    groups
}

/// Sorts the rows of each brick by ids, and measures them.
fn measure(groups: Vec<Group<'_>>) -> Vec<Tally> {
    let tallies = groups.into_par_iter().map_init(Scratch::default, |scratch, mut group| {
        let bricks = group.bricks.into_iter();
        let tallies = bricks.map(|members| {
            scratch.sort(&mut group.rows, members.clone());
            Tally::of(&group.rows.records[members])
        });
        tallies.collect::<Vec<_>>()
    });
    tallies.flatten_iter().collect()
}

/// Buffers that are used for one brick after the other.
#[derive(Default)]
struct Scratch {
    /// Ids, and below each the place of its row.
    pairs: Vec<u64>,
    records: Vec<Sphere>,
    words: Vec<[u8; 4]>,
    bytes: Vec<u8>,
}

impl Scratch {
    /// Sorts some rows by their ids, which are the first column.
    fn sort(&mut self, rows: &mut Rows<'_, Sphere>, members: Range<usize>) {
        let Some(Lane::Words(ids)) = rows.lanes.first() else { return };
        let ids = ids[members.clone()].iter().map(|&id| u64::from(u32::from_ne_bytes(id)));
        self.pairs.clear();
        self.pairs.extend(ids.zip(0..).map(|(id, place): (u64, u64)| id << 32 | place));
        if self.pairs.is_sorted() {
            return;
        }
        self.pairs.sort_unstable();
        let pairs = &self.pairs;
        permute(pairs, &mut rows.records[members.clone()], &mut self.records);
        for lane in &mut rows.lanes {
            match lane {
                Lane::Words(words) => permute(pairs, &mut words[members.clone()], &mut self.words),
                Lane::Bytes(bytes) => permute(pairs, &mut bytes[members.clone()], &mut self.bytes),
            }
        }
    }
}

/// Brings values into the order of the pairs, the lower halves of which tell where they are.
fn permute<T: Copy>(pairs: &[u64], values: &mut [T], scratch: &mut Vec<T>) {
    #[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
    let place = |pair: u64| pair as u32 as usize;
    scratch.clear();
    scratch.extend(pairs.iter().map(|&pair| values[place(pair)]));
    values.copy_from_slice(scratch);
}
