/*!
Records as glyphs: closed surfaces of triangles, which exist only while they are drawn.

The shaders of a glyph are put together from its own WGSL and from what draws triangles (`glyph.wgsl`).
Nothing is kept of a triangle that is small; large ones wait in a list of fixed size to be drawn block by
block. Where there is no room for more, or neighboring records have more triangles than a group should
draw, the CPU draws the brick. The geometry is that of the CPU's twin, and so are its levels of detail,
which belong to bricks.

# How exact it is

Corners are placed as spheres are (`runs.rs`), and an edge is tested relative to the pixel. With corners
within 1024 pixels of the reference, a corner is off by at most 5e-4 pixels, an edge by that and by
1e-4 for its test. What is larger, or nearer than its own size, or cut by the near plane, is drawn by the
CPU in `f64`.
*/

use crate::{
    Error, Gpu,
    exact::{Exact, key},
    kernel::{Kernel, Pool, Work, storage},
    picture::Frame,
    runs::is_plain_sphere,
    shape::{Close, Draw, Near, Place, Shape},
    solid_depths::depths,
    solid_shaders::{BLOCK_BYTES, Most, OVER_BLOCKS, sources, words},
    store::Layout,
    table::bound_of_sphere,
};
use puncta_avc::{Glyph, Glyphs, Lens, Level, Levels, Surface};
use puncta_core::{Brick, Camera, Content, NO_RECORD, Picture, Scene, ScreenBound};
use rayon::prelude::*;
use std::{fmt, ops::Range};

/// By how much a ball is larger than what it holds: more than rounding.
const AROUND: f64 = 1.00001;

/// Draws records as glyphs.
pub struct Solids<G: Glyph> {
    pub(crate) glyphs: Glyphs<G>,
    draw: Kernel,
    recall: Kernel,
    over_blocks: Kernel,
    draw_blocks: Kernel,
    /// What glyphs share, and what of it was written last.
    pub(crate) common: Option<wgpu::Buffer>,
    written: Option<(Vec<u32>, u64)>,
}

impl<G: Glyph> fmt::Debug for Solids<G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solids").field("glyphs", &self.glyphs).finish_non_exhaustive()
    }
}

impl<G: Glyph> Solids<G> {
    pub(crate) fn new(gpu: &Gpu, glyphs: Glyphs<G>) -> Result<Self, Error> {
        let [all, seen, blocks] = sources::<G>(gpu.visibility(), (gpu.is_cpu(), gpu.group_bytes()));
        gpu.guard("pipelines", || {
            let kernel = |label, source: &str, entry| Kernel::new(gpu, label, (source, entry), &[]);
            Self {
                draw: kernel("Solids::draw", &all, "draw_glyphs"),
                recall: kernel("Solids::recall", &seen, "draw_glyphs"),
                over_blocks: kernel("Solids::over_blocks", OVER_BLOCKS, "over_blocks"),
                draw_blocks: kernel("Solids::draw_blocks", &blocks, "draw_blocks"),
                glyphs,
                common: None,
                written: None,
            }
        })
    }

