/*!
Shading on the GPU: from the visibility buffer to an image, of which nothing is read back.

The visibility buffer holds ids, and ids say nothing of where a record lies. So shading goes over the
records of the bricks that were drawn once more, and looks for those that are seen:

1. The ids in the picture become a set, a bit for each (`shade_seen.wgsl`).
2. Each id of the set gets a number: with the bits that are set before its word, and those below it,
   numbers are without gaps, and no list has to be sorted.
3. What shading needs of each record whose bit is set goes into a table, at that number
   (`shade_table.wgsl`): its place, to tell how much the sphere faces the ray, and its color. Records of
   close bricks are listed by the CPU (`shade_list.rs`).
4. Each pixel of the image finds the numbers of its ids, and averages what they show (`shade.wgsl`).

No geometry is drawn, and no depth is compared: whatever has shown an id, its pixel gets a color. There
are at most as many numbers as pixels. So the table is never larger than what can be bound: large pictures
are made in bands of rows. Records may have left the GPU since they were drawn; they are brought again,
in groups, as they are for drawing.
*/

use crate::{
    Error, GpuRenderer, Shaded, Spheres,
    exact::Ball,
    paint::Paint,
    residency::SEGMENT,
    round::{Batch, CHUNK, CHUNKS_MAX, IS_RECALLED, Piece},
    shade_list::{Entry, list},
    shade_pass::{Shading, Tables},
    shape::Shape,
    store::Store,
    table::Known,
};
use bytemuck::{Pod, Zeroable};
use puncta_core::{Background, Content, Image, Record, View};
use std::ops::Range;

/// How to make an image of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadeConfig {
    /// What is seen where there is no record.
    pub background: Background,
    /// The share of light that reaches a surface from everywhere, 0 to 1.
    pub ambient: f32,
    /// How many pixels of the picture make one of the image, along each side.
    pub supersample: u32,
}

impl Default for ShadeConfig {
    fn default() -> Self {
        Self { background: Background::default(), ambient: 0.18, supersample: 1 }
    }
}

/// The most pixels that are shaded at once: a table of 128 MiB.
const BAND_PIXELS: u64 = 1 << 22;

/// The most records that are listed at once: 8 MiB.
const LISTED_MAX: u64 = 1 << 18;

const ENTRY_BYTES: u64 = size_of::<Entry>() as u64;

/// `Shade` of `shade_common.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct ShadeData {
    pub(crate) size: [u32; 2],
    pub(crate) factor: u32,
    pub(crate) ambient: f32,
    pub(crate) first_row: u32,
    pub(crate) rows: u32,
    pub(crate) per_record: u32,
    pub(crate) has_background: u32,
    pub(crate) top: [f32; 3],
    pub(crate) words: u32,
    pub(crate) bottom: [f32; 3],
    pub(crate) spare: u32,
    pub(crate) decode: [f32; 256],
}

