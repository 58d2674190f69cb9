/*!
Scenes that are larger than memory: an external sort into brick files, and their reader.

[`convert`] is a distribution sort. It goes over the data three times:

1. What the source gives is *spilled* to files without a name, for most sources give it only once.
   The box of all records is known then, a sample of them tells where the cells are to lie, and that
   makes the grid.
2. Rows are *counted* by the leading bits of their keys (the code of their cell, and their id
   below). Neighboring keys are joined to *parts* whose rows fit into memory. As the counts are exact, it is
   known where in the file the rows of each part will lie.
3. Rows are *distributed* to their parts, and then part by part is read, *sorted* in memory as any
   other scene, and written back.

So every row is written three times and read four times, always in large pieces. The keys are a
total order. So the file is the same whatever the memory and the number of threads, and a cell that
is larger than memory is no special case.

The layout of the file, and why it is as it is, stands in `docs/bricks.md`.
*/

mod arrange;
mod check;
mod convert;
mod distribute;
mod error;
mod field;
mod header;
mod keys;
mod lattice;
mod open;
mod parts;
mod publish;
mod shape;
mod spill;
mod sums;
mod survey;

pub use self::{
    convert::{
        ConvertConfig, ConvertStage, ConvertStep, ConvertSummary, Invalid, convert, convert_watched,
    },
    error::{ConvertError, OpenError},
    open::{BrickFile, Verify},
};
