/*!
Which cells hold a brick in play, and which brick it is.

A ray asks this at every step, so the answer must be short to get: a grid has up to 2^30 cells, most
of them empty. Cells come in blocks of 8 x 8 x 8. A table over the box of all bricks in play tells the
block; a block is 512 bits, one for each cell, which is a line of the cache. Bricks are numbered by
their bits: a number is the count of bits below, of which all but the last 64 are counted beforehand.

What ends a ray is marked as well, so that it takes one test only. The cell of the camera has a bit.
Beyond the box lies a layer of blocks whose bits are all set.

The address of a cell is a number in which each axis has bits of its own,

```text
[block z] [block y] [block x] [z: 3 bits] [y: 3 bits] [x: 3 bits]
```

so that a step along an axis is an addition that carries through these bits alone. The bits of an axis
may waste half of their numbers, so the table has up to four entries of 4 bytes for 512 cells.

The buffers are kept from frame to frame: fresh memory costs more than what is done here.
*/

use crate::graph::{CAMERA, camera::Camera};

/// The table's entry for a block without bricks; this block has no bits.
const EMPTY: u32 = 0;

/// The table's entry for what lies outside of the box; this block has all bits.
const OUTSIDE: u32 = 1;

/// The bits of an index that tell the cell within its block.
const CELL_BITS: u32 = 3;

/// The bits of an address that tell the cell within its block.
const BLOCK_BITS: u32 = 3 * CELL_BITS;

/// A place that no brick has.
pub(crate) const NOWHERE: [u32; 3] = [u32::MAX; 3];

/// The cells that rays end in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Occupancy {
    axes: Axes,
    table: Vec<u32>,
    blocks: Vec<[u64; 8]>,
    /// For each word of bits, how many are set in those before it.
    counts: Vec<[u32; 8]>,
    /// For each set bit the brick of the cell, as an index into the list in play.
    bricks: Vec<u32>,
}

/// The bits of an address.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Axes {
    /// The first block along each axis that is in the table.
    first: [u32; 3],
    /// The bits that each axis has.
    masks: [u64; 3],
    /// Where the bits of the block's index start.
    shifts: [u32; 3],
}

impl Axes {
    /// The axes of a box of blocks, and the number of blocks in their table.
    fn new(first: [u32; 3], count: [usize; 3]) -> (Self, usize) {
        // One more layer, which lies on both sides: what is below 0 is the largest number.
        let bits = |axis: usize| (count[axis] + 1).next_power_of_two().trailing_zeros();
        let shifts = [BLOCK_BITS, BLOCK_BITS + bits(0), BLOCK_BITS + bits(0) + bits(1)];
        let masks = std::array::from_fn(|axis| {
            let of_block = ((1_u64 << bits(axis)) - 1) << shifts[axis];
            of_block | 7 << (3 * axis)
        });
        (Self { first, masks, shifts }, count[2] << (bits(0) + bits(1)))
    }

    /// The part of an address that belongs to an axis.
    #[inline]
    fn part(&self, axis: usize, index: u32) -> u64 {
        let block = (index >> CELL_BITS).wrapping_sub(self.first[axis]);
        u64::from(block) << self.shifts[axis] | u64::from(index & 7) << (3 * axis)
    }

    /// The address of a cell in the box, in three parts.
    #[inline]
    pub(crate) fn parts(&self, place: [u32; 3]) -> [u64; 3] {
        std::array::from_fn(|axis| self.part(axis, place[axis]))
    }

    /// The bits of an axis.
    #[inline]
    pub(crate) fn mask(&self, axis: usize) -> u64 {
        self.masks[axis]
    }

    /// What to add to the part of an axis for a step of 1 or -1.
    #[inline]
    pub(crate) fn delta(&self, axis: usize, step: i64) -> u64 {
        if step < 0 { self.masks[axis] } else { 1 << (3 * axis) }
    }
}

/// The part of an address after a step along its axis.
#[inline(always)]
pub(crate) fn stepped(part: u64, delta: u64, mask: u64) -> u64 {
    // The ones between the bits of the axis hand the carry on.
    ((part | !mask).wrapping_add(delta)) & mask
}

/// Which entry of the table belongs to an address.
#[inline(always)]
fn entry(address: u64) -> usize {
    (address >> BLOCK_BITS) as usize
}

/// Which word of its block belongs to an address.
#[inline(always)]
fn word(address: u64) -> usize {
    (address >> 6 & 7) as usize
}

