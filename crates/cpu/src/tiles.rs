/*!
Tiles: the largest depth in each square of eight by eight pixels, so that what lies behind it can be
skipped without a look at the pixels.

This is hierarchical depth (Greene, Kass and Miller, *Hierarchical Z-Buffer Visibility*, 1993) with
one level above the pixels. Depths only ever fall while a picture is drawn. So a maximum that was
right once stays an upper bound, and a tile is looked at anew only where its bound is not enough:
drawing marks a tile as stale, a question about it makes it fresh.

What begins at a depth is hidden behind a pixel if the depth there is smaller. Equal is not enough,
because of two records at one depth the one with the lower id is shown.

Pixels to the right of the picture, which only fill up its rows, have the depth -inf: nothing is drawn
there, and they are in nobody's way.
*/

use crate::bound::ScreenBound;
use wide::f32x8;

/// The side of a tile.
pub(crate) const SIDE: usize = 8;

/// The tiles of some rows of a picture.
#[derive(Debug)]
pub(crate) struct Tiles<'a> {
    /// The first of the rows, a multiple of [`SIDE`].
    pub(crate) first_row: usize,
    /// The number of pixels of a row in memory, a multiple of [`SIDE`].
    pub(crate) stride: usize,
    /// For each tile, row by row, a depth that no pixel lies behind.
    pub(crate) deepest: &'a mut [f32],
    /// Whether something was drawn there since that was found.
    pub(crate) stale: &'a mut [bool],
}

/// Pixels of a rectangle, first and last inclusive, in coordinates of the rows at hand.
#[derive(Clone, Copy, Debug)]
struct Rect {
    columns: [usize; 2],
    rows: [usize; 2],
}

impl Tiles<'_> {
    /// Notes that something was drawn into these pixels, which lie in the rows at hand.
    #[inline]
    pub(crate) fn touch(&mut self, columns: [usize; 2], rows: [usize; 2]) {
        let across = self.stride / SIDE;
        for y in (rows[0] - self.first_row) / SIDE..=(rows[1] - self.first_row) / SIDE {
            let row = y * across;
            self.stale[row + columns[0] / SIDE..=row + columns[1] / SIDE].fill(true);
        }
    }

    /// Whether all pixels of the tiles around these, which lie in the rows at hand, are nearer than a
    /// depth.
    #[inline]
    pub(crate) fn hide_around(
        &mut self,
        columns: [usize; 2],
        rows: [usize; 2],
        (nearest, depth): (f32, &[f32]),
    ) -> bool {
        let across = self.stride / SIDE;
        let (left, right) = (columns[0] / SIDE, columns[1] / SIDE);
        ((rows[0] - self.first_row) / SIDE..=(rows[1] - self.first_row) / SIDE).all(|y| {
            (left..=right).all(|x| {
                let tile = y * across + x;
                if self.deepest[tile] >= nearest && self.stale[tile] {
                    self.freshen((x, y), depth);
                }
                self.deepest[tile] < nearest
            })
        })
    }

    /// Whether all pixels of a bound that lie in these rows are nearer than it.
    pub(crate) fn hides(&mut self, bound: &ScreenBound, depth: &[f32]) -> bool {
        let count = depth.len() / self.stride;
        let rows = bound.rows.map(usize::from);
        let rows = [rows[0].max(self.first_row), rows[1].min(self.first_row + count - 1)];
        if bound.is_empty() || rows[0] > rows[1] {
            return true;
        }
        let rows = rows.map(|row| row - self.first_row);
        let rect = Rect { columns: bound.columns.map(usize::from), rows };
        let [left, right] = rect.columns.map(|column| column / SIDE);
        let [top, bottom] = rect.rows.map(|row| row / SIDE);
        (top..=bottom)
            .all(|y| (left..=right).all(|x| self.tile_hides((x, y), &rect, bound.nearest, depth)))
    }

    #[inline]
    fn tile_hides(&mut self, at: (usize, usize), rect: &Rect, nearest: f32, depth: &[f32]) -> bool {
        let tile = at.1 * (self.stride / SIDE) + at.0;
        if self.deepest[tile] < nearest {
            return true;
        }
        if self.stale[tile] {
            self.freshen(at, depth);
            if self.deepest[tile] < nearest {
                return true;
            }
        }
        let part = part(at, rect);
        // A tile that is wholly in the rectangle has a pixel that is not hidden.
        let is_whole = part.columns[1] - part.columns[0] == SIDE - 1
            && part.rows[1] - part.rows[0] == SIDE - 1;
        !is_whole && {
            let [first, last] = part.columns;
            (part.rows[0]..=part.rows[1]).all(|row| {
                let row = &depth[row * self.stride..];
                row[first..=last].iter().all(|&depth| depth < nearest)
            })
        }
    }

    /// Finds the largest depth of a tile.
    fn freshen(&mut self, (x, y): (usize, usize), depth: &[f32]) {
        let tile = y * (self.stride / SIDE) + x;
        let rows = depth[y * SIDE * self.stride..].chunks(self.stride).take(SIDE);
        let deepest = rows.fold(f32x8::splat(f32::NEG_INFINITY), |deepest, row| {
            let row = row[x * SIDE..].first_chunk().copied();
            deepest.max(f32x8::new(row.unwrap_or([f32::INFINITY; SIDE])))
        });
        self.deepest[tile] = deepest.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max);
        self.stale[tile] = false;
    }

    /// Makes all tiles fresh.
    pub(crate) fn freshen_all(&mut self, depth: &[f32]) {
        let across = self.stride / SIDE;
        for tile in 0..self.stale.len() {
            if self.stale[tile] {
                self.freshen((tile % across, tile / across), depth);
            }
        }
    }
}

/// The part of a rectangle that lies in a tile.
#[inline]
fn part((x, y): (usize, usize), rect: &Rect) -> Rect {
    let clip = |[first, last]: [usize; 2], tile: usize| {
        [first.max(tile * SIDE), last.min(tile * SIDE + SIDE - 1)]
    };
    Rect { columns: clip(rect.columns, x), rows: clip(rect.rows, y) }
}
