/*!
The orders of accumulated density.

A brick behind others is seen through the gaps that they leave. The thesis takes the density of a
brick, which is the volume of its balls as a share of its cell, for how well it hides, and sums
densities over what lies between a brick and the camera:

```text
accum(b) = 0                                         if b is directly visible
accum(b) = min { accum(o) + density(o) }             over all bricks o that hide b
```

[`Density`] has exactly these minima. The thesis finds them with the queue of its algorithm 3.1,
"using the same breadth-first traversal algorithm as before", where "for each node, the level
changes only once", and so "along shortest paths to the camera node". A queue reaches nodes in the
order of their levels. So a path of more edges comes too late, even if it is less dense, and what a
node has handed on is not changed any more. [`DensityFifo`] is this order: the minimum over the
paths of the fewest edges. Where a queue would depend on the order of its nodes, which is where a
brick is hidden by one of its own level, that one is left out. So the order is one for any order of
bricks. It is here to be compared with.
*/

use crate::{
    OcclusionGraph,
    radix::{Radix, ascending},
};
use puncta_core::{Frame, Stage, Visible, VisibleBrick};
use puncta_grid::Grid;
use rayon::prelude::*;

/// How many bricks one thread takes at a time.
const CHUNK: usize = 1 << 14;

/// Orders bricks by the least density that lies before them: directly visible ones first.
///
/// Bricks before which equally much lies go by their depth, then by their index.
#[derive(Clone, Debug, Default)]
pub struct Density {
    order: Accumulated,
}

/// Orders bricks as [`Density`] does, but looks at the paths of the fewest edges only, as the
/// thesis does.
#[derive(Clone, Debug, Default)]
pub struct DensityFifo {
    order: Accumulated,
}

impl Density {
    /// The graph of the last frame. Its nodes are the bricks in the order that they had before.
    #[must_use]
    pub const fn graph(&self) -> &OcclusionGraph {
        &self.order.graph
    }
}

impl DensityFifo {
    /// The graph of the last frame. Its nodes are the bricks in the order that they had before.
    #[must_use]
    pub const fn graph(&self) -> &OcclusionGraph {
        &self.order.graph
    }
}

impl Stage<Grid> for Density {
    fn apply(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        self.order.apply(frame, visible, OcclusionGraph::least_sums);
    }
}

impl Stage<Grid> for DensityFifo {
    fn apply(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        self.order.apply(frame, visible, OcclusionGraph::shortest_sums);
    }
}

/// What both orders have in common.
#[derive(Clone, Debug, Default)]
struct Accumulated {
    graph: OcclusionGraph,
    densities: Vec<f32>,
    keys: Vec<u32>,
    radix: Radix,
}

impl Accumulated {
    fn apply(
        &mut self,
        frame: &Frame<'_, Grid>,
        visible: &mut Visible,
        sums: for<'a> fn(&'a mut OcclusionGraph, &[f32]) -> &'a [f32],
    ) {
        let bricks = frame.bricks.bricks();
        let density = |brick: &VisibleBrick| {
            bricks.get(brick.index() as usize).map_or(0.0, |brick| brick.density)
        };
        let densities = visible.bricks.par_iter().with_min_len(CHUNK).map(density);
        densities.collect_into_vec(&mut self.densities);
        self.graph.rebuild(frame, &visible.bricks);
        let sums = sums(&mut self.graph, &self.densities);
        self.keys.clear();
        self.keys.extend(sums.iter().map(|&sum| ascending(sum)));
        for (node, key) in self.keys.iter_mut().enumerate() {
            if self.graph.is_visible(node) {
                *key = 0;
            }
        }
        self.radix.sort(&mut visible.bricks, |node| self.keys[node]);
    }
}
