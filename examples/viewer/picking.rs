//! Picking: which particle is seen at a pixel, and what is known of it.

use crate::{camera, drawing::Shown, pointer, theme};
use egui::{Color32, Grid, Painter, Pos2, RichText, Stroke, Ui};
use glam::{DVec2, DVec3};
use puncta::{NO_RECORD, Scene, Sphere, View, io::elements};
use std::sync::Arc;

/// A particle that was picked.
#[derive(Debug)]
pub(crate) struct Pick {
    /// What it is known by.
    id: u32,
    /// Where it lies in the scene.
    index: u32,
    scene: Arc<Scene<Sphere>>,
}

/// The point of the surface that is seen at a pixel of the image.
pub(crate) fn point_at(shown: &Shown, pixel: DVec2) -> Option<DVec3> {
    let (index, pixel) = pointer::place(&shown.picture, shown.factor, pixel)?;
    let depth = f64::from(*shown.picture.depth.get(index)?);
    depth.is_finite().then(|| camera::point_at(&shown.view, pixel, depth))
}

impl Pick {
    /// What is seen at a pixel of the image.
    pub(crate) fn at(shown: &Shown, pixel: DVec2) -> Option<Self> {
        let (place, _) = pointer::place(&shown.picture, shown.factor, pixel)?;
        let index = *shown.picture.id.get(place)?;
        let scene = Arc::clone(&shown.scene);
        (index != NO_RECORD).then(|| Self { id: scene.id(index), index, scene })
    }

    /// Finds the same particle in a scene that was sorted anew.
    pub(crate) fn find_in(&mut self, scene: &Arc<Scene<Sphere>>) {
        let index = match &scene.attributes.ids {
            Some(ids) => ids.iter().position(|&id| id == self.id),
            None => usize::try_from(self.id).ok(),
        };
        if let Some(index) = index.and_then(|index| u32::try_from(index).ok()) {
            (self.index, self.scene) = (index, Arc::clone(scene));
        }
    }

    pub(crate) fn position(&self) -> DVec3 {
        self.scene.position(self.index as usize)
    }

    fn radius(&self) -> f32 {
        self.scene.records[self.index as usize].radius
    }

    /// Marks the particle in the picture: fainter if something hides it.
    pub(crate) fn mark(&self, painter: &Painter, shown: &Shown, place: impl Fn(DVec2) -> Pos2) {
        let Some((pixel, scale)) = camera::pixel_of(&shown.view, self.position()) else { return };
        let factor = f64::from(shown.factor);
        let image = |pixel: DVec2| (pixel + 0.5) / factor - 0.5;
        let center = place(image(pixel));
        let edge = image(pixel + DVec2::X * scale * f64::from(self.radius()));
        let radius = (place(edge).x - center.x).max(3.0) + 2.5;
        let strength = if self.is_seen(&shown.view, shown, (pixel, scale)) { 1.0 } else { 0.4 };
        let shadow = Color32::BLACK.gamma_multiply(0.6 * strength);
        painter.circle_stroke(center, radius, Stroke::new(5.0, shadow));
        painter.circle_stroke(
            center,
            radius,
            Stroke::new(2.0, Color32::WHITE.gamma_multiply(strength)),
        );
    }

    /// Whether a pixel around its centre shows it.
    fn is_seen(&self, view: &View, shown: &Shown, (pixel, scale): (DVec2, f64)) -> bool {
        const ACROSS: i32 = 16;
        let reach = scale * f64::from(self.radius());
        let steps = || (-ACROSS..=ACROSS).map(|step| f64::from(step) / f64::from(ACROSS) * reach);
        let shows = |pixel: DVec2| {
            let [column, row] = [pixel.x.round(), pixel.y.round()];
            let (width, height) = (f64::from(view.width()), f64::from(view.height()));
            if !((0.0..width).contains(&column) && (0.0..height).contains(&row)) {
                return false;
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is inside"
            )]
            let index = row as usize * view.width() as usize + column as usize;
            Arc::ptr_eq(&shown.scene, &self.scene)
                && shown.picture.id.get(index) == Some(&self.index)
        };
        steps().any(|x| steps().any(|y| shows(pixel + DVec2::new(x, y))))
    }

    /// All that is known of it.
    pub(crate) fn describe(&self, ui: &mut Ui) {
        let index = self.index as usize;
        let attributes = &self.scene.attributes;
        Grid::new("particle").num_columns(2).spacing([12.0, 2.0]).min_row_height(16.0).show(
            ui,
            |ui| {
                let mut row = |name: &str, value: String| {
                    ui.label(RichText::new(name).color(theme::FAINT));
                    ui.label(RichText::new(value).monospace());
                    ui.end_row();
                };
                row("id", self.id.to_string());
                if let Some(&number) = attributes.elements.as_ref().and_then(|all| all.get(index)) {
                    let symbol = elements::symbol(number).unwrap_or("unknown");
                    row("element", symbol.to_owned());
                }
                let digits = digits(&self.scene);
                for (axis, value) in ["x", "y", "z"].into_iter().zip(self.position().to_array()) {
                    row(axis, format!("{value:.digits$}"));
                }
                row("radius", format!("{}", self.radius()));
                for scalar in &attributes.scalars {
                    let value = scalar.values.get(index).copied().unwrap_or(f32::NAN);
                    row(&scalar.name, format!("{value}"));
                }
                if let Some(&[r, g, b, _]) =
                    attributes.colors.as_ref().and_then(|all| all.get(index))
                {
                    ui.label(RichText::new("color").color(theme::FAINT));
                    ui.horizontal(|ui| {
                        let text = RichText::new("  \u{2003}")
                            .background_color(Color32::from_rgb(r, g, b));
                        ui.label(text);
                        ui.label(RichText::new(format!("#{r:02x}{g:02x}{b:02x}")).monospace());
                    });
                    ui.end_row();
                }
            },
        );
    }
}

/// How many digits behind the point tell positions apart: they are offsets of 24 bits from an
/// origin.
fn digits(scene: &Scene<Sphere>) -> usize {
    let sample = scene.records.first().map_or(1.0, |sphere| f64::from(sphere.radius));
    let exponent = (4.0 - sample.max(1e-30).log10().floor()).clamp(0.0, 12.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
    let digits = exponent as usize;
    digits
}
