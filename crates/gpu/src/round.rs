/*!
Rounds: some pieces of bricks go through the GPU together.

1. Segments of records that are missing are brought (`store.rs`).
2. Tiles of the picture are looked at anew, if anything was drawn since (`tiles.wgsl`).
3. Pieces of hidden bricks are dropped, the others cut into chunks (`cull.wgsl`).
4. Chunks are drawn as what their records are: spheres become discs (`setup.wgsl`), and these pixels
   (`raster.rs`); glyphs become triangles, and these pixels (`glyph.wgsl`). What is hidden or covers no
   pixel's centre is dropped first.

Nothing comes back in between: each step leaves what it counted as arguments of the next.
*/

use crate::{
    Error, Gpu, Skipping,
    exact::{self, Exact},
    frame::tiles,
    kernel::{Pool, Work, uniform},
    kernels::Kernels,
    picture::Frame,
    shape::{Draw, Place},
    store::Page,
};
use bytemuck::{Pod, Zeroable};

/// The most records and chunks of a round: some tens of megabytes of discs, and what one dispatch does.
pub(crate) const RECORDS_MAX: u32 = 1 << 19;
pub(crate) const CHUNKS_MAX: u32 = 60_000;

/// How many records make a chunk.
pub(crate) const CHUNK: u32 = 64;

/// The bytes of the bits for what was missed.
const MISSED_BYTES: u64 = 1 << 13;

pub(crate) const IS_FIRST: u32 = 1;
pub(crate) const IS_TESTED: u32 = 2;
pub(crate) const IS_RECALLED: u32 = 4;
pub(crate) const IS_COUNTED: u32 = 8;

pub(crate) const DISC_BYTES: u64 = 48;
pub(crate) const CHUNK_BYTES: u64 = 8;

/// `Piece` of `cull.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Piece {
    pub(crate) run: u32,
    pub(crate) slot: u32,
    pub(crate) count: u32,
    pub(crate) flags: u32,
}

/// `Round` of `work.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct RoundData {
    pub(crate) pieces: u32,
    pub(crate) capacity: u32,
    pub(crate) small: u32,
    pub(crate) pass_of_two: u32,
}

/// `Counts` of `work.wgsl`.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Counts {
    pub(crate) chunks: u32,
    pub(crate) large: u32,
    pub(crate) small: u32,
    pub(crate) bricks: u32,
    pub(crate) records: u32,
    pub(crate) recalled: u32,
    pub(crate) open: u32,
    pub(crate) missed: u32,
}

/// What goes through together: pieces by page, and what must be brought or drawn by the CPU first.
#[derive(Debug)]
pub(crate) struct Batch<X> {
    pub(crate) pieces: Vec<Vec<Piece>>,
    pub(crate) missing: Vec<(u32, u32)>,
    pub(crate) exact: Vec<X>,
    /// How large what the CPU draws is, all in all.
    pub(crate) weight: usize,
    /// The set of seen ids, and the bricks drawn in the picture before, if only these are drawn.
    pub(crate) seen: Option<(wgpu::Buffer, wgpu::Buffer)>,
    pub(crate) records: u32,
    pub(crate) chunks: u32,
}

