/*!
The address of a cell: a number in which each axis has bits of its own.

```text
[block z] [block y] [block x] [z: 3 bits] [y: 3 bits] [x: 3 bits]
```

The upper part tells a block of 8 x 8 x 8 cells, the lower part the cell in it. A step along an axis
is an addition that carries through the bits of this axis alone. Along each axis, addresses are in
the order of cells.

The block beyond the last one along an axis has a number, too, and so has the one before the first:
it is the largest that fits into the bits. A ray that leaves the grid is at one of these.
*/

/// The bits of an index that tell the cell within its block.
const CELL_BITS: u32 = 3;

/// The bits of an address that tell the cell within its block.
pub(crate) const BLOCK_BITS: u32 = 3 * CELL_BITS;

/// The address of what the grid does not have.
pub(crate) const NOWHERE: u64 = u64::MAX;

/// Where the bits of an address are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Axes {
    /// The number of blocks along each axis.
    blocks: [u32; 3],
    /// The bits that each axis has.
    masks: [u64; 3],
    /// Where the bits of the block start.
    shifts: [u32; 3],
}

impl Axes {
    /// Addresses for so many cells along each axis, at least one.
    pub(crate) fn new(dims: [u32; 3]) -> Self {
        let blocks = dims.map(|dim| dim.div_ceil(1 << CELL_BITS).max(1));
        let bits = blocks.map(|count| (count + 1).next_power_of_two().trailing_zeros());
        let shifts = [BLOCK_BITS, BLOCK_BITS + bits[0], BLOCK_BITS + bits[0] + bits[1]];
        let masks = std::array::from_fn(|axis| {
            // Of the last axis all bits up to the highest, so that each bit has an axis.
            let end = if axis == 2 { u64::MAX } else { (1 << (shifts[axis] + bits[axis])) - 1 };
            end & u64::MAX << shifts[axis] | 7 << (3 * axis)
        });
        Self { blocks, masks, shifts }
    }

    /// The numbers of blocks, row by row: of each row those that hold cells. Also the number that
    /// is above all of them.
    pub(crate) fn rows(&self) -> (impl Iterator<Item = std::ops::Range<usize>>, usize) {
        let [x, y, z] = self.blocks.map(|count| count as usize);
        let [_, shift_y, shift_z] = self.shifts.map(|shift| shift - BLOCK_BITS);
        let row = move |(z, y): (usize, usize)| {
            let start = z << shift_z | y << shift_y;
            start..start + x
        };
        ((0..z).flat_map(move |z| (0..y).map(move |y| (z, y))).map(row), z << shift_z)
    }

    /// The part of an address that belongs to an axis, for an index of a cell that there is.
    #[inline(always)]
    pub(crate) fn part(&self, axis: usize, index: u32) -> u64 {
        u64::from(index >> CELL_BITS) << self.shifts[axis] | u64::from(index & 7) << (3 * axis)
    }

    /// The address of a cell.
    #[inline(always)]
    pub(crate) fn address(&self, cell: [u32; 3]) -> u64 {
        self.part(0, cell[0]) | self.part(1, cell[1]) | self.part(2, cell[2])
    }

    /// The cell along each axis that has this address.
    #[inline]
    pub(crate) fn cell(&self, address: u64) -> [i64; 3] {
        std::array::from_fn(|axis| {
            let block = (address & self.masks[axis]) >> self.shifts[axis];
            (block << CELL_BITS | address >> (3 * axis) & 7).cast_signed()
        })
    }

    /// The first cell of a block.
    pub(crate) fn first_cell(&self, block: usize) -> [u32; 3] {
        let first = self.cell((block as u64) << BLOCK_BITS);
        first.map(|index| u32::try_from(index).unwrap_or(u32::MAX))
    }

    /// The address of a cell, if it lies in some block.
    pub(crate) fn find(&self, cell: [i64; 3]) -> Option<u64> {
        let mut address = 0;
        for (axis, &index) in cell.iter().enumerate() {
            let index = u32::try_from(index).ok()?;
            if index >> CELL_BITS >= self.blocks[axis] {
                return None;
            }
            address |= self.part(axis, index);
        }
        Some(address)
    }

    /// The bits of an axis.
    #[inline(always)]
    pub(crate) const fn mask(&self, axis: usize) -> u64 {
        self.masks[axis]
    }

    /// What to add to the part of an axis for a step up or, if `step` is negative, down.
    #[inline(always)]
    pub(crate) const fn delta(&self, axis: usize, step: i64) -> u64 {
        if step < 0 { self.masks[axis] } else { 1 << (3 * axis) }
    }
}

/// Which block an address belongs to.
#[inline(always)]
pub(crate) const fn block(address: u64) -> usize {
    (address >> BLOCK_BITS) as usize
}

/// The part of an address after a step along its axis.
#[inline(always)]
pub(crate) const fn stepped(part: u64, delta: u64, mask: u64) -> u64 {
    // The ones between the bits of the axis hand the carry on.
    (part | !mask).wrapping_add(delta) & mask
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn steps_lead_to_the_next_cell(
            dims in [1_u32..300, 1_u32..300, 1_u32..300],
            at in [0.0_f64..1.0, 0.0_f64..1.0, 0.0_f64..1.0],
            axis in 0_usize..3,
            step in prop_oneof![Just(-1_i64), Just(1)],
        ) {
            let axes = Axes::new(dims);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
            let cell: [u32; 3] = std::array::from_fn(|i| (at[i] * f64::from(dims[i])) as u32);
            let address = axes.address(cell);
            prop_assert_eq!(axes.cell(address), cell.map(i64::from));
            prop_assert_eq!(axes.find(cell.map(i64::from)), Some(address));
            let mask = axes.mask(axis);
            let next = stepped(address & mask, axes.delta(axis, step), mask) | address & !mask;
            let mut expected = cell.map(i64::from);
            expected[axis] += step;
            let (mut rows, end) = axes.rows();
            let is_inside = rows.any(|row| row.contains(&block(next)));
            match axes.find(expected) {
                Some(address) => prop_assert!(next == address && is_inside && block(next) < end),
                None => prop_assert!(!is_inside),
            }
        }
    }
}
