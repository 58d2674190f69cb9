//! The grid over records that are not in memory: that of [`Grid::sort_scene`](crate::Grid).

use super::{convert::ConvertConfig, error::Trouble, spill::Spill};
use crate::{
    Cells, Fit,
    codes::{Coder, Layout},
    fit,
    leaf::How,
    sort,
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
        let bits = Layout::new(cells.dims(), 0).bits();
        let layout = Layout::new(cells.dims(), sort::split_bits::<Sphere>(records, bits));
        let coder = Coder::new(&cells, layout.digit(bits - layout.block_bits()..bits));
        let how = How { coder, layout, sides: cells.sides(), stable: false };
        Self { cells, how }
    }
}
