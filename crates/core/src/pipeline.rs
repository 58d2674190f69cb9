/*!
The pipeline: stages narrow and order the bricks of a frame, a renderer draws them.

[`Pipeline::render`] draws to the end. [`Pipeline::progressive`] draws batch by batch and tells
after each one what is left, so that a program can show what it has or give up for a newer view.
*/

use crate::{Brick, Error, Picture, Record, Scene, View, Visible, VisibleBrick};
use glam::DVec3;
use std::{
    fmt,
    ops::{AddAssign, Range},
};

/// What a stage sees of a frame.
#[derive(Debug)]
pub struct Frame<'a, G: ?Sized> {
    /// The view to draw.
    pub view: &'a View,
    /// The world position that the boxes of the bricks are relative to.
    pub origin: DVec3,
    /// The spatial structure: a grid, or whatever else holds bricks.
    pub bricks: &'a G,
}

impl<G: ?Sized> Clone for Frame<'_, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<G: ?Sized> Copy for Frame<'_, G> {}

/// Narrows or orders the bricks in play.
///
/// A stage must never drop a brick that can be seen. Tuples of stages are stages and run from left
/// to right; so are closures.
///
/// # Examples
///
/// A user's own stage leaves out bricks of another floor of the building:
///
/// ```
/// use puncta_core::{Brick, Frame, Stage, Visible};
///
/// struct Floor {
///     top: f32,
/// }
///
/// impl<G: AsRef<[Brick]>> Stage<G> for Floor {
///     fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
///         let bricks = frame.bricks.as_ref();
///         visible.bricks.retain(|brick| bricks[brick.index as usize].bounds.min.z < self.top);
///     }
/// }
/// ```
pub trait Stage<G: ?Sized> {
    /// Changes `visible`, which holds indices of the bricks in `frame`.
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible);
}

impl<G: ?Sized, F: FnMut(&Frame<'_, G>, &mut Visible)> Stage<G> for F {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self(frame, visible);
    }
}

impl<G: ?Sized> Stage<G> for () {
    fn apply(&mut self, _frame: &Frame<'_, G>, _visible: &mut Visible) {}
}

impl<G: ?Sized, A: Stage<G>, B: Stage<G>> Stage<G> for (A, B) {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.apply(frame, visible);
        self.1.apply(frame, visible);
    }
}

impl<G: ?Sized, A: Stage<G>, B: Stage<G>, C: Stage<G>> Stage<G> for (A, B, C) {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.apply(frame, visible);
        self.1.apply(frame, visible);
        self.2.apply(frame, visible);
    }
}

/// Bricks to draw, nearest first as far as the stages know.
#[derive(Debug)]
pub struct Batch<'a, R> {
    /// The scene that the bricks are made of.
    pub scene: &'a Scene<R>,
    /// All bricks of the scene.
    pub bricks: &'a [Brick],
    /// Those to draw: indices into `bricks`.
    pub visible: &'a [VisibleBrick],
}

impl<R: Record> Batch<'_, R> {
    /// Checks that the scene is valid, that its bricks are made of records that are there, and that
    /// those to draw are among the bricks. Renderers that index do this first.
    ///
    /// # Errors
    ///
    /// As [`Scene::validate`], [`Error::BrickRange`] or [`Error::UnknownBrick`].
    pub fn validate(&self) -> Result<(), Error> {
        self.scene.validate()?;
        let records = self.scene.records.len();
        for &VisibleBrick { index, .. } in self.visible {
            let bricks = self.bricks.len();
            let brick =
                self.bricks.get(index as usize).ok_or(Error::UnknownBrick { index, bricks })?;
            let Range { start, end } = brick.records;
            if start > end || end as usize > records {
                return Err(Error::BrickRange { brick: index as usize, start, end, records });
            }
        }
        Ok(())
    }
}

