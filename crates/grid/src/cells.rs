/*!
The cells of a uniform grid, and the one that holds a position.

A position must lie inside the box of its cell, in floating point, or culling by boxes would be
wrong. The usual index, `floor((p - min) / width)`, does not promise that: its rounding and that of
the box differ. So the faces between cells are numbers of their own, one ascending list for each
axis, and a cell is *defined* as the half-open box between neighboring faces. The quotient is a
guess, corrected by comparing with the faces; the last face lies just above the largest coordinate.
Every position within the data's box has exactly one cell, by construction.
*/

use crate::Error;
use glam::{DVec3, Vec3};
use puncta_core::Aabb;

/// The largest number of cells: sorting needs a gigabyte for them.
pub(crate) const CELLS_MAX: u64 = 1 << 27;

/// How fine a grid is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// The number of cells along the longest side of the data.
    LongestSide(u32),
    /// About this many records in a brick, if they were spread evenly over the box of the data; more
    /// if that would be more cells than a grid can have.
    RecordsPerBrick(u32),
}

impl Default for Resolution {
    fn default() -> Self {
        Self::RecordsPerBrick(512)
    }
}

/// Equal cubes that fill a box; the last ones may reach beyond it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    dims: [u32; 3],
    /// The faces between cells along each axis: one more than there are cells.
    faces: [Vec<f32>; 3],
    min: DVec3,
    /// Cells per unit of length.
    scale: f64,
}

impl Cells {
    /// The cells over the box of `records` positions.
    pub(crate) fn new(bounds: Aabb, records: usize, resolution: Resolution) -> Result<Self, Error> {
        if records == 0 {
            return Ok(Self {
                dims: [0; 3],
                faces: [vec![], vec![], vec![]],
                min: DVec3::ZERO,
                scale: 0.0,
            });
        }
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let sides = max - min;
        let longest = match resolution {
            Resolution::LongestSide(cells) => f64::from(cells),
            Resolution::RecordsPerBrick(target) => {
                // Less than there may be, as whole numbers of cells are a little more than wished.
                let bricks = records as f64 / f64::from(target.max(1));
                cells_along_longest(sides, bricks.min(CELLS_MAX as f64 * 0.6))
            }
        };
        // A point has no extent and one cell; its width is as good as any other.
        let width = sides.max_element() / longest;
        let width = if width > 0.0 { width } else { 1.0 };
        // Cells that are thinner than the spacing of the numbers themselves would hold nothing.
        let width = width.max(spacing(&bounds));
        let count = |side: f64| (side / width).ceil().clamp(1.0, longest.max(1.0));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 2^32")]
        let dims = sides.to_array().map(|side| count(side) as u64);
        let total = dims.iter().try_fold(1_u64, |product, &dim| product.checked_mul(dim));
        if longest < 1.0 || total.is_none_or(|total| total > CELLS_MAX) {
            let dims = if longest < 1.0 { [0; 3] } else { dims };
            return Err(Error::Resolution { dims });
        }
        let dims = dims.map(|dim| u32::try_from(dim).unwrap_or(u32::MAX));
        let axis = |axis: usize| faces(bounds.min[axis], bounds.max[axis], width, dims[axis]);
        Ok(Self { dims, faces: [axis(0), axis(1), axis(2)], min, scale: 1.0 / width })
    }

    /// The number of cells along each axis.
    #[must_use]
    pub const fn dims(&self) -> [u32; 3] {
        self.dims
    }

    /// The number of cells.
    #[must_use]
    pub fn count(&self) -> usize {
        self.dims.iter().map(|&dim| dim as usize).product()
    }

    /// The box of a cell; positions on its upper faces belong to the next cell.
    ///
    /// # Panics
    ///
    /// When there is no such cell.
    #[must_use]
    pub fn bounds(&self, place: [u32; 3]) -> Aabb {
        let face = |axis: usize, up: usize| self.faces[axis][place[axis] as usize + up];
        Aabb {
            min: Vec3::new(face(0, 0), face(1, 0), face(2, 0)),
            max: Vec3::new(face(0, 1), face(1, 1), face(2, 1)),
        }
    }

    /// The flat index of the cell that holds a position of the data.
    #[inline]
    pub(crate) fn index(&self, position: Vec3) -> usize {
        let [x, y, z] = position.to_array();
        let (dim_x, dim_y) = (self.dims[0] as usize, self.dims[1] as usize);
        (self.along(2, z) * dim_y + self.along(1, y)) * dim_x + self.along(0, x)
    }

    /// The flat index of a place.
    pub(crate) fn flat(&self, [x, y, z]: [u32; 3]) -> u32 {
        (z * self.dims[1] + y) * self.dims[0] + x
    }

