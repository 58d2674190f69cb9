/*!
The pipeline: stages narrow and order the bricks of a frame, a renderer draws them.

[`Pipeline::render`] draws to the end. [`Pipeline::progressive`] draws bit by bit and tells after each
step what is left and how many pixels that could still change, so that a program can show what it has,
stop when nothing can change any more, or turn to a newer view ([`Progressive::look`]). A
[`Live`](crate::Live) does that on a thread of its own.

A step draws for a [`Budget`]. Then the renderer is asked what each brick that is left could still
change: those that can change nothing are skipped, and the stages may order the rest anew. The first
step of a picture draws the records that were seen in the picture before, if there was one. It needs
neither a stage nor a brick to be looked at, and after a small move of the camera it shows nearly the
whole picture.
*/

use crate::{
    Amount, Brick, Bricks, Budget, Content, Frame, Picture, Progress, Record, Renderer, Scene,
    Stage, View, Visible, VisibleBrick,
};
use std::{fmt, time::Instant};

/// Stages and a renderer.
///
/// # Examples
///
/// ```
/// use puncta_core::{Brick, Frame, Pipeline, Visible};
/// # use puncta_core::{Amount, Content, Error, Picture, Record, Renderer, Scene, Sphere, View, VisibleBrick};
/// # #[derive(Default)]
/// # struct Count;
/// # impl<R: Record> Renderer<R> for Count {
/// #     type Error = Error;
/// #     fn begin(&mut self, _: &View) -> Result<(), Error> { Ok(()) }
/// #     fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
/// #         Ok(Amount::of(content.bricks, bricks))
/// #     }
/// #     fn finish(&mut self, _: &Content<'_, R>) -> Result<Picture, Error> { Picture::new(1, 1) }
/// # }
/// # let scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0)]);
/// # let bounds = puncta_core::Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO };
/// # let bricks = vec![Brick { records: 0..1, bounds, radius_max: 1.0, density: 1.0 }];
/// # let renderer = Count;
/// # let view = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y)?;
/// # let next_view = view.clone();
/// let nearest_first = |_: &Frame<'_, Vec<Brick>>, visible: &mut Visible| {
///     visible.bricks.sort_by(|a, b| a.near().total_cmp(&b.near()));
/// };
/// let mut pipeline = Pipeline::new(nearest_first, renderer);
/// let mut steps = pipeline.progressive(&scene, &bricks, &view, 100_000)?;
/// while let Some(progress) = steps.next() {
///     println!("{} pixels may still change", progress?.open);
///     let picture = steps.picture()?;
/// }
/// steps.look(&next_view)?;
/// assert!(!steps.progress().settled());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Pipeline<S, D> {
    stages: S,
    renderer: D,
    visible: Visible,
    /// Records drawn in a second, as far as that is known.
    speed: Option<f64>,
}

impl<S, D> Pipeline<S, D> {
    /// A pipeline that applies `stages` and lets `renderer` draw what they leave.
    pub fn new(stages: S, renderer: D) -> Self {
        Self { stages, renderer, visible: Visible::default(), speed: None }
    }

    /// Draws the complete picture.
    ///
    /// # Errors
    ///
    /// When the scene or its bricks are not valid, and what the renderer has to report.
    pub fn render<R, G>(
        &mut self,
        scene: &Scene<R>,
        bricks: &G,
        view: &View,
    ) -> Result<Picture, D::Error>
    where
        R: Record,
        G: Bricks,
        S: Stage<G>,
        D: Renderer<R>,
    {
        let mut steps = self.progressive(scene, bricks, view, u64::MAX)?;
        for step in &mut steps {
            step?;
        }
        steps.picture()
    }

    /// Starts a picture and returns an iterator that draws a bit more of it at each step.
    ///
    /// [`Progressive::picture`] gives the picture of what was drawn until then.
    ///
    /// # Errors
    ///
    /// When the scene or its bricks are not valid, and what the renderer has to report.
    pub fn progressive<'a, R, G>(
        &'a mut self,
        scene: &'a Scene<R>,
        bricks: &'a G,
        view: &View,
        budget: impl Into<Budget>,
    ) -> Result<Progressive<'a, R, G, S, D>, D::Error>
    where
        R: Record,
        G: Bricks,
        S: Stage<G>,
        D: Renderer<R>,
    {
        let mut progressive = Progressive {
            pipeline: self,
            scene,
            bricks,
            view: view.clone(),
            budget: budget.into(),
            next: 0,
            is_new: true,
            progress: Progress::default(),
        };
        progressive.look(view)?;
        Ok(progressive)
    }

    /// Forgets what was seen: the next picture starts from nothing.
    pub fn forget<R: Record>(&mut self)
    where
        D: Renderer<R>,
    {
        self.renderer.forget();
    }

    /// The renderer.
    pub const fn renderer(&self) -> &D {
        &self.renderer
    }

    /// The renderer, to change its settings or to use what it has drawn.
    pub const fn renderer_mut(&mut self) -> &mut D {
        &mut self.renderer
    }
}

