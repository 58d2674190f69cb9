/*!
Which cells hold a brick in play, and which brick it is.

A ray asks this at every step, so the answer must be short to get; and a grid has up to 2^30 cells,
most of them empty. Cells come in blocks of 8 x 8 x 8. A table tells the block that a cell is in; a
block is 512 bits, one for each cell. Bricks are numbered by their bits: a number is the count of
bits before, of which all but the last 64 are counted beforehand. The table has up to four entries
of 4 bytes for 512 cells, because an axis may waste half of the numbers that its bits have.

What ends a ray is marked as well, so that it takes one test only. The cell of the camera has a bit.
Around the grid lie blocks that have all bits.

The buffers are kept from frame to frame: fresh memory costs more than what is done here. Of the
table only what was in use is emptied.
*/

use crate::graph::{
    CAMERA,
    address::{Axes, NOWHERE, block},
};

/// The table's entry for a block without bricks; this block has no bits.
const EMPTY: u32 = 0;

/// The table's entry for what lies outside of the grid; this block has all bits.
const OUTSIDE: u32 = 1;

/// The cells that rays end in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Occupancy {
    axes: Axes,
    table: Vec<u32>,
    blocks: Vec<[Word; 8]>,
    /// The entries of all blocks but the first two.
    entries: Vec<usize>,
    /// For each set bit the brick of the cell, as an index into the list in play.
    bricks: Vec<u32>,
}

/// Some bits of a block.
#[derive(Clone, Copy, Debug, Default)]
struct Word {
    bits: u64,
    /// How many bits are set in the words before.
    before: u32,
}

impl Word {
    /// The word of what lies outside.
    const ALL: Self = Self { bits: u64::MAX, before: u32::MAX };

    /// Whether the bit of an address is set.
    #[inline(always)]
    const fn is_set(self, address: u64) -> bool {
        self.bits >> (address & 63) & 1 != 0
    }

    /// How many bits are set before that of an address.
    #[inline(always)]
    const fn number(self, address: u64) -> usize {
        let below = self.bits & !(u64::MAX << (address & 63));
        self.before.saturating_add(below.count_ones()) as usize
    }
}

/// Which word of its block belongs to an address.
#[inline(always)]
const fn word(address: u64) -> usize {
    (address >> 6 & 7) as usize
}

impl Occupancy {
    /// Marks the cells of bricks and that of the camera.
    pub(crate) fn rebuild(&mut self, axes: Axes, places: &[u64], camera: Option<u64>) {
        self.clear(axes);
        for &address in places.iter().filter(|&&address| address != NOWHERE) {
            self.mark(address);
        }
        if let Some(address) = camera {
            self.mark(address);
        }
        let mut total = 0_u32;
        for word in self.blocks.iter_mut().skip(OUTSIDE as usize + 1).flatten() {
            word.before = total;
            total += word.bits.count_ones();
        }
        self.bricks.clear();
        self.bricks.resize(total as usize, CAMERA);
        for (brick, &address) in (0_u32..).zip(places) {
            if address != NOWHERE {
                let number = self.word(address).number(address);
                self.bricks[number] = brick;
            }
        }
    }

    /// How cells are addressed.
    #[inline(always)]
    pub(crate) const fn axes(&self) -> &Axes {
        &self.axes
    }

    /// Removes all marks.
    fn clear(&mut self, axes: Axes) {
        if axes == self.axes && !self.table.is_empty() {
            for &entry in &self.entries {
                self.table[entry] = EMPTY;
            }
        } else {
            self.axes = axes;
            let (rows, end) = axes.rows();
            self.table.clear();
            self.table.resize(end, OUTSIDE);
            rows.for_each(|row| self.table[row].fill(EMPTY));
        }
        self.entries.clear();
        self.blocks.clear();
        self.blocks.extend([[Word::default(); 8], [Word::ALL; 8]]);
    }

    /// Sets the bit of a cell.
    #[inline(always)]
    fn mark(&mut self, address: u64) {
        let entry = block(address);
        let mut block = self.table[entry];
        if block == EMPTY {
            block = u32::try_from(self.blocks.len()).unwrap_or(OUTSIDE);
            self.table[entry] = block;
            self.entries.push(entry);
            self.blocks.push([Word::default(); 8]);
        }
        self.blocks[block as usize][word(address)].bits |= 1 << (address & 63);
    }

    /// The word of bits that belongs to an address.
    #[inline(always)]
    fn word(&self, address: u64) -> Word {
        let block = self.table.get(block(address)).map_or(OUTSIDE, |&block| block);
        self.blocks.get(block as usize).map_or(Word::ALL, |block| block[word(address)])
    }

    /// Whether a ray ends in a cell.
    #[inline(always)]
    pub(crate) fn ends(&self, address: u64) -> bool {
        self.word(address).is_set(address)
    }

    /// What a ray meets in a cell: a brick, [`CAMERA`], or nothing.
    #[inline(always)]
    pub(crate) fn met(&self, address: u64) -> Option<u32> {
        let word = self.word(address);
        // There is no brick that has the number of what lies outside.
        let brick = || self.bricks.get(word.number(address)).map_or(CAMERA, |&brick| brick);
        word.is_set(address).then(brick)
    }

    /// All blocks that hold bricks, and the first cell of each.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, [u32; 3])> {
        let first = |&entry: &usize| self.axes.first_cell(entry);
        (OUTSIDE as usize + 1..).zip(self.entries.iter().map(first))
    }

    /// The bricks of a block, such that each comes after what lies between it and the cell
    /// `nearest`.
    pub(crate) fn each_brick(&self, block: usize, nearest: [u32; 3], mut each: impl FnMut(u32)) {
        let first = self.axes.first_cell(self.entries[block - OUTSIDE as usize - 1]);
        let [x, y, z] = [0, 1, 2].map(|axis| nearest[axis].saturating_sub(first[axis]).min(8));
        for z in (z..8).chain((0..z).rev()) {
            let word = self.blocks[block][z as usize];
            if word.bits == 0 {
                continue;
            }
            for y in (y..8).chain((0..y).rev()) {
                let row = word.bits >> (8 * y) & 0xff;
                if row == 0 {
                    continue;
                }
                let start = word.number(u64::from(8 * y));
                let middle = start + (row & ((1 << x) - 1)).count_ones() as usize;
                let end = start + row.count_ones() as usize;
                let bricks = &self.bricks;
                let numbers = (middle..end).chain((start..middle).rev());
                let known = numbers.map(|number| bricks[number]).filter(|&brick| brick != CAMERA);
                known.for_each(&mut each);
            }
        }
    }
}