    /// The place with this flat index.
    pub(crate) fn place(&self, flat: u32) -> [u32; 3] {
        let row = flat / self.dims[0];
        [flat % self.dims[0], row % self.dims[1], row / self.dims[1]]
    }

    /// The cell along an axis that holds a coordinate of the data.
    #[inline]
    fn along(&self, axis: usize, coordinate: f32) -> usize {
        let faces = &self.faces[axis];
        let guess = (f64::from(coordinate) - self.min[axis]) * self.scale;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
        let mut cell = (guess as usize).min(faces.len() - 2);
        while cell > 0 && coordinate < faces[cell] {
            cell -= 1;
        }
        while cell + 2 < faces.len() && coordinate >= faces[cell + 1] {
            cell += 1;
        }
        cell
    }
}

/// The largest distance between neighboring `f32` along the sides that have an extent.
fn spacing(bounds: &Aabb) -> f64 {
    let along = |axis: usize| {
        let largest = bounds.min[axis].abs().max(bounds.max[axis].abs());
        let has_extent = bounds.min[axis] < bounds.max[axis];
        if has_extent { f64::from(largest) - f64::from(largest.next_down()) } else { 0.0 }
    };
    (0..3).map(along).fold(0.0, f64::max)
}

/// The ascending faces of `count` cells from `min` to just above `max`.
fn faces(min: f32, max: f32, width: f64, count: u32) -> Vec<f32> {
    #[expect(clippy::cast_possible_truncation, reason = "rounding keeps the order")]
    let face = |i: u32| (f64::from(min) + f64::from(i) * width) as f32;
    let inner = (0..count).map(|i| face(i).clamp(min, max));
    inner.chain([face(count).max(max.next_up())]).collect()
}

/// How many cells the longest side must have for about `bricks` cubes in a box of these sides.
///
/// Sides shorter than a cell count as one cell: they do not make the cubes smaller.
fn cells_along_longest(sides: DVec3, bricks: f64) -> f64 {
    let mut sides = sides.to_array();
    sides.sort_by(|a, b| b.total_cmp(a));
    let [a, b, c] = sides;
    let bricks = bricks.max(1.0);
    let cube = (a * b * c / bricks).cbrt();
    let square = (a * b / bricks).sqrt();
    let width = if c >= cube && cube > 0.0 {
        cube
    } else if b >= square && square > 0.0 {
        square
    } else {
        a / bricks
    };
    if width > 0.0 { (a / width).round().max(1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_and_thin_boxes_get_the_wanted_number_of_bricks() {
        assert_eq!(cells_along_longest(DVec3::new(2.0, 2.0, 2.0), 1000.0), 10.0);
        assert_eq!(cells_along_longest(DVec3::new(0.0, 2.0, 2.0), 100.0), 10.0);
        assert_eq!(cells_along_longest(DVec3::new(0.0, 0.0, 7.0), 100.0), 100.0);
        assert_eq!(cells_along_longest(DVec3::ZERO, 100.0), 1.0);
        assert_eq!(cells_along_longest(DVec3::new(1.0, 1.0, 1e-9), 100.0), 10.0);
    }

    #[test]
    fn cells_are_no_thinner_than_the_numbers_allow() {
        let bounds = Aabb { min: Vec3::X, max: Vec3::X.with_x(1.0_f32.next_up()) };
        let cells = Cells::new(bounds, 3_000_000, Resolution::default()).unwrap();
        assert!(cells.dims()[0] <= 2, "{:?}", cells.dims());
    }

    #[test]
    fn a_wish_for_too_many_bricks_is_lowered() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        for records in [1 << 28, u32::MAX as usize] {
            let cells = Cells::new(bounds, records, Resolution::RecordsPerBrick(1)).unwrap();
            assert!(cells.count() as u64 <= CELLS_MAX && cells.count() as u64 > CELLS_MAX / 2);
        }
    }

    #[test]
    fn resolutions_beyond_the_limit_are_refused() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let cells = |n| Cells::new(bounds, 10, Resolution::LongestSide(n));
        assert!(cells(512).is_ok());
        assert_eq!(cells(0), Err(Error::Resolution { dims: [0; 3] }));
        let error = cells(u32::MAX).unwrap_err();
        assert!(matches!(error, Error::Resolution { dims } if dims[0] >= 1 << 23), "{error}");
    }

    #[test]
    fn a_place_and_its_flat_index_belong_together() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::new(4.0, 2.0, 3.0) };
        let cells = Cells::new(bounds, 10, Resolution::LongestSide(4)).unwrap();
        assert_eq!(cells.dims(), [4, 2, 3]);
        for flat in 0..24 {
            assert_eq!(cells.flat(cells.place(flat)), flat);
        }
    }
}
