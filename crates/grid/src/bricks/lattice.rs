//! The grid over records that are not in memory: that of [`Grid::sort_scene`](crate::Grid).

use super::{convert::ConvertConfig, error::Trouble, spill::Spill};
use crate::{
    Cells, Fit,
    codes::Coder,
    fit,
    leaf::How,
    sort::{self, LeafRows},
};
use puncta_core::Sphere;

/// Cells, and how to sort rows into them.
#[derive(Debug)]
pub(crate) struct Lattice {
    pub(crate) cells: Cells,
    /// The coder's digit is that of the blocks.
    pub(crate) how: How,
}

impl Lattice {
    /// Lays the cells over the records of a spill.
    pub(crate) fn lay(spill: &Spill, config: &ConvertConfig) -> Result<Self, Trouble> {
        let records = usize::try_from(spill.rows).unwrap_or(usize::MAX);
        if records == 0 {
            return Ok(Self::over(Cells::EMPTY, 0));
        }
        let (bounds, resolution) = (spill.bounds, config.grid.resolution);
        let mut place = match config.grid.fit {
            Fit::Robust => {
                let sample = fit::places(records).map(|at| spill.position(at as u64));
                fit::inner_of(&sample.collect::<Result<Vec<_>, _>>()?)
            }
            Fit::Whole => fit::whole(bounds),
        };
        let mut cells = Cells::new(&place, records, resolution)?;
        loop {
            let overflow = fit::overflow(&place, &bounds, cells.width());
            if place.overflow == overflow {
                return Ok(Self::over(cells.around(bounds), records));
            }
            place.overflow = overflow;
            cells = Cells::new(&place, records, resolution)?;
        }
    }

    fn over(cells: Cells, records: usize) -> Self {
        let layout = sort::layout::<Sphere>(&cells, records);
        let (coder, leaf) =
            (Coder::new(&cells, layout.block()), LeafRows::new::<Sphere>(&cells, records));
        let how = How { coder, layout, leaf, sides: cells.sides(), stable: true };
        Self { cells, how }
    }
}
