/*!
Parts: runs of keys whose rows fit into memory.

Rows are counted by the leading bits of their keys. A run of keys that share these bits and has too
many rows is counted again, by the bits that follow, until none has too many; neighboring runs that
are small are joined. Evenly spread data are counted once: a million counts tell nearly all cells
apart.
*/

use super::{
    error::Trouble,
    field::{in_steps, length},
    keys::Keys,
    spill::Spill,
};
use puncta_core::Scene;
use std::{
    ops::{Range, RangeInclusive},
    sync::atomic::{AtomicU32, Ordering},
};

/// The largest number of bits by which a part is looked up.
const TABLE_BITS: u32 = 16;

/// The least and the largest number of rows that a thread looks at at once.
const STEP_ROWS: RangeInclusive<usize> = 1 << 6..=1 << 20;

/// How much memory there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// The largest number of rows in a part.
    pub(crate) part: u64,
    /// The number of rows that a thread looks at at once.
    pub(crate) step: usize,
    /// How many counts there may be.
    pub(crate) counts: usize,
}

impl Room {
    /// What to do with this many bytes for so many rows.
    pub(crate) fn new(memory: u64, row_bytes: usize, rows: u64) -> Self {
        let (buffers, row) = (memory / 5 * 4, row_bytes as u64);
        let threads = rayon::current_num_threads() as u64;
        // Rows, grouped rows, keys and places.
        let step = (buffers / threads / (2 * row + 12)).min(rows);
        let steps = STEP_ROWS;
        Self {
            // Rows, and what it takes to sort them if they are all in one brick.
            part: (buffers / (row + 28)).max(1),
            step: usize::try_from(step).unwrap_or(usize::MAX).clamp(*steps.start(), *steps.end()),
            counts: usize::try_from(memory / 64).unwrap_or(usize::MAX).clamp(4, 1 << 20),
        }
    }
}

/// A run of keys: those that share all bits but the lowest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    first: u64,
    bits: u32,
    rows: u64,
}

/// Called for each block of rows while they are counted for the first time.
pub(crate) type Look<'a, T> = &'a (dyn Fn(&mut T, &Scene, Range<u64>) + Sync);

/// Runs of keys, in order; together they hold all rows.
#[derive(Debug, PartialEq)]
pub(crate) struct Parts {
    /// The first key of each.
    firsts: Vec<u64>,
    /// The rows of each, once they are sorted.
    pub(crate) rows: Vec<Range<u64>>,
    /// For each value of the leading bits of a key, the part of the first key that has it.
    table: Vec<u32>,
    shift: u32,
}

impl Parts {
    /// Counts the rows of a spill, and looks at all of them once.
    pub(crate) fn count<T: Default + Send>(
        spill: &Spill,
        keys: &Keys,
        room: Room,
        look: Look<'_, T>,
    ) -> Result<(Self, Vec<T>), Trouble> {
        let mut runs = vec![Run { first: 0, bits: keys.bits, rows: spill.rows }];
        let (mut states, mut is_first) = (Vec::new(), true);
        let is_wide = |run: &Run| run.rows > room.part && run.bits > 0;
        while is_first || runs.iter().any(is_wide) {
            let found = cut((spill, keys, room), &mut runs, is_first.then_some(look))?;
            if is_first {
                states = found;
            }
            is_first = false;
        }
        Ok((Self::join(&runs, keys.bits, room.part), states))
    }

    /// Joins runs that have few rows.
    fn join(runs: &[Run], bits: u32, most: u64) -> Self {
        let (mut firsts, mut rows) = (vec![0], Vec::with_capacity(1));
        rows.push(0..0);
        for run in runs {
            let end = rows.last().map_or(0, |rows: &Range<u64>| rows.end);
            match rows.last_mut() {
                Some(last) if last.end - last.start + run.rows <= most || last.is_empty() => {
                    last.end += run.rows;
                }
                _ => {
                    firsts.push(run.first);
                    rows.push(end..end + run.rows);
                }
            }
        }
        let table_bits = bits.min(TABLE_BITS);
        let shift = bits - table_bits;
        let part_of = |key: u64| firsts.partition_point(|&first| first <= key) - 1;
        let table = (0..1_u64 << table_bits).map(|head| part_of(head << shift));
        let table = table.map(|part| u32::try_from(part).unwrap_or(u32::MAX)).collect();
        Self { firsts, rows, table, shift }
    }

    /// The part of a key.
    #[inline]
    pub(crate) fn of(&self, key: u64) -> usize {
        let head = usize::try_from(key >> self.shift).unwrap_or(usize::MAX);
        let low = self.table[head] as usize;
        let high = self.table.get(head + 1).map_or(self.firsts.len() - 1, |&part| part as usize);
        if low == high {
            return low;
        }
        low + self.firsts[low + 1..=high].partition_point(|&first| first <= key)
    }
}

/// Counts the rows of runs that have too many, and cuts these; on the way `look` looks at all rows.
fn cut<T: Default + Send>(
    (spill, keys, room): (&Spill, &Keys, Room),
    runs: &mut Vec<Run>,
    look: Option<Look<'_, T>>,
) -> Result<Vec<T>, Trouble> {
    let is_wide = |run: &Run| run.rows > room.part && run.bits > 0;
    let wide: Vec<Run> = runs.iter().copied().filter(is_wide).collect();
    let bits = (room.counts / wide.len().max(1)).max(2).ilog2();
    // A run of fewer bits than that has some counts that stay 0.
    let counts: Vec<AtomicU32> = (0..wide.len() << bits).map(|_| AtomicU32::new(0)).collect();
    let below = |run: &Run| run.bits.saturating_sub(bits);
    let start = || (spill.shape.block(room.step), Vec::new(), T::default());
    let work = |state: &mut (Scene, Vec<u64>, T), rows: Range<u64>| {
        let (block, found, looked) = state;
        spill.read(&rows, block)?;
        let count = length(&rows);
        if let Some(look) = look {
            look(looked, block, rows);
        }
        if wide.is_empty() {
            return Ok(());
        }
        let ids = block.attributes.ids.as_deref().unwrap_or_default();
        keys.of(&block.records[..count], &ids[..count], found);
        for &key in found.iter() {
            let at = wide.partition_point(|run| run.first <= key);
            let Some(run) = at.checked_sub(1).map(|at| &wide[at]) else { continue };
            let offset = key - run.first;
            if offset >> run.bits == 0 {
                let digit = usize::try_from(offset >> below(run)).unwrap_or(usize::MAX);
                counts[((at - 1) << bits) + digit].fetch_add(1, Ordering::Relaxed);
            }
        }
        Ok(())
    };
    let states = in_steps((spill.rows, room.step), start, work)?;
    let mut counts = counts.chunks(1 << bits);
    *runs = std::mem::take(runs)
        .into_iter()
        .flat_map(|run| match is_wide(&run).then(|| counts.next()).flatten() {
            None => vec![run],
            Some(counts) => (0_u64..)
                .zip(counts)
                .map(|(digit, rows)| (digit, u64::from(rows.load(Ordering::Relaxed))))
                .filter(|&(_, rows)| rows > 0)
                .map(|(digit, rows)| Run {
                    first: run.first + (digit << below(&run)),
                    bits: below(&run),
                    rows,
                })
                .collect(),
        })
        .collect();
    Ok(states.into_iter().map(|(.., looked)| looked).collect())
}
