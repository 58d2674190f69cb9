//! What happens on the drawing thread, and what it leaves for the window.

use super::Paint;
use crate::{
    drawing::lock,
    pace::{About, BUDGET, Pace},
};
use egui::ColorImage;
use puncta::{
    Background, Bricks, Depth, FrustumCull, Glyph, Glyphs, Image, Live, Picture, Pipeline,
    Progress, Renderer, Scene, Shading, Step, View, shade_glyphs,
};
use std::{
    fmt::Display,
    io,
    sync::{Arc, Mutex},
    time::Instant,
};

/// What the window and the drawing thread tell each other.
#[derive(Debug, Default)]
pub(crate) struct Desk {
    /// The view of which several pixels make one of the image.
    pub(crate) fine: Mutex<Option<View>>,
    latest: Mutex<Option<Frame>>,
}

/// Where the picture stands.
#[derive(Debug)]
pub(crate) struct Frame {
    /// Or why there is none.
    pub(crate) progress: Result<Progress, String>,
    /// What there is to see, if an image was made.
    pub(crate) shown: Option<Shown>,
}

/// What there is to see.
#[derive(Debug)]
pub(crate) struct Shown {
    pub(crate) view: View,
    pub(crate) picture: Picture,
    /// How many pixels of the picture make one of the image, along each side.
    pub(crate) factor: u32,
    pub(crate) image: Image,
    /// The same for the window, until that takes it.
    pub(crate) texture: Option<ColorImage>,
}

impl Desk {
    /// What was left since the last call.
    pub(crate) fn take(&self) -> Option<Frame> {
        lock(&self.latest).take()
    }

    /// Leaves what is newer; an image that nobody has seen stays until there is a newer one.
    fn leave(&self, mut frame: Frame) {
        let mut latest = lock(&self.latest);
        frame.shown = frame.shown.or(latest.take().and_then(|before| before.shown));
        *latest = Some(frame);
    }
}

/// How images are made of pictures.
#[derive(Debug)]
pub(crate) struct Style<G: Glyph> {
    pub(crate) glyphs: Glyphs<G>,
    pub(crate) paint: Paint<G>,
    pub(crate) background: Background,
    /// How many samples along each side of a pixel a fine picture has.
    pub(crate) factor: u32,
}

/// Starts a drawing thread; `wake` tells the window that there is something new on the desk.
pub(crate) fn spawn<G, B, D>(
    renderer: D,
    (scene, bricks): (Arc<Scene<G>>, Arc<B>),
    style: Style<G>,
    desk: Arc<Desk>,
    wake: impl Fn() + Send + 'static,
) -> io::Result<Live<G, B>>
where
    G: Glyph + 'static,
    B: Bricks + Send + Sync + 'static,
    D: Renderer<G, Error: Display> + Send + 'static,
{
    let pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
    let mut pace = Pace::default();
    Live::spawn(scene, bricks, pipeline, BUDGET, move |step| {
        desk.leave(present(step, &style, &desk, &mut pace));
        wake();
    })
}

/// Makes what the window shows of a step.
fn present<G, B, D>(
    step: Step<'_, G, B, D>,
    style: &Style<G>,
    desk: &Desk,
    pace: &mut Pace,
) -> Frame
where
    G: Glyph,
    B: Bricks,
    D: Renderer<G, Error: Display>,
{
    let progress = step.progress.as_ref().map_err(ToString::to_string).copied();
    let is_fine = lock(&desk.fine).as_ref() == Some(step.view);
    let is_settled = progress.as_ref().is_ok_and(Progress::settled);
    let about = About { is_first: step.latency.is_some(), is_settled, is_fine };
    if progress.is_err() || !pace.is_due(about) {
        return Frame { progress, shown: None };
    }
    let start = Instant::now();
    let shown = shade(step, style, if is_fine { style.factor } else { 1 });
    pace.note(start);
    match shown {
        Ok(shown) => Frame { progress, shown: Some(shown) },
        Err(error) => Frame { progress: Err(error), shown: None },
    }
}

/// Reads the picture back and shades it.
fn shade<G, B, D>(step: Step<'_, G, B, D>, style: &Style<G>, factor: u32) -> Result<Shown, String>
where
    G: Glyph,
    B: Bricks,
    D: Renderer<G, Error: Display>,
{
    let (scene, bricks) = (Arc::clone(step.scene), Arc::clone(step.bricks));
    let view = step.view.clone();
    let picture = step.picture().map_err(|error| error.to_string())?;
    let size = (view.width() / factor, view.height() / factor);
    let coarse = view.clone().with_size(size.0, size.1).map_err(|error| error.to_string())?;
    let Style { glyphs, paint, background, .. } = style;
    let image = paint.with_coloring(&scene, |coloring| {
        let background = *background;
        let shading = Shading { coloring, background, supersample: factor, ..Shading::default() };
        shade_glyphs(glyphs, &scene, bricks.as_ref(), &coarse, &picture, &shading)
    });
    let image = image.map_err(|error| error.to_string())?;
    let size = [image.width as usize, image.height as usize];
    let texture = ColorImage::from_rgba_unmultiplied(size, image.pixels.as_flattened());
    Ok(Shown { view, picture, factor, image, texture: Some(texture) })
}
