//! Stages: what narrows and orders the bricks of a frame before they are drawn.

use crate::{View, Visible};
use glam::DVec3;

/// What a stage sees of a frame.
#[derive(Debug)]
pub struct Frame<'a, G: ?Sized> {
    /// The view to draw.
    pub view: &'a View,
    /// The world position that the boxes of the bricks are relative to.
    pub origin: DVec3,
    /// The spatial structure: a grid, or whatever else holds bricks.
    pub bricks: &'a G,
}

impl<G: ?Sized> Clone for Frame<'_, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<G: ?Sized> Copy for Frame<'_, G> {}

/// Narrows or orders the bricks in play.
///
/// What a stage drops is not drawn. So a stage that is only there to save time must not drop a brick
/// that can be seen; one that chooses what to show may. Tuples of two or three stages are stages and
/// run from left to right; so are closures.
///
/// # Examples
///
/// A user's own stage leaves out bricks of another floor of the building:
///
/// ```
/// use puncta_core::{Bricks, Frame, Stage, Visible};
///
/// struct Floor {
///     top: f32,
/// }
///
/// impl<G: Bricks> Stage<G> for Floor {
///     fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
///         let bricks = frame.bricks.bricks();
///         visible.bricks.retain(|brick| bricks[brick.index() as usize].bounds.min.z < self.top);
///     }
/// }
/// ```
pub trait Stage<G: ?Sized> {
    /// Drops or orders the bricks of `visible`, before anything is drawn.
    ///
    /// At first these are all bricks of `frame`, in the order in which it holds them.
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible);

    /// Drops or orders what is left while a picture is being drawn, after the renderer has looked how
    /// much each brick may still change ([`VisibleBrick::gain`](crate::VisibleBrick::gain)).
    ///
    /// By default everything stays as it is. It is not called for renderers that do not look.
    fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        let _ = (frame, visible);
    }
}

impl<G: ?Sized, F: FnMut(&Frame<'_, G>, &mut Visible)> Stage<G> for F {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self(frame, visible);
    }
}

impl<G: ?Sized> Stage<G> for () {
    fn apply(&mut self, _frame: &Frame<'_, G>, _visible: &mut Visible) {}
}

impl<G: ?Sized> Stage<G> for Box<dyn Stage<G> + '_> {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.as_mut().apply(frame, visible);
    }

    fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.as_mut().refine(frame, visible);
    }
}

impl<G: ?Sized> Stage<G> for Box<dyn Stage<G> + Send + '_> {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.as_mut().apply(frame, visible);
    }

    fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.as_mut().refine(frame, visible);
    }
}

impl<G: ?Sized, A: Stage<G>, B: Stage<G>> Stage<G> for (A, B) {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.apply(frame, visible);
        self.1.apply(frame, visible);
    }

    fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.refine(frame, visible);
        self.1.refine(frame, visible);
    }
}

impl<G: ?Sized, A: Stage<G>, B: Stage<G>, C: Stage<G>> Stage<G> for (A, B, C) {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.apply(frame, visible);
        self.1.apply(frame, visible);
        self.2.apply(frame, visible);
    }

    fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        self.0.refine(frame, visible);
        self.1.refine(frame, visible);
        self.2.refine(frame, visible);
    }
}
