/*!
The last step of the sort: the rows of one bucket, which fit into the cache, are sorted into bricks,
and the bricks are measured while they are there.

Within a bucket, rows are sorted by counting: each is copied to its place in a scratch buffer, and
everything is copied back. Where cells are many and rows are few, counting would mostly count empty
cells; pairs of digit and place are sorted by comparison then. The columns follow one by one, by the
places that were found for the records.
*/

use crate::{
    codes::{Coder, Layout, RUN},
    dispatch::{Kernel, STREAM_AHEAD, prefetch, widest},
    measure::{mean_color, measure},
    rows::{Lane, Rows},
    sort::LeafRows,
};
use puncta_core::{Brick, Record};
use wide::f32x4;

/// How many cells there may be for each row if they are counted.
const CELLS_PER_ROW: usize = 4;

/// How to sort a bucket.
#[derive(Clone, Copy, Debug)]
pub(crate) struct How {
    pub(crate) coder: Coder,
    pub(crate) layout: Layout,
    /// How large buckets may be.
    pub(crate) leaf: LeafRows,
    /// The least sides of the cells.
    pub(crate) sides: f32x4,
    /// Whether rows keep the order of their ids, the first column, within a brick.
    pub(crate) stable: bool,
}

/// A bucket that is to be sorted into bricks.
pub(crate) struct Leaf<'a, R> {
    pub(crate) rows: Rows<'a, R>,
    /// The index of the first row.
    pub(crate) start: u32,
    /// The code of the first cell.
    pub(crate) base: u32,
    /// How many bits of the codes differ within the bucket.
    pub(crate) bits: u32,
}

/// The bricks of a bucket, their codes, and their mean colors if rows have colors.
#[derive(Debug, Default)]
pub(crate) struct Bricks {
    pub(crate) bricks: Vec<Brick>,
    pub(crate) codes: Vec<u32>,
    pub(crate) colors: Vec<[u8; 4]>,
}

/// Buffers that are used for one bucket after the other.
pub(crate) struct Scratch<R> {
    records: Vec<R>,
    words: Vec<[u8; 4]>,
    /// First the cell of each row, then its place.
    places: Vec<u32>,
    /// First the number of rows of each cell, then the place of the next one.
    counts: Vec<u32>,
    pairs: Vec<u64>,
    /// The number of rows of each brick.
    lengths: Vec<u32>,
}

impl<R: Record> Scratch<R> {
    pub(crate) fn new() -> Self {
        let (records, words, places) = (Vec::new(), Vec::new(), Vec::new());
        Self { records, words, places, counts: vec![], pairs: vec![], lengths: vec![] }
    }

    /// Sorts a bucket and measures its bricks.
    pub(crate) fn sort(&mut self, mut leaf: Leaf<'_, R>, how: How, found: &mut Bricks) {
        widest(Sort { scratch: self, leaf: &mut leaf, how, found });
        if let Some(Lane::Words(colors)) =
            leaf.rows.colors.and_then(|lane| leaf.rows.lanes.get(lane))
        {
            let mut rest = &colors[..];
            found.colors.extend(self.lengths.iter().map(|&length| {
                let (members, behind) = rest.split_at(length as usize);
                rest = behind;
                mean_color(members)
            }));
        }
    }

    #[inline(always)]
    fn sort_leaf(&mut self, leaf: &mut Leaf<'_, R>, how: How, found: &mut Bricks) {
        self.lengths.clear();
        if leaf.bits == 0 {
            self.lengths.push(u32::try_from(leaf.rows.len()).unwrap_or(u32::MAX));
            found.codes.push(leaf.base);
        } else {
            let coder = how.coder.with(how.layout.digit(0..leaf.bits));
            self.sort_rows(&mut leaf.rows, (&coder, leaf.base), &mut found.codes);
        }
        if how.stable {
            self.settle(&mut leaf.rows);
        }
        let (mut rest, mut start) = (&leaf.rows.records[..], leaf.start);
        found.bricks.reserve(self.lengths.len());
        for &length in &self.lengths {
            let (members, behind) = rest.split_at(length as usize);
            found.bricks.push(measure(members, start, how.sides));
            (rest, start) = (behind, start + length);
        }
    }

    /// Sorts rows by the digit of their codes, which are digits above `base`.
    #[inline(always)]
    fn sort_rows(
        &mut self,
        rows: &mut Rows<'_, R>,
        (coder, base): (&Coder, u32),
        codes: &mut Vec<u32>,
    ) {
        let count = rows.len();
        if let Some(&first) = rows.records.first()
            && self.records.len() < count
        {
            self.records.resize(count, first);
        }
        self.places.resize(count, 0);
        if count < coder.digit().values() / CELLS_PER_ROW {
            self.compare(rows.records, (coder, base), codes);
        } else {
            self.count(rows.records, (coder, base), codes);
        }
        rows.records.copy_from_slice(&self.records[..count]);
        for lane in &mut rows.lanes {
            self.sort_lane(lane);
        }
    }

