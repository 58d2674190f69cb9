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

mod cells;
mod error;
mod sort;

pub use crate::{
    cells::{Cells, Resolution},
    error::Error,
};

use puncta_core::{Aabb, Brick, Record, Scene};

/// How to lay the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridConfig {
    /// How fine it is.
    pub resolution: Resolution,
}

impl GridConfig {
    /// A grid with this many cells along the longest side of the data.
    #[must_use]
    pub const fn longest_side(cells: u32) -> Self {
        Self { resolution: Resolution::LongestSide(cells) }
    }
}

/// The bricks of a scene: one for each cell that holds records, in row order (x fastest).
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    cells: Cells,
    bricks: Vec<Brick>,
    /// The index of the cell of each brick, ascending.
    brick_cells: Vec<u32>,
}

impl Grid {
    /// Sorts records into bricks, in place.
    ///
    /// # Errors
    ///
    /// When a position or radius is not finite, a radius is negative, there are too many records,
    /// or the resolution asks for too many cells. The records keep their order then.
    pub fn sort<R: Record>(records: &mut [R], config: &GridConfig) -> Result<Self, Error> {
        let bounds = sort::bounds(records)?;
        let cells = Cells::new(bounds, records.len(), config.resolution)?;
        let counts = sort::count(records, &cells);
        sort::permute(records, &counts, |record| cells.index(record.position()));
        Ok(Self::of_sorted(records, cells, &counts))
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
        let bounds = sort::bounds(&scene.records)?;
        let cells = Cells::new(bounds, scene.records.len(), config.resolution)?;
        let counts = sort::count(&scene.records, &cells);
        scene.keep_order();
        sort::permute(scene, &counts, |record: &R| cells.index(record.position()));
        Ok(Self::of_sorted(&scene.records, cells, &counts))
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
        self.brick_cells.get(brick as usize).map(|&cell| self.cells.place(cell))
    }

    /// The brick at a place in the grid; `None` if the cell is empty or outside.
    #[must_use]
    pub fn brick_at(&self, place: [u32; 3]) -> Option<u32> {
        let inside = place.iter().zip(self.dims()).all(|(&at, dim)| at < dim);
        let cell = inside.then(|| self.cells.flat(place))?;
        self.brick_cells.binary_search(&cell).ok().and_then(|brick| u32::try_from(brick).ok())
    }

    /// The bytes that the grid holds beside the records.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.bricks.as_slice()) + size_of_val(self.brick_cells.as_slice())
    }

    /// The grid of records that lie in the order of their cells.
    fn of_sorted<R: Record>(records: &[R], cells: Cells, counts: &[u32]) -> Self {
        let occupied = counts.iter().filter(|&&count| count > 0).count();
        let mut grid = Self {
            cells,
            bricks: Vec::with_capacity(occupied),
            brick_cells: Vec::with_capacity(occupied),
        };
        let mut start = 0_u32;
        for (cell, &count) in (0_u32..).zip(counts).filter(|&(_, &count)| count > 0) {
            let end = start + count;
            let members = &records[start as usize..end as usize];
            grid.bricks.push(brick(members, start, &grid.cells.bounds(grid.cells.place(cell))));
            grid.brick_cells.push(cell);
            start = end;
        }
        grid
    }
}

impl AsRef<[Brick]> for Grid {
    fn as_ref(&self) -> &[Brick] {
        &self.bricks
    }
}

/// The brick of these records, the first of which is record `start` of the scene.
fn brick<R: Record>(members: &[R], start: u32, cell: &Aabb) -> Brick {
    let mut bounds = Aabb::EMPTY;
    let (mut radius_max, mut volume) = (0.0_f32, 0.0_f64);
    for record in members {
        bounds.add(record.position());
        radius_max = radius_max.max(record.radius());
        volume += f64::from(record.radius()).powi(3);
    }
    volume *= 4.0 / 3.0 * std::f64::consts::PI;
    // Flat cells would have no volume: each side is at least that of the largest sphere.
    let sides =
        (cell.max - cell.min).as_dvec3().max(glam::DVec3::splat(2.0 * f64::from(radius_max)));
    let density = volume / sides.element_product();
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let density = if density.is_finite() { density as f32 } else { 0.0 };
    let end = start + u32::try_from(members.len()).unwrap_or(u32::MAX - start);
    Brick { records: start..end, bounds, radius_max, density }
}
