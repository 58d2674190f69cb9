//! Which picture is drawn next: that of the camera, and a finer one when it rests.

use puncta::View;
use std::time::{Duration, Instant};

/// How long the camera must rest before a finer picture is drawn.
pub(crate) const REST: Duration = Duration::from_millis(200);

/// What was asked for last.
#[derive(Debug)]
pub(crate) struct Asking {
    pub(crate) view: Option<View>,
    pub(crate) moved: Instant,
}

/// What is to be asked for.
#[derive(Debug)]
pub(crate) enum Wish {
    Nothing,
    /// Nothing yet.
    Wait(Duration),
    /// The view of the camera.
    Plain(View),
    /// The same with more pixels.
    Fine(View),
}

impl Default for Asking {
    fn default() -> Self {
        Self { view: None, moved: Instant::now() }
    }
}

/// A view with `factor` times as many rows and columns, if there can be one that is finer.
pub(crate) fn fine(view: &View, factor: u32) -> Option<View> {
    let side = |side: u32| side.saturating_mul(factor);
    let fine = view.clone().with_size(side(view.width()), side(view.height())).ok();
    fine.filter(|_| factor > 1)
}

impl Asking {
    /// What is to be asked for if this is the view of the camera, and notes it. A picture of a camera
    /// that rests has `factor` times as many rows and columns.
    pub(crate) fn wish(
        &mut self,
        view: &View,
        factor: u32,
        (is_settled, is_held): (bool, bool),
    ) -> Wish {
        let fine = fine(view, factor);
        let is_asked = self.view.as_ref() == Some(view);
        let is_fine = fine.is_some() && self.view == fine;
        if !(is_asked || is_fine && !is_held) {
            self.moved = Instant::now();
            self.view = Some(view.clone());
            return Wish::Plain(view.clone());
        }
        let Some(fine) = fine.filter(|_| is_asked && is_settled && !is_held) else {
            return Wish::Nothing;
        };
        let rested = self.moved.elapsed();
        if rested < REST {
            return Wish::Wait(REST - rested);
        }
        self.view = Some(fine.clone());
        Wish::Fine(fine)
    }
}
