/*!
What can be seen of a world: the faces that no opaque block covers.

The bits of the neighbors of 64 cells of a column are a word of another column, or the column's own
words, shifted by one. A face is exposed where the cell is filled and that neighbor is not opaque.

# Eyes within blocks

A picture shows where rays enter blocks, beyond the near plane. A ray that starts in air, or in a clear
block, enters the first opaque block through a face that is exposed. But one that starts in an opaque
block leaves it through a face that is covered, and so enters the neighbor there. So for an eye within
a block, blocks near the eye must be taken as hiding nothing: all where a ray may start, which is no
farther from the eye than the corners of the near plane.
*/

use super::BlockWorld;
use crate::Block;
use bytemuck::Zeroable;
use glam::DVec3;
use rayon::prelude::*;

/// How many columns are worked on together.
const RUN: usize = 256;

impl BlockWorld {
    /// The blocks that have a face not covered by an opaque neighbor, with these faces, in the order
    /// of y, then x, then z.
    ///
    /// `kind_of` is asked once for each of them. If it calls one air, nothing is drawn of it.
    #[must_use]
    pub fn surface(&self, kind_of: impl Fn([u16; 3]) -> u8 + Sync) -> Vec<Block> {
        self.exposed(&|x, y, word| self.opaque(x, y, word), &kind_of)
    }

    /// The surface for an eye that may be within a block: opaque blocks hide nothing if a point of
    /// them is not farther from `eye` than `reach`. So this is the surface, and those faces of their
    /// neighbors that look at them.
    ///
    /// The eye lies in the coordinates of [`Block::cell`]. With a reach of the distance from the eye
    /// to the corners of the near plane, pictures are those of [`BlockWorld::all`], wherever the eye
    /// is (only where a ray meets no more than the edge of blocks, it may be another of these). If
    /// neither the eye nor the near plane is within a block, the faces that are added cannot be
    /// seen. If rays are parallel, a ball around the eye must hold all of the near plane that is seen.
    #[must_use]
    pub fn surface_around(
        &self,
        eye: DVec3,
        reach: f64,
        kind_of: impl Fn([u16; 3]) -> u8 + Sync,
    ) -> Vec<Block> {
        let near = Near::new(eye, reach);
        let hiding = |x, y, word| {
            let opaque = self.opaque(x, y, word);
            if near.may_have(x, y, word) { opaque & !near.word(x, y, word) } else { opaque }
        };
        self.exposed(&hiding, &kind_of)
    }

    /// All blocks, with all their faces, in the same order. Most of them are hidden: this is there to
    /// compare with.
    #[must_use]
    pub fn all(&self, kind_of: impl Fn([u16; 3]) -> u8 + Sync) -> Vec<Block> {
        self.exposed(&|_, _, _| 0, &kind_of)
    }

    /// The opaque cells of a word of the column at x, y.
    #[inline]
    fn opaque(&self, x: usize, y: usize, word: usize) -> u64 {
        let at = (y * self.dims[0] + x) * self.words + word;
        self.filled[at] & !self.clear.get(at).copied().unwrap_or(0)
    }

    /// The blocks with a face that no cell covers whose bit `hiding` gives.
    fn exposed(
        &self,
        hiding: &(impl Fn(usize, usize, usize) -> u64 + Sync),
        kind_of: &(impl Fn([u16; 3]) -> u8 + Sync),
    ) -> Vec<Block> {
        let columns = self.dims[0] * self.dims[1];
        let run = |index: usize| index * RUN..columns.min((index + 1) * RUN);
        let count = |index: usize| {
            let mut count = 0;
            for column in run(index) {
                self.words_of(column, hiding, |_, any, _| count += any.count_ones() as usize);
            }
            count
        };
        let counts: Vec<usize> = (0..columns.div_ceil(RUN)).into_par_iter().map(count).collect();
        let mut blocks = vec![Block::zeroed(); counts.iter().sum()];
        let mut rest = blocks.as_mut_slice();
        let mut parts = Vec::with_capacity(counts.len());
        for (index, count) in counts.into_iter().enumerate() {
            let (part, others) = rest.split_at_mut(count);
            parts.push((index, part));
            rest = others;
        }
        parts.into_par_iter().for_each(|(index, part)| {
            let mut places = part.iter_mut();
            for column in run(index) {
                self.words_of(column, hiding, |first, any, exposed| {
                    // There are as many places as bits were counted.
                    for (bit, place) in Bits(any).zip(&mut places) {
                        *place = block(first, bit, exposed, kind_of);
                    }
                });
            }
        });
        blocks
    }

