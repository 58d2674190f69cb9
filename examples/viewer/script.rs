//! What the window does by itself: turns the camera, writes what is seen, and ends.

use crate::{app::App, camera::Pivot, cli::Cli, worker::Job};
use anyhow::{Result, anyhow};
use std::path::PathBuf;

#[derive(Debug)]
pub(crate) struct Script {
    screenshot: Option<PathBuf>,
    /// How many frames are still to be shown.
    frames: u32,
    /// In radians for each frame.
    orbit: Option<[f64; 2]>,
    is_writing: bool,
}

impl Script {
    pub(crate) fn new(cli: &Cli) -> Self {
        Self {
            screenshot: cli.screenshot.clone(),
            frames: cli.frames,
            orbit: cli.orbit.map(|angles| angles.map(f64::to_radians)),
            is_writing: false,
        }
    }

    /// Goes on after a frame was shown; whether it wants another one at once.
    pub(crate) fn after_frame(&mut self, app: &mut App) -> Result<bool> {
        if self.screenshot.is_none() && self.orbit.is_none() {
            return Ok(false);
        }
        if let (Some(_), Some(error)) = (&self.screenshot, &app.error) {
            return Err(anyhow!("{error}"));
        }
        if app.shown.is_none() {
            return Ok(false);
        }
        if self.frames > 0 {
            self.frames -= 1;
            if let (Some([yaw, pitch]), Some(camera)) = (self.orbit, &mut app.camera) {
                camera.turn(Pivot::Target, yaw, pitch);
            }
            return Ok(true);
        }
        if let (Some(path), true, false) = (&self.screenshot, app.is_at_rest(), self.is_writing)
            && let Some(image) = app.image()
        {
            self.is_writing = true;
            app.send(Job::Save(path.clone(), image));
        }
        Ok(false)
    }

    /// Whether the window may close, now that an image was written. If it was not, the error will
    /// be told with the next frame.
    pub(crate) fn is_over(&self, saved: &Result<PathBuf>) -> bool {
        self.is_writing && saved.as_ref().is_ok_and(|path| Some(path) == self.screenshot.as_ref())
    }
}
