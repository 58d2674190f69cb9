//! Drawing: what happens on the drawing thread, and what it shares with the window.
//!
//! After each step [`present`] makes a [`Frame`] of it, and the window is told that there is one.
//! Only the latest is kept, and not of every step an image is made: see `pace.rs`.

use crate::{
    cli::Order,
    look::Look,
    pace::{About, BUDGET, Pace},
    stage::Ordering,
};
use egui::ColorImage;
use puncta::{
    ColorMap, Grid, Image, Live, Picture, Pipeline, Progress, Renderer, Scene, Shading, Sphere,
    Step, View, shade,
};
use std::{
    fmt::Display,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

/// What the window tells the drawing thread, and what that tells the window.
#[derive(Debug)]
pub(crate) struct Desk {
    pub(crate) look: Mutex<Look>,
    pub(crate) order: Arc<Mutex<Option<Order>>>,
    /// The size of pictures of which four pixels make one of the image.
    pub(crate) fine: Mutex<Option<(u32, u32)>>,
    latest: Mutex<Vec<Frame>>,
}

/// A step of a picture, for the window.
#[derive(Debug)]
pub(crate) struct Frame {
    /// Where the picture stands, or why there is none.
    pub(crate) progress: Result<Progress, String>,
    pub(crate) view: View,
    /// For the first step of a picture: how long ago it was asked for.
    pub(crate) latency: Option<Duration>,
    /// When the step was presented.
    pub(crate) at: Instant,
    /// What there is to see, if an image was made.
    pub(crate) shown: Option<Shown>,
}

/// What there is to see.
#[derive(Debug)]
pub(crate) struct Shown {
    pub(crate) scene: Arc<Scene<Sphere>>,
    pub(crate) view: View,
    pub(crate) picture: Picture,
    /// How many pixels of the picture make one of the image, along each side.
    pub(crate) factor: u32,
    pub(crate) image: Image,
    /// The same for the window, until that takes it.
    pub(crate) texture: Option<ColorImage>,
    /// The values at the ends of the color map.
    pub(crate) range: Option<[f64; 2]>,
}

impl Desk {
    pub(crate) fn new(look: Look, order: Order) -> Self {
        Self {
            look: Mutex::new(look),
            order: Arc::new(Mutex::new(Some(order))),
            fine: Mutex::default(),
            latest: Mutex::default(),
        }
    }

    /// What was presented since the last call, the oldest first; only the last one has an image.
    pub(crate) fn take(&self) -> Vec<Frame> {
        std::mem::take(&mut *lock(&self.latest))
    }

    fn leave(&self, frame: Frame) {
        let mut latest = lock(&self.latest);
        if frame.shown.is_some() {
            latest.iter_mut().for_each(|before| before.shown = None);
        }
        latest.push(frame);
    }
}

/// Waits for nobody for long: locks are held for moments.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a drawing thread; `wake` tells the window that there is something new on the desk.
pub(crate) fn spawn<D>(
    renderer: D,
    (scene, grid): (Arc<Scene<Sphere>>, Arc<Grid>),
    desk: Arc<Desk>,
    wake: impl Fn() + Send + 'static,
) -> std::io::Result<Live<Sphere, Grid>>
where
    D: Renderer<Sphere, Error: Display> + Send + 'static,
{
    let pipeline = Pipeline::new(Ordering::new(Arc::clone(&desk.order)), renderer);
    let mut presenter = Presenter::default();
    Live::spawn(scene, grid, pipeline, BUDGET, move |step| {
        let frame = present(step, &desk, &mut presenter);
        desk.leave(frame);
        wake();
    })
}

/// What is kept from one image to the next.
#[derive(Debug, Default)]
struct Presenter {
    pace: Pace,
    map: Option<(String, ColorMap)>,
    /// A range that was looked up, and what it is the range of.
    range: Option<(Arc<Scene<Sphere>>, String, [f64; 2])>,
}

/// Makes what the window shows of a step.
fn present<D>(step: Step<'_, Sphere, Grid, D>, desk: &Desk, presenter: &mut Presenter) -> Frame
where
    D: Renderer<Sphere, Error: Display>,
{
    let progress = step.progress.as_ref().map_err(ToString::to_string).copied();
    let (view, latency) = (step.view.clone(), step.latency);
    let is_settled = progress.as_ref().is_ok_and(Progress::settled);
    let is_fine = *lock(&desk.fine) == Some((view.width(), view.height()));
    let about = About { is_first: latency.is_some(), is_settled, is_fine };
    let is_due = presenter.pace.is_due(about);
    let mut frame = Frame { progress, view, latency, at: Instant::now(), shown: None };
    if frame.progress.is_ok() && is_due {
        let start = Instant::now();
        let factor = if is_fine { 2 } else { 1 };
        // On its own line: the lock ends with the statement.
        let look = lock(&desk.look).clone();
        let shown = show(step, factor, &look, presenter);
        match shown {
            Ok(shown) => frame.shown = Some(shown),
            Err(error) => frame.progress = Err(error),
        }
        presenter.pace.note(start);
        frame.at = Instant::now();
    }
    frame
}

/// Reads the picture back and shades it.
fn show<D>(
    step: Step<'_, Sphere, Grid, D>,
    factor: u32,
    look: &Look,
    presenter: &mut Presenter,
) -> Result<Shown, String>
where
    D: Renderer<Sphere, Error: Display>,
{
    let (scene, view) = (Arc::clone(step.scene), step.view.clone());
    let picture = step.picture().map_err(|error| error.to_string())?;
    let told = |error: puncta::cpu::Error| error.to_string();
    if presenter.map.as_ref().is_none_or(|(name, _)| *name != look.map) {
        let map = ColorMap::named(&look.map).map_err(told)?;
        presenter.map = Some((look.map.clone(), map));
    }
    let Presenter { map: Some((_, map)), range: known, .. } = presenter else {
        return Err("there is no color map".to_owned());
    };
    let range = match look.range {
        Some(range) => Some(range),
        None => {
            let what = format!("{:?} {}", look.color_by, look.up);
            let is_known =
                |known: &&(Arc<_>, String, _)| Arc::ptr_eq(&known.0, &scene) && known.1 == what;
            match known.as_ref().filter(is_known) {
                Some((_, _, range)) => Some(*range),
                None => {
                    let range = look.coloring(map, None).range(&scene).map_err(told)?;
                    *known = range.map(|range| (Arc::clone(&scene), what, range));
                    range
                }
            }
        }
    };
    let coloring = look.coloring(map, range);
    let size = (view.width() / factor, view.height() / factor);
    let coarse = view.clone().with_size(size.0, size.1).map_err(|error| error.to_string())?;
    let shading = Shading {
        coloring,
        background: look.background,
        supersample: factor,
        ..Shading::default()
    };
    let image = shade(&scene, &coarse, &picture, &shading).map_err(told)?;
    let size = [image.width as usize, image.height as usize];
    let texture = ColorImage::from_rgba_unmultiplied(size, image.pixels.as_flattened());
    Ok(Shown { scene, view, picture, factor, image, texture: Some(texture), range })
}