    /// Gives for each word of a column its first cell, the cells that are exposed, and those that are
    /// on each of the faces.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "sides are checked")]
    fn words_of(
        &self,
        column: usize,
        hiding: &impl Fn(usize, usize, usize) -> u64,
        mut give: impl FnMut([u16; 3], u64, &[u64; 6]),
    ) {
        let [width, depth, _] = self.dims;
        let (x, y) = (column % width, column / width);
        for word in 0..self.words {
            let filled = self.filled[column * self.words + word];
            if filled == 0 {
                continue;
            }
            let here = hiding(x, y, word);
            let below = if word > 0 { hiding(x, y, word - 1) } else { 0 };
            let above = if word + 1 < self.words { hiding(x, y, word + 1) } else { 0 };
            let covered = [
                if x > 0 { hiding(x - 1, y, word) } else { 0 },
                if x + 1 < width { hiding(x + 1, y, word) } else { 0 },
                if y > 0 { hiding(x, y - 1, word) } else { 0 },
                if y + 1 < depth { hiding(x, y + 1, word) } else { 0 },
                here << 1 | below >> 63,
                here >> 1 | above << 63,
            ];
            let exposed = covered.map(|covered| filled & !covered);
            let any = exposed.iter().fold(0, |any, face| any | face);
            give([x as u16, y as u16, (word * 64) as u16], any, &exposed);
        }
    }
}

/// The block of a bit of a word.
#[inline]
fn block(
    [x, y, z]: [u16; 3],
    bit: u8,
    exposed: &[u64; 6],
    kind_of: &impl Fn([u16; 3]) -> u8,
) -> Block {
    let cell = [x, y, z + u16::from(bit)];
    let is_seen = |face: usize| u8::from(exposed[face] >> bit & 1 == 1) << face;
    Block { cell, kind: kind_of(cell), faces: (0..6).fold(0, |faces, face| faces | is_seen(face)) }
}

/// The numbers of the bits that are set, from below.
struct Bits(u64);

impl Iterator for Bits {
    type Item = u8;

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "it is less than 64")]
    fn next(&mut self) -> Option<u8> {
        let bit = (self.0 != 0).then(|| self.0.trailing_zeros() as u8);
        self.0 &= self.0.wrapping_sub(1);
        bit
    }
}

/// The cells of which a point is not farther from an eye than a distance.
struct Near {
    eye: DVec3,
    reach: f64,
    /// The first and the last cell along each axis that may be one of them.
    ranges: [[usize; 2]; 3],
}

impl Near {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts saturate, and what is beyond the world does not matter"
    )]
    fn new(eye: DVec3, reach: f64) -> Self {
        // Written so that nothing is near to what is NaN.
        let is_place = eye.is_finite() && reach >= 0.0;
        let range = |at: f64| {
            // More than the reach, whatever rounding does.
            let wide = reach * 1.000_001 + 2.0;
            if is_place { [(at - wide) as usize, (at + wide).max(0.0) as usize] } else { [1, 0] }
        };
        Self { eye, reach, ranges: eye.to_array().map(range) }
    }

    /// Whether some cell of a word of the column at x, y may be near.
    #[inline]
    fn may_have(&self, x: usize, y: usize, word: usize) -> bool {
        let [across, along, up] = self.ranges;
        let is_in = |[first, last]: [usize; 2], at: usize| first <= at && at <= last;
        is_in(across, x) && is_in(along, y) && is_in(up.map(|cell| cell / 64), word)
    }

    /// Those of a word of the column at x, y.
    #[cold]
    fn word(&self, x: usize, y: usize, word: usize) -> u64 {
        let square = |axis: usize, cell: usize| {
            let (eye, low) = (self.eye[axis], cell as f64);
            (low - eye).max(eye - (low + 1.0)).max(0.0).powi(2)
        };
        let across = square(0, x) + square(1, y);
        let is_near = |z: usize| across + square(2, z) <= self.reach * self.reach;
        (0..64).fold(0, |cells, bit| cells | u64::from(is_near(word * 64 + bit)) << bit)
    }
}
