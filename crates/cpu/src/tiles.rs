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

use puncta_core::ScreenBound;
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A question: a bound, and a sphere's pixels if it is one of spheres.
    type Question = ([u16; 2], [u16; 2], f32, bool);

    const STRIDE: usize = 32;
    const FIRST_ROW: usize = 16;

    /// A few depths, so that many are equal.
    fn depths() -> impl Strategy<Value = f32> {
        prop_oneof![Just(1.0_f32), Just(2.0), Just(2.5), Just(3.0), Just(f32::INFINITY)]
    }

    fn ends(count: usize) -> impl Strategy<Value = [u16; 2]> {
        let count = u16::try_from(count).unwrap();
        (0..count, 0..count).prop_map(|(a, b)| [a.min(b), a.max(b)])
    }

    fn question(rows: usize) -> impl Strategy<Value = Question> {
        (ends(STRIDE), ends(FIRST_ROW + rows + 9), depths(), any::<bool>())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Whatever is drawn between questions, the answers are those of a look at all pixels.
        #[test]
        fn answers_are_those_of_the_pixels(
            rows in 1_usize..20,
            rounds in prop::collection::vec((question(20), question(20)), 1..12),
        ) {
            let across = STRIDE / SIDE;
            let count = across * rows.div_ceil(SIDE);
            let (mut deepest, mut stale) = (vec![f32::INFINITY; count], vec![false; count]);
            let mut tiles = Tiles {
                first_row: FIRST_ROW,
                stride: STRIDE,
                deepest: &mut deepest,
                stale: &mut stale,
            };
            let mut depth = vec![f32::INFINITY; STRIDE * rows];
            let end = FIRST_ROW + rows - 1;
            for (draw, ask) in rounds {
                // Draws a rectangle.
                let clip = |rows: [u16; 2]| {
                    let rows = rows.map(usize::from);
                    let rows = [rows[0].max(FIRST_ROW), rows[1].min(end)];
                    (rows[0] <= rows[1]).then_some(rows)
                };
                let columns = draw.0.map(usize::from);
                if let Some(rows) = clip(draw.1) {
                    tiles.touch(columns, rows);
                    for row in rows[0]..=rows[1] {
                        for pixel in &mut depth[(row - FIRST_ROW) * STRIDE..][columns[0]..=columns[1]] {
                            *pixel = pixel.min(draw.2);
                        }
                    }
                }
                let (columns, nearest) = (ask.0.map(usize::from), ask.2);
                let all = |columns: [usize; 2], rows: [usize; 2]| {
                    (rows[0]..=rows[1]).all(|row| {
                        let row = &depth[(row - FIRST_ROW) * STRIDE..];
                        row[columns[0]..=columns[1]].iter().all(|&depth| depth < nearest)
                    })
                };
                if ask.3 {
                    let bound = ScreenBound { columns: ask.0, rows: ask.1, nearest };
                    let expected = clip(ask.1).is_none_or(|rows| all(columns, rows));
                    prop_assert_eq!(tiles.hides(&bound, &depth), expected);
                } else if let Some(rows) = clip(ask.1) {
                    let around = |[a, b]: [usize; 2]| [a / SIDE * SIDE, b / SIDE * SIDE + SIDE - 1];
                    let whole = around(rows);
                    let expected = all(around(columns), [whole[0], whole[1].min(end)]);
                    let found = tiles.hide_around(columns, rows, (nearest, &depth));
                    prop_assert_eq!(found, expected);
                }
            }
            tiles.freshen_all(&depth);
            for (tile, deepest) in deepest.iter().enumerate() {
                let (x, y) = (tile % across * SIDE, tile / across * SIDE);
                let largest = (y..(y + SIDE).min(rows))
                    .flat_map(|row| depth[row * STRIDE + x..][..SIDE].to_vec())
                    .fold(f32::NEG_INFINITY, f32::max);
                prop_assert_eq!(*deepest, largest);
            }
        }
    }
}