    /// Finds the place of each row by counting, and puts the records there.
    #[inline(always)]
    fn count(&mut self, records: &[R], (coder, base): (&Coder, u32), codes: &mut Vec<u32>) {
        self.counts.clear();
        self.counts.resize(coder.digit().values(), 0);
        let counts = &mut self.counts[..];
        for (records, places) in records.chunks(RUN).zip(self.places.chunks_mut(RUN)) {
            coder.code(records, places);
            for (records, cells) in records.chunks(4).zip(places.chunks(4)) {
                prefetch(records, STREAM_AHEAD);
                cells.iter().for_each(|&cell| counts[cell as usize] += 1);
            }
        }
        let mut next = 0;
        for (code, count) in (base..).zip(counts.iter_mut()) {
            if *count > 0 {
                codes.push(code);
                self.lengths.push(*count);
            }
            next += std::mem::replace(count, next);
        }
        let sorted = &mut self.records[..records.len()];
        for (record, place) in records.iter().zip(&mut self.places) {
            let next = &mut counts[*place as usize];
            *place = *next;
            *next += 1;
            sorted[*place as usize] = *record;
        }
    }

    /// Finds the place of each row by comparing digits, and puts the records there.
    #[inline(always)]
    fn compare(&mut self, records: &[R], (coder, base): (&Coder, u32), codes: &mut Vec<u32>) {
        coder.code(records, &mut self.places);
        self.pairs.clear();
        self.pairs.extend((0..).zip(&self.places).map(|(row, &cell)| pair(cell, row)));
        self.pairs.sort_unstable();
        let mut last = None;
        for (place, &pair) in (0_u32..).zip(&self.pairs) {
            let (cell, row) = unpair(pair);
            self.places[row as usize] = place;
            self.records[place as usize] = records[row as usize];
            if last == Some(cell) {
                self.lengths.last_mut().into_iter().for_each(|length| *length += 1);
            } else {
                codes.push(base + cell);
                self.lengths.push(1);
                last = Some(cell);
            }
        }
    }

    /// Moves the values of a column to the places of their rows.
    fn sort_lane(&mut self, lane: &mut Lane<'_>) {
        let places = &self.places[..];
        self.words.resize(places.len().max(self.words.len()), [0; 4]);
        match lane {
            Lane::Words(words) => {
                for (word, &place) in words.iter().zip(places) {
                    self.words[place as usize] = *word;
                }
                words.copy_from_slice(&self.words[..words.len()]);
            }
            Lane::Bytes(bytes) => {
                for (byte, &place) in bytes.iter().zip(places) {
                    self.words[place as usize][0] = *byte;
                }
                for (byte, word) in bytes.iter_mut().zip(&self.words) {
                    *byte = word[0];
                }
            }
        }
    }

    /// Sorts the rows of each brick by their ids.
    fn settle(&mut self, rows: &mut Rows<'_, R>) {
        let mut end = 0;
        for index in 0..self.lengths.len() {
            let members = end..end + self.lengths[index] as usize;
            end = members.end;
            let Some(Lane::Words(ids)) = rows.lanes.first() else { return };
            let ids = ids[members.clone()].iter().map(|&id| u32::from_ne_bytes(id));
            self.pairs.clear();
            self.pairs.extend((0..).zip(ids).map(|(row, id)| pair(id, row)));
            if self.pairs.is_sorted() {
                continue;
            }
            self.pairs.sort_unstable();
            self.places.resize(members.len(), 0);
            for (place, &pair) in (0_u32..).zip(&self.pairs) {
                self.places[unpair(pair).1 as usize] = place;
            }
            let records = &mut rows.records[members.clone()];
            self.records.clear();
            self.records.extend(self.pairs.iter().map(|&pair| records[unpair(pair).1 as usize]));
            records.copy_from_slice(&self.records);
            rows.lanes.iter_mut().for_each(|lane| self.sort_lane(&mut lane.part(members.clone())));
        }
    }
}

/// A key and a row, to be sorted by the key, then the row.
fn pair(key: u32, row: u32) -> u64 {
    u64::from(key) << 32 | u64::from(row)
}

#[expect(clippy::cast_possible_truncation, reason = "the halves of a number")]
fn unpair(pair: u64) -> (u32, u32) {
    ((pair >> 32) as u32, pair as u32)
}

/// Sorts a bucket.
struct Sort<'s, 'a, R> {
    scratch: &'s mut Scratch<R>,
    leaf: &'s mut Leaf<'a, R>,
    how: How,
    found: &'s mut Bricks,
}

impl<R: Record> Kernel for Sort<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.scratch.sort_leaf(self.leaf, self.how, self.found);
    }
}