    /// Writes what all glyphs share, as far as it has changed.
    pub(crate) fn share(&mut self, gpu: &Gpu, sharpness: f32) -> Result<(), Error> {
        let style = bytemuck::bytes_of(&self.glyphs.style).chunks_exact(4);
        let mut head = vec![sharpness.to_bits()];
        head.extend(style.map(bytemuck::pod_read_unaligned::<u32>));
        let table = &self.glyphs.table;
        let now = (head, table.version());
        if self.written.as_ref() == Some(&now) && self.common.is_some() {
            return Ok(());
        }
        let bytes = (now.0.len() + table.len()) as u64 * 4;
        let limit = gpu.binding_bytes_max();
        if bytes > limit {
            return Err(Error::TableTooLarge { bytes, limit });
        }
        let is_same =
            |(head, version): &(Vec<u32>, u64)| head.len() == now.0.len() && *version == now.1;
        let has_table = self.written.as_ref().is_some_and(is_same);
        let buffer = match self.common.take() {
            Some(buffer) if has_table => buffer,
            // A buffer of just this size: indices are held within it.
            _ => storage(gpu, "Solids::common", bytes)?,
        };
        gpu.guard("what glyphs share", || {
            gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&now.0));
            if !has_table {
                let place = now.0.len() as u64 * 4;
                gpu.queue.write_buffer(&buffer, place, bytemuck::cast_slice(table.as_slice()));
            }
        })?;
        (self.common, self.written) = (Some(buffer), Some(now));
        Ok(())
    }

    /// Draws chunks, for the first or for the second time.
    fn draw_once(&self, work: &mut Work<'_>, place: &Place<'_>, (frame, again): (&Frame, bool)) {
        let bench = place.bench;
        let Some(common) = &self.common else { return };
        // The second time, the same blocks are drawn: which ones have room is decided once.
        let (round, start) = if again { (&bench.second, 4) } else { (&bench.round, 0) };
        work.encoder.clear_buffer(place.scratch, start, Some(12 - start));
        let mut shared = vec![
            (0, frame.target.camera.as_entire_binding()),
            (1, place.runs.as_entire_binding()),
            (3, place.page.records.as_entire_binding()),
            (6, place.scratch.as_entire_binding()),
            (9, frame.target.visibility.as_entire_binding()),
            (13, common.as_entire_binding()),
        ];
        let mut bindings = shared.clone();
        bindings.extend([
            (2, round.as_entire_binding()),
            (5, place.chunks.as_entire_binding()),
            (8, frame.target.tiles.as_entire_binding()),
        ]);
        let kernel = match place.seen {
            Some(seen) => {
                bindings.push((10, seen.as_entire_binding()));
                &self.recall
            }
            None => {
                bindings.push((12, bench.missed.as_entire_binding()));
                &self.draw
            }
        };
        kernel.run_indirect(work, &bindings, (&bench.arguments, 0));
        let counted = [
            (6, place.scratch.as_entire_binding()),
            (7, bench.counts.as_entire_binding()),
            (11, bench.blocks.as_entire_binding()),
        ];
        self.over_blocks.run_once(work, &counted);
        if frame.target.known.is_some() {
            shared.push((2, round.as_entire_binding()));
        }
        self.draw_blocks.run_indirect(work, &shared, (&bench.blocks, 0));
    }
}

impl<G: Glyph> Shape<G> for Solids<G> {
    type Exact = Solid;

    fn pack(&self, scene: &Scene<G>, range: Range<usize>, words: &mut Vec<u32>) {
        let layout = self.layout();
        let (cloud, ids) = (self.glyphs.cloud(&scene.records), scene.attributes.ids.as_deref());
        let zeros = layout.words as usize;
        let before = range.start.saturating_sub(layout.before as usize);
        words.resize(words.len() + zeros * (layout.before as usize - (range.start - before)), 0);
        let end = (range.end + layout.after as usize).min(cloud.records.len());
        for index in before..end {
            // Nothing that is not finite comes here.
            let is_sound = G::fault(&cloud, index).is_none();
            let record = if is_sound { cloud.get(index) } else { G::zeroed() };
            let bytes = bytemuck::bytes_of(&record).chunks_exact(4);
            words.extend(bytes.map(bytemuck::pod_read_unaligned::<u32>));
            let id = ids.and_then(|ids| ids.get(index).copied());
            words.push(id.unwrap_or(u32::try_from(index).unwrap_or(NO_RECORD)));
        }
    }

    fn prepare(&mut self, gpu: &Gpu, camera: &Camera) -> Result<(), Error> {
        self.share(gpu, Lens::new(camera, self.glyphs.tolerance).sharpness)
    }

    fn close(&self, near: &Near<'_, G>) -> Close<Solid> {
        let (camera, index) = (near.camera, near.index as usize);
        let cloud = self.glyphs.cloud(&near.scene.records);
        if G::fault(&cloud, index).is_some() {
            return Close::Nothing;
        }
        let (center, radius) = G::ball(&cloud, index);
        let (center, radius) = (camera.place(center.as_dvec3()), f64::from(radius) * AROUND);
        let Some(bound) = bound_of_sphere(camera, center, radius) else { return Close::Nothing };
        if !near.by_cpu && is_plain_sphere(camera, center, radius) {
            let position = cloud.get(index).position();
            let lens = Lens::new(camera, self.glyphs.tolerance);
            let bound = ScreenBound { nearest: lens.nearest(near.level, &cloud, index), ..bound };
            return Close::Plain(position, camera.place(position.as_dvec3()), bound);
        }
        let mut surface = Surface::default();
        let lens = Lens::new(camera, self.glyphs.tolerance);
        surface.fill(&lens, &cloud, index, near.level);
        Close::Exact(Solid { surface, bound, id: near.scene.id(near.index) })
    }

