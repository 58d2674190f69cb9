/*!
A picture that is being drawn, and how its rows are shared among threads.

The picture is cut into bands of rows. How many there are depends on its height alone, so what is
drawn and what is skipped does not depend on the number of threads.
*/

use crate::{
    band::{Band, Piece},
    shape::Shape,
    tiles::{self, Tiles},
};
use puncta_core::{Camera, NO_RECORD, Record, ScreenBound, View};
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
        (shape, records): (&impl Shape<R>, &[R]),
        pieces: &[Piece<'_>],
    ) {
        let stride = self.stride;
        self.bands(|tiles, depth, id| {
            let first_row = tiles.first_row as i64;
            let mut brush = shape.brush(camera, records);
            Band { camera, ids, first_row, stride, depth, id, tiles }.draw(&mut brush, pieces);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Spheres, band::Members};
    use glam::DVec3;
    use proptest::prelude::*;
    use puncta_avc::Level;
    use puncta_core::Sphere;

    fn view(width: u32, height: u32, is_perspective: bool) -> View {
        let view = View::look_at(DVec3::new(0.1, 0.2, 4.0), DVec3::ZERO, DVec3::Y).unwrap();
        let view = view.with_size(width, height).unwrap();
        if is_perspective { view } else { view.with_orthographic(3.0).unwrap() }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// After any drawing, in a picture after another one, tiles know the largest of their depths,
        /// and hide what these hide.
        #[test]
        fn fresh_tiles_hold_the_largest_depths(
            sizes in [(1_u32..100, 1_u32..150), (1_u32..100, 1_u32..150)],
            is_perspective in any::<bool>(),
            spheres in prop::collection::vec(
                ([-1.5_f32..1.5, -1.5_f32..1.5, -1.0_f32..3.5], 0.01_f32..1.0),
                0..20,
            ),
        ) {
            let records: Vec<Sphere> =
                spheres.iter().map(|&(center, radius)| Sphere { center, radius }).collect();
            let [first, view] = sizes.map(|(width, height)| view(width, height, is_perspective));
            let mut drawing = Drawing::new(&first);
            for view in [first, view] {
                drawing.restart(&view);
                let camera = Camera::new(&view, DVec3::ZERO);
                let last = camera.size().map(|side| u16::try_from(side - 1).unwrap());
                let bound = ScreenBound { columns: [0, last[0]], rows: [0, last[1]], nearest: 0.0 };
                for range in [0..records.len() / 2, records.len() / 2..records.len()] {
                    let [start, end] = [range.start, range.end].map(|i| u32::try_from(i).unwrap());
                    let members = Members::All(start..end);
                    let pieces = [Piece { bound, level: Level::Record, members, is_drawn: false.into() }];
                    drawing.draw((&camera, None), (&Spheres, &records), &pieces);
                    drawing.freshen();
                    let across = drawing.stride / tiles::SIDE;
                    for (tile, &deepest) in drawing.deepest.iter().enumerate() {
                        let (x, y) = (tile % across * tiles::SIDE, tile / across * tiles::SIDE);
                        let rows = drawing.depth.chunks(drawing.stride).skip(y).take(tiles::SIDE);
                        let largest = rows
                            .flat_map(|row| &row[x..x + tiles::SIDE])
                            .fold(f32::NEG_INFINITY, |a, &b| a.max(b));
                        // Tiles that lie beyond the picture are never asked.
                        prop_assert!(deepest == largest || largest == f32::NEG_INFINITY);
                    }
                    let tile = ScreenBound { columns: [last[0]; 2], rows: [last[1]; 2], nearest: 4.0 };
                    let at = (drawing.deepest.len() / across - 1) * across;
                    let deepest = drawing.deepest[at + usize::from(last[0]) / tiles::SIDE];
                    prop_assert_eq!(drawing.hides(&tile), deepest < 4.0);
                    let equal = ScreenBound { nearest: deepest, ..tile };
                    prop_assert!(!drawing.hides(&equal));
                }
            }
        }
    }
}
