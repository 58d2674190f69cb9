/*!
Colors of records: where they come from, and which of them are on the GPU.

Colors lie in pages beside the spheres that they belong to, 4 bytes each. They are brought there for
what was drawn, and only when something is shaded; they stay as long as their spheres do.
*/

use crate::{Error, Gpu, residency::SEGMENT, store::Store};
use rayon::prelude::*;
use std::fmt;

/// Where the colors of records come from. All colors are sRGB.
#[derive(Clone, Copy)]
pub enum Paint<'a> {
    /// One color for all.
    Uniform([u8; 3]),
    /// A color for each record.
    Each {
        /// A number that changes when any color does: what has this number is not asked for again.
        key: u64,
        /// The color of the record at an index of [`Scene::records`](puncta_core::Scene::records).
        of: &'a (dyn Fn(u32) -> [u8; 3] + Sync),
    },
}

impl fmt::Debug for Paint<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniform(color) => f.debug_tuple("Uniform").field(color).finish(),
            Self::Each { key, .. } => f.debug_struct("Each").field("key", key).finish(),
        }
    }
}

impl Paint<'_> {
    /// The color of a record, as shaders take it.
    pub(crate) fn word(&self, index: u32) -> u32 {
        let [r, g, b] = match self {
            Self::Uniform(color) => *color,
            Self::Each { of, .. } => of(index),
        };
        u32::from_le_bytes([r, g, b, 0])
    }
}

/// Which slots have colors, and those of which paint.
#[derive(Debug, Default)]
pub(crate) struct Coat {
    key: Option<u64>,
    has_color: Vec<bool>,
}

impl Coat {
    /// Another paint: what was there is worth nothing.
    pub(crate) fn begin(&mut self, key: u64) {
        if self.key != Some(key) {
            self.key = Some(key);
            self.has_color.clear();
        }
    }

    /// A slot holds other records from now on.
    pub(crate) fn wipe(&mut self, slot: u32) {
        if let Some(has_color) = self.has_color.get_mut(slot as usize) {
            *has_color = false;
        }
    }

    /// Notes that a slot is painted; returns whether it was.
    pub(crate) fn paint(&mut self, slot: u32) -> bool {
        let slot = slot as usize;
        if self.has_color.len() <= slot {
            self.has_color.resize(slot + 1, false);
        }
        std::mem::replace(&mut self.has_color[slot], true)
    }
}

/// How many segments are painted at once: 4 MB.
const PAINTED: usize = 1024;

impl Store {
    /// Brings the colors of segments to their slots, of a scene with so many records.
    pub(crate) fn paint(
        &mut self,
        gpu: &Gpu,
        (paint, records): (&Paint<'_>, u32),
        segments: &mut [(u32, u32)],
    ) -> Result<(), Error> {
        segments.sort_unstable_by_key(|(_, slot)| *slot);
        let result = segments
            .chunks(PAINTED)
            .try_for_each(|part| self.bring_colors(gpu, (paint, records), part));
        if result.is_err() {
            self.coat = Coat::default();
        }
        result
    }

    fn bring_colors(
        &mut self,
        gpu: &Gpu,
        (paint, records): (&Paint<'_>, u32),
        segments: &[(u32, u32)],
    ) -> Result<(), Error> {
        let mut words = vec![0_u32; segments.len() * SEGMENT as usize];
        words.par_chunks_mut(SEGMENT as usize).zip(segments).for_each(|(words, (segment, _))| {
            let first = segment * SEGMENT;
            for (word, index) in words.iter_mut().zip(first..records) {
                *word = paint.word(index);
            }
        });
        // Slots that lie side by side are written at once.
        let mut start = 0;
        while start < segments.len() {
            let (page, place) = self.address(segments[start].1);
            let is_next = |(count, (_, slot)): &(usize, &(u32, u32))| {
                let next = u32::try_from(*count).unwrap_or(u32::MAX).saturating_mul(SEGMENT);
                self.address(*slot) == (page, place.saturating_add(next))
            };
            let count = segments[start..].iter().enumerate().take_while(is_next).count().max(1);
            let colors = self.colors(gpu, page)?;
            let new = &words[start * SEGMENT as usize..][..count * SEGMENT as usize];
            let at = u64::from(place) * 4;
            gpu.guard("colors", || {
                gpu.queue.write_buffer(&colors, at, bytemuck::cast_slice(new));
            })?;
            start += count;
        }
        self.brought += words.len() as u64 * 4;
        // What was written is staged until something is submitted.
        gpu.guard("colors", || gpu.queue.submit([]))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_is_painted_until_it_is_wiped_or_the_paint_changes() {
        let mut coat = Coat::default();
        coat.begin(1);
        assert!(!coat.paint(3));
        coat.begin(1);
        assert!(coat.paint(3));
        assert!(!coat.paint(2));
        coat.wipe(3);
        coat.wipe(9);
        assert!(!coat.paint(3) && coat.paint(2));
        coat.begin(2);
        assert!(!coat.paint(2));
    }
}