    fn refine(&self, camera: &Camera, content: &Content<'_, G>, picture: &mut Picture) {
        let (lens, levels) =
            (Lens::new(camera, self.glyphs.tolerance), Levels::new(camera, content.bricks));
        let size = [picture.width, picture.height];
        let cloud = self.glyphs.cloud(&content.scene.records);
        // The pixels of a record together, so that its surface is made once.
        let seen = |(pixel, &id): (usize, &u32)| (id != NO_RECORD).then_some((id, pixel));
        let mut pixels: Vec<(u32, usize)> =
            picture.id.par_iter().enumerate().filter_map(seen).collect();
        pixels.par_sort_unstable();
        let exact = |pixels: &[(u32, usize)]| {
            let (id, _) = pixels[0];
            let mut surface = Surface::default();
            surface.fill(&lens, &cloud, id as usize, levels.of(id));
            let pixels: Vec<usize> = pixels.iter().map(|(_, pixel)| *pixel).collect();
            let depths = depths(&surface, &pixels, size);
            pixels.into_iter().zip(depths).collect()
        };
        let found: Vec<Vec<(usize, Option<f64>)>> =
            pixels.par_chunk_by(|a, b| a.0 == b.0).map(exact).collect();
        for (pixel, depth) in found.into_iter().flatten() {
            #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
            if let Some(depth) = depth {
                picture.depth[pixel] = depth as f32;
            }
        }
    }
}

impl<G: Glyph> Draw for Solids<G> {
    fn layout(&self) -> Layout {
        let words = u32::try_from(words::<G>().0 + 1).unwrap_or(u32::MAX);
        let [before, after] = if G::HAS_NEIGHBORS { [1, 2] } else { [0, 0] };
        Layout { words, has_ids: false, before, after }
    }

    fn radius_min(&self) -> f32 {
        0.0
    }

    /// Records of bricks that are near have levels of their own, which only the CPU finds.
    fn is_near(&self, brick: &Brick, nearest: f32) -> bool {
        Level::of(brick, nearest) == Level::Record
    }

    fn small(&self, gpu: &Gpu) -> u32 {
        // One lane at a time or all at once: what is large for a lane differs.
        if gpu.is_cpu() { 1024 } else { 128 }
    }

    fn scratch(&self, gpu: &Gpu, pool: &mut Pool, _records: u32) -> Result<wgpu::Buffer, Error> {
        let blocks = Most::of(gpu.is_cpu()).blocks;
        pool.storage(gpu, "Solids::large", 16 + (blocks + 1) * BLOCK_BYTES)
    }

    fn draw(&self, work: &mut Work<'_>, place: &Place<'_>, frame: &mut Frame) {
        self.draw_once(work, place, (frame, false));
        if frame.target.claim(work, place.claim) {
            self.draw_once(work, place, (frame, true));
        }
    }
}

/// A glyph that the CPU draws.
#[derive(Debug)]
pub(crate) struct Solid {
    surface: Surface,
    bound: ScreenBound,
    id: u32,
}

impl Exact for Solid {
    fn bound(&self) -> &ScreenBound {
        &self.bound
    }

    fn weight(&self) -> usize {
        1 + self.surface.facets().len()
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "both are inside")]
    fn draw_row(&self, camera: &Camera, row: usize, (first, pixels): (u16, &mut [u64])) {
        let [width, height] = camera.size();
        let end = i64::from(first) + pixels.len() as i64 - 1;
        for facet in self.surface.facets() {
            let [top, bottom] = facet.rows(height);
            if !(top..=bottom).contains(&(row as i64)) {
                continue;
            }
            let [from, to] = facet.span(row as f64, width);
            let depths = facet.depth_of_row(row as f64);
            for column in from.max(first.into())..=to.min(end) {
                let pixel = &mut pixels[(column - i64::from(first)) as usize];
                *pixel = key(depths.at(column as f64) as f32, self.id).max(*pixel);
            }
        }
    }
}
