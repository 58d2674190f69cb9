//! The order of hindsight: by what the finished picture shows of each brick.
//!
//! No order can know that before. Taking first the bricks that lower the squared error of the empty
//! picture the most, for each of their records, has the exact picture first of all orders of whole
//! bricks, and tells about how much there is to gain before. It is no bound for pictures that are nearly
//! right: a pixel that shows a neighbor for now often has nearly the color that it gets.

use crate::compare::{Sketch, Target};
use anyhow::Result;
use puncta::{Frame, Grid, NO_RECORD, Stage, Visible};

/// Orders bricks by what a finished picture shows of them.
#[derive(Clone, Debug)]
pub(crate) struct Hindsight {
    /// For each brick, the share of the squared error that it takes away, for each record.
    gains: Vec<f64>,
}

impl Hindsight {
    pub(crate) fn new(target: &Target<'_>, grid: &Grid) -> Result<Self> {
        let empty = Sketch::new(target)?.image;
        let mut gains = vec![0.0; grid.bricks().len()];
        let shown = target.picture.id.iter().zip(&empty.pixels).zip(&target.image.pixels);
        for ((&id, before), after) in shown.filter(|((id, _), _)| **id != NO_RECORD) {
            let brick = grid.bricks().partition_point(|brick| brick.records.end <= id);
            let channels = before[..3].iter().zip(&after[..3]);
            let squares = channels.map(|(&a, &b)| f64::from(a.abs_diff(b)).powi(2));
            // Something is to be gained from every visible pixel.
            gains[brick] += squares.sum::<f64>() + 1e-3;
        }
        for (gain, brick) in gains.iter_mut().zip(grid.bricks()) {
            *gain /= brick.records.len() as f64;
        }
        Ok(Self { gains })
    }
}

impl Stage<Grid> for Hindsight {
    fn apply(&mut self, _frame: &Frame<'_, Grid>, visible: &mut Visible) {
        let gain = |index: u32| self.gains.get(index as usize).copied().unwrap_or(0.0);
        visible.bricks.sort_unstable_by(|a, b| {
            let by_gain = gain(b.index()).total_cmp(&gain(a.index()));
            by_gain.then(a.near().total_cmp(&b.near())).then(a.index().cmp(&b.index()))
        });
    }
}
