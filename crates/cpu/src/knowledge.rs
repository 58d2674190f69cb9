/*!
What is known of the bricks of a frame: where they lie on the screen, and which are hidden.

Bounds are found when they are first asked for, and kept for the frame. Blocks of bricks are tested
together: if a block lies behind what is drawn, so do its bricks, and their bounds are never found.
*/

use crate::{
    bound::{Bounder, ScreenBound},
    camera::Camera,
    drawing::Drawing,
};
use puncta_core::Content;
use rayon::prelude::*;

/// The bound of what cannot be seen.
const HIDDEN: ScreenBound = ScreenBound { columns: [1, 0], rows: [1, 0], nearest: f32::INFINITY };

/// The bounds of bricks and blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Knowledge {
    /// Where the bricks are that this is about, and how many.
    content: (usize, usize),
    /// By brick: unknown, known, or empty if it cannot be seen.
    bricks: Vec<ScreenBound>,
    blocks: Vec<ScreenBound>,
}

impl Knowledge {
    /// Forgets everything: another picture begins.
    pub(crate) fn clear(&mut self) {
        self.content = (0, 0);
        self.bricks.clear();
        self.blocks.clear();
    }

    /// Makes room for these bricks.
    pub(crate) fn prepare<R>(&mut self, content: &Content<'_, R>, camera: &Camera) {
        let key = (content.bricks.as_ptr() as usize, content.bricks.len());
        if self.content == key && self.bricks.len() == key.1 {
            return;
        }
        self.content = key;
        self.bricks.clear();
        self.bricks.resize(key.1, ScreenBound::UNKNOWN);
        let bounder = Bounder::new(camera);
        self.blocks.clear();
        let bound = |block: &puncta_core::Block| bounder.bound(&block.bounds, block.radius_max);
        self.blocks.extend(content.blocks.iter().map(bound));
    }

    /// The bounds of bricks.
    pub(crate) fn bounds<R: Sync>(
        &self,
        content: &Content<'_, R>,
        camera: &Camera,
        bricks: &[u32],
    ) -> Vec<ScreenBound> {
        let bounder = Bounder::new(camera);
        let find = |&index: &u32| {
            let index = index as usize;
            let known = self.bricks[index];
            if known.is_known() {
                return known;
            }
            let brick = &content.bricks[index];
            bounder.bound(&brick.bounds, brick.radius_max)
        };
        bricks.par_iter().with_min_len(256).map(find).collect()
    }

    /// Keeps the bounds of bricks.
    pub(crate) fn keep(&mut self, bricks: &[u32], bounds: &[ScreenBound]) {
        for (&brick, bound) in bricks.iter().zip(bounds) {
            self.bricks[brick as usize] = *bound;
        }
    }

    /// Finds the blocks that lie behind what is drawn; all tiles must be fresh.
    pub(crate) fn hide_blocks<R>(&mut self, content: &Content<'_, R>, drawing: &Drawing) {
        let hides = |bound: &ScreenBound| !bound.is_empty() && drawing.hides(bound);
        let hidden: Vec<bool> = self.blocks.par_iter().with_min_len(64).map(hides).collect();
        for (index, _) in hidden.iter().enumerate().filter(|(_, hidden)| **hidden) {
            self.blocks[index] = HIDDEN;
            let bricks = &content.blocks[index].bricks;
            let range = bricks.start as usize..bricks.end as usize;
            if let Some(bricks) = self.bricks.get_mut(range) {
                bricks.fill(HIDDEN);
            }
        }
    }
}
