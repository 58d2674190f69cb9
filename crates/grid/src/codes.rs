/*!
The code of a cell: the number by which bricks are sorted.

Cells come in blocks. A code has two parts: which block, row by row, and which cell within the block,
again row by row. Bricks that are near in memory are near in space, and a run of codes that share
their leading bits is a block of cells or a slab of one. The sides of a block are powers of two, so
each index of a cell has some high bits that belong to the block and some low bits that belong to the
cell, and both parts of a code are sums of shifted indices. That is little enough to be done for
eight positions at once.

Two other orders were tried. A Morton curve through all cells has no advantage over two levels, and
its codes cost more. Rows of cells without blocks are as fast to sort, but a run of bricks is long
and thin then.
*/

use crate::Cells;
use puncta_core::Record;
use std::ops::Range;

/// Where the bits of the indices are in a code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    /// For each axis the number of bits of an index that belong to the block.
    block: [u32; 3],
    /// For each axis the number of bits of an index that belong to the cell within the block.
    cell: [u32; 3],
}

impl Layout {
    /// A layout for indices below `dims`, with up to `1 << bits` blocks.
    pub(crate) fn new(dims: [u32; 3], bits: u32) -> Self {
        let mut cell = dims.map(|dim| u32::BITS - dim.saturating_sub(1).leading_zeros());
        let mut block = [0; 3];
        for _ in 0..bits.min(cell.iter().sum()) {
            // The longest axis first; of axes that are equally long, the last.
            let axis = (0..3).max_by_key(|&axis| cell[axis]).unwrap_or(0);
            cell[axis] -= 1;
            block[axis] += 1;
        }
        Self { block, cell }
    }

    /// The number of bits of a code.
    pub(crate) fn bits(&self) -> u32 {
        self.block_bits() + self.cell.iter().sum::<u32>()
    }

    /// How many of them tell the block.
    pub(crate) fn block_bits(&self) -> u32 {
        self.block.iter().sum()
    }

    /// The code of a cell.
    pub(crate) fn encode(&self, place: [u32; 3]) -> u32 {
        let cell_bits = self.bits() - self.block_bits();
        // Without blocks, shifting by all 32 bits would be too far.
        let block = self.block().of(place).checked_shl(cell_bits).unwrap_or(0);
        block | self.digit(0..cell_bits).of(place)
    }

    /// The cell of a code.
    pub(crate) fn decode(&self, code: u32) -> [u32; 3] {
        let (mut place, mut rest) = ([0; 3], u64::from(code));
        let mut take = |bits: u32| {
            let taken = rest & ((1 << bits) - 1);
            rest >>= bits;
            u32::try_from(taken).unwrap_or(u32::MAX)
        };
        for (index, bits) in place.iter_mut().zip(self.cell) {
            *index = take(bits);
        }
        for ((index, bits), below) in place.iter_mut().zip(self.block).zip(self.cell) {
            *index |= take(bits) << below;
        }
        place
    }

    /// The bits that tell the block.
    pub(crate) fn block(&self) -> Digit {
        self.digit(self.bits() - self.block_bits()..self.bits())
    }

    /// Some bits of the codes, counted from the lowest: all of the block, or some of the cell.
    pub(crate) fn digit(&self, bits: Range<u32>) -> Digit {
        let cell_bits = self.bits() - self.block_bits();
        let (fields, below, mut start) = if bits.start >= cell_bits && bits.end > bits.start {
            (self.block, self.cell, cell_bits)
        } else {
            (self.cell, [0; 3], 0)
        };
        let mut digit =
            Digit { down: [0; 3], mask: [0; 3], up: [0; 3], bits: bits.end - bits.start };
        for axis in 0..3 {
            let (low, high) = (start.max(bits.start), (start + fields[axis]).min(bits.end));
            if low < high {
                digit.down[axis] = below[axis] + (low - start);
                digit.mask[axis] = (1 << (high - low)) - 1;
                digit.up[axis] = low - bits.start;
            }
            start += fields[axis];
        }
        digit
    }
}

/// Some bits of a code: how to make them from the indices of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Digit {
    down: [u32; 3],
    mask: [u32; 3],
    up: [u32; 3],
    bits: u32,
}

