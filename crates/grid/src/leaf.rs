/*!
The last step of the sort: the rows of one bucket, which fit into the cache, are sorted into bricks,
and the statistics of each brick are taken on the way.

Within a bucket, rows are sorted by counting: each is copied to its place in a scratch buffer, then
everything is copied back, brick by brick, which is when the bricks are measured. Where cells are
many and rows are few, counting would mostly count empty cells; pairs of code and place are sorted by
comparison then.
*/

use crate::{
    codes::{Coder, Layout, RUN},
    dispatch::{AHEAD, Kernel, lanes_of, prefetch, widest},
    rows::{Lane, Rows},
};
use glam::Vec3;
use puncta_core::{Aabb, Brick, Record};
use std::ops::Range;
use wide::f32x4;

/// How many cells there may be for each row if they are counted.
const CELLS_PER_ROW: usize = 16;

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

/// The bricks of a bucket, and their codes.
#[derive(Debug, Default)]
pub(crate) struct Bricks {
    pub(crate) bricks: Vec<Brick>,
    pub(crate) codes: Vec<u32>,
}

/// Sorts a bucket.
struct Sort<'a, R> {
    scratch: &'a mut Scratch<R>,
    leaf: Leaf<'a, R>,
    how: How,
    found: &'a mut Bricks,
}

impl<R: Record> Kernel for Sort<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.scratch.sort_leaf(self.leaf, self.how, self.found);
    }
}

/// How to sort a bucket.
#[derive(Clone, Copy, Debug)]
pub(crate) struct How {
    pub(crate) coder: Coder,
    pub(crate) layout: Layout,
    /// The least sides of the cells.
    pub(crate) sides: f32x4,
    /// Whether rows keep the order of their ids within a brick.
    pub(crate) stable: bool,
}

impl<R: Record> Scratch<R> {
    pub(crate) fn new() -> Self {
        let (records, words, places) = (Vec::new(), Vec::new(), Vec::new());
        Self { records, words, places, counts: vec![], pairs: vec![], lengths: vec![] }
    }

    /// Sorts a bucket and measures its bricks.
    pub(crate) fn sort(&mut self, leaf: Leaf<'_, R>, how: How, found: &mut Bricks) {
        widest(Sort { scratch: self, leaf, how, found });
    }

    #[inline(always)]
    fn sort_leaf(&mut self, leaf: Leaf<'_, R>, how: How, found: &mut Bricks) {
        let Leaf { rows, mut start, base, bits } = leaf;
        self.lengths.clear();
        if let Some(first) = rows.records.first()
            && self.records.len() < rows.records.len()
        {
            self.records.resize(rows.records.len(), *first);
        }
        let coder = how.coder.with(how.layout.digit(0..bits));
        let is_sparse = rows.len() < (1 << bits) / CELLS_PER_ROW;
        if is_sparse {
            self.compare(rows.records, (&coder, base), &mut found.codes);
        } else {
            self.count(rows.records, (&coder, base), &mut found.codes);
        }
        let mut sorted = &self.records[..rows.len()];
        rows.records.copy_from_slice(sorted);
        found.bricks.reserve(self.lengths.len());
        for &length in &self.lengths {
            let (members, rest) = sorted.split_at(length as usize);
            found.bricks.push(measure(members, start, how.sides));
            sorted = rest;
            start += length;
        }
        for lane in rows.lanes {
            self.sort_lane(lane);
        }
    }

    /// Finds the place of each row by counting.
    #[inline(always)]
    fn count(&mut self, records: &[R], (coder, base): (&Coder, u32), codes: &mut Vec<u32>) {
        self.counts.clear();
        self.counts.resize(coder.digit().values(), 0);
        self.places.resize(records.len(), 0);
        let counts = &mut self.counts[..];
        for (records, places) in records.chunks(RUN).zip(self.places.chunks_mut(RUN)) {
            coder.code(records, places);
            for (records, cells) in records.chunks(4).zip(places.chunks(4)) {
                prefetch(records, AHEAD);
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

    /// Finds the place of each row by comparing codes.
    #[inline(always)]
    fn compare(&mut self, records: &[R], (coder, base): (&Coder, u32), codes: &mut Vec<u32>) {
        self.places.resize(records.len(), 0);
        coder.code(records, &mut self.places);
        self.pairs.clear();
        let pair = |(index, &cell): (u64, &u32)| u64::from(cell) << 32 | index;
        self.pairs.extend((0_u64..).zip(&self.places).map(pair));
        self.pairs.sort_unstable();
        let mut last = None;
        for (place, pair) in (0_u32..).zip(&self.pairs) {
            let (cell, index) = ((pair >> 32) as u32, *pair as u32 as usize);
            self.places[index] = place;
            self.records[place as usize] = records[index];
            if last != Some(cell) {
                codes.push(base + cell);
                self.lengths.push(0);
                last = Some(cell);
            }
            self.lengths.last_mut().into_iter().for_each(|length| *length += 1);
        }
    }

    /// Moves the values of a column to the places of their rows.
    fn sort_lane(&mut self, lane: Lane<'_>) {
        self.words.resize(self.places.len().max(self.words.len()), [0; 4]);
        match lane {
            Lane::Words(words) => {
                for (word, &place) in words.iter().zip(&self.places) {
                    self.words[place as usize] = *word;
                }
                words.copy_from_slice(&self.words[..words.len()]);
            }
            Lane::Bytes(bytes) => {
                for (byte, &place) in bytes.iter().zip(&self.places) {
                    self.words[place as usize][0] = *byte;
                }
                for (byte, word) in bytes.iter_mut().zip(&self.words) {
                    *byte = word[0];
                }
            }
        }
    }
}

/// The brick of these records, the first of which is record `start`.
#[inline(always)]
fn measure<R: Record>(members: &[R], start: u32, sides: f32x4) -> Brick {
    let (mut least, mut most) = (f32x4::splat(f32::INFINITY), f32x4::splat(f32::NEG_INFINITY));
    let mut volume = 0.0;
    // Short sums in `f32` lose little; long ones are made of short ones.
    for members in members.chunks(256) {
        let mut cubes = f32x4::ZERO;
        for record in members {
            let lanes = lanes_of(record);
            least = lanes.fast_min(least);
            most = lanes.fast_max(most);
            cubes += lanes * lanes * lanes;
        }
        volume += f64::from(cubes.to_array()[3]);
    }
    #[expect(clippy::cast_possible_truncation, reason = "there are no more than MAX_RECORDS")]
    let end = start + members.len() as u32;
    describe(start..end, [least, most], volume, sides)
}

/// The brick of records with these extremes and this sum of cubed radii.
#[inline(always)]
pub(crate) fn describe(
    records: Range<u32>,
    [least, most]: [f32x4; 2],
    volume: f64,
    sides: f32x4,
) -> Brick {
    let [.., radius_max] = most.to_array();
    let corner = |lanes: f32x4| Vec3::from_slice(&lanes.to_array());
    let sides = sides.fast_max(most - least).fast_max(f32x4::splat(2.0 * radius_max));
    let cell = corner(sides).as_dvec3().element_product();
    let density = (4.0 / 3.0 * std::f64::consts::PI * volume / cell) as f32;
    Brick {
        records,
        bounds: Aabb { min: corner(least), max: corner(most) },
        radius_max,
        density: if density.is_finite() { density } else { 0.0 },
    }
}