impl Occupancy {
    /// Marks the cells of bricks, and what else ends a ray to this camera.
    pub(crate) fn rebuild(&mut self, places: &[[u32; 3]], range: [[u32; 3]; 2], camera: &Camera) {
        self.reserve(range);
        for &place in places {
            if place != NOWHERE {
                self.mark(place);
            }
        }
        if let Some(place) = camera.cell().and_then(|cell| within(cell, range)) {
            self.mark(place);
        }
        let total = self.count();
        self.bricks.clear();
        self.bricks.resize(total, CAMERA);
        for (brick, &place) in (0_u32..).zip(places) {
            if place != NOWHERE {
                let number = self.number(self.address(place));
                if let Some(brick_there) = self.bricks.get_mut(number) {
                    *brick_there = brick;
                }
            }
        }
    }

    /// The address of a cell in the box.
    #[inline]
    fn address(&self, place: [u32; 3]) -> u64 {
        let [x, y, z] = self.axes.parts(place);
        x | y | z
    }

    /// How cells are addressed.
    #[inline]
    pub(crate) fn axes(&self) -> &Axes {
        &self.axes
    }

    /// Empties the table and makes it as large as the range of cells needs.
    fn reserve(&mut self, [min, max]: [[u32; 3]; 2]) {
        let first = min.map(|index| index >> CELL_BITS);
        let count: [usize; 3] =
            std::array::from_fn(|axis| ((max[axis] >> CELL_BITS) - first[axis]) as usize + 1);
        let (axes, size) = Axes::new(first, count);
        self.axes = axes;
        self.table.clear();
        self.table.resize(size, OUTSIDE);
        for z in 0..count[2] {
            for y in 0..count[1] {
                let row = z << (axes.shifts[2] - BLOCK_BITS) | y << (axes.shifts[1] - BLOCK_BITS);
                self.table[row..row + count[0]].fill(EMPTY);
            }
        }
        self.blocks.clear();
        self.blocks.extend([[0; 8], [u64::MAX; 8]]);
    }

    /// Sets the bit of a cell in the box.
    #[inline]
    fn mark(&mut self, place: [u32; 3]) {
        let address = self.address(place);
        let block = &mut self.table[entry(address)];
        if *block == EMPTY {
            *block = u32::try_from(self.blocks.len()).unwrap_or(OUTSIDE);
            self.blocks.push([0; 8]);
        }
        self.blocks[*block as usize][word(address)] |= 1 << (address & 63);
    }

    /// Counts the bits before each word; gives the count of all.
    fn count(&mut self) -> usize {
        self.counts.clear();
        let mut total = 0_u32;
        self.counts.extend(self.blocks.iter().enumerate().map(|(block, words)| {
            words.map(|word| {
                let before = total;
                total += if block == OUTSIDE as usize { 0 } else { word.count_ones() };
                before
            })
        }));
        total as usize
    }

    /// Whether a ray ends in a cell.
    #[inline(always)]
    pub(crate) fn ends(&self, address: u64) -> bool {
        let block = self.table.get(entry(address)).map_or(OUTSIDE, |&block| block);
        let words = self.blocks.get(block as usize).unwrap_or(&[u64::MAX; 8]);
        words[word(address)] >> (address & 63) & 1 != 0
    }

    /// The number of a cell that is marked.
    #[inline(always)]
    fn number(&self, address: u64) -> usize {
        let block = self.table[entry(address)] as usize;
        let below = self.blocks[block][word(address)] & !(u64::MAX << (address & 63));
        (self.counts[block][word(address)] + below.count_ones()) as usize
    }

    /// What a ray meets in a cell in which it ends: a brick or [`CAMERA`].
    #[inline(always)]
    pub(crate) fn met(&self, address: u64) -> u32 {
        match self.table.get(entry(address)) {
            None | Some(&OUTSIDE) => CAMERA,
            Some(_) => self.bricks.get(self.number(address)).map_or(CAMERA, |&brick| brick),
        }
    }
}

/// The cell as a place in a range of cells; `None` if its block is not among theirs.
fn within(cell: [i64; 3], [min, max]: [[u32; 3]; 2]) -> Option<[u32; 3]> {
    let mut place = [0; 3];
    for axis in 0..3 {
        place[axis] = u32::try_from(cell[axis]).ok()?;
        let block = place[axis] >> CELL_BITS;
        if block < min[axis] >> CELL_BITS || block > max[axis] >> CELL_BITS {
            return None;
        }
    }
    Some(place)
}