impl Digit {
    /// How many values it can have.
    pub(crate) fn values(&self) -> usize {
        1 << self.bits
    }

    /// The digit of a cell.
    #[inline(always)]
    fn of(&self, place: [u32; 3]) -> u32 {
        let field =
            |axis: usize| (place[axis] >> self.down[axis] & self.mask[axis]) << self.up[axis];
        field(0) | field(1) | field(2)
    }
}

/// How many records are coded at once.
pub(crate) const RUN: usize = 64;

/// Codes positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coder {
    corner: [f32; 3],
    scale: f32,
    last: [f32; 3],
    digit: Digit,
    /// Zero, which the compiler does not know.
    zero: u32,
}

impl Coder {
    pub(crate) fn new(cells: &Cells, digit: Digit) -> Self {
        let (corner, scale, last) = cells.lattice();
        Self {
            corner: corner.to_array(),
            scale,
            last: last.to_array(),
            digit,
            zero: std::hint::black_box(0),
        }
    }

    /// The same cells, another digit.
    pub(crate) fn with(self, digit: Digit) -> Self {
        Self { digit, ..self }
    }

    pub(crate) fn digit(&self) -> &Digit {
        &self.digit
    }

    /// The digits of the cells of records.
    ///
    /// The arithmetic is that of [`Cells`]. What is not finite has some digit.
    #[inline(always)]
    pub(crate) fn code<R: Record>(&self, records: &[R], digits: &mut [u32]) {
        for (record, digit) in records.iter().zip(digits) {
            let position = record.position();
            // The radius, of which nothing is left, makes whole records of what is loaded.
            *digit = record.radius().to_bits() & self.zero
                | self.digit.of([
                    self.along(0, position.x),
                    self.along(1, position.y),
                    self.along(2, position.z),
                ]);
        }
    }

    /// The cell along an axis that holds a coordinate.
    #[inline(always)]
    fn along(&self, axis: usize, x: f32) -> u32 {
        let index = (x - self.corner[axis]) * self.scale;
        // Unlike `max` and `min`, these are one instruction each; of NaN they make 0.
        let index = if index > 0.0 { index } else { 0.0 };
        let index = if index < self.last[axis] { index } else { self.last[axis] };
        #[expect(unsafe_code, reason = "a cast that saturates is several instructions")]
        // SAFETY: the number is between 0 and the last index, which is below 2^20.
        unsafe {
            index.to_int_unchecked::<i32>() as u32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_code_is_made_of_its_digits(
            dims in [1_u32..2000, 1_u32..2000, 1_u32..200],
            block_bits in 0_u32..14,
            cut in 0_u32..30,
            seed in any::<u32>(),
        ) {
            let layout = Layout::new(dims, block_bits);
            prop_assert!(layout.block_bits() == block_bits.min(layout.bits()));
            let place = [seed % dims[0], (seed >> 8) % dims[1], (seed >> 20) % dims[2]];
            let code = layout.encode(place);
            prop_assert_eq!(layout.decode(code), place);
            let cell_bits = layout.bits() - layout.block_bits();
            prop_assert_eq!(layout.block().of(place), code.checked_shr(cell_bits).unwrap_or(0));
            let cut = cut.min(cell_bits);
            let cell = u64::from(code) & ((1 << cell_bits) - 1);
            prop_assert_eq!(u64::from(layout.digit(0..cut).of(place)), cell & ((1 << cut) - 1));
            prop_assert_eq!(u64::from(layout.digit(cut..cell_bits).of(place)), cell >> cut);
        }
    }

    #[test]
    fn codes_differ() {
        for (dims, bits) in [([7, 5, 3], 4), ([16, 1, 1], 2), ([1, 1, 1], 3), ([2, 9, 4], 0)] {
            let layout = Layout::new(dims, bits);
            let mut seen = std::collections::BTreeSet::new();
            for x in 0..dims[0] {
                for y in 0..dims[1] {
                    seen.extend((0..dims[2]).map(|z| layout.encode([x, y, z])));
                }
            }
            assert_eq!(seen.len(), dims.iter().map(|&dim| dim as usize).product::<usize>());
            assert!(seen.last().is_none_or(|&last| u64::from(last) < 1 << layout.bits()));
        }
    }
}
