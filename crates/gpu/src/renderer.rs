//! The renderer: what is drawn, what is left out, and what is still open.

use crate::{
    Error, Fragment, Gpu, GpuConfig, Setup, Skipping,
    exact::Ball,
    finish,
    kernel::{Work, storage},
    kernels::Kernels,
    raster::Raster,
    residency::SEGMENT,
    round::{Batch, Bench, IS_COUNTED, IS_FIRST, IS_RECALLED, IS_TESTED, Piece, Stage},
    runs::{Run, is_plain_sphere},
    shade::Shading,
    store::{Ring, Store},
    survey,
    table::{Known, Table, bound_of_sphere},
    target::Target,
};
use puncta_core::{Amount, Camera, Content, Picture, Record, Renderer, View, VisibleBrick};
use std::ops::Range;

/// The share of the bricks that are drawn before those that are left are tested for the first time, and
/// the smallest number.
const FIRST_SHARE: usize = 128;
const FIRST_MIN: usize = 64;

/// The share of the bricks that are left by then, of which more than that is drawn at once later: what
/// is hidden is neither drawn nor brought, and testing takes few turns.
const LATER_SHARE: usize = 64;

/// Draws spheres exactly, through wgpu.
///
/// At each pixel the picture shows what [`Camera`] defines: the nearest point where its ray enters a
/// sphere, at a view depth of at least [`View::near`]; of equal depths the one with the lower
/// [`puncta_core::Scene::id`]. It does not depend on the order of drawing, on [`Setup`], or on what
/// was left out because it is hidden.
///
/// A picture is of one content: drawing another one into it is [`Error::OtherContent`].
///
/// # Examples
///
/// See the [crate's page](crate).
#[derive(Debug)]
pub struct GpuRenderer {
    pub(crate) gpu: Gpu,
    pub(crate) config: GpuConfig,
    setup: Setup,
    fragment: Fragment,
    pub(crate) kernels: Kernels,
    pub(crate) raster: Raster,
    pub(crate) bench: Bench,
    pub(crate) ring: Ring,
    pub(crate) store: Option<Store>,
    pub(crate) frame: Option<Frame>,
    /// The picture before, if it may be recalled.
    last: Option<Frame>,
    pub(crate) round: u64,
    /// What shading needs, once something was shaded.
    pub(crate) shading: Option<Shading>,
}

/// A picture that is being drawn.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) target: Target,
    content: Option<Key>,
    pub(crate) camera: Option<Camera>,
    pub(crate) table: Table,
    /// By brick, whether it was drawn.
    pub(crate) drawn: wgpu::Buffer,
    /// The bricks that records may be seen of.
    pub(crate) touched: Vec<bool>,
    has_drawn: bool,
    pub(crate) have_tiles: bool,
    pub(crate) are_tiles_fresh: bool,
    pub(crate) has_depth: bool,
    pub(crate) has_outlook: bool,
}

/// The place in the world and in memory of what is drawn, and how much it is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    origin: glam::DVec3,
    records: (u64, u64, usize),
    bricks: (usize, usize),
}

impl Key {
    fn of<R: Record>(content: &Content<'_, R>) -> Self {
        Self {
            origin: content.scene.origin,
            records: crate::store::key(content.scene),
            bricks: (content.bricks.as_ptr() as usize, content.bricks.len()),
        }
    }
}

impl Frame {
    fn new(gpu: &Gpu, view: &View) -> Result<Self, Error> {
        Ok(Self {
            target: Target::new(gpu, view)?,
            content: None,
            camera: None,
            table: Table::default(),
            drawn: storage(gpu, "Frame::drawn", 16)?,
            touched: Vec::new(),
            has_drawn: false,
            have_tiles: false,
            are_tiles_fresh: false,
            has_depth: false,
            has_outlook: false,
        })
    }