impl GpuRenderer<Spheres> {
    /// Makes an image of what was drawn so far, on the GPU. It equals what the CPU's shading makes of the
    /// finished picture.
    ///
    /// Colors of records are brought to the GPU for what was drawn, once. Nothing is read back, and
    /// nothing waits: what is submitted to the queue after this sees the image.
    ///
    /// # Errors
    ///
    /// When no picture was begun, it shows another content, its sides are no multiples of
    /// [`ShadeConfig::supersample`], or the device fails.
    pub fn shade<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        config: &ShadeConfig,
        paint: &Paint<'_>,
    ) -> Result<&Shaded, Error> {
        self.prepare(content, &[])?;
        let frame = self.frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
        let data = ShadeData::new(&frame.target.view, config, paint)?;
        let shading = match self.shading.take() {
            Some(known) if known.shaded.size() == data.size => known,
            Some(known) => known.resized(&self.gpu, data.size)?,
            None => Shading::new(&self.gpu, data.size)?,
        };
        let result = self.shade_all(content, (&shading, data), paint);
        let shading = self.shading.insert(shading);
        result.map(|()| &shading.shaded)
    }

    /// The same, read back.
    ///
    /// # Errors
    ///
    /// As [`Self::shade`].
    pub fn shade_image<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        config: &ShadeConfig,
        paint: &Paint<'_>,
    ) -> Result<Image, Error> {
        let shaded = self.shade(content, config, paint)?.clone();
        shaded.read(&self.gpu, &mut self.bench.pool)
    }

    fn shade_all<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (shading, data): (&Shading, ShadeData),
        paint: &Paint<'_>,
    ) -> Result<(), Error> {
        if let (Paint::Each { key, .. }, Some(store)) = (paint, &mut self.store) {
            store.coat.begin(*key);
        }
        let id = self.store.as_ref().map_or(0, |store| store.id_max);
        let (words, limit) = (id / 32 + 1, self.gpu.binding_bytes_max());
        let bytes = u64::from(words) * 4;
        if bytes > limit {
            return Err(Error::TooManyIds { id, bytes, limit });
        }
        let row_pixels = u64::from(data.size[0] * data.factor * data.factor);
        let rows_max = (BAND_PIXELS.min(limit / ENTRY_BYTES) / row_pixels).max(1);
        let rows_max = u32::try_from(rows_max).unwrap_or(u32::MAX).min(data.size[1]);
        let entries = (u64::from(rows_max) * row_pixels).min(content.scene.records.len() as u64);
        let pool = &mut self.bench.pool;
        let uniform = match paint {
            Paint::Uniform(_) => {
                Some(pool.filled(&self.gpu, "Shade::color", &[paint.word(0); 4])?)
            }
            Paint::Each { .. } => None,
        };
        let tables = Tables {
            seen: pool.storage(&self.gpu, "Shade::seen", bytes)?,
            bases: pool.storage(&self.gpu, "Shade::bases", bytes)?,
            table: pool.storage(&self.gpu, "Shade::table", entries * ENTRY_BYTES)?,
            uniform,
        };
        for first_row in (0..data.size[1]).step_by(rows_max as usize) {
            let rows = rows_max.min(data.size[1] - first_row);
            let data = ShadeData { first_row, rows, words, ..data };
            self.shade_band(content, (shading, &data, &tables), paint)?;
        }
        Ok(())
    }

    fn shade_band<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (shading, data, tables): (&Shading, &ShadeData, &Tables),
        paint: &Paint<'_>,
    ) -> Result<(), Error> {
        shading.begin(self, data, tables)?;
        let mut batch = Batch::new(self.store.as_ref().map_or(0, Store::pages));
        let (mut close, mut unpainted) = (Vec::new(), Vec::new());
        let bricks = self.frame.as_ref().map_or(0, |frame| frame.touched.len());
        for index in 0..u32::try_from(bricks).unwrap_or(u32::MAX) {
            let Some(frame) = self.frame.as_ref().filter(|f| f.touched[index as usize]) else {
                continue;
            };
            match frame.table.known(index) {
                Known::Unknown | Known::Outside => {}
                Known::Close(_) => close.push(index),
                Known::Plain(run) => {
                    let mut rest = content.bricks[index as usize].records.clone();
                    while !rest.is_empty() {
                        let is_new = (paint, &mut unpainted);
                        rest = self.collect((run, rest), &mut batch, is_new)?;
                        if !rest.is_empty() {
                            self.enter(
                                content,
                                (shading, tables, paint),
                                (&mut batch, &mut unpainted),
                            )?;
                        }
                    }
                }
            }
        }
        self.enter(content, (shading, tables, paint), (&mut batch, &mut unpainted))?;
        self.enter_close(content, (shading, tables, paint), &close)?;
        shading.end(self, data, tables)
    }

    /// Adds records of a brick to a batch; returns those that are left when it is full.
    fn collect(
        &mut self,
        (run, records): (u32, Range<u32>),
        batch: &mut Batch<Ball>,
        (paint, unpainted): (&Paint<'_>, &mut Vec<(u32, u32)>),
    ) -> Result<Range<u32>, Error> {
        let mut first = records.start;
        while first < records.end {
            let segment = first / SEGMENT;
            let last = records.end.min(segment.saturating_add(1).saturating_mul(SEGMENT));
            let count = last - first;
            if batch.chunks + count.div_ceil(CHUNK) > CHUNKS_MAX {
                break;
            }
            let Some(slot) = self.take(segment, batch) else { break };
            let Some(store) = &mut self.store else { break };
            if matches!(paint, Paint::Each { .. }) && !store.coat.paint(slot) {
                unpainted.push((segment, slot));
            }
            let (page, start) = store.address(slot);
            let slot = start + first % SEGMENT;
            batch.push(page, Piece { run, slot, count, flags: IS_RECALLED });
            first = last;
        }
        if first == records.start && batch.records == 0 && !records.is_empty() {
            let least = Spheres::LAYOUT.bytes();
            return Err(Error::Budget { bytes: self.config.record_bytes, least });
        }
        Ok(first..records.end)
    }

    /// Enters those records of a batch that are seen into the table, and empties it.
    fn enter<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (shading, tables, paint): (&Shading, &Tables, &Paint<'_>),
        (batch, unpainted): (&mut Batch<Ball>, &mut Vec<(u32, u32)>),
    ) -> Result<(), Error> {
        self.round += 1;
        let records = u32::try_from(content.scene.records.len()).unwrap_or(u32::MAX);
        let Some(store) = &mut self.store else { return Ok(()) };
        let pack = |range, words: &mut Vec<u32>| self.shape.pack(content.scene, range, words);
        store.bring(&self.gpu, &mut self.ring, (content.scene, &batch.missing, &pack))?;
        store.paint(&self.gpu, (paint, records), unpainted)?;
        unpainted.clear();
        for (page, pieces) in batch.pieces.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
            shading.enter_page(self, tables, (page, pieces))?;
        }
        batch.clear();
        Ok(())
    }

    /// Enters the records of close bricks that are seen.
    fn enter_close<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (shading, tables, paint): (&Shading, &Tables, &Paint<'_>),
        bricks: &[u32],
    ) -> Result<(), Error> {
        let mut rest = bricks;
        while let Some(camera) = self.frame.as_ref().and_then(|frame| frame.camera.as_ref())
            && !rest.is_empty()
        {
            let mut records = 0;
            let is_room = |&&brick: &&u32| {
                records += content.bricks[brick as usize].records.len() as u64;
                records <= LISTED_MAX
            };
            let count = rest.iter().take_while(is_room).count().max(1);
            let (now, later) = rest.split_at(count);
            rest = later;
            let (ids, entries) = list(content, (camera, self.config.radius_min_pixels), paint, now);
            // A brick may be larger than the list.
            let parts = ids.chunks(1 << 18).zip(entries.chunks(1 << 18));
            for (ids, entries) in parts {
                shading.enter_listed(self, tables, (ids, entries))?;
            }
        }
        Ok(())
    }
}

