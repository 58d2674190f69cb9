//! What the records that were seen before show at once, after the camera has moved a little.

use crate::{
    clock::{self, Span},
    compare::Target,
    counting::Counting,
    world::{World, focus},
};
use anyhow::{Context, Result};
use puncta::{Depth, FrustumCull, NO_RECORD, Picture, Pipeline};

/// How the camera moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    /// It looks to the right.
    Turn,
    /// It goes around the point that is seen in the middle.
    Orbit,
}

impl Motion {
    pub(crate) const ALL: [Self; 2] = [Self::Turn, Self::Orbit];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Turn => "turn",
            Self::Orbit => "orbit",
        }
    }
}

/// What was found after a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    pub(crate) motion: Motion,
    pub(crate) degrees: f64,
    /// The number of records that had been seen and were drawn again.
    pub(crate) recalled: u64,
    /// The number of pixels that could still change after that.
    pub(crate) open: u64,
    /// The time of the first step, with culling and ordering, and that of the whole picture.
    pub(crate) first: Span,
    pub(crate) whole: Span,
    pub(crate) agreement: Agreement,
}

/// How many pixels of a first picture agree with the final one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Agreement {
    pub(crate) pixels: u64,
    /// Those that show a record in the end.
    pub(crate) covered: u64,
    /// Those with the final record, and those with its depth as well.
    pub(crate) same_record: u64,
    pub(crate) same: u64,
    /// Those with the final record, of those that show a record in the end.
    pub(crate) covered_same_record: u64,
}

impl Agreement {
    fn of(first: &Picture, last: &Picture) -> Self {
        let count = |is: &dyn Fn(usize) -> bool| {
            (0..last.id.len()).filter(|&pixel| is(pixel)).count() as u64
        };
        let same_record = |pixel: usize| first.id[pixel] == last.id[pixel];
        let same_depth = |pixel: usize| first.depth[pixel].to_bits() == last.depth[pixel].to_bits();
        let is_covered = |pixel: usize| last.id[pixel] != NO_RECORD;
        Self {
            pixels: last.id.len() as u64,
            covered: count(&is_covered),
            same_record: count(&same_record),
            same: count(&|pixel| same_record(pixel) && same_depth(pixel)),
            covered_same_record: count(&|pixel| is_covered(pixel) && same_record(pixel)),
        }
    }
}

/// Moves the camera away from a view, and draws what follows.
pub(crate) fn measure(
    world: &World,
    target: &Target<'_>,
    motion: Motion,
    degrees: f64,
) -> Result<Turned> {
    let view = target.view;
    let pivot = match motion {
        Motion::Turn => view.eye(),
        Motion::Orbit => focus(view, target.picture).context("there is nothing to go around")?,
    };
    let next = view.clone().orbited(pivot, degrees.to_radians(), 0.0);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), Counting::default());
    pipeline.render(world.scene(), &world.grid, view)?;
    let (begun, mut time) =
        clock::time(|| pipeline.progressive(world.scene(), &world.grid, &next, u64::MAX));
    let mut steps = begun?;
    let mut first = None;
    loop {
        let (step, span) = clock::time(|| steps.next());
        let Some(progress) = step.transpose()? else { break };
        time += span;
        if first.is_none() {
            first = Some((progress, time, steps.picture()?));
        }
    }
    let (progress, first, picture) = first.context("nothing is in view")?;
    let agreement = Agreement::of(&picture, &steps.picture()?);
    let (recalled, open) = (progress.recalled, progress.open);
    Ok(Turned { motion, degrees, recalled, open, first, whole: time, agreement })
}
