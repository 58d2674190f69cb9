/*!
Worlds of blocks: which cells are filled, a bit for each.

Most blocks of a world cannot be seen, because others cover all their faces. So a world is not a list
of blocks: 64 cells one above the other are a word, and the blocks of the surface are found by a few
operations on words, for 64 cells at once (see `world/exposed.rs`). What a block is made of is asked for
when it is known to be part of the surface.
*/

mod exposed;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

/// How a cell is filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filling {
    /// Nothing is there.
    #[default]
    Air,
    /// A block that hides nothing: one can see through it, or it does not fill its cell.
    Clear,
    /// A block that hides what is behind it.
    Opaque,
}

impl Filling {
    /// That of a kind of block, if all kinds but air are opaque.
    #[must_use]
    #[inline]
    pub const fn solid(kind: u8) -> Self {
        if kind == 0 { Self::Air } else { Self::Opaque }
    }
}

/// What is wrong with a world of blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BlockWorldError {
    /// A side without cells, or with too many.
    #[error("a world with {side} cells along axis {axis}: it must have 1 to {max}", max = BlockWorld::SIDE_MAX)]
    Side {
        /// Which side.
        axis: usize,
        /// How many cells it has.
        side: u32,
    },
    /// A cell that is not there.
    #[error("a world of {dims:?} cells has no cell {cell:?}")]
    Outside {
        /// The index of the cell.
        cell: [u16; 3],
        /// How many cells there are along each axis.
        dims: [u32; 3],
    },
}

/// Which cells of a box are filled: one bit a cell, or two if some blocks are
/// [clear](Filling::Clear). 512³ cells take 16 MiB.
///
/// The border of the world does not hide anything.
///
/// # Examples
///
/// Of a massive cube, the blocks inside are not drawn, and of the others only what looks outwards:
///
/// ```
/// use puncta_avc::{BlockWorld, Filling};
///
/// let mut world = BlockWorld::new([10, 10, 10])?;
/// world.fill(|_cell| Filling::Opaque);
/// let blocks = world.surface(|_cell| 1);
/// assert_eq!(blocks.len(), 10 * 10 * 10 - 8 * 8 * 8);
/// let faces: u32 = blocks.iter().map(|block| block.faces.count_ones()).sum();
/// assert_eq!(faces, 6 * 10 * 10);
/// # Ok::<(), puncta_avc::BlockWorldError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockWorld {
    dims: [usize; 3],
    /// How many words a column along the z axis has.
    words: usize,
    /// The columns: those of a row along the x axis lie together, and then come those of the next y.
    /// Bits above the last cell of a column are zero.
    filled: Vec<u64>,
    /// Which of the filled cells are clear; empty if none is.
    clear: Vec<u64>,
}

impl BlockWorld {
    /// The most cells along an axis.
    pub const SIDE_MAX: u32 = 2048;

    /// A world of so many cells along each axis, all of them air.
    ///
    /// # Errors
    ///
    /// A side must have 1 to [`BlockWorld::SIDE_MAX`] cells.
    pub fn new(dims: [u32; 3]) -> Result<Self, BlockWorldError> {
        for (axis, side) in dims.into_iter().enumerate() {
            if !(1..=Self::SIDE_MAX).contains(&side) {
                return Err(BlockWorldError::Side { axis, side });
            }
        }
        let dims = dims.map(|side| side as usize);
        let words = dims[2].div_ceil(64);
        let filled = vec![0; dims[0] * dims[1] * words];
        Ok(Self { dims, words, filled, clear: Vec::new() })
    }

    /// How many cells there are along each axis.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "sides are checked")]
    pub fn dims(&self) -> [u32; 3] {
        self.dims.map(|side| side as u32)
    }

    /// How many blocks there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.filled.par_iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// Fills all cells anew, in parallel. The function is asked once for each.
    pub fn fill(&mut self, filling: impl Fn([u16; 3]) -> Filling + Sync) {
        self.fill_columns(|[x, y], column| {
            for (z, cell) in (0..).zip(column) {
                *cell = filling([x, y, z]);
            }
        });
    }

    /// Fills all cells anew, in parallel. The function is given the x and y of a column and its cells
    /// from below, which are air.
    #[expect(clippy::cast_possible_truncation, reason = "sides are checked")]
    pub fn fill_columns(&mut self, column: impl Fn([u16; 2], &mut [Filling]) + Sync) {
        let [width, _, height] = self.dims;
        self.clear = vec![0; self.filled.len()];
        let columns = self.filled.par_chunks_mut(self.words);
        let columns = columns.zip(self.clear.par_chunks_mut(self.words)).enumerate();
        let fill =
            |cells: &mut Vec<Filling>,
             (index, (filled, clear)): (usize, (&mut [u64], &mut [u64]))| {
                cells.fill(Filling::Air);
                column([(index % width) as u16, (index / width) as u16], cells);
                for (cells, (filled, clear)) in cells.chunks(64).zip(filled.iter_mut().zip(clear)) {
                    *filled = bits(cells, |cell| cell != Filling::Air);
                    let found = bits(cells, |cell| cell == Filling::Clear);
                    // Pages of memory that stay untouched are not needed.
                    if found != 0 {
                        *clear = found;
                    }
                }
            };
        columns.for_each_init(|| vec![Filling::Air; height], fill);
        if self.clear.par_iter().all(|&word| word == 0) {
            self.clear = Vec::new();
        }
    }

    /// Fills one cell.
    ///
    /// # Errors
    ///
    /// The cell must be there.
    pub fn set(&mut self, cell: [u16; 3], filling: Filling) -> Result<(), BlockWorldError> {
        let outside = BlockWorldError::Outside { cell, dims: self.dims() };
        let (at, bit) = self.place(cell).ok_or(outside)?;
        let put =
            |word: &mut u64, is_set: bool| *word = *word & !bit | if is_set { bit } else { 0 };
        put(&mut self.filled[at], filling != Filling::Air);
        let is_clear = filling == Filling::Clear;
        if is_clear && self.clear.is_empty() {
            self.clear = vec![0; self.filled.len()];
        }
        if let Some(word) = self.clear.get_mut(at) {
            put(word, is_clear);
        }
        Ok(())
    }

    /// How a cell is filled. What is not there is air.
    #[must_use]
    pub fn get(&self, cell: [u16; 3]) -> Filling {
        match self.place(cell) {
            Some((at, bit)) if self.filled[at] & bit != 0 => {
                let clear = self.clear.get(at).copied().unwrap_or(0);
                if clear & bit != 0 { Filling::Clear } else { Filling::Opaque }
            }
            _ => Filling::Air,
        }
    }

    /// The word of a cell, and its bit.
    fn place(&self, cell: [u16; 3]) -> Option<(usize, u64)> {
        let [x, y, z] = cell.map(usize::from);
        let [width, depth, height] = self.dims;
        let is_in = x < width && y < depth && z < height;
        is_in.then(|| ((y * width + x) * self.words + z / 64, 1 << (z % 64)))
    }
}

/// A bit for each of up to 64 cells.
#[inline]
fn bits(cells: &[Filling], is_set: impl Fn(Filling) -> bool) -> u64 {
    cells.iter().rev().fold(0, |word, &cell| word << 1 | u64::from(is_set(cell)))
}