/// Draws bricks into a picture.
///
/// Drawing is order independent: whatever the order of the batches, the picture shows the nearest
/// surface, and the lower [`Scene::id`] where two are equally near.
///
/// # Examples
///
/// A renderer that draws nothing but counts what it would have to draw:
///
/// ```
/// use puncta_core::{Batch, Error, Picture, Progress, Record, Renderer, View};
///
/// #[derive(Default)]
/// struct Count {
///     size: (u32, u32),
///     progress: Progress,
/// }
///
/// impl<R: Record> Renderer<R> for Count {
///     type Error = Error;
///
///     fn begin(&mut self, view: &View) -> Result<(), Error> {
///         *self = Self { size: (view.width(), view.height()), progress: Progress::default() };
///         Ok(())
///     }
///
///     fn draw(&mut self, batch: &Batch<'_, R>) -> Result<(), Error> {
///         self.progress += Progress::of(batch.bricks, batch.visible);
///         Ok(())
///     }
///
///     fn finish(&mut self) -> Result<Picture, Error> {
///         Picture::new(self.size.0, self.size.1)
///     }
///
///     fn progress(&self) -> Progress {
///         self.progress
///     }
/// }
/// ```
pub trait Renderer<R: Record> {
    /// What can go wrong.
    type Error: From<Error>;

    /// Starts a new picture, whatever became of the one before.
    ///
    /// # Errors
    ///
    /// When there cannot be such a picture.
    fn begin(&mut self, view: &View) -> Result<(), Self::Error>;

    /// Draws bricks into the picture.
    ///
    /// # Errors
    ///
    /// When the device fails.
    fn draw(&mut self, batch: &Batch<'_, R>) -> Result<(), Self::Error>;

    /// The picture of all that was drawn since [`Renderer::begin`].
    ///
    /// # Errors
    ///
    /// When the device fails, or no picture was begun.
    fn finish(&mut self) -> Result<Picture, Self::Error>;

    /// What was drawn since [`Renderer::begin`].
    fn progress(&self) -> Progress;
}

/// An amount of bricks and of their records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// A number of bricks.
    pub bricks: u64,
    /// The number of records in them.
    pub records: u64,
}

impl Progress {
    /// The amount of the bricks in play; those that are not among `bricks` hold nothing.
    #[must_use]
    pub fn of(bricks: &[Brick], visible: &[VisibleBrick]) -> Self {
        let records = |brick: &VisibleBrick| {
            bricks.get(brick.index as usize).map_or(0, |brick| brick.records.len() as u64)
        };
        Self { bricks: visible.len() as u64, records: visible.iter().map(records).sum() }
    }
}

impl AddAssign for Progress {
    fn add_assign(&mut self, other: Self) {
        self.bricks += other.bricks;
        self.records += other.records;
    }
}

/// Where a picture stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Step {
    /// What was drawn.
    pub drawn: Progress,
    /// What is still to be drawn.
    pub left: Progress,
    /// What the stages dropped.
    pub culled: Progress,
}

impl Step {
    /// Whether nothing that is left can change any pixel.
    #[must_use]
    pub const fn settled(&self) -> bool {
        self.left.bricks == 0
    }
}

/// Stages and a renderer.
///
/// # Examples
///
/// ```
/// use puncta_core::{Brick, Frame, Pipeline, Visible};
/// # use puncta_core::{Batch, Error, Picture, Progress, Record, Renderer, Scene, Sphere, View};
/// # #[derive(Default)]
/// # struct Count(Progress);
/// # impl<R: Record> Renderer<R> for Count {
/// #     type Error = Error;
/// #     fn begin(&mut self, _: &View) -> Result<(), Error> { Ok(()) }
/// #     fn draw(&mut self, batch: &Batch<'_, R>) -> Result<(), Error> {
/// #         self.0 += Progress::of(batch.bricks, batch.visible);
/// #         Ok(())
/// #     }
/// #     fn finish(&mut self) -> Result<Picture, Error> { Picture::new(1, 1) }
/// #     fn progress(&self) -> Progress { self.0 }
/// # }
/// # let scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0)]);
/// # let bounds = puncta_core::Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO };
/// # let bricks = vec![Brick { records: 0..1, bounds, radius_max: 1.0, density: 1.0 }];
/// # let renderer = Count::default();
/// # let view = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y)?;
/// let nearest_first = |_: &Frame<'_, Vec<Brick>>, visible: &mut Visible| {
///     visible.bricks.sort_by(|a, b| a.near.total_cmp(&b.near));
/// };
/// let mut pipeline = Pipeline::new(nearest_first, renderer);
/// let mut steps = pipeline.progressive(&scene, &bricks, &view, 100_000)?;
/// for step in &mut steps {
///     println!("{} records to go", step?.left.records);
/// }
/// let picture = steps.finish()?;
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Pipeline<S, D> {
    stages: S,
    renderer: D,
    visible: Visible,
}

