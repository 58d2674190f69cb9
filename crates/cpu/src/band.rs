//! Bands: runs of rows of a picture, each drawn by one thread.

use crate::{
    camera::{Camera, ScreenBox},
    disc::{Disc, LANES, Target},
};
use glam::DVec3;
use puncta_core::{Batch, Record, Scene, VisibleBrick};
use std::ops::RangeInclusive;

/// Some rows of a picture. A row has `stride` pixels, of which the last ones are not seen: so eight
/// pixels can always be drawn at once.
#[derive(Debug)]
pub(crate) struct Band<'a> {
    pub(crate) first_row: i64,
    pub(crate) stride: usize,
    pub(crate) depth: &'a mut [f32],
    pub(crate) id: &'a mut [u32],
}

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

/// The number of pixels of a row in memory.
pub(crate) fn stride(width: u32) -> usize {
    (width as usize).next_multiple_of(LANES) + LANES
}

impl Band<'_> {
    /// Draws the records of these bricks, as far as they lie in this band.
    pub(crate) fn draw<R: Record>(
        &mut self,
        camera: &Camera,
        batch: &Batch<'_, R>,
        rows_of_bricks: &[RangeInclusive<i64>],
    ) {
        for (VisibleBrick { index, .. }, rows) in batch.visible.iter().zip(rows_of_bricks) {
            if *rows.start() > self.last_row() || *rows.end() < self.first_row {
                continue;
            }
            let records = batch.bricks[*index as usize].records.clone();
            let members = &batch.scene.records[records.start as usize..records.end as usize];
            for (id, record) in records.zip(members) {
                self.draw_sphere(camera, batch.scene, record, id);
            }
        }
    }

    fn draw_sphere<R: Record>(&mut self, camera: &Camera, scene: &Scene<R>, record: &R, id: u32) {
        let center = camera.place(record.position().as_dvec3());
        let radius = f64::from(record.radius());
        let Some(mut screen) = camera.screen_box(center, radius) else {
            return;
        };
        let first = (*screen.rows.start()).max(self.first_row);
        let last = (*screen.rows.end()).min(self.last_row());
        screen.rows = first..=last;
        if first > last || screen.columns.is_empty() {
            return;
        }
        let nearest = center.z - radius - 1e-6 * (center.z.abs() + radius);
        let ball = Ball { center, radius, nearest, id };
        // Of two records at equal depth the one with the lower original id is shown.
        let wins = |id: u32, other: u32| scene.id(id) < scene.id(other);
        match Disc::new(camera, center, radius) {
            Some(disc) => self.draw_disc(camera, &disc, &ball, &screen, wins),
            None => self.draw_exact(camera, &ball, &screen, wins),
        }
    }

    /// Draws a small sphere, eight pixels at a time.
    fn draw_disc(
        &mut self,
        camera: &Camera,
        disc: &Disc,
        ball: &Ball,
        screen: &ScreenBox,
        wins: impl Fn(u32, u32) -> bool,
    ) {
        for row in screen.rows.clone() {
            let row_of_disc = disc.row(camera, row as f64);
            for column in screen.columns.clone().step_by(LANES) {
                let Some(mut target) = self.target(row, column) else {
                    return;
                };
                let left = disc.draw(camera, row_of_disc, column as f64, &mut target, ball.id);
                for lane in bits(left.ties) {
                    if wins(ball.id, target.id[lane as usize]) {
                        target.id[lane as usize] = ball.id;
                    }
                }
                for lane in bits(left.doubts) {
                    self.draw_pixel(camera, ball, (row, column + i64::from(lane)), &wins);
                }
            }
        }
    }

    /// Draws any sphere, pixel by pixel in `f64`.
    fn draw_exact(
        &mut self,
        camera: &Camera,
        ball: &Ball,
        screen: &ScreenBox,
        wins: impl Fn(u32, u32) -> bool,
    ) {
        for row in screen.rows.clone() {
            for column in screen.columns.clone() {
                self.draw_pixel(camera, ball, (row, column), &wins);
            }
        }
    }

    /// Draws one pixel of a sphere in `f64`.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn draw_pixel(
        &mut self,
        camera: &Camera,
        ball: &Ball,
        (row, column): (i64, i64),
        wins: impl Fn(u32, u32) -> bool,
    ) {
        let pixel = self.pixel(row, column);
        let (old, old_id) = (self.depth[pixel], self.id[pixel]);
        if f64::from(old) < ball.nearest {
            return;
        }
        let ray = camera.ray(column as f64, row as f64);
        if let Some(depth) = camera.depth(ray, ball.center, ball.radius) {
            let depth = depth as f32;
            if depth < old || depth == old && wins(ball.id, old_id) {
                self.depth[pixel] = depth;
                self.id[pixel] = ball.id;
            }
        }
    }

    /// Eight pixels of this band.
    #[inline]
    fn target(&mut self, row: i64, column: i64) -> Option<Target<'_>> {
        let pixel = self.pixel(row, column);
        let depth = self.depth.get_mut(pixel..)?.first_chunk_mut()?;
        let id = self.id.get_mut(pixel..)?.first_chunk_mut()?;
        Some(Target { depth, id })
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "both are inside")]
    fn pixel(&self, row: i64, column: i64) -> usize {
        (row - self.first_row) as usize * self.stride + column as usize
    }

    fn last_row(&self) -> i64 {
        self.first_row + (self.depth.len() / self.stride) as i64 - 1
    }
}
