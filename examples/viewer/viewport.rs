//! The picture in the window, and what the pointer does to it.

use crate::{
    app::App,
    drawing::Shown,
    look,
    options::ColorBy,
    picking::{self, Pick},
    pointer::{self, Placed},
    progress,
    theme::{self, rough},
};
use egui::{
    Align2, Color32, CornerRadius, FontId, Key, Painter, Rect, Response, Sense, Stroke, StrokeKind,
    Ui, pos2, vec2,
};
use glam::DVec3;
use puncta::ColorMap;

/// How many distances to the target a flight covers in a second.
const SPEED: f64 = 0.8;

/// Shows the picture in what is left of the window.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    let rect = ui.max_rect();
    let scale = ui.ctx().pixels_per_point();
    if let Some(camera) = &mut app.camera {
        camera.resize(pointer::pixels(rect, scale));
    }
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, theme::WELL);
    let response = ui.interact(rect, egui::Id::unique("picture"), Sense::click_and_drag());
    let frame = paint(app, &painter, rect);
    point(app, &response, frame);
    keys(app, ui);
    if let (Some(shown), Some(frame)) = (&app.shown, frame) {
        if let Some(pick) = &app.pick {
            pick.mark(&painter, shown, |pixel| frame.point(pixel));
        }
        if let Some(pick) = &app.pick {
            card(pick, ui, rect);
        }
        legend(app, shown, &painter, rect);
        scale_bar(app, &painter, rect, scale);
    } else if app.error.is_none() {
        let (font, at) = (FontId::proportional(16.0), rect.center());
        let text = match (&app.content, progress::now()) {
            (_, Some(_)) => "opening ...",
            (Some(_), None) => "drawing ...",
            (None, None) => "drop a file here",
        };
        painter.text(at, Align2::CENTER_CENTER, text, font, theme::FAINT);
    }
    if ui.ctx().input(|input| !input.raw.hovered_files.is_empty()) {
        let stroke = Stroke::new(3.0, theme::ACCENT);
        painter.rect_stroke(rect.shrink(8.0), 8.0, stroke, StrokeKind::Inside);
        let (font, at) = (FontId::proportional(22.0), rect.center());
        painter.text(at, Align2::CENTER_CENTER, "drop to open", font, Color32::WHITE);
    }
}

/// Paints the image, if there is one.
fn paint(app: &App, painter: &Painter, rect: Rect) -> Option<Placed> {
    let (texture, shown) = (app.texture.as_ref()?, app.shown.as_ref()?);
    Some(pointer::paint(painter, rect, (texture.id(), (shown.image.width, shown.image.height))))
}

/// Turns, moves, zooms and picks.
fn point(app: &mut App, response: &Response, frame: Option<Placed>) {
    app.is_held = response.dragged();
    let Some(camera) = &mut app.camera else { return };
    let shown = app.shown.as_ref();
    let seen = |pixel| shown.and_then(|shown| picking::point_at(shown, pixel));
    app.anchor.steer(camera, response, frame, seen);
    let Some(pixel) = frame.zip(response.hover_pos()).map(|(frame, at)| frame.pixel(at)) else {
        return;
    };
    if response.double_clicked() {
        if let Some(point) = seen(pixel) {
            camera.center(point);
        }
    } else if response.clicked() {
        app.pick = shown.and_then(|shown| Pick::at(shown, pixel));
    }
}

/// Flies, and does what has a key.
fn keys(app: &mut App, ui: &Ui) {
    let ctx = ui.ctx();
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    let pressed = |key| ctx.input(|input| input.key_pressed(key));
    if pressed(Key::P) || pressed(Key::F12) {
        app.save();
    }
    if pressed(Key::H) {
        app.has_panel = !app.has_panel;
    }
    if pressed(Key::Escape) {
        app.pick = None;
    }
    if pressed(Key::Home) || pressed(Key::R) {
        app.go_home();
    }
    let Some(camera) = &mut app.camera else { return };
    if let (Some(pick), true) = (&app.pick, pressed(Key::F)) {
        camera.center(pick.position());
    }
    let (steps, dt) = ctx.input(|input| {
        let along = |forth, back| {
            f64::from(i8::from(input.key_down(forth)) - i8::from(input.key_down(back)))
        };
        let steps = DVec3::new(along(Key::D, Key::A), along(Key::E, Key::Q), along(Key::W, Key::S));
        let factor = if input.modifiers.shift { 4.0 } else { 1.0 };
        (steps * factor, f64::from(input.stable_dt.min(0.1)))
    });
    if steps != DVec3::ZERO && !ctx.input(|input| input.modifiers.command) {
        camera.fly(steps * (SPEED * dt));
        app.is_held = true;
        ctx.request_repaint();
    }
}

