//! The order of levels in the occlusion graph.

use crate::{OcclusionGraph, radix::Radix};
use puncta_core::{Frame, Stage, Visible};
use puncta_grid::Grid;

/// Orders bricks by how many others hide them, one behind the other: directly visible ones first.
///
/// This is the level of section 3.2.2 of the thesis: one more than the least level of what hides
/// the brick. Bricks of a level go by their depth, then by their index.
#[derive(Clone, Debug, Default)]
pub struct Level {
    graph: OcclusionGraph,
    radix: Radix,
}

impl Level {
    /// The graph of the last frame. Its nodes are the bricks in the order that they had before.
    #[must_use]
    pub const fn graph(&self) -> &OcclusionGraph {
        &self.graph
    }
}

impl Stage<Grid> for Level {
    fn apply(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        self.graph.rebuild(frame, &visible.bricks);
        let levels = self.graph.levels();
        self.radix.sort(&mut visible.bricks, |node| levels[node]);
    }
}
