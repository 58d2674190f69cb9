//! What stands around the picture: choices and numbers beside it, the state of things below.

use crate::{
    app::App, cli::Order, look, options::BackendKind, options::ColorBy, progress, theme, viewport,
};
use egui::{
    Align, ComboBox, Grid, Layout, Margin, ProgressBar, Rect, RichText, ScrollArea, Slider,
    TextEdit, Ui, UiBuilder,
};
use puncta::{ColorMap, Projection};
use std::time::Duration;

/// The width of the panel beside the picture, and the height of the line below it, in points.
const PANEL_WIDTH: f32 = 272.0;
pub(crate) const STATE_HEIGHT: f32 = 32.0;

/// What the pointer and the keys do.
const HELP: [(&str, &str); 11] = [
    ("left drag", "turn"),
    ("right drag, shift", "move"),
    ("ctrl drag", "look around"),
    ("wheel", "zoom to the pointer"),
    ("W A S D Q E", "fly, shift is faster"),
    ("click", "pick a particle"),
    ("double click, F", "center it"),
    ("Home, R", "see everything"),
    ("P", "write the picture"),
    ("H", "hide this panel"),
    ("Esc", "forget the particle"),
];

impl App {
    /// The whole window.
    pub(crate) fn show(&mut self, ui: &mut Ui) {
        // The places are reckoned here and not found by what is in them: each change of the
        // picture's size is a picture to draw.
        let whole = ui.max_rect();
        let (above, state) = whole.split_top_bottom_at_y(whole.bottom() - STATE_HEIGHT);
        let side = if self.has_panel { above.right() - PANEL_WIDTH } else { above.right() };
        let (picture, panel) = above.split_left_right_at_x(side.max(above.left()));
        within(ui, picture, Margin::ZERO, |ui| viewport::show(self, ui));
        within(ui, state, Margin::symmetric(12, 3), |ui| self.show_state(ui));
        if self.has_panel {
            within(ui, panel, Margin::same(12), |ui| {
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.show_panel(ui));
            });
        }
        self.show_error(ui);
        if let Some(delay) = self.ask() {
            ui.ctx().request_repaint_after(delay);
        }
        if progress::now().is_some() {
            ui.ctx().request_repaint_after(Duration::from_millis(80));
        }
    }

    fn show_panel(&mut self, ui: &mut Ui) {
        self.show_source(ui);
        section(ui, "Color", |ui| self.show_color(ui));
        section(ui, "Draw", |ui| self.show_draw(ui));
        section(ui, "Speed", |ui| {
            self.history.show(ui);
            self.show_counts(ui);
        });
        ui.add_space(8.0);
        ui.collapsing("Mouse and keys", |ui| {
            Grid::new("help").num_columns(2).spacing([12.0, 1.0]).min_row_height(14.0).show(
                ui,
                |ui| {
                    for (key, what) in HELP {
                        ui.label(RichText::new(key).small());
                        ui.label(RichText::new(what).small().color(theme::FAINT));
                        ui.end_row();
                    }
                },
            );
        });
    }

    fn show_source(&mut self, ui: &mut Ui) {
        let mut is_entered = false;
        ui.horizontal(|ui| {
            let edit = TextEdit::singleline(&mut self.name)
                .hint_text("a file, or cube:n=1000000")
                .desired_width(ui.available_width() - 60.0);
            let entry = ui.add(edit);
            is_entered =
                entry.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            is_entered |= ui.button("Open").clicked();
        });
        if is_entered {
            let name = self.name.clone();
            self.open(name.trim());
        }
        if let Some(content) = &self.content {
            let count = grouped(content.scene.records.len() as u64);
            let text = format!("{count} particles, {}", content.format);
            let label = ui.label(RichText::new(text).color(theme::FAINT));
            if !content.notices.is_empty() {
                label.on_hover_text(content.notices.join("\n"));
            }
        }
    }

    fn show_color(&mut self, ui: &mut Ui) {
        let Some(content) = self.content.clone() else { return };
        let mut chosen = None;
        row(ui, "by", |ui| {
            let now = look::name(&self.look.color_by);
            ComboBox::from_id_salt("color by").selected_text(&now).show_ui(ui, |ui| {
                for choice in &content.palette.choices {
                    let name = look::name(choice);
                    if ui.selectable_label(name == now, name).clicked() {
                        chosen = Some(choice.clone());
                    }
                }
            });
        });
        if let Some(choice) = chosen {
            self.color_by(choice);
        }
        let mut is_changed = false;
        if look::is_mapped(&self.look.color_by) {
            row(ui, "map", |ui| {
                ComboBox::from_id_salt("map").selected_text(&self.look.map).show_ui(ui, |ui| {
                    for name in ColorMap::names() {
                        let option = ui.selectable_value(&mut self.look.map, name.to_owned(), name);
                        is_changed |= option.changed();
                    }
                });
            });
            let shown = self.shown.as_ref().and_then(|shown| shown.range);
            if let Some(mut range) = self.look.range.or(shown) {
                let speed = ((range[1] - range[0]).abs() * 0.005).max(1e-9);
                let mut is_dragged = false;
                row(ui, "range", |ui| {
                    for end in &mut range {
                        let value = egui::DragValue::new(end).speed(speed).max_decimals(4);
                        is_dragged |= ui.add(value).changed();
                    }
                    if self.look.range.is_some() && ui.small_button("auto").clicked() {
                        self.look.range = None;
                        is_changed = true;
                    }
                });
                if is_dragged && range[0] < range[1] {
                    self.look.range = Some(range);
                    is_changed = true;
                }
            }
        } else if matches!(self.look.color_by, ColorBy::Uniform) {
            row(ui, "color", |ui| {
                is_changed |= ui.color_edit_button_srgb(&mut self.look.uniform).changed();
            });
        }
        if is_changed {
            self.set_look();
        }
    }

    fn show_draw(&mut self, ui: &mut Ui) {
        let mut backend = self.backend;
        row(ui, "with", |ui| {
            ui.selectable_value(&mut backend, BackendKind::Gpu, "GPU");
            ui.selectable_value(&mut backend, BackendKind::Cpu, "CPU");
        });
        if backend != self.backend {
            self.start(backend);
        }
        if let Some(engine) = &self.engine {
            ui.label(RichText::new(&engine.name).small().color(theme::FAINT));
        }
        let before = self.order;
        row(ui, "order", |ui| {
            ComboBox::from_id_salt("order").selected_text(self.order.name()).show_ui(ui, |ui| {
                for order in Order::ALL {
                    ui.selectable_value(&mut self.order, order, order.name());
                }
            });
        });
        if before != self.order {
            self.set_order();
        }
        let is_fixed = self.content.as_ref().is_some_and(|content| content.is_fixed);
        row(ui, "radius", |ui| {
            let slider = Slider::new(&mut self.radius_scale, 0.05..=8.0)
                .logarithmic(true)
                .max_decimals(2)
                .suffix("×");
            ui.spacing_mut().slider_width = 96.0;
            let slider = ui.add_enabled(!is_fixed, slider);
            slider.on_disabled_hover_text("the radii of a brick file are chosen when it is made");
        });
        self.scale();
        self.show_projection(ui);
        row(ui, "", |ui| {
            ui.checkbox(&mut self.is_smooth, "smooth edges at rest");
        });
        row(ui, "", |ui| {
            if ui.button("See all").clicked() {
                self.go_home();
            }
            if ui.button("Screenshot").clicked() {
                self.save();
            }
        });
    }

    fn show_projection(&mut self, ui: &mut Ui) {
        let Some(camera) = &mut self.camera else { return };
        let mut is_perspective = camera.view().is_perspective();
        let before = is_perspective;
        row(ui, "rays", |ui| {
            ui.selectable_value(&mut is_perspective, true, "perspective");
            ui.selectable_value(&mut is_perspective, false, "parallel");
        });
        if before != is_perspective {
            let height = camera.height();
            camera.project(if is_perspective {
                Projection::Perspective { fov_y: 2.0 * (height * 0.5 / camera.distance()).atan() }
            } else {
                Projection::Orthographic { height }
            });
        }
    }

    fn show_counts(&self, ui: &mut Ui) {
        let progress = self.progress;
        Grid::new("counts").num_columns(2).spacing([12.0, 1.0]).min_row_height(14.0).show(
            ui,
            |ui| {
                for (name, count) in [
                    ("drawn", progress.drawn.records),
                    ("hidden, skipped", progress.skipped.records),
                    ("out of view", progress.culled.records),
                    ("seen before", progress.recalled),
                ] {
                    ui.label(RichText::new(name).small().color(theme::FAINT));
                    ui.label(RichText::new(grouped(count)).small().monospace());
                    ui.end_row();
                }
            },
        );
    }

    /// The line at the bottom.
    fn show_state(&self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let (share, text, color) = self.state();
            let bar = ProgressBar::new(share).desired_width(150.0).desired_height(8.0).fill(color);
            ui.add(bar);
            ui.label(RichText::new(text).color(theme::TEXT));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if let Some(shown) = &self.shown {
                    let size = format!("{} × {}", shown.image.width, shown.image.height);
                    ui.label(RichText::new(size).color(theme::FAINT));
                }
                let notice = RichText::new(&self.notice).color(theme::FAINT);
                ui.add(egui::Label::new(notice).truncate()).on_hover_text(&self.notice);
            });
        });
    }

    /// How far what is going on is, and what it is.
    fn state(&self) -> (f32, String, egui::Color32) {
        if let Some((what, share)) = progress::now() {
            let text =
                share.map_or(what.to_owned(), |share| format!("{what} {:.0} %", share * 100.0));
            return (share.unwrap_or(0.5), text, theme::WARM);
        }
        if self.error.is_some() && self.shown.is_none() {
            return (0.0, "nothing to show".to_owned(), theme::BAD);
        }
        let open = self.progress.open;
        if self.shown.is_none() {
            (0.0, "drawing".to_owned(), theme::ACCENT)
        } else if open == 0 {
            (1.0, "settled".to_owned(), theme::GOOD)
        } else {
            let share = 1.0 - open as f32 / self.history.pixels.max(1) as f32;
            (share, format!("{} pixels open", grouped(open)), theme::ACCENT)
        }
    }

    fn show_error(&mut self, ui: &mut Ui) {
        let Some(error) = self.error.clone() else { return };
        let mut is_read = false;
        egui::Window::new(RichText::new("That did not work").color(theme::BAD))
            .anchor(egui::Align2::CENTER_CENTER, egui::vec2(-100.0, 0.0))
            .collapsible(false)
            .resizable(false)
            .show(ui.ctx(), |ui| {
                ui.set_max_width(460.0);
                ui.label(error);
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    is_read = ui.button("Close").clicked();
                    if self.backend == BackendKind::Gpu
                        && self.engine.is_some()
                        && ui.button("Draw on the CPU").clicked()
                    {
                        is_read = true;
                        self.start(BackendKind::Cpu);
                    }
                });
            });
        if is_read {
            self.error = None;
        }
    }
}

/// Shows something in a part of the window, and nothing beyond it.
pub(crate) fn within(ui: &mut Ui, rect: Rect, margin: Margin, content: impl FnOnce(&mut Ui)) {
    ui.painter().rect_filled(rect, 0.0, theme::PANEL);
    ui.scope_builder(UiBuilder::new().max_rect(rect - margin), |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        content(ui);
    });
}

fn section(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    ui.add_space(3.0);
    ui.separator();
    ui.label(RichText::new(title).strong().color(theme::ACCENT));
    content(ui);
}

/// A name, and what can be chosen.
fn row(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        let size = egui::vec2(44.0, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_size(size);
            ui.label(RichText::new(name).color(theme::FAINT));
        });
        content(ui);
    });
}

/// A count with commas between thousands.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
