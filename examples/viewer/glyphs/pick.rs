//! Which record is seen at a pixel, and what is known of it.

use super::{Paint, drawing::Shown};
use crate::{
    camera,
    pointer::{self, Placed},
};
use egui::{Color32, Painter, Stroke};
use glam::{DVec2, DVec3};
use puncta::{Glyph, NO_RECORD, Scene};
use std::fmt;

/// A record that was picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pick {
    /// What it is known by.
    id: u32,
    /// Where it lies in the scene.
    index: u32,
    color: [u8; 3],
    /// Where it was met.
    point: DVec3,
}

/// The point of a surface that is seen at a pixel of the image.
pub(crate) fn point_at(shown: &Shown, pixel: DVec2) -> Option<DVec3> {
    let (at, pixel) = pointer::place(&shown.picture, shown.factor, pixel)?;
    let depth = f64::from(*shown.picture.depth.get(at)?);
    depth.is_finite().then(|| camera::point_at(&shown.view, pixel, depth))
}

impl Pick {
    /// What is seen at a pixel of the image.
    pub(crate) fn at<G: Glyph>(
        (scene, paint): (&Scene<G>, &Paint<G>),
        shown: &Shown,
        pixel: DVec2,
    ) -> Option<Self> {
        let (at, _) = pointer::place(&shown.picture, shown.factor, pixel)?;
        let index = *shown.picture.id.get(at).filter(|index| **index != NO_RECORD)?;
        let color = |coloring: puncta::Coloring<'_>| Some(coloring.colors(scene).ok()?.of(index));
        let color = paint.with_coloring(scene, color)?;
        Some(Self { id: scene.id(index), index, color, point: point_at(shown, pixel)? })
    }

    /// Marks where it was met.
    pub(crate) fn mark(&self, painter: &Painter, shown: &Shown, frame: Placed) {
        let Some((pixel, _)) = camera::pixel_of(&shown.view, self.point) else { return };
        let center = frame.point((pixel + 0.5) / f64::from(shown.factor) - 0.5);
        let [r, g, b] = self.color;
        painter.circle_filled(center, 6.0, Color32::BLACK);
        painter.circle_filled(center, 5.0, Color32::WHITE);
        painter.circle_filled(center, 3.5, Color32::from_rgb(r, g, b));
        painter.circle_stroke(center, 3.5, Stroke::new(1.0, Color32::BLACK));
    }
}

impl fmt::Display for Pick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, index, color: [r, g, b], .. } = self;
        write!(f, "record {id} (index {index}) #{r:02x}{g:02x}{b:02x}")
    }
}