impl<X> Batch<X> {
    pub(crate) fn new(pages: usize) -> Self {
        Self {
            pieces: vec![Vec::new(); pages],
            missing: Vec::new(),
            exact: Vec::new(),
            weight: 0,
            seen: None,
            records: 0,
            chunks: 0,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.pieces.iter_mut().for_each(Vec::clear);
        self.missing.clear();
        self.exact.clear();
        (self.records, self.chunks, self.weight) = (0, 0, 0);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.records == 0 && self.exact.is_empty()
    }

    /// Whether these many records more would be too many.
    pub(crate) fn is_full(&self, count: u32) -> bool {
        self.records + count > RECORDS_MAX || self.chunks + count.div_ceil(CHUNK) > CHUNKS_MAX
    }

    pub(crate) fn push(&mut self, page: usize, piece: Piece) {
        self.records += piece.count;
        self.chunks += piece.count.div_ceil(CHUNK);
        self.pieces[page].push(piece);
    }
}

/// Buffers that last from one picture to the next.
#[derive(Debug)]
pub(crate) struct Bench {
    pub(crate) pool: Pool,
    pub(crate) counts: wgpu::Buffer,
    pub(crate) arguments: wgpu::Buffer,
    pub(crate) blocks: wgpu::Buffer,
    pub(crate) round: wgpu::Buffer,
    pub(crate) second: wgpu::Buffer,
    /// Bits for bricks of which something was missed: several bricks share a bit.
    pub(crate) missed: wgpu::Buffer,
    patch: wgpu::Buffer,
}

impl Bench {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let round = |label| uniform(gpu, label, size_of::<RoundData>() as u64);
        Ok(Self {
            pool: Pool::default(),
            counts: crate::kernel::storage(gpu, "Bench::counts", size_of::<Counts>() as u64)?,
            arguments: crate::kernel::storage(gpu, "Bench::arguments", 64)?,
            blocks: crate::kernel::storage(gpu, "Bench::blocks", 64)?,
            round: round("Bench::round")?,
            second: round("Bench::second")?,
            missed: crate::kernel::storage(gpu, "Bench::missed", MISSED_BYTES)?,
            patch: round("Bench::patch")?,
        })
    }

    /// What was counted.
    pub(crate) fn counted(&mut self, gpu: &Gpu) -> Result<Counts, Error> {
        let bytes = size_of::<Counts>() as u64;
        let read = crate::kernel::read(gpu, &mut self.pool, &[(&self.counts, 0..bytes)])?;
        Ok(bytemuck::pod_read_unaligned(&read))
    }

    /// Which of some bricks may have missed something.
    pub(crate) fn missed(&mut self, gpu: &Gpu, mut bricks: Vec<u32>) -> Result<Vec<u32>, Error> {
        let read = crate::kernel::read(gpu, &mut self.pool, &[(&self.missed, 0..MISSED_BYTES)])?;
        let bits = crate::survey::words(&read);
        let is_set = |brick: u32| bits[(brick >> 5) as usize % bits.len()] >> (brick & 31) & 1 != 0;
        bricks.retain(|&brick| is_set(brick));
        Ok(bricks)
    }

    pub(crate) fn write_round(&self, gpu: &Gpu, data: RoundData) -> &wgpu::Buffer {
        gpu.queue.write_buffer(&self.round, 0, bytemuck::bytes_of(&data));
        &self.round
    }
}

/// Where a round takes place.
#[derive(Debug)]
pub(crate) struct Stage<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) kernels: &'a Kernels,
    pub(crate) bench: &'a mut Bench,
    pub(crate) frame: &'a mut Frame,
    pub(crate) skipping: Skipping,
    /// The set of seen ids, and the bricks drawn in the picture before, if only these are drawn.
    pub(crate) seen: Option<(wgpu::Buffer, wgpu::Buffer)>,
}

