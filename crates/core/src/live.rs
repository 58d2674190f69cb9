/*!
Drawing in the background: views go in at any time, pictures come out, and the latest view wins.

A program that reacts to its user cannot wait for a picture, however soon that will be done. So a
[`Live`] runs a [`Pipeline`] on a thread of its own. Of the views that it is sent, only the latest
is kept. After each step the thread looks whether there is a newer one, and turns to it. Views that
were overtaken before they were begun are never begun: they are neither culled nor ordered nor
drawn.

A picture that was begun is drawn until a step has drawn bricks. If the thread turned away any
earlier, a camera that moves without rest would be shown nothing new: a first step may consist of
what was seen in the picture before ([`Renderer::recall`]). So a new view waits for at most two
steps of the one before, and mostly for one. What a step may cost is up to the [`Budget`].
*/

mod desk;
#[cfg(test)]
mod tests;

use crate::{
    Bricks, Budget, Content, Error, Picture, Pipeline, Progress, Record, Renderer, Scene, Stage,
    View,
};
use desk::{Call, Desk, Shown, Task};
use std::{
    any::Any,
    fmt, io,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::Arc,
    thread::{self, JoinHandle},
    time::Duration,
};

/// Draws views in the background, and always the latest.
///
/// # Threads
///
/// * The thread that calls [`look`](Self::look) or [`show`](Self::show) only hands over, and never
///   waits for a picture. It may be any thread, or several.
/// * The **drawing thread** culls, orders and draws, and calls `on_step` after each step. When
///   nothing is left to do it sleeps.
/// * Renderers may draw and load on further threads of their own.
///
/// So `on_step` must not wait for a thread that waits for the drawing thread, in
/// [`wait_idle`](Self::wait_idle) or by dropping the `Live`. It had better hand over what it has,
/// and return: while it runs, nothing is drawn.
///
/// When a `Live` is dropped, the drawing thread ends after the step that it is at, and is waited
/// for.
///
/// # Errors and panics
///
/// An error of the renderer is told to `on_step` ([`Step::progress`]) and ends the picture; the
/// thread goes on with the next view. A panic on the drawing thread ends it. From then on all
/// methods say so, by [`Error::DrawingPanicked`], and nobody is left waiting.
///
/// # Examples
///
/// ```
/// use puncta_core::{Live, Pipeline};
/// use std::sync::{Arc, mpsc};
/// # use puncta_core::{Amount, Brick, Content, Error, Picture, Record, Renderer, Scene, Sphere, View, VisibleBrick};
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
/// # let scene = Arc::new(Scene::new(vec![Sphere::new([0.0; 3], 1.0)]));
/// # let bounds = puncta_core::Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO };
/// # let bricks = Arc::new(vec![Brick { records: 0..1, bounds, radius_max: 1.0, density: 1.0 }]);
/// # let renderer = Count;
/// # let view = View::look_at(glam::DVec3::Z, glam::DVec3::ZERO, glam::DVec3::Y)?;
/// # let next_view = view.clone();
/// let (pictures, received) = mpsc::channel();
/// let pipeline = Pipeline::new((), renderer);
/// let live = Live::spawn(scene, bricks, pipeline, 100_000, move |step| {
///     if let (Ok(progress), Some(latency)) = (&step.progress, step.latency) {
///         println!("after {latency:?}, {} pixels may still change", progress.open);
///     }
///     let view = step.view.clone();
///     // The picture as it stands, or why there is none.
///     pictures.send((view, step.picture())).ok();
/// })?;
/// live.look(view)?; // returns at once
/// live.look(next_view.clone())?; // and so does this, which takes over
/// live.wait_idle()?; // only for the sake of the example
/// let (view, picture) = received.try_iter().last().expect("at least a step");
/// assert_eq!(view, next_view);
/// assert_eq!(picture?.covered_pixels(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Live<R, G> {
    desk: Arc<Desk<R, G>>,
    thread: Option<JoinHandle<()>>,
}

