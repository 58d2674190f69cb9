//! The state of a window: what is shown, what was asked for, and what follows from what.

use super::{
    Paint, Script, Show, UP,
    drawing::{self, Desk, Frame, Shown, Style},
    pick::{self, Pick},
};
use crate::{
    asking::{self, Asking, REST, Wish},
    camera::{Camera, Pivot},
    drawing::lock,
    look::middle,
    panel::{STATE_HEIGHT, grouped, within},
    pointer::{self, Anchor, Placed},
    theme,
    window::{Next, Program},
};
use anyhow::{Result, anyhow};
use egui::{
    Align2, Context, FontId, Key, Margin, Painter, Rect, Response, RichText, Sense, TextureHandle,
    TextureOptions, Ui,
};
use glam::DVec2;
use puncta::{Bricks, Glyph, Live, Progress, Renderer, Scene, io::png};
use std::{
    fmt::Display,
    io::{self, Write},
    sync::Arc,
    time::Duration,
};

/// There is something new on the desk.
#[derive(Debug)]
pub(crate) struct Drawn;

pub(crate) struct App<G: Glyph, B> {
    live: Live<G, B>,
    desk: Arc<Desk>,
    name: String,
    scene: Arc<Scene<G>>,
    paint: Paint<G>,
    /// How many times more rows and columns a fine picture has.
    factor: u32,
    script: Script,
    home: Camera,
    camera: Camera,
    asking: Asking,
    /// Whether the user is holding the camera.
    is_held: bool,
    anchor: Anchor,
    /// The pixel of the image that was clicked, until it is known what is seen there.
    clicked: Option<DVec2>,
    pick: Option<Pick>,
    shown: Option<Shown>,
    texture: Option<TextureHandle>,
    progress: Progress,
    error: Option<String>,
    /// The title that the window has.
    title: String,
}

impl<G: Glyph + 'static, B: Bricks + Send + Sync + 'static> App<G, B> {
    pub(crate) fn new<D>(
        show: Show<G, B>,
        renderer: D,
        wake: impl Fn() + Send + 'static,
    ) -> io::Result<Self>
    where
        D: Renderer<G, Error: Display> + Send + 'static,
    {
        let Show { name, scene, bricks, glyphs, paint, view, bounds, .. } = show;
        let (factor, background) = (show.supersample.max(1), show.background);
        let (scene, desk) = (Arc::new(scene), Arc::new(Desk::default()));
        let content = (Arc::clone(&scene), Arc::new(bricks));
        let style = Style { glyphs, paint, background, factor };
        let camera = Camera::new(view, UP, middle(&bounds));
        Ok(Self {
            live: drawing::spawn(renderer, content, style, Arc::clone(&desk), wake)?,
            desk,
            name,
            scene,
            paint,
            factor,
            script: show.script,
            home: camera.clone(),
            camera,
            asking: Asking::default(),
            is_held: false,
            anchor: Anchor::default(),
            clicked: None,
            pick: None,
            shown: None,
            texture: None,
            progress: Progress::default(),
            error: None,
            title: String::new(),
        })
    }

    /// Asks for the picture that is to be seen now, if it was not asked for yet. Returns when to
    /// look again.
    fn ask(&mut self) -> Option<Duration> {
        let state = (self.is_settled(), self.is_held);
        let (next, fine) = match self.asking.wish(self.camera.view(), self.factor, state) {
            Wish::Nothing => return None,
            Wish::Wait(time) => return Some(time),
            Wish::Plain(view) => (view, None),
            Wish::Fine(view) => (view.clone(), Some(view)),
        };
        *lock(&self.desk.fine) = fine;
        self.progress.open = u64::from(next.width()) * u64::from(next.height());
        if let Err(error) = self.live.look(next) {
            self.error = Some(error.to_string());
        }
        Some(REST)
    }

    /// Whether the picture that was asked for last is there, and complete.
    fn is_settled(&self) -> bool {
        let is_asked = |shown: &Shown| self.asking.view.as_ref() == Some(&shown.view);
        self.progress.settled() && self.shown.as_ref().is_some_and(is_asked)
    }

    /// Whether there is nothing more to come.
    fn is_at_rest(&self) -> bool {
        let is_final = |shown: &Shown| shown.factor == self.factor;
        self.is_settled()
            && (self.shown.as_ref().is_some_and(is_final)
                || asking::fine(self.camera.view(), self.factor).is_none())
    }

    fn take(&mut self, frame: Frame, context: &Context) {
        match frame.progress {
            Ok(progress) => (self.progress, self.error) = (progress, None),
            Err(error) => self.error = Some(error),
        }
        let Some(mut shown) = frame.shown else { return };
        if let Some(image) = shown.texture.take() {
            let options = TextureOptions::LINEAR;
            match &mut self.texture {
                Some(texture) => texture.set(image, options),
                None => self.texture = Some(context.load_texture("picture", image, options)),
            }
        }
        self.shown = Some(shown);
        if let Some(shown) = self.shown.as_ref().filter(|_| self.is_settled()) {
            let (width, height) = (shown.view.width(), shown.view.height());
            let (eye, covered) = (shown.view.eye(), shown.picture.covered_pixels());
            self.log(&format!("settled {width}x{height} eye={eye} covered={covered}"));
        }
    }

    fn log(&self, line: &str) {
        if self.script.log {
            // Nobody may be listening any more.
            writeln!(io::stdout(), "{line}").ok();
        }
    }

