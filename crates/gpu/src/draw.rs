//! Which records go through the GPU together: those of bricks, close ones each on their own, and those
//! that were seen in the picture before.

use crate::{
    Error, GpuRenderer, Skipping,
    exact::Exact,
    kernel::Work,
    picture::{Frame, Key},
    residency::SEGMENT,
    round::{Batch, IS_COUNTED, IS_FIRST, IS_RECALLED, IS_TESTED, Piece, Stage},
    runs::Run,
    shape::{Close, Near, Shape},
    store::Store,
    survey,
    table::Known,
};
use puncta_avc::Level;
use puncta_core::{Amount, Bounder, Content, Record, VisibleBrick};
use std::ops::Range;

/// The most records that are placed one by one in a batch, and the most work for the CPU.
const SINGLE_MAX: usize = 1 << 17;

impl<S> GpuRenderer<S> {
    /// Draws bricks that were learned; returns what was drawn of those that the GPU does not count.
    pub(crate) fn draw_round<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[u32],
    ) -> Result<Amount, Error>
    where
        S: Shape<R>,
    {
        let mut close = Amount::default();
        let mut batch = Batch::new(self.store.as_ref().map_or(0, Store::pages));
        for &index in bricks {
            let Some(frame) = &mut self.frame else { break };
            frame.touched[index as usize] = true;
            let records = content.bricks[index as usize].records.clone();
            let is_tested = frame.has_drawn && self.config.skipping == Skipping::Hidden;
            let tested = if is_tested { IS_TESTED } else { 0 };
            match frame.table.known(index) {
                Known::Unknown | Known::Outside => {}
                Known::Plain(run) => {
                    let flags = IS_FIRST | IS_COUNTED | tested;
                    self.add(content, &mut batch, (run, records), flags)?;
                }
                Known::Close(_) => {
                    close += Amount { bricks: 1, records: records.len() as u64 };
                    self.add_close(content, &mut batch, (index, records), false)?;
                }
            }
        }
        self.flush(content, &mut batch)?;
        if let Some(frame) = &mut self.frame {
            frame.table.forget_records();
        }
        Ok(close)
    }

    /// Draws by the CPU what was missed of bricks. They were counted before.
    pub(crate) fn draw_missed<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<(), Error>
    where
        S: Shape<R>,
    {
        let indices = bricks.iter().map(VisibleBrick::index).collect();
        let mut indices = self.bench.missed(&self.gpu, indices)?;
        self.missed += indices.len() as u64;
        if self.config.skipping == Skipping::Hidden {
            indices = survey::glance(self, &indices)?;
        }
        let mut batch = Batch::new(self.store.as_ref().map_or(0, Store::pages));
        for index in indices {
            let records = content.bricks[index as usize].records.clone();
            self.add_close(content, &mut batch, (index, records), true)?;
        }
        self.flush(content, &mut batch)
    }

    /// Adds the records of a brick to a batch, which goes through first if it is full.
    fn add<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch<S::Exact>,
        (run, records): (u32, Range<u32>),
        mut flags: u32,
    ) -> Result<(), Error>
    where
        S: Shape<R>,
    {
        let mut first = records.start;
        while first < records.end {
            let segment = first / SEGMENT;
            let last = records.end.min(segment.saturating_add(1).saturating_mul(SEGMENT));
            let count = last - first;
            if batch.is_full(count) {
                self.flush(content, batch)?;
            }
            let mut slot = self.take(segment, batch);
            if slot.is_none() {
                self.flush(content, batch)?;
                slot = self.take(segment, batch);
            }
            let least = self.shape.layout().bytes();
            let none = Error::Budget { bytes: self.config.record_bytes, least };
            let (slot, store) = slot.zip(self.store.as_ref()).ok_or(none)?;
            let (page, start) = store.address(slot);
            batch.push(page, Piece { run, slot: start + first % SEGMENT, count, flags });
            flags &= !IS_FIRST;
            first = last;
        }
        Ok(())
    }

    pub(crate) fn take<X>(&mut self, segment: u32, batch: &mut Batch<X>) -> Option<u32> {
        self.store.as_mut().and_then(|store| store.take(segment, self.round, &mut batch.missing))
    }

    /// Adds the records of a close brick, each on its own; or all of them for the CPU to draw.
    fn add_close<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch<S::Exact>,
        (brick, records): (u32, Range<u32>),
        by_cpu: bool,
    ) -> Result<(), Error>
    where
        S: Shape<R>,
    {
        let Some(camera) = self.frame.as_ref().and_then(|frame| frame.camera.clone()) else {
            return Ok(());
        };
        let holder = &content.bricks[brick as usize];
        let bound = Bounder::new(&camera).bound(&holder.bounds, holder.radius_max);
        let level = Level::of(holder, bound.nearest);
        for index in records {
            let near = Near { camera: &camera, scene: content.scene, index, level, by_cpu };
            let close = self.shape.close(&near);
            if self.is_crowded(batch) {
                self.flush(content, batch)?;
                if let Some(frame) = &mut self.frame {
                    frame.table.forget_records();
                }
            }
            match close {
                Close::Nothing => {}
                Close::Plain(reference, center, bound) => {
                    let run = Run::new(&camera, (reference, center), &bound, brick);
                    let Some(frame) = &mut self.frame else { continue };
                    let run = frame.table.push(run);
                    let is_tested = frame.has_drawn && self.config.skipping == Skipping::Hidden;
                    let tested = if is_tested { IS_TESTED } else { 0 };
                    self.add(content, batch, (run, index..index + 1), tested)?;
                }
                Close::Exact(exact) => {
                    batch.weight += exact.weight();
                    batch.exact.push(exact);
                }
            }
        }
        Ok(())
    }

    /// Whether a batch holds as many single records as should go through together.
    fn is_crowded<X>(&self, batch: &Batch<X>) -> bool {
        let runs = self.frame.as_ref().map_or(0, |frame| frame.table.records());
        runs >= SINGLE_MAX || batch.weight >= SINGLE_MAX
    }

    /// Draws a batch, and empties it.
    fn flush<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch<S::Exact>,
    ) -> Result<(), Error>
    where
        S: Shape<R>,
    {
        self.round += 1;
        if batch.is_empty() {
            batch.clear();
            return Ok(());
        }
        let Self { gpu, shape, kernels, bench, ring, store, frame, config, .. } = self;
        let (Some(store), Some(frame)) = (store, frame) else { return Ok(()) };
        let pack = |range, words: &mut Vec<u32>| shape.pack(content.scene, range, words);
        store.bring(gpu, ring, (content.scene, &batch.missing, &pack))?;
        let skipping = config.skipping;
        let seen = batch.seen.clone();
        let mut stage = Stage { gpu, kernels, bench, frame, skipping, seen };
        stage.draw_exact(&mut batch.exact)?;
        for (index, pieces) in batch.pieces.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
            let page = store.page(gpu, index)?;
            stage.draw_page(shape, (&page, pieces))?;
        }
        stage.frame.has_drawn = true;
        batch.clear();
        Ok(())
    }

    /// Draws what was seen in the picture before, of the bricks that were drawn then.
    pub(crate) fn recall_from<R: Record>(
        &mut self,
        last: &Frame,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<u64, Error>
    where
        S: Shape<R>,
    {
        if last.content.map(|key| key.bricks) != Some(Key::of(content).bricks) {
            return Ok(0);
        }
        let indices = self.prepare(content, bricks)?;
        let Some(seen) = self.find_seen(last, content)? else { return Ok(0) };
        self.clear_counts()?;
        let mut batch = Batch::new(self.store.as_ref().map_or(0, Store::pages));
        batch.seen = Some((seen, last.drawn.clone()));
        for index in indices {
            let (Some(frame), Some(store)) = (&mut self.frame, &self.store) else { break };
            let Known::Plain(run) = frame.table.known(index) else { continue };
            if !last.touched.get(index as usize).is_some_and(|&is_touched| is_touched) {
                continue;
            }
            let records = content.bricks[index as usize].records.clone();
            let segments = records.start / SEGMENT..records.end.div_ceil(SEGMENT);
            if segments.clone().any(|segment| store.residency.find(segment).is_none()) {
                continue;
            }
            frame.touched[index as usize] = true;
            let count = records.end.saturating_sub(records.start);
            if batch.is_full(count) {
                self.flush(content, &mut batch)?;
            }
            self.add(content, &mut batch, (run, records), IS_RECALLED)?;
        }
        self.flush(content, &mut batch)?;
        let counted = self.bench.counted(&self.gpu)?;
        // What is not whole is followed by a picture that is.
        Ok(if counted.missed > 0 { 0 } else { counted.recalled.into() })
    }

    /// The set of ids in a picture; `None` if it would be too large.
    fn find_seen<R: Record>(
        &mut self,
        last: &Frame,
        content: &Content<'_, R>,
    ) -> Result<Option<wgpu::Buffer>, Error> {
        let Some(store) = &self.store else { return Ok(None) };
        let bytes = (u64::from(store.id_max) / 32 + 1) * 4;
        if bytes > self.gpu.binding_bytes_max() || content.scene.records.is_empty() {
            return Ok(None);
        }
        let seen = self.bench.pool.storage(&self.gpu, "GpuRenderer::seen", bytes)?;
        self.gpu.guard("what was seen", || {
            let mut work = Work::new(&self.gpu, "GpuRenderer::find_seen");
            work.encoder.clear_buffer(&seen, 0, None);
            let bindings = [
                (0, last.target.camera.as_entire_binding()),
                (9, last.target.visibility.as_entire_binding()),
                (10, seen.as_entire_binding()),
            ];
            self.kernels.mark_seen.run(&mut work, &bindings, last.target.pixels());
            work.submit();
        })?;
        Ok(Some(seen))
    }
}