    fn restart(&mut self, gpu: &Gpu, view: &View, radius_min: f32) -> Result<(), Error> {
        (self.content, self.camera) = (None, None);
        self.touched.clear();
        self.has_drawn = false;
        (self.have_tiles, self.are_tiles_fresh) = (false, false);
        (self.has_depth, self.has_outlook) = (false, false);
        self.target.restart(gpu, view, radius_min)
    }

    /// Whether this is what was drawn.
    pub(crate) fn is_of<R: Record>(&self, content: &Content<'_, R>) -> bool {
        self.content == Some(Key::of(content))
    }

    /// Gets ready for this content.
    fn prepare<R: Record>(&mut self, gpu: &Gpu, content: &Content<'_, R>) -> Result<(), Error> {
        let key = Key::of(content);
        match self.content {
            Some(known) if known == key => return Ok(()),
            Some(_) => return Err(Error::OtherContent),
            None => {}
        }
        let bytes = content.bricks.len() as u64 * 4;
        if self.drawn.size() < bytes {
            self.drawn = storage(gpu, "Frame::drawn", bytes)?;
        }
        gpu.guard("bricks", || {
            let mut work = Work::new(gpu, "Frame::prepare");
            work.encoder.clear_buffer(&self.drawn, 0, None);
            work.submit();
        })?;
        self.table.clear(content.bricks.len());
        self.touched.resize(content.bricks.len(), false);
        self.camera = Some(Camera::new(&self.target.view, content.scene.origin));
        self.content = Some(key);
        Ok(())
    }
}

impl<R: Record> Renderer<R> for GpuRenderer {
    type Error = Error;

    fn begin(&mut self, view: &View) -> Result<(), Error> {
        self.gpu.check()?;
        // A picture of nothing is no reason to forget the one before.
        if self.frame.as_ref().is_some_and(|frame| frame.has_drawn) {
            std::mem::swap(&mut self.frame, &mut self.last);
        }
        let known = self.frame.take().filter(|frame| frame.target.fits(view));
        let mut frame = match known {
            Some(frame) => frame,
            None => Frame::new(&self.gpu, view)?,
        };
        frame.restart(&self.gpu, view, self.config.radius_min_pixels)?;
        self.frame = Some(frame);
        Ok(())
    }

    fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
        let indices = self.prepare(content, bricks)?;
        self.clear_counts()?;
        let mut close = Amount::default();
        let (mut rest, first) = (indices, bricks.len().div_ceil(FIRST_SHARE).max(FIRST_MIN));
        while !rest.is_empty() {
            let count = match self.config.skipping {
                Skipping::Nothing => rest.len(),
                Skipping::Hidden => {
                    if self.frame.as_ref().is_some_and(|frame| frame.has_drawn) {
                        rest = survey::glance(self, &rest)?;
                    }
                    first.max(rest.len() / LATER_SHARE).min(rest.len())
                }
            };
            let later = rest.split_off(count);
            close += self.draw_round(content, &rest)?;
            rest = later;
        }
        let counted = self.bench.counted(&self.gpu)?;
        close += Amount { bricks: counted.bricks.into(), records: counted.records.into() };
        Ok(close)
    }

    fn recall(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<u64, Error> {
        let Some(last) = self.last.take() else { return Ok(0) };
        let result = self.recall_from(&last, content, bricks);
        self.last = Some(last);
        result
    }

    fn forget(&mut self) {
        self.last = None;
        if let Some(frame) = &mut self.frame {
            frame.has_drawn = false;
        }
    }

    fn survey(
        &mut self,
        content: &Content<'_, R>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Error> {
        self.prepare(content, left)?;
        survey::survey(self, left).map(Some)
    }

    fn finish(&mut self, content: &Content<'_, R>) -> Result<Picture, Error> {
        let radius_min = self.config.radius_min_pixels;
        let is_exact = self.fragment.is_exact();
        finish::finish(self, content, is_exact.then_some(radius_min))
    }
}