    /// What is going on.
    fn state(&self) -> String {
        let records = grouped(self.scene.records.len() as u64);
        let state = match (&self.error, &self.shown) {
            (Some(error), _) => error.clone(),
            (None, None) => "drawing".to_owned(),
            (None, Some(_)) if self.is_settled() => "settled".to_owned(),
            (None, Some(_)) => format!("{} pixels open", grouped(self.progress.open)),
        };
        let picked = self.pick.map_or_else(String::new, |pick| format!("; {pick}"));
        format!("{records} records, {state}{picked}")
    }

    fn show_picture(&mut self, ui: &mut Ui) {
        let rect = ui.max_rect();
        self.camera.resize(pointer::pixels(rect, ui.ctx().pixels_per_point()));
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, theme::WELL);
        let response = ui.interact(rect, egui::Id::unique("picture"), Sense::click_and_drag());
        let frame = self.paint(&painter, rect);
        self.point(&response, frame);
        self.pick();
        let pressed = |key| ui.ctx().input(|input| input.key_pressed(key));
        if pressed(Key::Escape) {
            self.pick = None;
        }
        if pressed(Key::Home) || pressed(Key::R) {
            self.camera = self.home.clone();
            self.camera.resize(pointer::pixels(rect, ui.ctx().pixels_per_point()));
        }
    }

    fn paint(&self, painter: &Painter, rect: Rect) -> Option<Placed> {
        let (Some(texture), Some(shown)) = (&self.texture, &self.shown) else {
            let (font, at) = (FontId::proportional(16.0), rect.center());
            painter.text(at, Align2::CENTER_CENTER, "drawing ...", font, theme::FAINT);
            return None;
        };
        let size = (shown.image.width, shown.image.height);
        let frame = pointer::paint(painter, rect, (texture.id(), size));
        if let Some(pick) = &self.pick {
            pick.mark(painter, shown, frame);
        }
        Some(frame)
    }

    /// Turns, moves, zooms and picks.
    fn point(&mut self, response: &Response, frame: Option<Placed>) {
        self.is_held = response.dragged();
        let shown = self.shown.as_ref();
        let seen = |pixel| shown.and_then(|shown| pick::point_at(shown, pixel));
        self.anchor.steer(&mut self.camera, response, frame, seen);
        let Some((at, frame)) = response.hover_pos().zip(frame) else { return };
        let pixel = frame.pixel(at);
        if response.double_clicked() {
            if let Some(point) = seen(pixel) {
                self.camera.center(point);
            }
        } else if response.clicked() {
            self.clicked = Some(pixel);
        }
    }

    /// Picks what was clicked. In a picture that is being drawn something may still come before what is
    /// seen; a picture that was overtaken stays as it is.
    fn pick(&mut self) {
        let Some(shown) = &self.shown else { return };
        if self.asking.view.as_ref() == Some(&shown.view) && !self.progress.settled() {
            return;
        }
        let Some(pixel) = self.clicked.take() else { return };
        self.pick = Pick::at((&self.scene, &self.paint), shown, pixel);
        let picked = self.pick.map_or_else(|| "nothing".to_owned(), |pick| pick.to_string());
        self.log(&format!("picked {picked}"));
    }
}

impl<G: Glyph + 'static, B: Bricks + Send + Sync + 'static> Program for App<G, B> {
    type Message = Drawn;

    fn show(&mut self, ui: &mut Ui) {
        // The places are reckoned here and not found by what is in them: each change of the
        // picture's size is a picture to draw.
        let whole = ui.max_rect();
        let (picture, state) = whole.split_top_bottom_at_y(whole.bottom() - STATE_HEIGHT);
        within(ui, picture, Margin::ZERO, |ui| self.show_picture(ui));
        let again = self.ask();
        within(ui, state, Margin::symmetric(12, 6), |ui| {
            let color = match (&self.error, self.is_settled()) {
                (Some(_), _) => theme::BAD,
                (None, true) => theme::GOOD,
                (None, false) => theme::ACCENT,
            };
            let text = RichText::new(self.state()).color(color);
            ui.add(egui::Label::new(text).truncate());
        });
        if let Some(delay) = again {
            ui.ctx().request_repaint_after(delay);
        }
    }

    fn receive(&mut self, Drawn: Drawn, context: &Context) -> Next {
        if let Some(frame) = self.desk.take() {
            self.take(frame, context);
        }
        Next::Again
    }

    fn after_frame(&mut self) -> Result<Next> {
        if self.script.screenshot.is_none() && self.script.orbit.is_none() {
            return Ok(Next::Wait);
        }
        if let (Some(_), Some(error)) = (&self.script.screenshot, &self.error) {
            return Err(anyhow!("{error}"));
        }
        let Some(shown) = &self.shown else { return Ok(Next::Wait) };
        if self.script.frames > 0 {
            self.script.frames -= 1;
            if let Some([yaw, pitch]) = self.script.orbit {
                self.camera.turn(Pivot::Target, yaw.to_radians(), pitch.to_radians());
            }
            return Ok(Next::Again);
        }
        let is_at_rest = self.is_at_rest();
        let Some(path) = self.script.screenshot.as_ref().filter(|_| is_at_rest) else {
            return Ok(Next::Wait);
        };
        png::write(path, &shown.image)?;
        Ok(Next::End)
    }

    fn new_title(&mut self) -> Option<String> {
        let title = format!("{}: {} - puncta", self.name, self.state());
        if title == self.title {
            return None;
        }
        self.title.clone_from(&title);
        Some(title)
    }
}
