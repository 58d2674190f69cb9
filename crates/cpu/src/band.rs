//! Bands: runs of rows of a picture, each drawn by one thread.

use crate::{
    disc::{Disc, LANES, Target},
    shape::Brush,
    tiles::Tiles,
};
use glam::DVec3;
use puncta_avc::Level;
use puncta_core::{Amount, Camera, ScreenBound, ScreenBox, depth_below, nearest_depth};
use std::{
    ops::{Range, RangeInclusive},
    sync::atomic::{AtomicBool, Ordering},
};

/// Some records of a brick, to be drawn together.
#[derive(Debug)]
pub(crate) struct Piece<'a> {
    pub(crate) bound: ScreenBound,
    /// How finely its records are drawn.
    pub(crate) level: Level,
    pub(crate) members: Members<'a>,
    /// Whether a band had to draw it, because it was not hidden.
    pub(crate) is_drawn: AtomicBool,
}

impl Piece<'_> {
    /// The amount that was drawn.
    pub(crate) fn drawn(&self) -> Amount {
        let records = match &self.members {
            Members::All(range) => range.len(),
            Members::Some(ids) => ids.len(),
        };
        let is_drawn = u64::from(self.is_drawn.load(Ordering::Relaxed));
        Amount { bricks: is_drawn, records: is_drawn * records as u64 }
    }
}

/// Which records.
#[derive(Clone, Debug)]
pub(crate) enum Members<'a> {
    All(Range<u32>),
    Some(&'a [u32]),
}

/// Some rows of a picture. A row has `stride` pixels, of which the last ones are not seen: so eight
/// pixels can always be drawn at once.
#[derive(Debug)]
pub(crate) struct Band<'a> {
    pub(crate) camera: &'a Camera,
    /// The original ids of the records: of two at equal depth the lower one is shown.
    pub(crate) ids: Option<&'a [u32]>,
    pub(crate) first_row: i64,
    pub(crate) stride: usize,
    pub(crate) depth: &'a mut [f32],
    pub(crate) id: &'a mut [u32],
    pub(crate) tiles: Tiles<'a>,
}

/// The first and last of some pixels, which are in the picture.
#[inline]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "they are in range")]
fn ends(range: &RangeInclusive<i64>) -> [usize; 2] {
    [*range.start() as usize, *range.end() as usize]
}

/// The largest side, in pixels, of a sphere that is looked at by tiles before it is set up.
const GLANCE: usize = 64;

/// A sphere in camera coordinates.
#[derive(Clone, Copy, Debug)]
struct Ball {
    center: DVec3,
    radius: f64,
    /// A view depth in front of which the sphere has no point.
    nearest: f64,
    id: u32,
}

/// The places of the bits that are set.
fn bits(mut mask: u32) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let place = (mask != 0).then(|| mask.trailing_zeros())?;
        mask &= mask - 1;
        Some(place)
    })
}

