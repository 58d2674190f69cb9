/*!
A picture that is being drawn, and how its rows are shared among threads.

The picture is cut into bands of rows. How many there are depends on its height alone, so what is
drawn and what is skipped does not depend on the number of threads.
*/

use crate::{
    band::{Band, Piece},
    bound::ScreenBound,
    camera::Camera,
    tiles::{self, Tiles},
};
use puncta_core::{NO_RECORD, Record, View};
use rayon::prelude::*;

/// The number of bands that is aimed at: some of them show more than others.
const BANDS: usize = 24;

/// The smallest number of rows of a band: a sphere is set up once for each band that it lies in.
const BAND_ROWS_MIN: usize = 32;

/// Depths and ids of a picture, in bands.
#[derive(Clone, Debug)]
pub(crate) struct Drawing {
    pub(crate) view: View,
    /// The number of pixels of a row in memory.
    pub(crate) stride: usize,
    /// The number of rows of a band, a multiple of the side of a tile.
    band_rows: usize,
    pub(crate) depth: Vec<f32>,
    pub(crate) id: Vec<u32>,
    /// For each tile, a depth that no pixel lies behind.
    pub(crate) deepest: Vec<f32>,
    stale: Vec<bool>,
}

impl Drawing {
    pub(crate) fn new(view: &View) -> Self {
        let (view, depth, id) = (view.clone(), Vec::new(), Vec::new());
        let (deepest, stale) = (Vec::new(), Vec::new());
        let mut drawing = Self { view, stride: 0, band_rows: 0, depth, id, deepest, stale };
        drawing.clear();
        drawing
    }

    /// Starts a new picture in the same memory.
    pub(crate) fn restart(&mut self, view: &View) {
        self.view = view.clone();
        self.clear();
    }

    fn clear(&mut self) {
        let (width, height) = (self.view.width() as usize, self.view.height() as usize);
        self.stride = width.next_multiple_of(tiles::SIDE) + tiles::SIDE;
        self.band_rows = height.div_ceil(BANDS).max(BAND_ROWS_MIN).next_multiple_of(tiles::SIDE);
        let (pixels, tiles) =
            (self.stride * height, self.stride / tiles::SIDE * height.div_ceil(tiles::SIDE));
        fill(&mut self.depth, pixels, f32::INFINITY);
        fill(&mut self.id, pixels, NO_RECORD);
        fill(&mut self.deepest, tiles, f32::INFINITY);
        fill(&mut self.stale, tiles, false);
        // What fills up the rows is in front of everything.
        self.depth.par_chunks_mut(self.stride).for_each(|row| row[width..].fill(f32::NEG_INFINITY));
    }

    /// Draws pieces, on all cores.
    pub(crate) fn draw<R: Record>(
        &mut self,
        (camera, ids): (&Camera, Option<&[u32]>),
        records: &[R],
        pieces: &[Piece<'_>],
    ) {
        let stride = self.stride;
        self.bands(|tiles, depth, id| {
            let first_row = tiles.first_row as i64;
            Band { camera, ids, first_row, stride, depth, id, tiles }.draw(records, pieces);
        });
    }

    /// Finds the largest depths of all tiles.
    pub(crate) fn freshen(&mut self) {
        self.bands(|mut tiles, depth, _| tiles.freshen_all(depth));
    }

    /// Whether all pixels of a bound are nearer than it; tiles must be fresh.
    pub(crate) fn hides(&self, bound: &ScreenBound) -> bool {
        let across = self.stride / tiles::SIDE;
        let [left, right] = bound.columns.map(|column| usize::from(column) / tiles::SIDE);
        let [top, bottom] = bound.rows.map(|row| usize::from(row) / tiles::SIDE);
        bound.is_empty()
            || (top..=bottom).all(|y| {
                let row = &self.deepest[y * across..];
                row[left..=right].iter().all(|&deepest| deepest < bound.nearest)
            })
    }

    fn bands(&mut self, work: impl Fn(Tiles<'_>, &mut [f32], &mut [u32]) + Sync) {
        let (stride, rows) = (self.stride, self.band_rows);
        let tiles = stride / tiles::SIDE * (rows / tiles::SIDE);
        let bands = self
            .depth
            .par_chunks_mut(stride * rows)
            .zip(self.id.par_chunks_mut(stride * rows))
            .zip(self.deepest.par_chunks_mut(tiles))
            .zip(self.stale.par_chunks_mut(tiles));
        bands.enumerate().with_max_len(1).for_each(|(band, (((depth, id), deepest), stale))| {
            work(Tiles { first_row: band * rows, stride, deepest, stale }, depth, id);
        });
    }
}

/// Makes a vector hold only this value.
fn fill<T: Copy>(values: &mut Vec<T>, count: usize, value: T) {
    values.clear();
    values.resize(count, value);
}
