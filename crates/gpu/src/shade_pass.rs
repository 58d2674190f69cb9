//! The passes of shading (`shade.rs`), from ids to an image.

use crate::{
    Error, Gpu, GpuRenderer, Shaded,
    kernel::{Kernel, Work, shader, storage, uniform},
    round::{CHUNK, Piece, RoundData},
    shade::ShadeData,
    shade_list::Entry,
};

const SEEN: &str = shader!("camera", "visibility_read", "shade_common", "shade_seen");
const TABLE: &str = shader!("camera", "disc", "place", "shade_common", "shade_table");
pub(crate) const SHADE: &str =
    shader!("camera", "disc", "visibility_read", "shade_common", "shade");

/// All of these, to be tested.
#[cfg(test)]
pub(crate) const SOURCES: [(&str, &str); 3] =
    [("what is seen", SEEN), ("its table", TABLE), ("shade", SHADE)];

/// What shading needs, from one image to the next.
#[derive(Debug)]
pub(crate) struct Shading {
    mark: Kernel,
    number: Kernel,
    enter: Kernel,
    enter_listed: Kernel,
    shade: Kernel,
    data: wgpu::Buffer,
    listed: wgpu::Buffer,
    total: wgpu::Buffer,
    pub(crate) shaded: Shaded,
}

/// The buffers of a band.
#[derive(Debug)]
pub(crate) struct Tables {
    pub(crate) seen: wgpu::Buffer,
    pub(crate) bases: wgpu::Buffer,
    pub(crate) table: wgpu::Buffer,
    /// The colors of pages, or the only one.
    pub(crate) uniform: Option<wgpu::Buffer>,
}

