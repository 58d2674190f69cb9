/*!
From the visibility buffer to a picture.

The GPU has found which record is seen at each pixel. What remains to be done for ids is to find where
those records lie now; only bricks that were drawn need to be searched. Depths are computed once more,
in `f64`: they are as exact as those of the CPU's renderer, and at rims, where `f32` is at its worst,
too. Where the answer hangs on a hair and `f64` says that the ray misses, the GPU's depth stays.
*/

use crate::{Error, GpuRenderer, kernel::read, picture::Frame, survey::words};
use puncta_core::{Content, NO_RECORD, Picture, Record};
use rayon::prelude::*;

/// The picture of what was drawn, with the depths that the GPU found.
pub(crate) fn finish<R: Record, S>(
    renderer: &mut GpuRenderer<S>,
    content: &Content<'_, R>,
) -> Result<Picture, Error> {
    let GpuRenderer { gpu, bench, frame, .. } = renderer;
    let frame = frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
    content.validate(&[])?;
    let view = &frame.target.view;
    let mut picture = Picture::new(view.width(), view.height())?;
    let bytes = u64::from(frame.target.pixels()) * 8;
    let keys = words(&read(gpu, &mut bench.pool, &[(&frame.target.visibility, 0..bytes)])?);
    let places = frame.is_of(content).then(|| Places::new(frame, content, &keys));
    let is_seen = keys.par_chunks(2).any(|key| key[1] != 0);
    let Some(places) = places else {
        return if is_seen { Err(Error::OtherContent) } else { Ok(picture) };
    };
    let width = view.width() as usize;
    let rows = picture.id.par_chunks_mut(width).zip(picture.depth.par_chunks_mut(width));
    rows.zip(keys.par_chunks(2 * width)).for_each(|((ids, depths), keys)| {
        let mut known = (NO_RECORD, NO_RECORD);
        for (column, key) in keys.chunks(2).enumerate().filter(|(_, key)| key[1] != 0) {
            if known.0 != !key[0] {
                known = (!key[0], places.find(!key[0]));
            }
            (ids[column], depths[column]) = (known.1, f32::from_bits(!key[1]));
        }
    });
    Ok(picture)
}

/// Where the records of some ids lie.
struct Places {
    /// Ids and indices, ascending; `None` where an id is an index.
    pairs: Option<Vec<(u32, u32)>>,
}

impl Places {
    fn new<R: Record>(frame: &Frame, content: &Content<'_, R>, keys: &[u32]) -> Self {
        let Some(ids) = content.scene.attributes.ids.as_deref() else {
            return Self { pairs: None };
        };
        let mut seen: Vec<u32> = keys
            .par_chunks(1 << 14)
            .flat_map_iter(|keys| {
                let mut last = None;
                keys.chunks(2)
                    .filter(|key| key[1] != 0)
                    .map(|key| !key[0])
                    .filter(move |&id| last.replace(id) != Some(id))
            })
            .collect();
        seen.par_sort_unstable();
        seen.dedup();
        let filter = Filter::new(&seen);
        let touched =
            content.bricks.par_iter().zip(&frame.touched).filter(|(_, touched)| **touched);
        let mut pairs: Vec<(u32, u32)> = touched
            .flat_map_iter(|(brick, _)| {
                let range = brick.records.clone();
                let held = &ids[range.start as usize..range.end as usize];
                let pairs = held.iter().copied().zip(range);
                pairs.filter(|(id, _)| filter.may_hold(*id) && seen.binary_search(id).is_ok())
            })
            .collect();
        pairs.par_sort_unstable();
        pairs.dedup_by_key(|(id, _)| *id);
        Self { pairs: Some(pairs) }
    }

    fn find(&self, id: u32) -> u32 {
        let Some(pairs) = &self.pairs else { return id };
        let place = pairs.binary_search_by_key(&id, |(id, _)| *id);
        place.ok().and_then(|place| pairs.get(place)).map_or(NO_RECORD, |(_, index)| *index)
    }
}

/// Says quickly of most ids that they are not in a set.
struct Filter {
    bits: Vec<u64>,
    mask: u32,
}

impl Filter {
    fn new(ids: &[u32]) -> Self {
        let count = (ids.len() * 16).next_power_of_two().clamp(64, 1 << 28);
        let mask = u32::try_from(count - 1).unwrap_or(u32::MAX);
        let mut bits = vec![0_u64; count / 64];
        for id in ids {
            bits[((id & mask) / 64) as usize] |= 1 << (id % 64);
        }
        Self { bits, mask }
    }

    fn may_hold(&self, id: u32) -> bool {
        self.bits[((id & self.mask) / 64) as usize] >> (id % 64) & 1 != 0
    }
}
