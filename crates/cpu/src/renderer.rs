//! The renderer: bands of rows, drawn in parallel.

use crate::{
    Error,
    band::{Band, stride},
    camera::Camera,
};
use puncta_core::{Amount, Content, NO_RECORD, Picture, Record, Renderer, View, VisibleBrick};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// The number of bands for each thread: some of them show more than others.
const BANDS_PER_THREAD: usize = 4;

/// The smallest number of rows of a band: a sphere is set up once for each band that it lies in.
const BAND_ROWS_MIN: usize = 32;

/// Draws spheres exactly, on all cores of the present rayon pool.
///
/// At each pixel the picture shows the nearest point where its ray enters a sphere, at a view depth
/// of at least [`View::near`]; of equal depths the one with the lower [`puncta_core::Scene::id`]. So
/// a sphere that holds the camera is not drawn, and what the near plane cuts open is hollow. A sphere
/// that covers no pixel's centre is not seen, nor is a view depth beyond what `f32` holds.
///
/// Against exact arithmetic, a silhouette is off by at most 1e-4 of a pixel and a view depth by at
/// most 2⁻²² of itself. Set-up is in `f64`, from offsets relative to the eye; so neither a narrow
/// angle nor the distance of the scene from the world's origin changes that. Only the last digits of
/// `f64` set a limit: a sphere whose surface is nearer to the eye than 1e-8 of its radius.
///
/// # Examples
///
/// See the [crate's page](crate).
#[derive(Clone, Debug, Default)]
pub struct CpuRenderer {
    frame: Option<Drawing>,
}

/// A picture that is being drawn.
#[derive(Clone, Debug)]
struct Drawing {
    view: View,
    depth: Vec<f32>,
    id: Vec<u32>,
}

impl<R: Record> Renderer<R> for CpuRenderer {
    type Error = Error;

    fn begin(&mut self, view: &View) -> Result<(), Error> {
        let pixels = stride(view.width()) * view.height() as usize;
        let mut drawing = self.frame.take().map_or_else(
            || Drawing { view: view.clone(), depth: Vec::new(), id: Vec::new() },
            |old| Drawing { view: view.clone(), ..old },
        );
        drawing.depth.clear();
        drawing.depth.resize(pixels, f32::INFINITY);
        drawing.id.clear();
        drawing.id.resize(pixels, NO_RECORD);
        self.frame = Some(drawing);
        Ok(())
    }

    fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
        let drawing = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
        content.validate(bricks)?;
        let camera = &Camera::new(&drawing.view, content.scene.origin);
        let originals = content.scene.attributes.ids.as_deref();
        let rows_of_bricks = rows_of_bricks(camera, content, bricks);
        let stride = stride(drawing.view.width());
        let bands = rayon::current_num_threads() * BANDS_PER_THREAD;
        let rows = (drawing.view.height() as usize).div_ceil(bands).max(BAND_ROWS_MIN);
        let depths = drawing.depth.par_chunks_mut(stride * rows);
        let ids = drawing.id.par_chunks_mut(stride * rows);
        depths.zip(ids).enumerate().with_max_len(1).for_each(|(band, (depth, id))| {
            let first_row = (band * rows) as i64;
            Band { camera, ids: originals, first_row, stride, depth, id }.draw(
                content,
                bricks,
                &rows_of_bricks,
            );
        });
        Ok(Amount::of(content.bricks, bricks))
    }

    fn finish(&mut self) -> Result<Picture, Error> {
        let drawing = self.frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
        let mut picture = Picture::new(drawing.view.width(), drawing.view.height())?;
        let (width, stride) = (picture.width as usize, stride(picture.width));
        let seen = |row: usize| row * stride..row * stride + width;
        for (row, (depth, id)) in
            picture.depth.chunks_mut(width).zip(picture.id.chunks_mut(width)).enumerate()
        {
            depth.copy_from_slice(&drawing.depth[seen(row)]);
            id.copy_from_slice(&drawing.id[seen(row)]);
        }
        Ok(picture)
    }
}

/// The rows that each brick of the batch may cover.
fn rows_of_bricks<R>(
    camera: &Camera,
    content: &Content<'_, R>,
    bricks: &[VisibleBrick],
) -> Vec<RangeInclusive<i64>> {
    let all = content.bricks;
    let rows = |index: u32| {
        let brick = &all[index as usize];
        let (min, max) = (brick.bounds.min.as_dvec3(), brick.bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        camera.rows_of_box(min + half, half + f64::from(brick.radius_max))
    };
    bricks.par_iter().map(|brick| rows(brick.index())).collect()
}