/// What is known of the particle that was picked.
fn card(pick: &Pick, ui: &Ui, rect: Rect) {
    let area = egui::Area::new(egui::Id::unique("particle")).fixed_pos(rect.min + vec2(12.0, 12.0));
    area.show(ui.ctx(), |ui| {
        let fill = Color32::from_black_alpha(170);
        let frame = egui::Frame::new().fill(fill).corner_radius(6.0).inner_margin(10.0);
        frame.show(ui, |ui| {
            ui.set_max_height((rect.height() - 220.0).max(60.0));
            egui::ScrollArea::vertical().show(ui, |ui| pick.describe(ui));
        });
    });
}

/// Explains the color map.
fn legend(app: &App, shown: &Shown, painter: &Painter, rect: Rect) {
    let (Some([low, high]), Ok(map)) = (shown.range, ColorMap::named(&app.look.map)) else {
        return;
    };
    if !look::is_mapped(&app.look.color_by) {
        return;
    }
    let bar = Rect::from_min_size(rect.left_bottom() + vec2(18.0, -158.0), vec2(14.0, 120.0));
    let plate = Rect::from_min_max(bar.min - vec2(8.0, 28.0), bar.max + vec2(86.0, 10.0));
    painter.rect_filled(plate, 6.0, Color32::from_black_alpha(120));
    const ROWS: u16 = 60;
    for row in 0..ROWS {
        let share = |row: u16| f32::from(row) / f32::from(ROWS);
        let [r, g, b] = map.color(f64::from(1.0 - share(row)));
        let (top, bottom) = (bar.height() * share(row), bar.height() * share(row + 1));
        let cell = Rect::from_x_y_ranges(bar.x_range(), bar.top() + top..=bar.top() + bottom);
        painter.rect_filled(cell, CornerRadius::ZERO, Color32::from_rgb(r, g, b));
    }
    let font = FontId::proportional(12.0);
    let name = match &app.look.color_by {
        ColorBy::Scalar(name) => name.clone(),
        other => look::name(other),
    };
    let at = bar.left_top() - vec2(0.0, 6.0);
    painter.text(at, Align2::LEFT_BOTTOM, name, font.clone(), theme::TEXT);
    for (share, align) in
        [(0.0, Align2::LEFT_BOTTOM), (0.5, Align2::LEFT_CENTER), (1.0, Align2::LEFT_TOP)]
    {
        let value = low + (high - low) * share;
        // What is left of a difference says nothing.
        let value = number(if value.abs() < 1e-4 * (high - low) { 0.0 } else { value });
        let at = pos2(bar.right() + 8.0, bar.bottom() - bar.height() * rough(share));
        painter.text(at, align, value, font.clone(), theme::TEXT);
    }
}

/// A length at the distance of the target.
fn scale_bar(app: &App, painter: &Painter, rect: Rect, pixels_per_point: f32) {
    let Some(camera) = &app.camera else { return };
    let points = f64::from(rect.height());
    let per_point = camera.height() / points;
    let wanted = 110.0 * per_point;
    let decade = 10_f64.powf(wanted.log10().floor());
    let length = [5.0, 2.0, 1.0].map(|digit| digit * decade);
    let length = length.into_iter().find(|&length| length <= wanted).unwrap_or(decade);
    let width = rough(length / per_point);
    if !width.is_finite() {
        return;
    }
    let right = ((rect.right() - 18.0) * pixels_per_point).round() / pixels_per_point;
    let (left, y) = (right - width, rect.bottom() - 18.0);
    for (grow, stroke) in [
        (1.0, Stroke::new(4.0, Color32::from_black_alpha(140))),
        (0.0, Stroke::new(2.0, Color32::from_gray(230))),
    ] {
        painter.hline(left - grow..=right + grow, y, stroke);
        painter.vline(left, y - 4.0 - grow..=y + 4.0 + grow, stroke);
        painter.vline(right, y - 4.0 - grow..=y + 4.0 + grow, stroke);
    }
    let at = pos2((left + right) * 0.5, y - 7.0);
    let font = FontId::proportional(12.0);
    let text = number(length);
    let shadow = Color32::from_black_alpha(180);
    painter.text(at + vec2(1.0, 1.0), Align2::CENTER_BOTTOM, &text, font.clone(), shadow);
    painter.text(at, Align2::CENTER_BOTTOM, text, font, Color32::from_gray(235));
}

/// A number in four digits.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is between 0 and 6"
        )]
        let digits = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.2e}")
    }
}