impl Band<'_> {
    /// Draws these pieces, as far as they lie in this band and can be seen.
    pub(crate) fn draw(&mut self, brush: &mut impl Brush, pieces: &[Piece<'_>]) {
        let (first, last) = (self.first_row, self.last_row());
        for piece in pieces {
            let rows = piece.bound.rows.map(i64::from);
            if rows[0] > last || rows[1] < first || self.tiles.hides(&piece.bound, self.depth) {
                continue;
            }
            piece.is_drawn.store(true, Ordering::Relaxed);
            let level = piece.level;
            match &piece.members {
                Members::All(range) => {
                    range.clone().for_each(|id| brush.draw(self, id, level));
                }
                Members::Some(ids) => ids.iter().for_each(|&id| brush.draw(self, id, level)),
            }
        }
    }

    /// Draws a sphere around a stored position.
    #[inline]
    pub(crate) fn draw_sphere(&mut self, position: DVec3, radius: f64, id: u32) {
        let center = self.camera.place(position);
        if self.is_hidden(center, radius) {
            return;
        }
        let nearest = nearest_depth(center.z, radius);
        let Some(mut screen) = self.camera.screen_box(center, radius) else {
            return;
        };
        let first = (*screen.rows.start()).max(self.first_row);
        let last = (*screen.rows.end()).min(self.last_row());
        screen.rows = first..=last;
        if first > last || screen.columns.is_empty() {
            return;
        }
        self.tiles.touch(ends(&screen.columns), ends(&screen.rows));
        let ball = Ball { center, radius, nearest, id };
        match Disc::new(self.camera, center, radius) {
            Some(disc) => self.draw_disc(&disc, &ball, &screen),
            None => self.draw_exact(&ball, &screen),
        }
    }

    /// Whether a ball lies outside of this band or behind what is there, at a glance.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    pub(crate) fn is_hidden(&mut self, center: DVec3, radius: f64) -> bool {
        // It may be negative where no grid has looked at it.
        if radius < 0.0 {
            return true;
        }
        let Some([columns, rows]) = self.camera.outline(center, radius) else {
            return false;
        };
        let last = [f64::from(self.camera.size()[0] - 1), self.last_row() as f64];
        let first_row = self.first_row as f64;
        // Written so that NaN is not hidden here.
        if columns[1] < 0.0 || columns[0] > last[0] || rows[1] < first_row || rows[0] > last[1] {
            return true;
        }
        let columns = [columns[0] as usize, columns[1].min(last[0]) as usize];
        let rows = [rows[0].max(first_row) as usize, rows[1].min(last[1]) as usize];
        let is_small = columns[1] - columns[0] <= GLANCE && rows[1] - rows[0] <= GLANCE;
        let nearest = depth_below(nearest_depth(center.z, radius));
        is_small && self.tiles.hide_around(columns, rows, (nearest, self.depth))
    }

    /// Draws a small sphere, eight pixels at a time.
    fn draw_disc(&mut self, disc: &Disc, ball: &Ball, screen: &ScreenBox) {
        for row in screen.rows.clone() {
            let row_of_disc = disc.row(self.camera, row as f64);
            for column in screen.columns.clone().step_by(LANES) {
                let camera = self.camera;
                let Some(mut target) = self.target(row, column, ball.id) else {
                    return;
                };
                let left = disc.draw(camera, row_of_disc, column as f64, &mut target);
                for lane in bits(left.ties) {
                    self.break_tie((row, column + i64::from(lane)), ball.id);
                }
                for lane in bits(left.doubts) {
                    self.draw_pixel(ball, (row, column + i64::from(lane)));
                }
            }
        }
    }

    /// Draws any sphere, pixel by pixel in `f64`.
    fn draw_exact(&mut self, ball: &Ball, screen: &ScreenBox) {
        for row in screen.rows.clone() {
            for column in screen.columns.clone() {
                self.draw_pixel(ball, (row, column));
            }
        }
    }

    /// Draws one pixel of a sphere in `f64`.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn draw_pixel(&mut self, ball: &Ball, (row, column): (i64, i64)) {
        let pixel = self.pixel(row, column);
        let old = self.depth[pixel];
        if f64::from(old) < ball.nearest {
            return;
        }
        let ray = self.camera.ray(column as f64, row as f64);
        if let Some(depth) = self.camera.depth(ray, ball.center, ball.radius) {
            let depth = depth as f32;
            if depth < old {
                self.depth[pixel] = depth;
                self.id[pixel] = ball.id;
            } else if depth == old && depth.is_finite() {
                self.break_tie((row, column), ball.id);
            }
        }
    }

    /// Decides between what is seen at a pixel and a record of equal depth.
    pub(crate) fn break_tie(&mut self, (row, column): (i64, i64), id: u32) {
        let pixel = self.pixel(row, column);
        let original =
            |id: u32| self.ids.and_then(|ids| ids.get(id as usize)).copied().unwrap_or(id);
        if original(id) < original(self.id[pixel]) {
            self.id[pixel] = id;
        }
    }

    /// Eight pixels of this band.
    #[inline]
    pub(crate) fn target(&mut self, row: i64, column: i64, new_id: u32) -> Option<Target<'_>> {
        let pixel = self.pixel(row, column);
        let depth = self.depth.get_mut(pixel..)?.first_chunk_mut()?;
        let id = self.id.get_mut(pixel..)?.first_chunk_mut()?;
        Some(Target { depth, id, new_id })
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "both are inside")]
    pub(crate) fn pixel(&self, row: i64, column: i64) -> usize {
        (row - self.first_row) as usize * self.stride + column as usize
    }

    /// Whether all pixels of the tiles around these, which lie in this band, are nearer than a depth.
    #[inline]
    pub(crate) fn hides(&mut self, columns: [i64; 2], rows: [i64; 2], nearest: f32) -> bool {
        let ends = |[first, last]: [i64; 2]| ends(&(first..=last));
        self.tiles.hide_around(ends(columns), ends(rows), (nearest, self.depth))
    }

    /// Notes that something was drawn into these columns of a row.
    #[inline]
    pub(crate) fn touch(&mut self, columns: [i64; 2], row: i64) {
        let [first, last] = columns;
        self.tiles.touch(ends(&(first..=last)), ends(&(row..=row)));
    }

    pub(crate) fn last_row(&self) -> i64 {
        self.first_row + (self.depth.len() / self.stride) as i64 - 1
    }
}
