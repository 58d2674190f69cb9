//! The order of drawing, as a stage that changes when the user chooses another one.

use crate::cli::Order;
use puncta::{
    Density, Depth, FrustumCull, Grid, Level, Stage, Transmittance, Visible, core::Frame,
};
use std::sync::{Arc, Mutex, PoisonError};

/// Culls, and orders as was chosen last.
#[derive(Debug, Default)]
pub(crate) struct Ordering {
    chosen: Arc<Mutex<Option<Order>>>,
    /// What the picture that is being drawn began with.
    now: Option<Order>,
    depth: Depth,
    level: Level,
    density: Density,
    transmittance: Transmittance,
}

impl Ordering {
    pub(crate) fn new(chosen: Arc<Mutex<Option<Order>>>) -> Self {
        Self { chosen, ..Self::default() }
    }

    fn stage(&mut self) -> &mut dyn Stage<Grid> {
        match self.now {
            None | Some(Order::Depth) => &mut self.depth,
            Some(Order::Level) => &mut self.level,
            Some(Order::Density) => &mut self.density,
            Some(Order::Transmittance) => &mut self.transmittance,
        }
    }
}

impl Stage<Grid> for Ordering {
    fn apply(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        self.now = *self.chosen.lock().unwrap_or_else(PoisonError::into_inner);
        FrustumCull.apply(frame, visible);
        self.stage().apply(frame, visible);
    }

    fn refine(&mut self, frame: &Frame<'_, Grid>, visible: &mut Visible) {
        self.stage().refine(frame, visible);
    }
}