/// A picture that is being drawn, step by step.
///
/// As an iterator it draws at each step, for its [`Budget`], and gives where the picture stands. It ends
/// when nothing is left that can change the picture, and after an error. The first step of a picture
/// only draws what was seen in the one before, whatever the budget, if that is known.
pub struct Progressive<'a, R, G, S, D> {
    pipeline: &'a mut Pipeline<S, D>,
    scene: &'a Scene<R>,
    bricks: &'a G,
    view: View,
    budget: Budget,
    /// Which of the bricks in play comes next.
    next: usize,
    /// Whether nothing of this picture has been drawn.
    is_new: bool,
    progress: Progress,
}

impl<R, G, S, D> Progressive<'_, R, G, S, D> {
    /// Where the picture stands.
    #[must_use]
    pub const fn progress(&self) -> Progress {
        self.progress
    }

    /// The view that is being drawn.
    #[must_use]
    pub const fn view(&self) -> &View {
        &self.view
    }

    /// The renderer.
    #[must_use]
    pub const fn renderer(&self) -> &D {
        &self.pipeline.renderer
    }

    /// The renderer, to show what it has drawn without making a [`Picture`].
    ///
    /// The picture is half done and the rest will be drawn with this renderer. Whoever begins a
    /// picture with it, draws with it or puts another one in its place spoils this picture; the next
    /// one ([`look`](Self::look)) is not concerned.
    #[must_use]
    pub const fn renderer_mut(&mut self) -> &mut D {
        &mut self.pipeline.renderer
    }

    /// The bricks that are left, in the order in which they are to be drawn.
    #[must_use]
    pub fn left(&self) -> &[VisibleBrick] {
        self.pipeline.visible.bricks.get(self.next..).unwrap_or_default()
    }
}