impl<S, D> Pipeline<S, D> {
    /// A pipeline that applies `stages` and lets `renderer` draw what they leave.
    pub fn new(stages: S, renderer: D) -> Self {
        Self { stages, renderer, visible: Visible::default() }
    }

    /// Draws everything that can be seen.
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
        G: AsRef<[Brick]>,
        S: Stage<G>,
        D: Renderer<R>,
    {
        let mut steps = self.progressive(scene, bricks, view, u64::MAX)?;
        for step in &mut steps {
            step?;
        }
        steps.finish()
    }

    /// Starts a picture and returns an iterator that draws, at each step, the next bricks in order
    /// until they hold at least `budget` records.
    ///
    /// [`Progressive::finish`] gives the picture of what was drawn until then.
    ///
    /// # Errors
    ///
    /// When the scene or its bricks are not valid, and what the renderer has to report.
    pub fn progressive<'a, R, G>(
        &'a mut self,
        scene: &'a Scene<R>,
        bricks: &'a G,
        view: &View,
        budget: u64,
    ) -> Result<Progressive<'a, R, D>, D::Error>
    where
        R: Record,
        G: AsRef<[Brick]>,
        S: Stage<G>,
        D: Renderer<R>,
    {
        let list = bricks.as_ref();
        self.visible = Visible::all(list, scene.origin, view);
        Batch { scene, bricks: list, visible: &self.visible.bricks }.validate()?;
        let all = Progress::of(list, &self.visible.bricks);
        self.stages.apply(&Frame { view, origin: scene.origin, bricks }, &mut self.visible);
        let known = |brick: &VisibleBrick| (brick.index as usize) < list.len();
        self.visible.bricks.retain(known);
        let left = Progress::of(list, &self.visible.bricks);
        self.renderer.begin(view)?;
        let culled = Progress {
            bricks: all.bricks.saturating_sub(left.bricks),
            records: all.records.saturating_sub(left.records),
        };
        Ok(Progressive {
            renderer: &mut self.renderer,
            batch: Batch { scene, bricks: list, visible: &self.visible.bricks },
            step: Step { drawn: Progress::default(), left, culled },
            budget,
        })
    }

    /// The renderer.
    pub const fn renderer(&self) -> &D {
        &self.renderer
    }
}

/// A picture that is being drawn, step by step.
pub struct Progressive<'a, R, D> {
    renderer: &'a mut D,
    /// What is left to draw.
    batch: Batch<'a, R>,
    step: Step,
    budget: u64,
}

impl<R, D> Progressive<'_, R, D> {
    /// Where the picture stands.
    #[must_use]
    pub const fn step(&self) -> Step {
        self.step
    }
}

impl<R: Record, D: Renderer<R>> Progressive<'_, R, D> {
    /// The picture of what was drawn so far.
    ///
    /// # Errors
    ///
    /// What the renderer has to report.
    pub fn finish(self) -> Result<Picture, D::Error> {
        self.renderer.finish()
    }
}

impl<R: Record, D: Renderer<R>> Iterator for Progressive<'_, R, D> {
    type Item = Result<Step, D::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let left = self.batch.visible;
        if left.is_empty() {
            return None;
        }
        let mut records = 0;
        let enough = left.iter().position(|brick| {
            records += self.batch.bricks[brick.index as usize].records.len() as u64;
            records >= self.budget
        });
        let (now, later) = left.split_at(enough.map_or(left.len(), |last| last + 1));
        self.batch.visible = later;
        let batch = Batch { visible: now, ..self.batch };
        if let Err(error) = self.renderer.draw(&batch) {
            self.batch.visible = &[];
            return Some(Err(error));
        }
        self.step.drawn = self.renderer.progress();
        self.step.left.bricks -= now.len() as u64;
        self.step.left.records -= records;
        Some(Ok(self.step))
    }
}

impl<R, D> fmt::Debug for Progressive<'_, R, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progressive").field("step", &self.step).finish_non_exhaustive()
    }
}
