//! Windows for scenes of glyphs: pictures that follow the mouse, drawn by a [`puncta::Live`].
//!
//! A left drag turns around the middle, a right or middle drag moves, and the wheel zooms to the
//! pointer. A click picks the record below the pointer, a double click brings it to the middle.

mod app;
mod drawing;
mod pick;

use crate::window;
use anyhow::{Context, Result};
use glam::DVec3;
use puncta::{
    Background, Bounds, Bricks, Coloring, Glyph, Glyphs, Renderer, Scene, View, cpu::Each,
};
use std::{fmt, path::PathBuf};

/// A scene of glyphs, and how it is shown. z is up.
#[derive(Debug)]
pub struct Show<G: Glyph, B> {
    /// What stands first in the title of the window.
    pub name: String,
    /// What is drawn.
    pub scene: Scene<G>,
    /// The bricks of the scene.
    pub bricks: B,
    /// What all records share.
    pub glyphs: Glyphs<G>,
    /// Where the colors of records come from.
    pub paint: Paint<G>,
    /// What is seen first; its size is that of the window in pixels.
    pub view: View,
    /// Around what there is to see: a camera that looks at none of it turns around its middle.
    pub bounds: Bounds,
    /// What is seen where there is nothing.
    pub background: Background,
    /// How many samples along each side of a pixel are averaged when the camera rests.
    pub supersample: u32,
    /// What the window does by itself.
    pub script: Script,
}

/// Where the colors of records come from.
#[derive(Clone, Copy)]
pub enum Paint<G> {
    /// The colors of the scene.
    Scene,
    /// What a record says itself, in sRGB.
    Record(fn(&G) -> [u8; 3]),
}

impl<G> fmt::Debug for Paint<G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scene => "Scene",
            Self::Record(_) => "Record",
        })
    }
}

impl<G: Glyph> Paint<G> {
    /// Does something with the colors of the records of a scene.
    pub fn with_coloring<T>(&self, scene: &Scene<G>, act: impl FnOnce(Coloring<'_>) -> T) -> T {
        let records = scene.records.as_slice();
        match self {
            Self::Scene => act(Coloring::Colors),
            Self::Record(color) => {
                let each = |index: u32| records.get(index as usize).map_or([128; 3], color);
                act(Coloring::Each(Each::new(&each)))
            }
        }
    }
}

/// What a window does by itself.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// Writes the picture to this file once it is settled, and closes.
    pub screenshot: Option<PathBuf>,
    /// How many times the window is painted before that, at least.
    pub frames: u32,
    /// By how many degrees the camera turns with each of these frames, to the right and upwards.
    pub orbit: Option<[f64; 2]>,
    /// Whether a line is printed for each picture that is settled, and for each record that is picked.
    pub log: bool,
}

/// Two angles in degrees, as `YAW,PITCH`.
///
/// # Errors
///
/// When the text is anything else.
pub fn angles(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let angles = text.split_once(',').and_then(|(yaw, pitch)| Some([number(yaw)?, number(pitch)?]));
    angles.ok_or_else(|| "two numbers with a comma between them".to_owned())
}

/// Opens a window with a scene that this renderer draws, and returns when the user closes it.
///
/// # Errors
///
/// Where there can be no window, or no thread to draw on. If a script writes a picture, also what
/// goes wrong while that is drawn or written; otherwise the window tells it.
pub fn show<G, B, D>(show: Show<G, B>, renderer: D) -> Result<()>
where
    G: Glyph + 'static,
    B: Bricks + Send + Sync + 'static,
    D: Renderer<G, Error: fmt::Display> + Send + 'static,
{
    let size = (show.view.width(), show.view.height());
    window::run(size, |proxy| {
        let wake = move || {
            // There is nobody to wake up if the window is gone.
            proxy.send_event(app::Drawn).ok();
        };
        app::App::new(show, renderer, wake).context("the system gives no thread to draw on")
    })
}

/// The axis that stays upright.
const UP: DVec3 = DVec3::Z;
