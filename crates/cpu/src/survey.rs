/*!
The survey: what the bricks that are left can still change.

A pixel is open for a brick if it lies in the brick's bound and is not nearer than it. The pixels that
are open for a brick tell how much there is to gain from drawing it, and if there are none it need not
be drawn. For all bricks together, each tile notes the nearest of those that can change any of its
pixels: what is nearer than that can no longer change. So the open set is a little larger than the
union of the bricks' pixels, never smaller.
*/

use crate::{drawing::Drawing, tiles::SIDE};
use puncta_core::{ScreenBound, VisibleBrick};
use rayon::prelude::*;

/// How many bricks are looked at in one piece of work.
const CHUNK: usize = 2048;

/// How much a change counts where something is seen already: what is there is often like what will
/// be. (Between 0.25 and 1 the orders that build on it differ little.)
const COVERED: f32 = 0.5;

/// What can still change.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outlook {
    /// For each tile, the depth of the nearest brick that may change it; +inf if there is none.
    nearest: Vec<f32>,
}

impl Outlook {
    pub(crate) fn clear(&mut self) {
        self.nearest.clear();
    }

    /// Whether a pixel may change.
    pub(crate) fn is_open(&self, drawing: &Drawing, column: usize, row: usize) -> bool {
        let across = drawing.stride / SIDE;
        let nearest = self.nearest.get(row / SIDE * across + column / SIDE);
        nearest.is_none_or(|&nearest| {
            nearest < f32::INFINITY && drawing.depth[row * drawing.stride + column] >= nearest
        })
    }

    /// The number of pixels that may change.
    pub(crate) fn count(&self, drawing: &Drawing) -> u64 {
        let (stride, width) = (drawing.stride, drawing.view.width() as usize);
        let across = stride / SIDE;
        let open_in_row = |(row, depth): (usize, &[f32])| {
            let nearest = &self.nearest[row / SIDE * across..][..across];
            let tiles = depth[..width].chunks(SIDE).zip(nearest);
            let open = |(depth, &nearest): (&[f32], &f32)| {
                if nearest < f32::INFINITY {
                    depth.iter().filter(|&&depth| depth >= nearest).count() as u64
                } else {
                    0
                }
            };
            tiles.map(open).sum::<u64>()
        };
        drawing.depth.par_chunks(stride).enumerate().with_min_len(16).map(open_in_row).sum()
    }
}

/// Notes how many pixels are open for each brick, and what is open for all; tiles must be fresh.
pub(crate) fn survey(
    drawing: &Drawing,
    left: &mut [VisibleBrick],
    bounds: &[ScreenBound],
) -> Outlook {
    let shallowest = shallowest(drawing);
    let tiles = drawing.deepest.len();
    let empty = || vec![f32::INFINITY; tiles];
    let work = left.par_chunks_mut(CHUNK).zip(bounds.par_chunks(CHUNK));
    let nearest = work
        .fold(empty, |mut nearest, (bricks, bounds)| {
            let view = Look { drawing, shallowest: &shallowest };
            for (brick, bound) in bricks.iter_mut().zip(bounds) {
                brick.set_gain(view.gain(brick, bound, &mut nearest));
            }
            nearest
        })
        .reduce(empty, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a = a.min(b));
            a
        });
    Outlook { nearest }
}

/// For each tile, a depth that no pixel lies in front of.
fn shallowest(drawing: &Drawing) -> Vec<f32> {
    let across = drawing.stride / SIDE;
    let mut shallowest = vec![f32::INFINITY; drawing.deepest.len()];
    let rows = drawing.depth.par_chunks(drawing.stride * SIDE);
    shallowest.par_chunks_mut(across).zip(rows).for_each(|(shallowest, rows)| {
        for row in rows.chunks(drawing.stride) {
            for (tile, depth) in shallowest.iter_mut().zip(row.chunks(SIDE)) {
                *tile = depth.iter().copied().fold(*tile, f32::min);
            }
        }
    });
    shallowest
}

struct Look<'a> {
    drawing: &'a Drawing,
    shallowest: &'a [f32],
}