impl ShadeData {
    fn new(view: &View, config: &ShadeConfig, paint: &Paint<'_>) -> Result<Self, Error> {
        let factor = config.supersample.max(1);
        let (width, height) = (view.width(), view.height());
        if !width.is_multiple_of(factor) || !height.is_multiple_of(factor) {
            return Err(Error::Supersample { width, height, factor });
        }
        let (ends, has_background) = match config.background {
            Background::Solid(color) => ([color; 2], 1),
            Background::Gradient(top, bottom) => ([top, bottom], 1),
            Background::Transparent => ([[0; 3]; 2], 0),
        };
        let [top, bottom] = ends.map(|color| color.map(f32::from));
        Ok(Self {
            size: [width / factor, height / factor],
            factor,
            ambient: config.ambient,
            first_row: 0,
            rows: 0,
            per_record: u32::from(matches!(paint, Paint::Each { .. })),
            has_background,
            top,
            words: 0,
            bottom,
            spare: 0,
            decode: std::array::from_fn(|byte| decode(byte as f32 / 255.0)),
        })
    }
}

/// From sRGB to light.
fn decode(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{shade_pass::SHADE, shaders::assert_same_layout};

    #[test]
    fn structs_are_those_of_the_shaders() {
        assert_same_layout!(
            SHADE,
            "Shade",
            ShadeData {
                size,
                factor,
                ambient,
                first_row,
                rows,
                per_record,
                has_background,
                top,
                words,
                bottom,
                spare,
                decode,
            }
        );
    }
}
