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
the thesis whose methods puncta is built on: cells are cubes, and records are sorted in place by
counting. The thesis sorts in one thread, straight into cells. Here all cores sort, in two steps that
suit the memory: into some thousand buckets first, then each bucket within the cache. It owns no
records. Beside them it needs 45 bytes for each brick, 4 more if there are colors, and while sorting
up to 20 more, a megabyte, and up to 2.5 megabytes for each thread: those only if cells and records
are many. Cells without records cost nothing.
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
mod measure;
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
    census::Census,
    codes::{Coder, Layout},
    leaf::How,
    rows::Rows,
};
use puncta_core::{Block, Brick, Bricks, MAX_RECORDS, NO_RECORD, Record, Scene};
use rayon::prelude::*;
use std::ops::Range;

/// How to lay the grid.
///
/// # Examples
///
/// A town with a few birds high above it: they do not make the cells of the town larger.
///
/// ```
/// use puncta_core::Sphere;
/// use puncta_grid::{Grid, GridConfig, Resolution};
///
/// let house = |i: u16| Sphere::new([f32::from(i % 50), f32::from(i / 50), 0.0], 0.5);
/// let mut spheres: Vec<Sphere> = (0..2500).map(house).collect();
/// spheres.push(Sphere::new([20.0, 20.0, 4000.0], 0.1));
/// let config = GridConfig { resolution: Resolution::Width(5.0), ..GridConfig::default() };
/// let grid = Grid::sort(&mut spheres, &config)?;
/// assert_eq!(grid.dims(), [10, 10, 2]);
/// assert_eq!(grid.bricks().len(), 101);
/// # Ok::<(), puncta_grid::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridConfig {
    /// How fine it is.
    pub resolution: Resolution,
    /// Which box the cells fill.
    pub fit: Fit,
    /// In which order the records of a brick are.
    pub order: Order,
}

/// The order of the records within a brick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Some order. It is the same for any number of threads.
    #[default]
    Any,
    /// The order that they had before, or that their ids tell if they have ids. This takes two to
    /// three times as long, and for records without ids 4 bytes each while sorting.
    Stable,
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
        Self { resolution: Resolution::LongestSide(cells), fit: Fit::Robust, order: Order::Any }
    }
}