impl Shading {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        let shaded = Shaded::new(gpu, size)?;
        let data = uniform(gpu, "Shading::data", size_of::<ShadeData>() as u64)?;
        let listed = uniform(gpu, "Shading::listed", 16)?;
        let total = storage(gpu, "Shading::total", 16)?;
        gpu.guard("pipelines", || {
            let kernel = |label, source, entry| Kernel::new(gpu, label, (source, entry), &[]);
            Self {
                mark: kernel("Shading::mark", SEEN, "mark_band"),
                number: kernel("Shading::number", SEEN, "number_ids"),
                enter: kernel("Shading::enter", TABLE, "enter"),
                enter_listed: kernel("Shading::enter_listed", TABLE, "enter_listed"),
                shade: kernel("Shading::shade", SHADE, "shade_band"),
                data,
                listed,
                total,
                shaded,
            }
        })
    }

    /// The same for images of another size.
    pub(crate) fn resized(self, gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        Ok(Self { shaded: Shaded::new(gpu, size)?, ..self })
    }

    /// Finds which ids are seen in a band, and numbers them.
    pub(crate) fn begin(
        &self,
        renderer: &GpuRenderer,
        data: &ShadeData,
        tables: &Tables,
    ) -> Result<(), Error> {
        let GpuRenderer { gpu, frame: Some(frame), .. } = renderer else { return Ok(()) };
        gpu.guard("what is seen", || {
            gpu.queue.write_buffer(&self.data, 0, bytemuck::bytes_of(data));
            let mut work = Work::new(gpu, "Shading::begin");
            work.encoder.clear_buffer(&tables.seen, 0, Some(u64::from(data.words) * 4));
            work.encoder.clear_buffer(&self.total, 0, None);
            let bindings = [
                (0, frame.target.camera.as_entire_binding()),
                (2, self.data.as_entire_binding()),
                (9, frame.target.visibility.as_entire_binding()),
                (10, tables.seen.as_entire_binding()),
            ];
            let items = data.rows * data.size[0] * data.factor * data.factor;
            self.mark.run(&mut work, &bindings, items);
            let bindings = [
                (2, self.data.as_entire_binding()),
                (7, self.total.as_entire_binding()),
                (10, tables.seen.as_entire_binding()),
                (13, tables.bases.as_entire_binding()),
            ];
            self.number.run(&mut work, &bindings, data.words);
            work.submit();
        })
    }

    /// Enters those records of pieces that are seen, of bricks that were drawn.
    pub(crate) fn enter_page(
        &self,
        renderer: &mut GpuRenderer,
        tables: &Tables,
        (page, pieces): (usize, &[Piece]),
    ) -> Result<(), Error> {
        let GpuRenderer { gpu, kernels, bench, store, frame, .. } = renderer;
        let (Some(store), Some(frame)) = (store, frame) else { return Ok(()) };
        let colors = match &tables.uniform {
            Some(only) => only.clone(),
            None => store.colors(gpu, page)?,
        };
        let page = store.page(gpu, page)?;
        let Some(ids) = &page.ids else { return Ok(()) };
        let runs = frame.table.buffer(gpu)?;
        let chunks: u32 = pieces.iter().map(|piece| piece.count.div_ceil(CHUNK)).sum();
        let pool = &mut bench.pool;
        let list = pool.filled(gpu, "Round::pieces", pieces)?;
        let cut = pool.storage(gpu, "Round::chunks", u64::from(chunks) * 8)?;
        // Culling notes what it lets pass, which is of no use here.
        let passed = pool.storage(gpu, "Shading::passed", frame.drawn.size())?;
        let count = u32::try_from(pieces.len()).unwrap_or(u32::MAX);
        let round = RoundData { pieces: count, capacity: 0, small: 0, pass_of_two: 0 };
        let round = bench.write_round(gpu, round);
        gpu.guard("a table of records", || {
            let mut work = Work::new(gpu, "Shading::enter_page");
            work.encoder.clear_buffer(&bench.counts, 0, Some(12));
            let bindings = [
                (0, frame.target.camera.as_entire_binding()),
                (1, runs.as_entire_binding()),
                (2, round.as_entire_binding()),
                (3, list.as_entire_binding()),
                (5, cut.as_entire_binding()),
                (7, bench.counts.as_entire_binding()),
                (8, frame.target.tiles.as_entire_binding()),
                (10, passed.as_entire_binding()),
                (12, frame.drawn.as_entire_binding()),
            ];
            kernels.cull.run(&mut work, &bindings, count);
            let counted =
                [(7, bench.counts.as_entire_binding()), (11, bench.arguments.as_entire_binding())];
            kernels.over_chunks.run_once(&mut work, &counted);
            let bindings = [
                (0, frame.target.camera.as_entire_binding()),
                (1, runs.as_entire_binding()),
                (2, self.data.as_entire_binding()),
                (3, page.records.as_entire_binding()),
                (4, ids.as_entire_binding()),
                (5, cut.as_entire_binding()),
                (10, tables.seen.as_entire_binding()),
                (13, tables.bases.as_entire_binding()),
                (14, colors.as_entire_binding()),
                (15, tables.table.as_entire_binding()),
            ];
            self.enter.run_indirect(&mut work, &bindings, (&bench.arguments, 0));
            work.submit();
        })
    }

    /// Enters those of listed records that are seen.
    pub(crate) fn enter_listed(
        &self,
        renderer: &mut GpuRenderer,
        tables: &Tables,
        (ids, entries): (&[u32], &[Entry]),
    ) -> Result<(), Error> {
        let GpuRenderer { gpu, bench, .. } = renderer;
        let count = u32::try_from(ids.len()).unwrap_or(u32::MAX);
        let ids = bench.pool.filled(gpu, "Shading::ids", ids)?;
        let entries = bench.pool.filled(gpu, "Shading::entries", entries)?;
        gpu.guard("a list of records", || {
            gpu.queue.write_buffer(&self.listed, 0, bytemuck::bytes_of(&[count; 4]));
            let mut work = Work::new(gpu, "Shading::enter_listed");
            let bindings = [
                (4, ids.as_entire_binding()),
                (6, entries.as_entire_binding()),
                (7, self.listed.as_entire_binding()),
                (10, tables.seen.as_entire_binding()),
                (13, tables.bases.as_entire_binding()),
                (15, tables.table.as_entire_binding()),
            ];
            self.enter_listed.run(&mut work, &bindings, count);
            work.submit();
        })
    }

    /// Makes a band of the image.
    pub(crate) fn end(
        &self,
        renderer: &GpuRenderer,
        data: &ShadeData,
        tables: &Tables,
    ) -> Result<(), Error> {
        let GpuRenderer { gpu, frame: Some(frame), .. } = renderer else { return Ok(()) };
        gpu.guard("an image", || {
            let mut work = Work::new(gpu, "Shading::end");
            let bindings = [
                (0, frame.target.camera.as_entire_binding()),
                (2, self.data.as_entire_binding()),
                (9, frame.target.visibility.as_entire_binding()),
                (10, tables.seen.as_entire_binding()),
                (13, tables.bases.as_entire_binding()),
                (15, tables.table.as_entire_binding()),
                (16, wgpu::BindingResource::TextureView(self.shaded.color())),
                (17, wgpu::BindingResource::TextureView(self.shaded.depth())),
            ];
            self.shade.run(&mut work, &bindings, data.rows * data.size[0]);
            work.submit();
        })
    }
}
