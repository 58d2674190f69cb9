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
        // Of two records at equal depth the one with the lower original id is shown.
        let wins = |id: u32, other: u32| scene.id(id) < scene.id(other);
        match Disc::new(camera, center, radius) {
            Some(disc) => self.draw_disc(camera, &disc, &screen, id, wins),
            None => self.draw_exact(camera, (center, radius), &screen, id, wins),
        }
    }

    /// Draws a small sphere, eight pixels at a time.
    fn draw_disc(
        &mut self,
        camera: &Camera,
        disc: &Disc,
        screen: &ScreenBox,
        id: u32,
        wins: impl Fn(u32, u32) -> bool,
    ) {
        for row in screen.rows.clone() {
            let row_of_disc = disc.row(camera, row as f64);
            for column in screen.columns.clone().step_by(LANES) {
                let Some(mut target) = self.target(row, column) else {
                    return;
                };
                let mut ties = disc.draw(camera, row_of_disc, column as f64, &mut target, id);
                while ties != 0 {
                    let lane = ties.trailing_zeros() as usize;
                    if wins(id, target.id[lane]) {
                        target.id[lane] = id;
                    }
                    ties &= ties - 1;
                }
            }
        }
    }

    /// Draws any sphere, pixel by pixel in `f64`.
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn draw_exact(
        &mut self,
        camera: &Camera,
        (center, radius): (DVec3, f64),
        screen: &ScreenBox,
        id: u32,
        wins: impl Fn(u32, u32) -> bool,
    ) {
        let nearest = ((center.z - radius) * (1.0 - 1e-6)) as f32;
        for row in screen.rows.clone() {
            for column in screen.columns.clone() {
                let pixel = self.pixel(row, column);
                if self.depth[pixel] < nearest {
                    continue;
                }
                let ray = camera.ray(column as f64, row as f64);
                let Some(depth) = camera.depth(ray, center, radius) else {
                    continue;
                };
                let depth = depth as f32;
                let old = self.depth[pixel];
                if depth < old || depth == old && wins(id, self.id[pixel]) {
                    self.depth[pixel] = depth;
                    self.id[pixel] = id;
                }
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