impl GpuRenderer {
    /// A renderer on this device.
    ///
    /// # Errors
    ///
    /// [`Error::Unsupported`] when the device cannot do what `config` names, [`Error::Budget`], or what
    /// the device reports.
    pub fn new(gpu: &Gpu, config: GpuConfig) -> Result<Self, Error> {
        let setup = config.setup.unwrap_or_else(|| suited(gpu));
        let fragment = config.fragment.unwrap_or(Fragment::Sphere);
        let least = crate::store::RECORD_BYTES * u64::from(SEGMENT);
        if config.record_bytes < least {
            return Err(Error::Budget { bytes: config.record_bytes, least });
        }
        Ok(Self {
            kernels: Kernels::new(gpu, setup, fragment)?,
            raster: Raster::new(gpu, setup, fragment)?,
            bench: Bench::new(gpu)?,
            gpu: gpu.clone(),
            config,
            setup,
            fragment,
            ring: Ring::default(),
            store: None,
            frame: None,
            last: None,
            round: 0,
            shading: None,
        })
    }

    /// How spheres become fragments.
    #[must_use]
    pub const fn setup(&self) -> Setup {
        self.setup
    }

    /// What fragments do.
    #[must_use]
    pub const fn fragment(&self) -> Fragment {
        self.fragment
    }

    /// The device.
    #[must_use]
    pub const fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The bytes of records on the GPU now, which are at most [`GpuConfig::record_bytes`].
    #[must_use]
    pub fn record_bytes(&self) -> u64 {
        self.store.as_ref().map_or(0, Store::bytes)
    }

    /// The bytes of records that were brought to the GPU for the scene that is there now.
    #[must_use]
    pub fn brought_bytes(&self) -> u64 {
        self.store.as_ref().map_or(0, |store| store.brought)
    }

    /// For each pixel, whether the bricks that were left when [`Renderer::survey`] was last asked may
    /// still change it. Before that, all pixels are open. Those drawn since count as left.
    ///
    /// # Errors
    ///
    /// When no picture was begun, or the device fails.
    pub fn open_pixels(&mut self) -> Result<Vec<bool>, Error> {
        survey::open_pixels(self)
    }

    /// Checks what is to be drawn, and gets ready for it. Returns which bricks these are.
    pub(crate) fn prepare<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Vec<u32>, Error> {
        self.gpu.check()?;
        let frame = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
        content.validate(bricks)?;
        frame.prepare(&self.gpu, content)?;
        if self.store.as_ref().is_none_or(|store| !store.is_of(content.scene)) {
            self.store = None;
            self.store = Some(Store::new(&self.gpu, content.scene, self.config.record_bytes)?);
        }
        let indices: Vec<u32> = bricks.iter().map(VisibleBrick::index).collect();
        if let Some(camera) = &frame.camera {
            let camera = (camera, self.config.radius_min_pixels);
            frame.table.learn(content, camera, &indices);
        }
        Ok(indices)
    }

    fn clear_counts(&self) -> Result<(), Error> {
        self.gpu.guard("counts", || {
            let mut work = Work::new(&self.gpu, "GpuRenderer::clear_counts");
            work.encoder.clear_buffer(&self.bench.counts, 0, None);
            work.submit();
        })
    }

