/*!
The uniform grid: records sorted in place into bricks, and what is known about each brick.

```
use puncta_core::Sphere;
use puncta_grid::{Grid, GridConfig};

let mut spheres: Vec<Sphere> =
    (0..1000_u16).map(|i| Sphere::new([f32::from(i * 7 % 1000), 0.0, 0.0], 0.5)).collect();
let grid = Grid::sort(&mut spheres, &GridConfig::longest_side(10))?;
assert_eq!(grid.dims(), [10, 1, 1]);
let brick = &grid.bricks()[3];
for sphere in &spheres[brick.records.start as usize..brick.records.end as usize] {
    assert!((300.0..400.0).contains(&sphere.center[0]));
}
# Ok::<(), puncta_grid::Error>(())
```

The grid follows section 3.1.1 of *Visibility-Driven Progressive Rendering of Large Particle Data*,
the thesis whose methods puncta is built on: cells are cubes; a histogram over the cells gives each
brick its place; a second pass swaps records into their places. It owns no records, and beside them
it needs 8 bytes for each cell while sorting and 44 bytes for each occupied brick afterwards.
*/

#[cfg(all(target_endian = "little", any(unix, windows)))]
mod bricks;
mod cells;
mod census;
mod codes;
mod dispatch;
mod error;
mod fit;
mod leaf;
mod partition;
mod rows;
mod sort;

#[cfg(all(target_endian = "little", any(unix, windows)))]
pub use crate::bricks::{
    BrickFile, ConvertConfig, ConvertError, ConvertStage, ConvertStep, ConvertSummary, Invalid,
    OpenError, Verify, convert, convert_watched,
};
pub use crate::{cells::Cells, error::Error, fit::Fit};

use crate::{
    codes::Coder,
    leaf::{Bricks, How},
    rows::Rows,
};
use puncta_core::{Brick, MAX_RECORDS, Record, Scene};

/// How to lay the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridConfig {
    /// How fine it is.
    pub resolution: Resolution,
    /// Which box the cells fill.
    pub fit: Fit,
}

/// How fine a grid is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// The number of cells along the longest side of the box that the cells fill.
    LongestSide(u32),
    /// About this many records in a brick, if they were spread evenly over the box that the cells
    /// fill; more if that would be more cells than a grid can have.
    RecordsPerBrick(u32),
    /// The side of a cell, in units of the data.
    Width(f32),
}

impl Default for Resolution {
    fn default() -> Self {
        Self::RecordsPerBrick(512)
    }
}

impl GridConfig {
    /// A grid with this many cells along the longest side of the data.
    #[must_use]
    pub const fn longest_side(cells: u32) -> Self {
        Self { resolution: Resolution::LongestSide(cells), fit: Fit::Robust }
    }
}

/// The bricks of a scene: one for each cell that holds records.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    cells: Cells,
    layout: codes::Layout,
    bricks: Vec<Brick>,
    /// The code of the cell of each brick, ascending.
    codes: Vec<u32>,
}

impl Grid {
    /// Sorts records into bricks, in place.
    ///
    /// # Errors
    ///
    /// When a position or radius is not finite, a radius is negative, there are too many records,
    /// or the resolution asks for too many cells. The records keep their order then.
    pub fn sort<R: Record>(records: &mut [R], config: &GridConfig) -> Result<Self, Error> {
        if records.len() > MAX_RECORDS {
            return Err(puncta_core::Error::TooManyRecords { records: records.len() }.into());
        }
        Self::sort_rows(Rows::new(records), config)
    }

    /// Sorts the records of a scene into bricks, in place, and their attributes with them.
    ///
    /// The order they had is kept in their ids: [`Scene::id`] gives the same index as before. Columns
    /// that are shared are copied first.
    ///
    /// # Errors
    ///
    /// As [`Grid::sort`], and when the scene is not valid.
    pub fn sort_scene<R: Record>(scene: &mut Scene<R>, config: &GridConfig) -> Result<Self, Error> {
        scene.validate()?;
        scene.keep_order();
        Self::sort_rows(Rows::of_scene(scene), config)
    }

    fn sort_rows<R: Record>(rows: Rows<'_, R>, config: &GridConfig) -> Result<Self, Error> {
        if rows.len() == 0 {
            let layout = codes::Layout::new([0; 3], 0);
            return Ok(Self { cells: Cells::EMPTY, layout, bricks: vec![], codes: vec![] });
        }
        let records = &*rows.records;
        let mut place = match config.fit {
            Fit::Robust => fit::inner(records),
            Fit::Whole => fit::whole(census::bounds(records)?),
        };
        let mut cells = Cells::new(&place, records.len(), config.resolution)?;
        let (layout, coder, census) = loop {
            let bits = codes::Layout::new(cells.dims(), 0).bits();
            let layout =
                codes::Layout::new(cells.dims(), sort::split_bits::<R>(records.len(), bits));
            let coder = Coder::new(&cells, layout.digit(bits - layout.block_bits()..bits));
            let census = census::take(records, &coder)?;
            cells = cells.around(census.bounds);
            let overflow = fit::overflow(&place, &census.bounds, cells.width());
            if place.overflow == overflow {
                break (layout, coder, census);
            }
            place.overflow = overflow;
            cells = Cells::new(&place, records.len(), config.resolution)?;
        };
        let how = How { coder, layout, sides: cells.sides(), stable: false };
        let Bricks { bricks, codes } = sort::sort(rows, how, &census.counts);
        Ok(Self { cells, layout, bricks, codes })
    }

    /// The cells of the grid.
    #[must_use]
    pub const fn cells(&self) -> &Cells {
        &self.cells
    }

    /// The number of cells along each axis.
    #[must_use]
    pub const fn dims(&self) -> [u32; 3] {
        self.cells.dims()
    }

    /// The bricks, in the order of their records.
    #[must_use]
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// The place in the grid of a brick; `None` if there is no brick `brick`.
    #[must_use]
    pub fn cell_of(&self, brick: u32) -> Option<[u32; 3]> {
        self.codes.get(brick as usize).map(|&code| self.layout.decode(code))
    }

    /// The brick at a place in the grid; `None` if the cell is empty or outside.
    #[must_use]
    pub fn brick_at(&self, place: [u32; 3]) -> Option<u32> {
        let code = self.cells.contains(place).then(|| self.layout.encode(place))?;
        self.codes.binary_search(&code).ok().and_then(|brick| u32::try_from(brick).ok())
    }

    /// The bytes that the grid holds beside the records.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.bricks.as_slice()) + size_of_val(self.codes.as_slice())
    }
}

impl AsRef<[Brick]> for Grid {
    fn as_ref(&self) -> &[Brick] {
        &self.bricks
    }
}
