/*!
The order of what drawing a brick is likely to show, for what it costs.

If balls were spread at random, a ray that crosses a cell would miss all of them with probability
`exp(-tau)`, where `tau` is the sum of their cross sections over the area of a side. For balls of
equal radius `r` in a cell of width `w`, whose volumes are `density` times that of the cell, it is

```text
tau = density * w * 3 / (4 r)
```

The largest radius is taken for `r`, as it is known. A brick with `t` before it, by the same sum as
for density, is expected to show this many pixels, where the side of its cell covers `area`:

```text
exp(-t) * (1 - exp(-tau)) * area
```

Divided by the number of its records, this is what is gained for a unit of work. Taking the largest
first fills the picture as fast as this guess allows. Bricks with few records come early even if
they are partly hidden, and dense bricks come once, not all at once.

While the picture is drawn, guesses are replaced by what is known. What was drawn hides what the
depths of the picture say, so `area` becomes the [`gain`](VisibleBrick::gain) that the renderer's
survey finds; and `t` sums only over the bricks that are still to be drawn, by one more sweep over
the same graph.
*/

use crate::{
    OcclusionGraph,
    radix::{Radix, descending},
};
use puncta_core::{Brick, Frame, Stage, View, Visible, VisibleBrick};
use puncta_grid::Grid;
use rayon::prelude::*;

/// What stands for no node.
const NO_NODE: u32 = u32::MAX;

/// How many bricks one thread takes at a time.
const CHUNK: usize = 1 << 14;

/// Orders bricks by the pixels that they are expected to show for each of their records, the most
/// first.
///
/// Bricks of which equally much is expected go by their depth, then by their index.
#[derive(Clone, Debug, Default)]
pub struct Transmittance {
    graph: OcclusionGraph,
    /// The node of each brick of the grid.
    nodes: Vec<u32>,
    thicknesses: Vec<f32>,
    /// The pixels for each record, if nothing lies before.
    gains: Vec<f32>,
    /// The thicknesses of the nodes that are still to be drawn.
    left: Vec<f32>,
    keys: Vec<u32>,
    radix: Radix,
}

impl Transmittance {
    /// The graph of the last frame. Its nodes are the bricks in the order that they had before.
    #[must_use]
    pub const fn graph(&self) -> &OcclusionGraph {
        &self.graph
    }

    /// The optical thickness of a brick in a cell of this width: minus the logarithm of the
    /// probability that a ray across the cell meets none of its records, which are taken to be
    /// spread at random and of equal size. 0 if they have no size.
    #[must_use]
    pub fn thickness(brick: &Brick, cell_width: f32) -> f32 {
        if brick.radius_max > 0.0 {
            (brick.density * cell_width * 0.75 / brick.radius_max).max(0.0)
        } else {
            0.0
        }
    }
}

impl Stage<Grid> for Transmittance {
    fn apply(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        let (bricks, width) = (frame.bricks.bricks(), frame.bricks.cells().width());
        self.nodes.clear();
        self.nodes.resize(bricks.len(), NO_NODE);
        for (node, brick) in (0..).zip(&visible.bricks) {
            if let Some(place) = self.nodes.get_mut(brick.index() as usize) {
                *place = node;
            }
        }
        let side = Side { width, view: frame.view };
        let look = |visible: &VisibleBrick| {
            let Some(brick) = bricks.get(visible.index() as usize) else { return (0.0, 0.0) };
            let thickness = Self::thickness(brick, width);
            let records = brick.records.len().max(1) as f32;
            (thickness, opacity(thickness) * side.area(visible) / records)
        };
        let list = visible.bricks.par_iter().with_min_len(CHUNK);
        list.map(look).unzip_into_vecs(&mut self.thicknesses, &mut self.gains);
        self.graph.rebuild(frame, &visible.bricks);
        let before = self.graph.least_sums(&self.thicknesses);
        let key = |(&gain, &before): (&f32, &f32)| descending((gain * (-before).exp()).max(0.0));
        let gains = self.gains.par_iter().with_min_len(CHUNK);
        gains.zip(before).map(key).collect_into_vec(&mut self.keys);
        self.radix.sort(&mut visible.bricks, |node| self.keys[node]);
    }

    fn refine(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        let bricks = frame.bricks.bricks();
        let node = |brick: &VisibleBrick| {
            self.nodes.get(brick.index() as usize).map_or(usize::MAX, |&node| node as usize)
        };
        self.left.clear();
        self.left.resize(self.thicknesses.len(), 0.0);
        for node in visible.bricks.iter().map(node) {
            if let (Some(left), Some(own)) = (self.left.get_mut(node), self.thicknesses.get(node)) {
                *left = *own;
            }
        }
        let before = self.graph.least_sums(&self.left);
        let key = |visible: &VisibleBrick| {
            let records =
                bricks.get(visible.index() as usize).map_or(1, |b| b.records.len().max(1));
            let node = node(visible);
            let value = |values: &[f32]| values.get(node).copied().unwrap_or(0.0);
            let pixels = (-value(before)).exp() * opacity(value(&self.left)) * visible.gain();
            descending((pixels / records as f32).max(0.0))
        };
        let list = visible.bricks.par_iter().with_min_len(CHUNK);
        list.map(key).collect_into_vec(&mut self.keys);
        self.radix.sort(&mut visible.bricks, |place| self.keys[place]);
    }
}

/// A side of a cell, as it is seen.
#[derive(Clone, Copy)]
struct Side<'a> {
    width: f32,
    view: &'a View,
}

impl Side<'_> {
    /// How many pixels it covers, about. A cell is taken to be at least half its width away.
    #[inline]
    fn area(&self, brick: &VisibleBrick) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "it need not be exact")]
        let pixel = self.view.pixel_size() as f32;
        let spread = if self.view.is_perspective() {
            (brick.near() * 0.5 + brick.far() * 0.5).max(self.width * 0.5)
        } else {
            1.0
        };
        let side = self.width / (spread * pixel);
        side * side
    }
}

/// `1 - exp(-tau)`, also where that is small.
#[inline]
fn opacity(tau: f32) -> f32 {
    if tau < 1e-2 { tau - tau * tau * 0.5 } else { 1.0 - (-tau).exp() }
}