impl Stage<'_> {
    /// Looks at tiles anew, if they are not as they should be.
    pub(crate) fn freshen(&mut self, work: &mut Work<'_>) {
        let frame = &mut *self.frame;
        let is_stale = match self.skipping {
            Skipping::Hidden => !frame.are_tiles_fresh,
            // As they were before anything was drawn, for good.
            Skipping::Nothing => !frame.have_tiles,
        };
        if is_stale {
            let target = &frame.target;
            let bindings = [
                (0, target.camera.as_entire_binding()),
                (8, target.tiles.as_entire_binding()),
                (9, target.visibility.as_entire_binding()),
            ];
            self.kernels.tiles.run(work, &bindings, tiles(&target.view));
            (frame.have_tiles, frame.are_tiles_fresh) = (true, true);
        }
    }

    /// Draws pieces that lie in one page.
    pub(crate) fn draw_page(
        &mut self,
        shape: &dyn Draw,
        (page, pieces): (&Page, &[Piece]),
    ) -> Result<(), Error> {
        let (gpu, small) = (self.gpu, shape.small(self.gpu));
        let capacity: u32 = pieces.iter().map(|piece| piece.count).sum();
        let chunks: u32 = pieces.iter().map(|piece| piece.count.div_ceil(CHUNK)).sum();
        let runs = self.frame.table.buffer(gpu)?;
        let pool = &mut self.bench.pool;
        let list = pool.filled(gpu, "Round::pieces", pieces)?;
        let cut = pool.storage(gpu, "Round::chunks", u64::from(chunks) * CHUNK_BYTES)?;
        let scratch = shape.scratch(gpu, pool, capacity)?;
        let count = u32::try_from(pieces.len()).unwrap_or(u32::MAX);
        let data = RoundData { pieces: count, capacity, small, pass_of_two: 0 };
        gpu.queue.write_buffer(&self.bench.round, 0, bytemuck::bytes_of(&data));
        let second = RoundData { pass_of_two: 1, ..data };
        gpu.queue.write_buffer(&self.bench.second, 0, bytemuck::bytes_of(&second));
        let (kernels, drawn) = (self.kernels, self.frame.drawn.clone());
        let before = self.seen.as_ref().map_or_else(|| list.clone(), |(_, before)| before.clone());
        gpu.guard("a round", || {
            let mut work = Work::new(gpu, "Stage::draw_page");
            self.freshen(&mut work);
            let (frame, bench) = (&mut *self.frame, &*self.bench);
            work.encoder.clear_buffer(&bench.counts, 0, Some(12));
            let bindings = [
                (0, frame.target.camera.as_entire_binding()),
                (1, runs.as_entire_binding()),
                (2, bench.round.as_entire_binding()),
                (3, list.as_entire_binding()),
                (5, cut.as_entire_binding()),
                (7, bench.counts.as_entire_binding()),
                (8, frame.target.tiles.as_entire_binding()),
                (10, drawn.as_entire_binding()),
                (12, before.as_entire_binding()),
            ];
            kernels.cull.run(&mut work, &bindings, count);
            let counted =
                [(7, bench.counts.as_entire_binding()), (11, bench.arguments.as_entire_binding())];
            kernels.over_chunks.run_once(&mut work, &counted);
            let place = Place {
                bench,
                runs: &runs,
                page,
                chunks: &cut,
                scratch: &scratch,
                seen: self.seen.as_ref().map(|(seen, _)| seen),
                claim: &kernels.claim,
            };
            shape.draw(&mut work, &place, frame);
            frame.are_tiles_fresh = false;
            work.submit();
        })
    }

    /// Draws what `f32` cannot.
    pub(crate) fn draw_exact<X: Exact>(&mut self, items: &mut [X]) -> Result<(), Error> {
        let Some(camera) = &self.frame.camera else { return Ok(()) };
        let Some((rectangle, pixels)) = exact::draw(camera, items) else { return Ok(()) };
        let gpu = self.gpu;
        let drawn = self.bench.pool.filled(gpu, "Round::patch", &pixels)?;
        gpu.queue.write_buffer(&self.bench.patch, 0, bytemuck::bytes_of(&rectangle));
        let target = &self.frame.target;
        gpu.guard("a patch", || {
            let mut work = Work::new(gpu, "Stage::draw_exact");
            let bindings = [
                (0, target.camera.as_entire_binding()),
                (3, self.bench.patch.as_entire_binding()),
                (4, drawn.as_entire_binding()),
                (9, target.visibility.as_entire_binding()),
            ];
            let items = rectangle.size[0] * rectangle.size[1];
            self.kernels.merge.run(&mut work, &bindings, items);
            // Else its ids would be forgotten when something is drawn over it.
            if let Some(known) = &target.known {
                let bindings = [
                    (0, target.camera.as_entire_binding()),
                    (9, target.visibility.as_entire_binding()),
                    (10, known.as_entire_binding()),
                ];
                self.kernels.accept.run(&mut work, &bindings, target.pixels());
            }
            work.submit();
        })?;
        self.frame.are_tiles_fresh = false;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernels::CULL, shaders::assert_same_layout};

    #[test]
    fn structs_are_those_of_the_shaders() {
        assert_same_layout!(CULL, "Piece", Piece { run, slot, count, flags });
        assert_same_layout!(CULL, "Round", RoundData { pieces, capacity, small, pass_of_two });
        assert_same_layout!(
            CULL,
            "Counts",
            Counts { chunks, large, small, bricks, records, recalled, open, missed }
        );
    }
}
