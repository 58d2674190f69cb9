//! The pointer: where an image lies in the window, and what drags and wheels do to a camera.

use crate::{
    camera::{Camera, Pivot},
    theme::rough,
};
use egui::{Color32, Painter, PointerButton, Pos2, Rect, Response, TextureId, pos2, vec2};
use glam::{DVec2, DVec3};
use puncta::Picture;
use std::time::{Duration, Instant};

/// Radians that a drag of one point turns by.
const TURN: f64 = 0.006;

/// How much a point of scrolling zooms by; a notch of a wheel is 40 to 50 of them.
const ZOOM: f64 = 0.003;

/// How long a zoom goes on towards the same point.
const SAME_ZOOM: Duration = Duration::from_millis(400);

/// Where an image lies in the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    rect: Rect,
    /// Pixels of the image in a point of the window.
    scale: f64,
}

impl Placed {
    /// The pixel of the image at a point of the window; the centre of a pixel has whole
    /// coordinates.
    pub(crate) fn pixel(self, at: Pos2) -> DVec2 {
        let offset = at - self.rect.min;
        DVec2::new(f64::from(offset.x), f64::from(offset.y)) * self.scale - 0.5
    }

    pub(crate) fn point(self, pixel: DVec2) -> Pos2 {
        let offset = (pixel + 0.5) / self.scale;
        self.rect.min + vec2(rough(offset.x), rough(offset.y))
    }
}

/// Columns and rows of what fills a part of the window.
pub(crate) fn pixels(rect: Rect, pixels_per_point: f32) -> (u32, u32) {
    let side = |side: f32| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "windows have that many pixels"
        )]
        let pixels = (side * pixels_per_point).round().max(1.0) as u32;
        pixels
    };
    (side(rect.width()), side(rect.height()))
}

/// Paints an image of this many columns and rows; one of another size keeps its middle and fills the
/// height.
pub(crate) fn paint(
    painter: &Painter,
    rect: Rect,
    (texture, (width, height)): (TextureId, (u32, u32)),
) -> Placed {
    let (width, height) = (width as f32, height as f32);
    let pixels = painter.ctx().pixels_per_point();
    let fits = (rect.height() * pixels - height).abs() < 1.0;
    let scale = if fits { pixels } else { height / rect.height() };
    let size = vec2(width, height) / scale;
    let min = if fits && (rect.width() - size.x).abs() < 1.0 {
        rect.min
    } else {
        rect.center() - size * 0.5
    };
    let placed = Rect::from_min_size(min, size);
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(texture, placed, whole, Color32::WHITE);
    Placed { rect: placed, scale: f64::from(scale) }
}

/// Where the pixel of a picture lies that is seen at a pixel of an image: its index, column and row.
/// `factor` of its pixels make one of the image, along each side.
pub(crate) fn place(picture: &Picture, factor: u32, pixel: DVec2) -> Option<(usize, DVec2)> {
    let fine = (pixel + 0.5) * f64::from(factor) - 0.5;
    let [column, row] = [fine.x.round(), fine.y.round()];
    let is_inside = (0.0..f64::from(picture.width)).contains(&column)
        && (0.0..f64::from(picture.height)).contains(&row);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is inside")]
    let index = || row as usize * picture.width as usize + column as usize;
    is_inside.then(|| (index(), DVec2::new(column, row)))
}

/// Where the last zoom went, and when.
#[derive(Debug, Default)]
pub(crate) struct Anchor(Option<(Pos2, DVec3, Instant)>);

impl Anchor {
    /// Turns, moves and zooms as the pointer says. `seen` is the point that is seen at a pixel of the
    /// image.
    pub(crate) fn steer(
        &mut self,
        camera: &mut Camera,
        response: &Response,
        frame: Option<Placed>,
        seen: impl Fn(DVec2) -> Option<DVec3>,
    ) {
        let ctx = &response.ctx;
        let (modifiers, scroll, pinch) =
            ctx.input(|input| (input.modifiers, input.smooth_scroll_delta(), input.zoom_delta()));
        let drag = response.drag_delta();
        let drag = DVec2::new(f64::from(drag.x), f64::from(drag.y));
        if response.dragged_by(PointerButton::Primary) && !modifiers.shift {
            let pivot = if modifiers.command { Pivot::Eye } else { Pivot::Target };
            camera.turn(pivot, drag.x * TURN, -drag.y * TURN);
        } else if response.dragged() {
            camera.pan(drag * f64::from(ctx.pixels_per_point()));
        }
        let Some((at, frame)) = response.hover_pos().zip(frame) else { return };
        let pixel = frame.pixel(at);
        let zoom = f64::from(scroll.y) * ZOOM + f64::from(pinch).ln();
        if zoom == 0.0 {
            return;
        }
        // The picture lags behind: what was below the pointer when the zoom began is what is meant.
        let is_same = |(before, _, since): &(Pos2, DVec3, Instant)| {
            before.distance(at) < 2.0 && since.elapsed() < SAME_ZOOM
        };
        let point = match self.0.filter(is_same) {
            Some((_, point, _)) => point,
            None => seen(pixel).unwrap_or_else(|| camera.point_at(pixel, None)),
        };
        self.0 = Some((at, point, Instant::now()));
        camera.zoom((-zoom).exp(), point);
    }
}