/// A step of a picture that is drawn in the background, as `on_step` of [`Live::spawn`] is told.
#[non_exhaustive]
pub struct Step<'a, R: Record, G, D: Renderer<R>> {
    /// Where the picture stands, or why nothing more of it will be drawn. A picture for which
    /// nothing is to be drawn has one step all the same.
    pub progress: Result<Progress, D::Error>,
    /// For the first step of a picture: how long ago it was asked for, by [`Live::look`] or
    /// [`Live::show`]. That is how long the user waits for an answer, without what it takes to
    /// bring it onto the screen.
    pub latency: Option<Duration>,
    /// The view that is drawn.
    pub view: &'a View,
    /// The scene that is drawn.
    pub scene: &'a Arc<Scene<R>>,
    /// Its bricks.
    pub bricks: &'a Arc<G>,
    /// The renderer, to show what it has drawn without making a [`Picture`]. What must not be done
    /// with it is said at [`Progressive::renderer_mut`](crate::Progressive::renderer_mut); after an
    /// error, anything may be done.
    pub renderer: &'a mut D,
}

impl<R: Record, G: Bricks, D: Renderer<R>> Step<'_, R, G, D> {
    /// What is drawn.
    #[must_use]
    pub fn content(&self) -> Content<'_, R> {
        Content { scene: self.scene, bricks: self.bricks.bricks(), blocks: self.bricks.blocks() }
    }

    /// The picture of what was drawn so far; the complete one if it is
    /// [settled](Progress::settled).
    ///
    /// # Errors
    ///
    /// That of the step, or what the renderer has to report now.
    pub fn picture(self) -> Result<Picture, D::Error> {
        self.progress?;
        let (bricks, blocks) = (self.bricks.bricks(), self.bricks.blocks());
        self.renderer.finish(&Content { scene: self.scene, bricks, blocks })
    }
}

impl<R: Record, G, D: Renderer<R>> fmt::Debug for Step<'_, R, G, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Step")
            .field("progress", &self.progress.as_ref().ok())
            .field("latency", &self.latency)
            .field("view", &self.view)
            .finish_non_exhaustive()
    }
}

impl<R, G> Live<R, G> {
    /// Starts a thread that will draw this scene with this pipeline, a budget for each step, and
    /// call `on_step` after each. It draws nothing before the first [`look`](Self::look).
    ///
    /// The budget says how soon the thread turns to a newer view. Some milliseconds are a good one.
    ///
    /// # Errors
    ///
    /// When the system gives no thread.
    pub fn spawn<S, D, F>(
        scene: Arc<Scene<R>>,
        bricks: Arc<G>,
        pipeline: Pipeline<S, D>,
        budget: impl Into<Budget>,
        on_step: F,
    ) -> io::Result<Self>
    where
        R: Record + 'static,
        G: Bricks + Send + Sync + 'static,
        S: Stage<G> + Send + 'static,
        D: Renderer<R> + Send + 'static,
        F: FnMut(Step<'_, R, G, D>) + Send + 'static,
    {
        let content = Shown { scene, bricks };
        let desk = Arc::new(Desk::new(content.clone()));
        let worker = Worker { desk: Arc::clone(&desk), pipeline, budget: budget.into(), on_step };
        let shared = Arc::clone(&desk);
        let thread = thread::Builder::new().name("puncta-live".into()).spawn(move || {
            // Nothing that a panic may have left half done is used again.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(move || worker.run(content))) {
                shared.fail(message(panic.as_ref()));
            }
        })?;
        Ok(Self { desk, thread: Some(thread) })
    }

    /// Turns to another view, and returns at once.
    ///
    /// # Errors
    ///
    /// [`Error::DrawingPanicked`].
    pub fn look(&self, view: View) -> Result<(), Error> {
        self.desk.ask(None, Some(view))
    }

