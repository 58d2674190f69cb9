/*!
The distribution: each row goes from the spill to where the rows of its part will lie.

A thread reads a block of rows, groups them by their parts in memory, and writes each group behind
what was written of its part before. Where that is, is known from the counts; so threads do not wait
for each other. The order within a part is that of nothing, but parts are sorted afterwards.
*/

use super::{
    error::Trouble,
    field::{Field, in_steps, length},
    keys::Keys,
    parts::Parts,
    shape,
    spill::Spill,
};
use puncta_core::Scene;
use std::{
    ops::Range,
    sync::atomic::{AtomicU64, Ordering},
};

/// The buffers of a thread.
struct Buffers {
    rows: Scene,
    grouped: Scene,
    keys: Vec<u64>,
    /// First the part of each row, then its place among the grouped rows.
    places: Vec<u32>,
    /// The end of the group of each part.
    ends: Vec<u32>,
}

/// Writes all rows of a spill to the places of their parts, `step` at a time.
pub(crate) fn distribute(
    (spill, keys): (&Spill, &Keys),
    parts: &Parts,
    fields: &[Field],
    step: usize,
    done: &(dyn Fn(u64) + Sync),
) -> Result<(), Trouble> {
    let next: Vec<AtomicU64> = parts.rows.iter().map(|rows| AtomicU64::new(rows.start)).collect();
    let start = || Buffers {
        rows: spill.shape.block(step),
        grouped: spill.shape.block(step),
        keys: Vec::new(),
        places: Vec::new(),
        ends: Vec::new(),
    };
    let work = |buffers: &mut Buffers, rows: Range<u64>| {
        let count = length(&rows);
        spill.read(&rows, &mut buffers.rows)?;
        buffers.group(count, keys, parts);
        let grouped = shape::bytes(&buffers.grouped);
        let mut start = 0;
        for (next, &end) in next.iter().zip(&buffers.ends) {
            let group = start as usize..end as usize;
            start = end;
            if group.is_empty() {
                continue;
            }
            let row = next.fetch_add(group.len() as u64, Ordering::Relaxed);
            for (field, bytes) in fields.iter().zip(&grouped) {
                let bytes = &bytes[group.start * field.width..group.end * field.width];
                field.write(row, bytes).map_err(Trouble::writing)?;
            }
        }
        spill.forget(&rows);
        done(count as u64);
        Ok(())
    };
    in_steps((spill.rows, step), start, work).map(drop)
}

impl Buffers {
    /// Brings together the rows of each part.
    fn group(&mut self, count: usize, keys: &Keys, parts: &Parts) {
        let ids = self.rows.attributes.ids.as_deref().unwrap_or_default();
        keys.of(&self.rows.records[..count], &ids[..count], &mut self.keys);
        self.ends.clear();
        self.ends.resize(parts.rows.len(), 0);
        self.places.clear();
        for &key in &self.keys {
            let part = parts.of(key);
            self.ends[part] += 1;
            self.places.push(u32::try_from(part).unwrap_or(u32::MAX));
        }
        let mut start = 0;
        for end in &mut self.ends {
            start += std::mem::replace(end, start);
        }
        for place in &mut self.places {
            let next = &mut self.ends[*place as usize];
            *place = *next;
            *next += 1;
        }
        let widths = shape::Shape::of(&self.rows).widths();
        let columns = shape::bytes(&self.rows).into_iter().zip(shape::bytes_mut(&mut self.grouped));
        for ((from, to), width) in columns.zip(widths) {
            shape::scatter(from, to, width, &self.places);
        }
    }
}