    /// Draws bricks that were learned; returns what was drawn of those that the GPU does not count.
    fn draw_round<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[u32],
    ) -> Result<Amount, Error> {
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
                    self.add_close(content, &mut batch, (index, records))?;
                }
            }
        }
        self.flush(content, &mut batch, None)?;
        Ok(close)
    }

    /// Adds the records of a brick to a batch, which goes through first if it is full.
    fn add<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch,
        (run, records): (u32, Range<u32>),
        mut flags: u32,
    ) -> Result<(), Error> {
        let mut first = records.start;
        while first < records.end {
            let segment = first / SEGMENT;
            let last = records.end.min(segment.saturating_add(1).saturating_mul(SEGMENT));
            let count = last - first;
            if batch.is_full(count) {
                self.flush(content, batch, None)?;
            }
            let mut slot = self.take(segment, batch);
            if slot.is_none() {
                self.flush(content, batch, None)?;
                slot = self.take(segment, batch);
            }
            let least = u64::from(SEGMENT) * crate::store::RECORD_BYTES;
            let none = Error::Budget { bytes: self.config.record_bytes, least };
            let (slot, store) = slot.zip(self.store.as_ref()).ok_or(none)?;
            let (page, start) = store.address(slot);
            batch.push(page, Piece { run, slot: start + first % SEGMENT, count, flags });
            flags &= !IS_FIRST;
            first = last;
        }
        Ok(())
    }

    pub(crate) fn take(&mut self, segment: u32, batch: &mut Batch) -> Option<u32> {
        self.store.as_mut().and_then(|store| store.take(segment, self.round, &mut batch.missing))
    }

    /// Adds the records of a close brick, each on its own.
    fn add_close<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch,
        (brick, records): (u32, Range<u32>),
    ) -> Result<(), Error> {
        let Some(camera) = self.frame.as_ref().and_then(|frame| frame.camera.clone()) else {
            return Ok(());
        };
        let least = f64::from(self.config.radius_min_pixels) * camera.pixel_size();
        for index in records {
            let record = &content.scene.records[index as usize];
            let center = camera.place(record.position().as_dvec3());
            let spread = if camera.is_perspective() { center.z } else { 1.0 };
            let mut radius = f64::from(record.radius());
            // Of no size means of no picture, whatever is made of small ones.
            if radius > 0.0 {
                radius = radius.max(least * spread);
            }
            let Some(bound) = bound_of_sphere(&camera, center, radius) else { continue };
            if is_plain_sphere(&camera, center, radius) {
                let run = Run::new(&camera, (record.position(), center), &bound, brick);
                let Some(frame) = &mut self.frame else { continue };
                let run = frame.table.push(run);
                let tested = if frame.has_drawn { IS_TESTED } else { 0 };
                self.add(content, batch, (run, index..index + 1), tested)?;
            } else {
                let id = content.scene.id(index);
                batch.balls.push(Ball { center, radius, bound, id });
            }
        }
        Ok(())
    }

    /// Draws a batch, and empties it.
    fn flush<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        batch: &mut Batch,
        seen: Option<(wgpu::Buffer, wgpu::Buffer)>,
    ) -> Result<(), Error> {
        self.round += 1;
        if batch.is_empty() {
            batch.clear();
            return Ok(());
        }
        let Self { gpu, kernels, raster, bench, ring, store, frame, config, .. } = self;
        let (Some(store), Some(frame)) = (store, frame) else { return Ok(()) };
        store.bring(gpu, ring, (content.scene, &batch.missing))?;
        let skipping = config.skipping;
        let mut stage = Stage { gpu, kernels, raster, bench, frame, skipping, seen };
        stage.draw_exact(&batch.balls)?;
        for (index, pieces) in batch.pieces.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
            let page = store.page(gpu, index)?;
            stage.draw_page(&page, pieces)?;
        }
        stage.frame.has_drawn = true;
        batch.clear();
        Ok(())
    }

    /// Draws what was seen in the picture before, of the bricks that were drawn then.
    fn recall_from<R: Record>(
        &mut self,
        last: &Frame,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<u64, Error> {
        if last.content.map(|key| key.bricks) != Some(Key::of(content).bricks) {
            return Ok(0);
        }
        let indices = self.prepare(content, bricks)?;
        let Some(seen) = self.find_seen(last, content)? else { return Ok(0) };
        self.clear_counts()?;
        let mut batch = Batch::new(self.store.as_ref().map_or(0, Store::pages));
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
                self.flush(content, &mut batch, Some((seen.clone(), last.drawn.clone())))?;
            }
            self.add(content, &mut batch, (run, records), IS_RECALLED)?;
        }
        self.flush(content, &mut batch, Some((seen, last.drawn.clone())))?;
        Ok(self.bench.counted(&self.gpu)?.recalled.into())
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

/// The set-up that suits a device.
fn suited(gpu: &Gpu) -> Setup {
    if gpu.is_wide() { Setup::Compute } else { Setup::Triangle }
}
