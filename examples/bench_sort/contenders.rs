//! The sorts that are compared, and copying, which none can beat by much.

use clap::ValueEnum;
use puncta::{Cells, Grid, GridConfig, GridError, Record, Sphere};
use rayon::prelude::*;
use rdst::{RadixKey, RadixSort};
use std::{
    any::Any,
    sync::atomic::{AtomicU32, Ordering::Relaxed},
};

/// Something that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Contender {
    /// Copies the records, one thread
    Copy1,
    /// Copies the records, two threads
    Copy2,
    /// Ours: bounds, count, permutation, statistics
    Puncta,
    /// The sort of the thesis: one thread, two passes, straight into cells; then the statistics
    Thesis,
    /// The parallel sort of rayon, by cell, without statistics
    Rayon,
    /// The radix sort rdst, by cell, without statistics
    Rdst,
}

impl Contender {
    pub(crate) fn is_copy(self) -> bool {
        matches!(self, Self::Copy1 | Self::Copy2)
    }

    /// Whether it takes so long that it is measured less often.
    pub(crate) fn is_slow(self) -> bool {
        matches!(self, Self::Thesis | Self::Rayon)
    }

    /// Runs it on `work`, a copy of `records`; what comes of it is to be dropped after the clock was
    /// read.
    pub(crate) fn run(
        self,
        records: &[Sphere],
        work: &mut [Sphere],
        grid: u32,
        cells: &Cells,
    ) -> Result<Box<dyn Any>, GridError> {
        match self {
            Self::Copy1 => work.copy_from_slice(records),
            Self::Copy2 => copy_by_two(records, work),
            Self::Puncta => {
                return Ok(Box::new(Grid::sort(work, &GridConfig::longest_side(grid))?));
            }
            Self::Thesis => return Ok(Box::new(thesis(work, cells))),
            Self::Rayon => work.par_sort_unstable_by_key(|record| flat(cells, record)),
            Self::Rdst => {
                Keyed::prepare(cells);
                Keyed::cast(work).radix_sort_unstable();
            }
        }
        Ok(Box::new(()))
    }

    /// Whether the records of each cell are next to each other.
    pub(crate) fn is_right(self, work: &[Sphere], cells: &Cells) -> bool {
        let mut seen = vec![0_u64; cells.count().div_ceil(64)];
        let runs = work.chunk_by(|a, b| flat(cells, a) == flat(cells, b));
        let mut is_new = |cell: u32| {
            let (word, bit) = (&mut seen[cell as usize / 64], 1 << (cell % 64));
            let is_new = *word & bit == 0;
            *word |= bit;
            is_new
        };
        self.is_copy() || runs.into_iter().all(|run| is_new(flat(cells, &run[0])))
    }
}

fn copy_by_two(from: &[Sphere], to: &mut [Sphere]) {
    let middle = from.len() / 2;
    let (from, to) = (from.split_at(middle), to.split_at_mut(middle));
    rayon::join(|| to.0.copy_from_slice(from.0), || to.1.copy_from_slice(from.1));
}

/// The cell of a record, row by row.
fn flat(cells: &Cells, record: &Sphere) -> u32 {
    let ([x, y, z], dims) = (cells.place(record.position()), cells.dims());
    (z * dims[1] + y) * dims[0] + x
}

/// What the thesis does: a histogram over the cells gives each cell its place, then each record is
/// swapped to the place of its cell, and at last the bricks are measured.
fn thesis(records: &mut [Sphere], cells: &Cells) -> Vec<([f32; 6], f32)> {
    let mut counts = vec![0_u32; cells.count()];
    for record in &*records {
        counts[flat(cells, record) as usize] += 1;
    }
    let mut start = 0;
    let mut heads = counts.clone();
    for head in &mut heads {
        start += std::mem::replace(head, start);
    }
    let mut end = 0;
    for here in 0..counts.len() {
        end += counts[here];
        while heads[here] < end {
            let head = heads[here] as usize;
            let there = flat(cells, &records[head]) as usize;
            if there != here {
                records.swap(head, heads[there] as usize);
            }
            heads[there] += 1;
        }
    }
    let mut rest = &*records;
    let mut bricks = Vec::new();
    for count in counts.into_iter().filter(|&count| count > 0) {
        let (members, behind) = rest.split_at(count as usize);
        rest = behind;
        let mut found = ([f32::INFINITY; 6], 0.0_f32);
        for member in members {
            for axis in 0..3 {
                found.0[axis] = found.0[axis].min(member.center[axis]);
                found.0[axis + 3] = found.0[axis + 3].min(-member.center[axis]);
            }
            found.1 = found.1.max(member.radius);
        }
        bricks.push(found);
    }
    bricks
}

/// A record whose key is its cell, computed whenever it is asked for.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
struct Keyed(Sphere);

/// The corner and scale of the cells, as bits, and their numbers: a key cannot be told otherwise.
static CELLS: [AtomicU32; 7] = [const { AtomicU32::new(0) }; 7];

impl Keyed {
    fn prepare(cells: &Cells) {
        let corner = cells.corner().to_array().map(f32::to_bits);
        let scale = cells.scale().to_bits();
        for (cell, value) in CELLS.iter().zip(corner.into_iter().chain([scale]).chain(cells.dims()))
        {
            cell.store(value, Relaxed);
        }
    }

    fn cast(records: &mut [Sphere]) -> &mut [Self] {
        bytemuck::cast_slice_mut(records)
    }

    fn key(&self) -> u32 {
        let scale = f32::from_bits(CELLS[3].load(Relaxed));
        let place: [u32; 3] = std::array::from_fn(|axis| {
            let corner = f32::from_bits(CELLS[axis].load(Relaxed));
            let last = CELLS[4 + axis].load(Relaxed) - 1;
            let cell = (self.0.center[axis] - corner) * scale;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it saturates"
            )]
            let cell = cell as u32;
            cell.min(last)
        });
        let dims = [CELLS[4].load(Relaxed), CELLS[5].load(Relaxed)];
        (place[2] * dims[1] + place[1]) * dims[0] + place[0]
    }
}

impl RadixKey for Keyed {
    const LEVELS: usize = 3;

    fn get_level(&self, level: usize) -> u8 {
        self.key().to_le_bytes()[level]
    }
}
