//! The order of view depth.

use puncta_core::{Frame, Stage, Visible};

/// Orders bricks by the smallest view depth at which they can have a surface, nearest first.
///
/// Bricks of equal depth keep the order of their indices, so the result depends on the view alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Depth;

impl<G: ?Sized> Stage<G> for Depth {
    fn apply(&mut self, _frame: &Frame<'_, G>, visible: &mut Visible) {
        visible
            .bricks
            .sort_unstable_by(|a, b| a.near().total_cmp(&b.near()).then(a.index().cmp(&b.index())));
    }
}