/// The bricks of a scene: one for each cell that holds records.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    cells: Cells,
    layout: Layout,
    bricks: Vec<Brick>,
    blocks: Vec<Block>,
    /// The code of the cell of each brick, ascending.
    codes: Vec<u32>,
    /// The mean color of each brick, if the records have colors.
    colors: Option<Vec<[u8; 4]>>,
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
        match config.order {
            Order::Any => Self::sort_rows(Rows::new(records), config),
            Order::Stable => {
                let mut ids = order(records.len());
                Self::sort_rows(Rows::with_ids(records, &mut ids), config)
            }
        }
    }

    /// Sorts the records of a scene into bricks, in place, and their attributes with them.
    ///
    /// The order they had is kept in their ids: [`Scene::id`] gives the same index as before. Columns
    /// that are shared are copied first.
    ///
    /// # Errors
    ///
    /// As [`Grid::sort`], and when the scene is not valid. The scene is as it was then.
    pub fn sort_scene<R: Record>(scene: &mut Scene<R>, config: &GridConfig) -> Result<Self, Error> {
        scene.validate()?;
        let (count, had_ids) = (scene.records.len(), scene.attributes.ids.is_some());
        scene.attributes.ids.get_or_insert_with(|| order(count).into());
        let sorted = Self::sort_rows(Rows::of_scene(scene), config);
        if sorted.is_err() && !had_ids {
            scene.attributes.ids = None;
        }
        sorted
    }

    fn sort_rows<R: Record>(rows: Rows<'_, R>, config: &GridConfig) -> Result<Self, Error> {
        let colors = rows.colors.map(|_| Vec::new());
        if rows.len() == 0 {
            let (cells, layout) = (Cells::EMPTY, Layout::new([0; 3], 0));
            return Ok(Self::new(cells, layout, (vec![], vec![]), colors));
        }
        let records = &*rows.records;
        let mut placement = match config.fit {
            Fit::Robust => fit::inner(records),
            Fit::Whole => fit::whole(census::bounds(records)?),
        };
        let mut survey = Survey::new(records, &placement, config.resolution)?;
        let overflow = fit::overflow(&placement, &survey.census.bounds, survey.cells.width());
        if overflow != placement.overflow {
            // Once is enough: cells are as wide as before.
            placement.overflow = overflow;
            survey = Survey::new(records, &placement, config.resolution)?;
        }
        let Survey { cells, layout, coder, census } = survey;
        let cells = cells.around(census.bounds);
        let stable = config.order == Order::Stable;
        let leaf = sort::LeafRows::new::<R>(&cells, rows.len());
        let how = How { coder, layout, leaf, sides: cells.sides(), stable };
        let found = sort::sort(rows, how, &census.counts);
        let colors = colors.map(|_| found.colors);
        Ok(Self::new(cells, layout, (found.bricks, found.codes), colors))
    }

    /// The grid of these bricks and their codes.
    pub(crate) fn new(
        cells: Cells,
        layout: Layout,
        (bricks, codes): (Vec<Brick>, Vec<u32>),
        colors: Option<Vec<[u8; 4]>>,
    ) -> Self {
        let block = |(run, bricks): (usize, &[Brick])| {
            Block::of_run(u32::try_from(run * Block::RUN).unwrap_or(u32::MAX), bricks)
        };
        let blocks =
            bricks.par_chunks(Block::RUN).enumerate().with_min_len(64).map(block).collect();
        Self { cells, layout, bricks, blocks, codes, colors }
    }

    /// Measures the bricks again that hold any of these records, which were changed where they are
    /// ([`Column::edit`](puncta_core::Column::edit)). Records stay in their bricks, even if they have
    /// moved out of their cells: what has moved far is drawn right, but is worse to skip.
    ///
    /// # Errors
    ///
    /// When a position or radius of these bricks is not finite, or a radius is negative. The grid is as
    /// it was then, and must not be used for these records.
    pub fn refit<R: Record>(&mut self, records: &[R], range: Range<usize>) -> Result<(), Error> {
        let is_in = |brick: &Brick| {
            (brick.records.start as usize) < range.end && range.start < brick.records.end as usize
        };
        let first = self.bricks.partition_point(|brick| brick.records.end as usize <= range.start);
        let count = self.bricks[first..].iter().take_while(|brick| is_in(brick)).count();
        let sides = self.cells.sides();
        let measured: Result<Vec<Brick>, Error> = self.bricks[first..first + count]
            .iter()
            .map(|brick| {
                let (start, end) = (brick.records.start as usize, brick.records.end as usize);
                let members = records.get(start..end).unwrap_or_default();
                census::bounds(members).map_err(|error| error.after(start))?;
                Ok(measure::measure(members, brick.records.start, sides))
            })
            .collect();
        for (brick, measured) in self.bricks[first..].iter_mut().zip(measured?) {
            *brick = Brick { records: brick.records.clone(), ..measured };
        }
        let blocks = first / Block::RUN..(first + count).div_ceil(Block::RUN);
        for block in self.blocks.get_mut(blocks).unwrap_or_default() {
            let run = block.bricks.start as usize..block.bricks.end as usize;
            *block = Block::of_run(block.bricks.start, &self.bricks[run]);
        }
        Ok(())
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

    /// The mean color of the records of each brick, if the scene has colors: the mean of the stored
    /// values of each channel. The grid of a brick file has none.
    #[must_use]
    pub fn colors(&self) -> Option<&[[u8; 4]]> {
        self.colors.as_deref()
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
        size_of_val(self.bricks.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.codes.as_slice())
            + self.colors.as_ref().map_or(0, |colors| size_of_val(colors.as_slice()))
    }
}

impl Bricks for Grid {
    fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}

/// Cells, and what a look at all records finds for them.
struct Survey {
    cells: Cells,
    layout: Layout,
    coder: Coder,
    census: Census,
}

impl Survey {
    fn new<R: Record>(
        records: &[R],
        placement: &cells::Placement,
        resolution: Resolution,
    ) -> Result<Self, Error> {
        let cells = Cells::new(placement, records.len(), resolution)?;
        let layout = sort::layout::<R>(&cells, records.len());
        let coder = Coder::new(&cells, layout.block());
        let census = census::take(records, &coder)?;
        Ok(Self { cells, layout, coder, census })
    }
}

/// The indices of records, which are not too many, in their order.
fn order(records: usize) -> Vec<u32> {
    let count = u32::try_from(records).unwrap_or(NO_RECORD);
    (0..count).into_par_iter().collect()
}