impl Look<'_> {
    /// What a brick may gain, 0 if no pixel is open for it; notes its depth in the tiles of those.
    fn gain(&self, brick: &VisibleBrick, bound: &ScreenBound, nearest: &mut [f32]) -> f32 {
        if bound.is_empty() {
            return 0.0;
        }
        let across = self.drawing.stride / SIDE;
        let [left, right] = bound.columns.map(usize::from);
        let [top, bottom] = bound.rows.map(usize::from);
        let scale = 1.0 / (brick.far() - bound.nearest);
        let (mut is_open, mut gain) = (false, 0.0);
        for y in top / SIDE..=bottom / SIDE {
            let rows = [top.max(y * SIDE), bottom.min(y * SIDE + SIDE - 1)];
            for x in left / SIDE..=right / SIDE {
                let tile = y * across + x;
                if self.drawing.deepest[tile] < bound.nearest {
                    continue;
                }
                let columns = [left.max(x * SIDE), right.min(x * SIDE + SIDE - 1)];
                let (open, more) = if self.shallowest[tile] == f32::INFINITY {
                    let open = (rows[1] - rows[0] + 1) * (columns[1] - columns[0] + 1);
                    (open, open as f32)
                } else {
                    self.count(columns, rows, (bound.nearest, scale))
                };
                if open > 0 {
                    nearest[tile] = nearest[tile].min(bound.nearest);
                    is_open = true;
                    gain += more;
                }
            }
        }
        // What can change something has something to gain, even where the sum is 0 or NaN.
        if gain > 0.0 || !is_open { gain } else { f32::MIN_POSITIVE }
    }

    /// The open pixels of a rectangle, and what they may gain, for a brick that begins at a depth
    /// and has this scale (one divided by its length along the line of sight).
    fn count(
        &self,
        [left, right]: [usize; 2],
        [top, bottom]: [usize; 2],
        (nearest, scale): (f32, f32),
    ) -> (usize, f32) {
        let (mut open, mut gain) = (0, 0.0);
        for row in top..=bottom {
            for &depth in &self.drawing.depth[row * self.drawing.stride..][left..=right] {
                open += usize::from(depth >= nearest);
                let share = ((depth - nearest) * scale).clamp(0.0, 1.0);
                gain += if depth == f32::INFINITY { 1.0 } else { COVERED * share };
            }
        }
        (open, gain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use proptest::prelude::*;
    use puncta_core::{Aabb, Brick, View, Visible};

    const SIZE: [u16; 2] = [29, 21];

    /// A few depths, so that many are equal.
    fn depths() -> impl Strategy<Value = f32> {
        prop_oneof![Just(1.0_f32), Just(2.0), Just(2.5), Just(3.0), Just(f32::INFINITY)]
    }

    fn bounds() -> impl Strategy<Value = ScreenBound> {
        let ends =
            |count: u16| (0..count, 0..count).prop_map(|(a, b)| [a.min(b), a.max(b)]).boxed();
        let ends = |axis: usize| prop_oneof![9 => ends(SIZE[axis]), 1 => Just([1, 0])];
        let nearest = prop_oneof![Just(0.5_f32), Just(1.0), Just(2.0), Just(2.5)];
        (ends(0), ends(1), nearest).prop_map(|(columns, rows, nearest)| ScreenBound {
            columns,
            rows,
            nearest,
        })
    }

    /// A picture in which rectangles were drawn.
    fn drawing(view: &View, drawn: &[(ScreenBound, f32)]) -> Drawing {
        let mut drawing = Drawing::new(view);
        let (stride, across) = (drawing.stride, drawing.stride / SIDE);
        for (bound, depth) in drawn.iter().filter(|(bound, _)| !bound.is_empty()) {
            for row in bound.rows[0]..=bound.rows[1] {
                let row = &mut drawing.depth[usize::from(row) * stride..];
                for pixel in &mut row[bound.columns[0].into()..=bound.columns[1].into()] {
                    *pixel = pixel.min(*depth);
                }
            }
        }
        drawing.deepest.fill(f32::NEG_INFINITY);
        for (pixel, &depth) in drawing.depth.iter().enumerate() {
            let deepest =
                &mut drawing.deepest[pixel / stride / SIDE * across + pixel % stride / SIDE];
            *deepest = deepest.max(depth);
        }
        drawing
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]

        /// The open pixels of a brick are those of a look at all; the open set holds them all, and
        /// nothing in tiles without any.
        #[test]
        fn open_pixels_are_those_of_all_pixels(
            drawn in prop::collection::vec((bounds(), depths()), 0..6),
            bounds in prop::collection::vec(bounds(), 0..6),
        ) {
            let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
            let view = view.with_size(SIZE[0].into(), SIZE[1].into()).unwrap();
            let drawing = drawing(&view, &drawn);
            // Its far depth is 4, or nearly so.
            let place = Aabb { min: Vec3::splat(1.0), max: Vec3::splat(1.0) };
            let brick = Brick { records: 0..0, bounds: place, radius_max: 0.0, density: 0.0 };
            let bricks = vec![brick; bounds.len()];
            let mut left = Visible::all(&bricks, DVec3::ZERO, &view).bricks;
            let outlook = survey(&drawing, &mut left, &bounds);
            let pixels = || {
                (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| (column, row)))
            };
            let depth = |(column, row): (u16, u16)| {
                drawing.depth[usize::from(row) * drawing.stride + usize::from(column)]
            };
            let is_open = |bound: &ScreenBound, at: (u16, u16)| {
                let holds = |[first, last]: [u16; 2], at: u16| first <= at && at <= last;
                holds(bound.columns, at.0) && holds(bound.rows, at.1) && depth(at) >= bound.nearest
            };
            for (brick, bound) in left.iter().zip(&bounds) {
                let open: Vec<_> = pixels().filter(|&at| is_open(bound, at)).collect();
                prop_assert_eq!(brick.is_open(), !open.is_empty());
                let gain = |&at: &(u16, u16)| {
                    let share = (depth(at) - bound.nearest) / (brick.far() - bound.nearest);
                    if depth(at) == f32::INFINITY { 1.0 } else { 0.5 * share.min(1.0) }
                };
                let gain = open.iter().map(gain).sum::<f32>();
                prop_assert!((brick.gain() - gain).abs() <= 1e-3 * (1.0 + gain));
            }
            let tile = |at: (u16, u16)| (usize::from(at.0) / SIDE, usize::from(at.1) / SIDE);
            let mut count = 0;
            for at in pixels() {
                let nearest = bounds
                    .iter()
                    .filter(|b| pixels().any(|other| tile(other) == tile(at) && is_open(b, other)))
                    .map(|bound| bound.nearest)
                    .reduce(f32::min);
                let expected = nearest.is_some_and(|nearest| depth(at) >= nearest);
                let found = outlook.is_open(&drawing, at.0.into(), at.1.into());
                prop_assert_eq!(found, expected);
                count += u64::from(found);
            }
            prop_assert_eq!(outlook.count(&drawing), count);
        }
    }
}
