/*!
Keys: by which rows are sorted.

A key is the code of a row's cell, and below it the row's id. So a cell that holds more rows than
there is memory for is cut by ids, as the grid is cut by codes, and the order of all rows is given
by their keys alone.
*/

use crate::{
    codes::{Coder, Layout, RUN},
    dispatch::{Kernel, widest},
};
use puncta_core::Sphere;

/// How many bits of a key belong to the id.
pub(crate) const ID_BITS: u32 = u32::BITS;

/// Makes keys.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keys {
    block: Coder,
    cell: Coder,
    cell_bits: u32,
    /// How many bits differ.
    pub(crate) bits: u32,
}

impl Keys {
    /// Keys for a grid; the digit of the coder does not matter.
    pub(crate) fn new(layout: Layout, coder: Coder) -> Self {
        let cell_bits = layout.bits() - layout.block_bits();
        Self {
            block: coder.with(layout.digit(cell_bits..layout.bits())),
            cell: coder.with(layout.digit(0..cell_bits)),
            cell_bits,
            bits: layout.bits() + ID_BITS,
        }
    }

    /// The keys of some rows.
    pub(crate) fn of(&self, records: &[Sphere], ids: &[u32], keys: &mut Vec<u64>) {
        widest(Make { of: self, records, ids, keys });
    }
}

/// Makes keys.
struct Make<'a> {
    of: &'a Keys,
    records: &'a [Sphere],
    ids: &'a [u32],
    keys: &'a mut Vec<u64>,
}

impl Kernel for Make<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (mut blocks, mut cells) = ([0; RUN], [0; RUN]);
        self.keys.clear();
        for (records, ids) in self.records.chunks(RUN).zip(self.ids.chunks(RUN)) {
            self.of.block.code(records, &mut blocks);
            self.of.cell.code(records, &mut cells);
            for ((block, cell), id) in blocks.iter().zip(&cells).zip(ids) {
                let code = u64::from(block << self.of.cell_bits | cell);
                self.keys.push(code << ID_BITS | u64::from(*id));
            }
        }
    }
}
