//! The renderer: what is drawn, what is left out, and what is still open.

use crate::{
    Error, Fragment, Gpu, GpuConfig, Setup, Skipping, Solids, Spheres, finish,
    kernel::Work,
    kernels::Kernels,
    pace::Pace,
    picture::Frame,
    round::Bench,
    shade_pass::Shading,
    shape::{Draw, Shape},
    store::{Ring, Store},
    survey,
};
use puncta_avc::{Glyph, Glyphs};
use puncta_core::{Amount, Content, Picture, Record, Renderer, View, VisibleBrick};

/// The most storage buffers that a shader sees at once: the default of WebGPU.
const BUFFERS_MIN: u32 = 8;

/// Draws spheres, or glyphs, exactly, through wgpu.
///
/// At each pixel the picture shows what [`Camera`](puncta_core::Camera) defines: the nearest point where its ray enters a
/// sphere or the triangles of a glyph, at a view depth of at least [`View::near`]; of equal depths the one with the lower
/// [`puncta_core::Scene::id`]. It does not depend on the order of drawing, on [`Setup`], or on what
/// was left out because it is hidden.
///
/// A picture is of one content: drawing another one into it is [`Error::OtherContent`].
///
/// # Examples
///
/// See the [crate's page](crate).
#[derive(Debug)]
pub struct GpuRenderer<S = Spheres> {
    pub(crate) gpu: Gpu,
    pub(crate) config: GpuConfig,
    pub(crate) shape: S,
    pub(crate) kernels: Kernels,
    pub(crate) bench: Bench,
    pub(crate) ring: Ring,
    pub(crate) store: Option<Store>,
    pub(crate) frame: Option<Frame>,
    /// The picture before, if it may be recalled.
    pub(crate) last: Option<Frame>,
    pub(crate) round: u64,
    /// Bricks of this picture that were too much for the device.
    pub(crate) missed: u64,
    /// What shading needs, once something was shaded.
    pub(crate) shading: Option<Shading>,
}

/// The renderer of one shape: all the same.
macro_rules! renderer {
    ([$($generics:tt)+] $record:ty, $shape:ty) => {
        impl<$($generics)+> Renderer<$record> for GpuRenderer<$shape> {
            type Error = Error;

            fn begin(&mut self, view: &View) -> Result<(), Error> {
                self.begin_picture(view)
            }

            fn draw(
                &mut self,
                content: &Content<'_, $record>,
                bricks: &[VisibleBrick],
            ) -> Result<Amount, Error> {
                let drawn = self.draw_all(content, bricks);
                self.keep_if_sound(drawn)
            }

            fn recall(
                &mut self,
                content: &Content<'_, $record>,
                bricks: &[VisibleBrick],
            ) -> Result<u64, Error> {
                let Some(last) = self.last.take() else { return Ok(0) };
                let result = self.recall_from(&last, content, bricks);
                self.last = Some(last);
                self.keep_if_sound(result)
            }

            fn forget(&mut self) {
                self.last = None;
                if let Some(frame) = &mut self.frame {
                    frame.has_drawn = false;
                }
            }

            fn survey(
                &mut self,
                content: &Content<'_, $record>,
                left: &mut [VisibleBrick],
            ) -> Result<Option<u64>, Error> {
                self.prepare(content, left)?;
                let open = survey::survey(self, left).map(Some);
                self.keep_if_sound(open)
            }

            fn finish(&mut self, content: &Content<'_, $record>) -> Result<Picture, Error> {
                let mut picture = finish::finish(self, content)?;
                if let Some(camera) = self.frame.as_ref().and_then(|frame| frame.camera.as_ref()) {
                    self.shape.refine(camera, content, &mut picture);
                }
                Ok(picture)
            }
        }
    };
}

renderer!([R: Record] R, Spheres);
renderer!([G: Glyph] G, Solids<G>);

impl GpuRenderer {
    /// A renderer of spheres on this device.
    ///
    /// # Errors
    ///
    /// [`Error::Unsupported`] when the device cannot do what `config` names, [`Error::Budget`], or what
    /// the device reports.
    pub fn new(gpu: &Gpu, config: GpuConfig) -> Result<Self, Error> {
        let radius = config.radius_min_pixels;
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(Error::RadiusMin { pixels: radius });
        }
        check_buffers(gpu)?;
        let shape = Spheres::new(gpu, &config)?;
        Self::with_shape(gpu, config, shape)
    }

    /// How spheres become fragments.
    #[must_use]
    pub const fn setup(&self) -> Setup {
        self.shape.setup
    }

    /// What fragments do.
    #[must_use]
    pub const fn fragment(&self) -> Fragment {
        self.shape.fragment
    }
}

impl<G: Glyph> GpuRenderer<Solids<G>> {
    /// A renderer of these glyphs on this device. Of `config`, what concerns spheres is not used.
    ///
    /// # Errors
    ///
    /// [`Error::Budget`], or what the device reports.
    pub fn of(gpu: &Gpu, glyphs: Glyphs<G>, config: GpuConfig) -> Result<Self, Error> {
        check_buffers(gpu)?;
        let shape = Solids::new(gpu, glyphs)?;
        Self::with_shape(gpu, config, shape)
    }

