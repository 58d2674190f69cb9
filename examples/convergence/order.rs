//! The orders in which bricks are drawn, by name.

use clap::ValueEnum;
use puncta::{
    Depth, Grid, Stage,
    occlusion::{Density, DensityFifo, Level, Transmittance},
};

/// An order of bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Order {
    /// As they lie in memory: no order by what is seen
    Memory,
    /// The nearest first
    Depth,
    /// Those with the fewest bricks in front first
    Level,
    /// Those with the least density in front first
    Density,
    /// The same as the thesis computes it: over the paths of the fewest bricks
    DensityFifo,
    /// Those first of which a record is expected to show the most pixels
    Transmittance,
    /// By what the finished picture shows of a brick: what no order can know, to see what is left to gain
    Hindsight,
}

impl Order {
    /// Those that are compared unless others are asked for.
    pub(crate) fn usual() -> Vec<Self> {
        let all = Self::value_variants().iter().copied();
        all.filter(|&order| !matches!(order, Self::Memory | Self::Hindsight)).collect()
    }

    /// The stage that makes this order; none makes that of hindsight without the finished picture.
    pub(crate) fn stage(self) -> Option<Box<dyn Stage<Grid>>> {
        Some(match self {
            Self::Memory => Box::new(()),
            Self::Depth => Box::new(Depth::default()),
            Self::Level => Box::new(Level::default()),
            Self::Density => Box::new(Density::default()),
            Self::DensityFifo => Box::new(DensityFifo::default()),
            Self::Transmittance => Box::new(Transmittance::default()),
            Self::Hindsight => return None,
        })
    }
}
