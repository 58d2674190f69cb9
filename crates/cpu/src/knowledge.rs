/*!
What is known of the bricks of a frame: where they lie on the screen, and which are hidden.

Bounds are found when they are first asked for, and kept for the frame. Blocks of bricks are tested
together: if a block lies behind what is drawn, so do its bricks, and their bounds are never found.
*/

use crate::drawing::Drawing;
use glam::DVec3;
use puncta_core::{Bounder, Camera, Content, ScreenBound};
use rayon::prelude::*;

/// The bound of what cannot be seen.
const HIDDEN: ScreenBound = ScreenBound { columns: [1, 0], rows: [1, 0], nearest: f32::INFINITY };

/// The place in the world and in memory of bricks and blocks, and how many there are.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    origin: DVec3,
    bricks: (usize, usize),
    blocks: (usize, usize),
}

impl Key {
    fn of<R>(content: &Content<'_, R>) -> Self {
        Self {
            origin: content.scene.origin,
            bricks: (content.bricks.as_ptr() as usize, content.bricks.len()),
            blocks: (content.blocks.as_ptr() as usize, content.blocks.len()),
        }
    }
}

/// The bounds of bricks and blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Knowledge {
    /// What this is about.
    content: Option<Key>,
    /// By brick: unknown, known, or empty if it cannot be seen.
    bricks: Vec<ScreenBound>,
    blocks: Vec<ScreenBound>,
}

impl Knowledge {
    /// Forgets everything: another picture begins.
    pub(crate) fn clear(&mut self) {
        self.content = None;
        self.bricks.clear();
        self.blocks.clear();
    }

    /// Makes room for these bricks.
    pub(crate) fn prepare<R>(&mut self, content: &Content<'_, R>, camera: &Camera) {
        let key = Key::of(content);
        if self.content == Some(key) {
            return;
        }
        self.content = Some(key);
        self.bricks.clear();
        self.bricks.resize(content.bricks.len(), ScreenBound::UNKNOWN);
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
        let blocks = self.blocks.iter_mut().zip(content.blocks).zip(hidden);
        for ((bound, block), _) in blocks.filter(|(_, is_hidden)| *is_hidden) {
            *bound = HIDDEN;
            let range = block.bricks.start as usize..block.bricks.end as usize;
            if let Some(bricks) = self.bricks.get_mut(range) {
                bricks.fill(HIDDEN);
            }
        }
    }
}