impl<R: Record, G: Bricks, S: Stage<G>, D: Renderer<R>> Progressive<'_, R, G, S, D> {
    /// Turns to another view, at once: what is left of the view before is not drawn any more.
    ///
    /// # Errors
    ///
    /// When the scene or its bricks are not valid, and what the renderer has to report. Nothing is
    /// left to draw then.
    pub fn look(&mut self, view: &View) -> Result<(), D::Error> {
        self.view = view.clone();
        self.progress = Progress::default();
        let (list, origin) = (self.bricks.bricks(), self.scene.origin);
        let Pipeline { stages, renderer, visible, .. } = &mut *self.pipeline;
        visible.refill(list, origin, view);
        let all = Amount::of(list, &visible.bricks);
        let content = Content { scene: self.scene, bricks: list, blocks: self.bricks.blocks() };
        let begun = content.validate(&visible.bricks).map_err(D::Error::from);
        if let Err(error) = begun.and_then(|()| renderer.begin(view)) {
            visible.bricks.clear();
            // Nothing is left, but the picture of this view is not complete.
            self.progress.open = self.pixels();
            return Err(error);
        }
        stages.apply(&Frame { view, origin, bricks: self.bricks }, visible);
        keep_known(visible, list);
        let left = Amount::of(list, &visible.bricks);
        self.progress = Progress { left, culled: all - left, ..Progress::default() };
        self.progress.open = if visible.bricks.is_empty() { 0 } else { self.pixels() };
        (self.next, self.is_new) = (0, true);
        Ok(())
    }

    /// The picture of what was drawn so far; the complete one if it is
    /// [settled](Progress::settled).
    ///
    /// # Errors
    ///
    /// What the renderer has to report.
    pub fn picture(&mut self) -> Result<Picture, D::Error> {
        let content = content(self.scene, self.bricks);
        self.pipeline.renderer.finish(&content)
    }

    /// Draws what was seen before; whether there was anything.
    fn recall(&mut self) -> Result<bool, D::Error> {
        let Pipeline { renderer, visible, .. } = &mut *self.pipeline;
        let content = content(self.scene, self.bricks);
        self.progress.recalled = renderer.recall(&content, &visible.bricks)?;
        Ok(self.progress.recalled > 0)
    }

    /// Draws until the budget is spent.
    fn draw(&mut self) -> Result<(), D::Error> {
        match self.budget {
            Budget::Records(records) => self.draw_records(records),
            Budget::Time(time) => {
                let start = Instant::now();
                while self.next < self.pipeline.visible.bricks.len() {
                    let rest = time.saturating_sub(start.elapsed());
                    // Half of what the rest of the time seems good for, as speeds vary.
                    let speed = self.pipeline.speed.unwrap_or(1e6);
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "it saturates"
                    )]
                    let records = (rest.as_secs_f64() * 0.5 * speed) as u64;
                    let (from, drawn) = (Instant::now(), self.progress.drawn.records);
                    self.draw_records(records.max(SMALLEST))?;
                    let drawn = (self.progress.drawn.records - drawn) as f64;
                    let took = from.elapsed().as_secs_f64();
                    if drawn > 0.0 && took > 0.0 {
                        self.pipeline.speed = Some(drawn / took);
                    }
                    if start.elapsed() >= time {
                        break;
                    }
                }
                Ok(())
            }
        }
    }

    /// Draws the next bricks, which hold at least this many records.
    fn draw_records(&mut self, records: u64) -> Result<(), D::Error> {
        let content = content(self.scene, self.bricks);
        let left = self.pipeline.visible.bricks.get(self.next..).unwrap_or_default();
        let mut sum = 0;
        let enough = left.iter().position(|brick| {
            sum += Amount::of(content.bricks, std::slice::from_ref(brick)).records;
            sum >= records
        });
        let now = &left[..enough.map_or(left.len(), |last| last + 1)];
        let taken = Amount { bricks: now.len() as u64, records: sum };
        let drawn = self.pipeline.renderer.draw(&content, now)?;
        self.next += now.len();
        self.progress.drawn += drawn;
        self.progress.skipped += taken - drawn;
        self.progress.left = self.progress.left - taken;
        Ok(())
    }

    /// Finds what the bricks that are left could change, and leaves out those that cannot.
    fn survey(&mut self) -> Result<(), D::Error> {
        let pixels = self.pixels();
        let content = content(self.scene, self.bricks);
        let Pipeline { stages, renderer, visible, .. } = &mut *self.pipeline;
        visible.bricks.drain(..self.next);
        self.next = 0;
        let open = match visible.bricks.as_mut_slice() {
            [] => Some(0),
            left => renderer.survey(&content, left)?,
        };
        if open == Some(0) {
            visible.bricks.clear();
        } else if open.is_some() {
            visible.bricks.retain(VisibleBrick::is_open);
        }
        let left = Amount::of(content.bricks, &visible.bricks);
        self.progress.skipped += self.progress.left - left;
        self.progress.left = left;
        if open.is_some() {
            let (view, origin) = (&self.view, self.scene.origin);
            stages.refine(&Frame { view, origin, bricks: self.bricks }, visible);
            keep_known(visible, content.bricks);
            if visible.bricks.len() as u64 != left.bricks {
                self.progress.left = Amount::of(content.bricks, &visible.bricks);
                self.progress.culled += left - self.progress.left;
            }
        }
        self.progress.open = if visible.bricks.is_empty() { 0 } else { open.unwrap_or(pixels) };
        Ok(())
    }

    fn step(&mut self) -> Result<Progress, D::Error> {
        let is_new = std::mem::take(&mut self.is_new);
        if !(is_new && self.recall()?) {
            self.draw()?;
        }
        self.survey()?;
        Ok(self.progress)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.view.width()) * u64::from(self.view.height())
    }
}

/// The fewest records that are drawn at once for a budget of time.
const SMALLEST: u64 = 1 << 14;

/// Stages cannot make bricks, but may have swapped in a list of others.
fn keep_known(visible: &mut Visible, bricks: &[Brick]) {
    visible.bricks.retain(|brick| (brick.index() as usize) < bricks.len());
}

fn content<'a, R, G: Bricks>(scene: &'a Scene<R>, bricks: &'a G) -> Content<'a, R> {
    Content { scene, bricks: bricks.bricks(), blocks: bricks.blocks() }
}

impl<R: Record, G: Bricks, S: Stage<G>, D: Renderer<R>> Iterator for Progressive<'_, R, G, S, D> {
    type Item = Result<Progress, D::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.left().is_empty() {
            return None;
        }
        let step = self.step();
        if step.is_err() {
            self.pipeline.visible.bricks.clear();
        }
        Some(step)
    }
}

impl<R, G, S, D> fmt::Debug for Progressive<'_, R, G, S, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progressive").field("progress", &self.progress).finish_non_exhaustive()
    }
}
