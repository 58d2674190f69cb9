//! The order of view depth.

use crate::radix::Radix;
use puncta_core::{Frame, Stage, Visible};

/// Orders bricks by the smallest view depth at which they can have a surface, nearest first.
///
/// Bricks of equal depth go by their index, so the result depends on the view alone.
#[derive(Clone, Debug, Default)]
pub struct Depth {
    radix: Radix,
}

impl<G: ?Sized> Stage<G> for Depth {
    fn apply(&mut self, _frame: &Frame<'_, G>, visible: &mut Visible) {
        self.radix.sort(&mut visible.bricks, |_| 0);
    }
}
