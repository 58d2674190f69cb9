//! What a tool builds: a scene of glyphs, and how to look at it.

use super::options::Drawing;
use anyhow::{Context, Result};
use glam::DVec3;
use puncta::{Background, Bounds, Glyph, Glyphs, Scene, View};
use puncta_viewer::glyphs::Paint;

/// A scene of glyphs that can be drawn.
pub(crate) struct Built<G: Glyph, B> {
    pub(crate) scene: Scene<G>,
    pub(crate) bricks: B,
    pub(crate) glyphs: Glyphs<G>,
    pub(crate) paint: Paint<G>,
    pub(crate) outlook: Outlook,
    /// What the user should know, such as what was left out.
    pub(crate) notes: Vec<String>,
    /// What it is made of, in words.
    pub(crate) facts: Vec<String>,
}

/// A view and a light that suit a scene. z is up.
#[derive(Clone, Debug)]
pub(crate) struct Outlook {
    /// What should be seen: points in world coordinates.
    pub(crate) points: Vec<DVec3>,
    /// From the middle towards the camera.
    pub(crate) toward: DVec3,
    /// In degrees.
    pub(crate) fov: f64,
    /// How many times nearer the camera is than one that sees all points.
    pub(crate) zoom: f64,
    /// Where the sun stands.
    pub(crate) sun: DVec3,
    /// What is seen where there is nothing.
    pub(crate) background: Background,
}

impl Outlook {
    /// The box around what should be seen.
    pub(crate) fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        self.points.iter().for_each(|&point| bounds.add(point));
        bounds
    }

    /// The view that the options ask for; where they say nothing, one that suits.
    pub(crate) fn view(&self, options: &Drawing) -> Result<View> {
        let fov = options.fov.unwrap_or(self.fov);
        let (width, height) = options.size;
        let set = |view: View| -> Result<View> {
            Ok(view.with_size(width, height)?.with_perspective(fov.to_radians())?)
        };
        let bounds = self.bounds();
        let middle = bounds.center();
        let target = options.target.unwrap_or(middle);
        let reach = bounds.extent().length().max(f64::MIN_POSITIVE);
        let eye = options.eye.unwrap_or(target + self.toward.normalize_or(DVec3::Z) * reach);
        let sight = target - eye;
        let is_along_z = sight.truncate().length() <= 1e-6 * sight.length();
        let up = if is_along_z { DVec3::Y } else { DVec3::Z };
        let view = set(View::look_at(eye, target, up).context("--eye and --target")?)?;
        if options.eye.is_some() {
            return Ok(view);
        }
        let fitted = view.framing(self.points.iter().map(|&point| (point, 0.0)));
        let distance = (fitted.eye() - middle).dot(-fitted.forward()).max(0.0);
        let nearer = fitted.eye() + fitted.forward() * (distance * (1.0 - 1.0 / self.zoom));
        let eye = if options.target.is_some() { nearer + target - middle } else { nearer };
        set(View::look_at(eye, eye + fitted.forward() * reach, up)?)
    }
}