    /// The glyphs.
    #[must_use]
    pub const fn glyphs(&self) -> &Glyphs<G> {
        &self.shape.glyphs
    }

    /// The glyphs, to change what all of them share for the next picture: records stay where they are.
    ///
    /// A picture that is half done must not see other glyphs: begin another one.
    #[must_use]
    pub const fn glyphs_mut(&mut self) -> &mut Glyphs<G> {
        &mut self.shape.glyphs
    }
}

/// Whether a shader of this device sees as many buffers as drawing needs.
fn check_buffers(gpu: &Gpu) -> Result<(), Error> {
    let buffers = gpu.device.limits().max_storage_buffers_per_shader_stage;
    if buffers < BUFFERS_MIN {
        let what = format!("bind {BUFFERS_MIN} storage buffers at once, but {buffers}");
        return Err(Error::Unsupported { adapter: gpu.name().to_owned(), what });
    }
    Ok(())
}

impl<S> GpuRenderer<S> {
    fn with_shape(gpu: &Gpu, config: GpuConfig, shape: S) -> Result<Self, Error>
    where
        S: Draw,
    {
        let least = shape.layout().bytes();
        if config.record_bytes < least {
            return Err(Error::Budget { bytes: config.record_bytes, least });
        }
        Ok(Self {
            kernels: Kernels::new(gpu)?,
            bench: Bench::new(gpu)?,
            gpu: gpu.clone(),
            config,
            shape,
            ring: Ring::default(),
            store: None,
            frame: None,
            last: None,
            round: 0,
            missed: 0,
            shading: None,
        })
    }

    fn begin_picture(&mut self, view: &View) -> Result<(), Error>
    where
        S: Draw,
    {
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
        frame.restart(&self.gpu, view, self.shape.radius_min())?;
        self.frame = Some(frame);
        self.missed = 0;
        Ok(())
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

    /// How many bricks of this picture were too much for the device, so that the CPU drew them: the
    /// picture is right, but it took longer.
    ///
    /// That is so where bricks hold more large triangles than there is room for, or records of more
    /// triangles than a shader may go through: smaller bricks help, and simpler records. Spheres are
    /// never too much.
    #[must_use]
    pub const fn missed_bricks(&self) -> u64 {
        self.missed
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

    /// A picture that may be half drawn is given up: what it would say of itself could be wrong.
    fn keep_if_sound<T>(&mut self, result: Result<T, Error>) -> Result<T, Error> {
        if matches!(result, Err(Error::OutOfMemory { .. } | Error::Refused { .. })) {
            self.frame = None;
        }
        result
    }

    fn draw_all<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Error>
    where
        S: Shape<R>,
    {
        let indices = self.prepare(content, bricks)?;
        self.clear_counts()?;
        let mut close = Amount::default();
        let mut rest = indices;
        let mut pace = Pace::new(rest.len());
        while !rest.is_empty() {
            let count = match self.config.skipping {
                Skipping::Nothing => rest.len(),
                Skipping::Hidden => {
                    if self.frame.as_ref().is_some_and(|frame| frame.has_drawn) {
                        let before = rest.len();
                        rest = survey::glance(self, &rest)?;
                        pace.adapt(before - rest.len(), before);
                    }
                    let Some(frame) = &self.frame else { break };
                    let pixels = |&brick: &u32| frame.table.pixels(brick);
                    pace.next(frame.target.pixels().into(), rest.iter().map(pixels))
                }
            };
            let later = rest.split_off(count);
            close += self.draw_round(content, &rest)?;
            rest = later;
        }
        let counted = self.bench.counted(&self.gpu)?;
        if counted.missed > 0 {
            self.draw_missed(content, bricks)?;
        }
        close += Amount { bricks: counted.bricks.into(), records: counted.records.into() };
        Ok(close)
    }

    /// Checks what is to be drawn, and gets ready for it. Returns which bricks these are.
    pub(crate) fn prepare<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Vec<u32>, Error>
    where
        S: Shape<R>,
    {
        self.gpu.check()?;
        let frame = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
        content.validate(bricks)?;
        frame.prepare(&self.gpu, content)?;
        if !self.store.as_mut().is_some_and(|store| store.follow(content.scene)) {
            self.store = None;
            let room = (self.shape.layout(), self.config.record_bytes);
            self.store = Some(Store::new(&self.gpu, content.scene, room)?);
        }
        let indices: Vec<u32> = bricks.iter().map(VisibleBrick::index).collect();
        if let Some(camera) = &frame.camera {
            self.shape.prepare(&self.gpu, camera)?;
            frame.table.learn(content, (camera, &self.shape), &indices);
        }
        Ok(indices)
    }

    pub(crate) fn clear_counts(&self) -> Result<(), Error> {
        self.gpu.guard("counts", || {
            let mut work = Work::new(&self.gpu, "GpuRenderer::clear_counts");
            work.encoder.clear_buffer(&self.bench.counts, 0, None);
            work.encoder.clear_buffer(&self.bench.missed, 0, None);
            work.submit();
        })
    }
}