    /// Turns to another scene, or to other bricks or attributes of it, in the view as it is, and
    /// returns at once.
    ///
    /// # Errors
    ///
    /// [`Error::DrawingPanicked`].
    pub fn show(&self, scene: Arc<Scene<R>>, bricks: Arc<G>) -> Result<(), Error> {
        self.desk.ask(Some(Shown { scene, bricks }), None)
    }

    /// Turns to another scene and another view together, and returns at once. No step will show one
    /// without the other.
    ///
    /// # Errors
    ///
    /// [`Error::DrawingPanicked`].
    pub fn show_from(&self, scene: Arc<Scene<R>>, bricks: Arc<G>, view: View) -> Result<(), Error> {
        self.desk.ask(Some(Shown { scene, bricks }), Some(view))
    }

    /// Waits until nothing is left to do: the picture of the latest view is settled or has failed,
    /// and `on_step` has returned.
    ///
    /// `on_step` would wait for itself here.
    ///
    /// # Errors
    ///
    /// [`Error::DrawingPanicked`].
    pub fn wait_idle(&self) -> Result<(), Error> {
        self.desk.wait_idle()
    }
}

impl<R, G> Drop for Live<R, G> {
    fn drop(&mut self) {
        self.desk.stop();
        let Some(thread) = self.thread.take() else { return };
        // If `on_step` holds the last handle, the thread ends when that returns.
        if thread.thread().id() != thread::current().id() {
            // A panic has been caught already.
            thread.join().ok();
        }
    }
}

impl<R, G> fmt::Debug for Live<R, G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Live").finish_non_exhaustive()
    }
}

/// What lives on the drawing thread.
struct Worker<R, G, S, D, F> {
    desk: Arc<Desk<R, G>>,
    pipeline: Pipeline<S, D>,
    budget: Budget,
    on_step: F,
}

impl<R, G, S, D, F> Worker<R, G, S, D, F>
where
    R: Record,
    G: Bricks,
    S: Stage<G>,
    D: Renderer<R>,
    F: FnMut(Step<'_, R, G, D>),
{
    /// Draws until there are no more pictures to draw.
    fn run(mut self, mut content: Shown<R, G>) {
        while let Some(task) = self.desk.take() {
            let before = std::mem::replace(&mut content, task.content.clone());
            self.draw(&task, before);
        }
    }

    /// Draws a picture until it is settled, fails or is overtaken.
    ///
    /// The content from before is let go of after the first step: until the picture begins the
    /// renderer may know it by where it lies, and letting go of much memory takes time.
    fn draw(&mut self, task: &Task<R, G>, before: Shown<R, G>) {
        let Self { desk, pipeline, budget, on_step } = self;
        let Task { content: Shown { scene, bricks }, view, asked } = task;
        let mut first = Some((asked, before));
        let mut tell = |progress, renderer: &mut D| {
            let (asked, before) = first.take().unzip();
            let latency = asked.map(|asked| asked.elapsed());
            on_step(Step { progress, latency, view, scene, bricks, renderer });
            drop(before);
        };
        let error = match pipeline.progressive(scene, bricks.as_ref(), view, *budget) {
            Ok(mut steps) => {
                let mut is_first = true;
                loop {
                    let step = steps.next();
                    // A picture of nothing takes no step.
                    let progress = step.unwrap_or_else(|| Ok(steps.progress()));
                    tell(progress, steps.renderer_mut());
                    // No place to turn away: see the top of this file.
                    let only_recalled =
                        std::mem::take(&mut is_first) && steps.progress().recalled > 0;
                    let is_over = match desk.call() {
                        Call::Stop => true,
                        Call::Turn => !only_recalled,
                        Call::GoOn => false,
                    };
                    if is_over || steps.left().is_empty() {
                        return;
                    }
                }
            }
            Err(error) => error,
        };
        tell(Err(error), pipeline.renderer_mut());
    }
}

/// What a panic says.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("it does not say why").to_owned()
}
