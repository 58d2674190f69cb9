/*!
The survey: what the bricks that are left can still change.

A pixel is open for a brick if it lies in the brick's bound and is not nearer than it. How many pixels
are open for a brick tells how much there is to gain from drawing it, and none at all that it need not
be drawn. For all bricks together, each tile notes the nearest of those that can change any of its
pixels: what is nearer than that can no longer change. So the open set is a little larger than the
union of the bricks' pixels, never smaller.
*/

use crate::{bound::ScreenBound, drawing::Drawing, tiles::SIDE};
use puncta_core::VisibleBrick;
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
                let (open, gain) = view.open(brick, bound, &mut nearest);
                brick.set_open(open, gain);
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
    /// How many pixels are open for a brick, and what it may gain; notes its depth in their tiles.
    fn open(&self, brick: &VisibleBrick, bound: &ScreenBound, nearest: &mut [f32]) -> (u32, f32) {
        if bound.is_empty() {
            return (0, 0.0);
        }
        let across = self.drawing.stride / SIDE;
        let [left, right] = bound.columns.map(usize::from);
        let [top, bottom] = bound.rows.map(usize::from);
        let scale = 1.0 / (brick.far() - bound.nearest);
        let (mut sum, mut gain) = (0, 0.0);
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
                    sum += open;
                    gain += more;
                }
            }
        }
        (u32::try_from(sum).unwrap_or(u32::MAX), gain)
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
