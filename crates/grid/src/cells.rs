/*!
The cells of a uniform grid, and the one that holds a position.

A position must lie inside the box of its cell, in floating point, or culling by boxes would be
wrong. Here this holds by construction. The index of a cell along an axis is

```text
cell(x) = trunc(clamp((x - corner) * scale, 0, cells - 1))
```

in `f32`. Subtracting a constant, multiplying by a positive one, clamping and truncating all keep the
order of numbers, rounded or not: the index never falls as `x` grows. So the positions with index `i`
are exactly the numbers from the first with index `i` to the one before the first with index `i + 1`.
Those first numbers are the faces between cells; they are found by bisection when somebody asks for
them. No record is ever compared with a face, and no face is stored.

The clamp makes the outermost cells reach as far as the data do, which is what a robust
[`Fit`](crate::Fit) builds on.
*/

use crate::{Error, Resolution};
use glam::{DVec3, Vec3};
use puncta_core::Aabb;
use wide::f32x4;

/// The largest number of cells. A cell costs nothing while it is empty, but its code must fit into 32
/// bits, and each axis may waste nearly one of them.
pub(crate) const CELLS_MAX: u64 = 1 << 30;

/// The largest number of cells along an axis: from here on `f32` cannot tell them apart well.
pub(crate) const AXIS_MAX: u64 = 1 << 20;

/// The largest number of cells that are aimed at when nobody asks for a number of cells.
const AUTOMATIC_MAX: f64 = CELLS_MAX as f64 * 0.24;

/// Equal cubes that fill a box; the outermost ones reach to the ends of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    dims: [u32; 3],
    /// The smallest box around the data.
    bounds: Aabb,
    /// Where the cells start.
    corner: Vec3,
    /// Cells per unit of length.
    scale: f32,
}

/// Where the cells of a grid lie, apart from its resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// The box that the cells fill.
    pub(crate) inner: Aabb,
    /// For each axis, whether a layer of cells for what lies below the box is needed, and above.
    pub(crate) overflow: [[bool; 2]; 3],
}

impl Cells {
    /// The cells of no records.
    pub(crate) const EMPTY: Self =
        Self { dims: [0; 3], bounds: Aabb::EMPTY, corner: Vec3::ZERO, scale: 0.0 };

    /// The cells over a box for this many records.
    pub(crate) fn new(
        placement: &Placement,
        records: usize,
        resolution: Resolution,
    ) -> Result<Self, Error> {
        let Aabb { min, max } = placement.inner;
        let sides = max.as_dvec3() - min.as_dvec3();
        let longest = sides.max_element();
        let width = match resolution {
            Resolution::LongestSide(0) => return Err(Error::Resolution { dims: [0; 3] }),
            Resolution::LongestSide(cells) => longest / f64::from(cells),
            Resolution::RecordsPerBrick(target) => {
                // Less than there may be: a side of one cell can become two cells and two layers.
                let bricks = (records as f64 / f64::from(target.max(1))).min(AUTOMATIC_MAX);
                let most = AXIS_MAX as f64 * 0.5;
                longest / cells_along_longest(sides, bricks).min(most)
            }
            Resolution::Width(width) if width.is_normal() && width > 0.0 => f64::from(width),
            Resolution::Width(width) => return Err(Error::Width { width }),
        };
        // Cells that are thinner than the spacing of the numbers themselves would hold nothing. A
        // point has no extent and one cell; its width is as good as any other.
        let width = width.max(spacing(&placement.inner));
        let width = if width > 0.0 { width } else { 1.0 };
        // What rounding adds to a whole number is no cell of its own.
        let cells = |side: f64| (side / width * (1.0 - 4.0 * f64::EPSILON)).ceil().max(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
        let inner = sides.to_array().map(|side| cells(side) as u64);
        let [x, y, z] = std::array::from_fn(|axis| {
            inner[axis]
                + placement.overflow[axis].iter().map(|&layer| u64::from(layer)).sum::<u64>()
        });
        let total = x.checked_mul(y).and_then(|xy| xy.checked_mul(z));
        let dims = [x, y, z];
        if total.is_none_or(|total| total > CELLS_MAX) || dims.iter().any(|&dim| dim > AXIS_MAX) {
            return Err(Error::Resolution { dims });
        }
        #[expect(clippy::cast_possible_truncation, reason = "rounding is as good")]
        let (scale, layer) = ((1.0 / width).min(f64::from(f32::MAX)) as f32, width as f32);
        // A layer that is not there may be infinitely thick, and one that is there reach too far.
        let below = placement.overflow.map(|[below, _]| if below { layer } else { 0.0 });
        let corner = (min - Vec3::from_array(below)).max(Vec3::MIN);
        let dims = dims.map(|dim| u32::try_from(dim).unwrap_or(u32::MAX));
        Ok(Self { dims, bounds: placement.inner, corner, scale })
    }

    /// The same cells; their outermost faces are those of this box around the data.
    pub(crate) fn around(self, bounds: Aabb) -> Self {
        Self { bounds, ..self }
    }

    /// All there is to know of the cells: dims, corner, scale and bounds.
    pub(crate) fn parts(&self) -> ([u32; 3], Vec3, f32, Aabb) {
        (self.dims, self.corner, self.scale, self.bounds)
    }

    /// The cells that have these parts.
    pub(crate) fn from_parts(dims: [u32; 3], corner: Vec3, scale: f32, bounds: Aabb) -> Self {
        Self { dims, bounds, corner, scale }
    }

    /// The number of cells along each axis.
    #[must_use]
    pub const fn dims(&self) -> [u32; 3] {
        self.dims
    }

    /// The number of cells, most of which may be empty.
    #[must_use]
    pub fn count(&self) -> usize {
        self.dims.iter().map(|&dim| dim as usize).product()
    }

    /// The side of a cell that is not an outermost one.
    #[must_use]
    pub fn width(&self) -> f32 {
        1.0 / self.scale
    }

    /// Where the cells start: see the formula in [`Self::place`].
    #[must_use]
    pub const fn corner(&self) -> Vec3 {
        self.corner
    }

    /// The number of cells per unit of length: see the formula in [`Self::place`].
    #[must_use]
    pub const fn scale(&self) -> f32 {
        self.scale
    }

    /// The box of a cell; positions on its upper faces belong to the next cell.
    ///
    /// Outermost cells reach to the ends of the data.
    ///
    /// # Panics
    ///
    /// When there is no such cell.
    #[must_use]
    pub fn bounds(&self, place: [u32; 3]) -> Aabb {
        assert!(self.contains(place), "there is no cell {place:?} among {:?}", self.dims);
        let face = |up: u32| std::array::from_fn(|axis| self.face(axis, place[axis] + up));
        Aabb { min: Vec3::from_array(face(0)), max: Vec3::from_array(face(1)) }
    }

    /// The cell that holds a position; one outside the box of the data is held by an outermost cell.
    ///
    /// Along each axis it is `(position - corner) * scale`, in `f32`, rounded down and clamped to the
    /// cells that there are.
    ///
    /// # Panics
    ///
    /// When there are no cells.
    #[must_use]
    pub fn place(&self, position: Vec3) -> [u32; 3] {
        assert!(self.dims[0] > 0, "there are no cells");
        std::array::from_fn(|axis| self.along(axis, position[axis]))
    }

    /// Whether there is such a cell.
    #[must_use]
    pub fn contains(&self, place: [u32; 3]) -> bool {
        place.iter().zip(self.dims).all(|(&at, dim)| at < dim)
    }

    /// The corner, the scale and the largest index along each axis, as the sort needs them.
    pub(crate) fn lattice(&self) -> (Vec3, f32, Vec3) {
        let last = self.dims.map(|dim| dim.saturating_sub(1) as f32);
        (self.corner, self.scale, Vec3::from_array(last))
    }

    /// The sides of a cell, as lanes; those of an only cell along an axis are those of the data.
    pub(crate) fn sides(&self) -> f32x4 {
        let extent = self.bounds.max - self.bounds.min;
        let side = |axis: usize| if self.dims[axis] == 1 { extent[axis] } else { self.width() };
        f32x4::new([side(0), side(1), side(2), 0.0])
    }

    /// The cell along an axis that holds a coordinate.
    fn along(&self, axis: usize, x: f32) -> u32 {
        let last = (self.dims[axis] - 1) as f32;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is meant")]
        let cell = ((x - self.corner[axis]) * self.scale).max(0.0).min(last) as u32;
        cell
    }

    /// The smallest number of the data's range whose cell along an axis is at least `cell`; the one
    /// above the range if there is none.
    fn face(&self, axis: usize, cell: u32) -> f32 {
        let (min, max) = (self.bounds.min[axis], self.bounds.max[axis]);
        let (mut low, mut high) = (rank(min), rank(max) + 1);
        while low < high {
            // No overflow: ranks are 33-bit numbers.
            let middle = (low + high).div_euclid(2);
            if cell < self.dims[axis] && self.along(axis, number(middle)) >= cell {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        number(high)
    }
}

/// The place of a number among all `f32`, ascending.
fn rank(x: f32) -> i64 {
    let magnitude = i64::from(x.to_bits() & 0x7fff_ffff);
    if x.is_sign_negative() { -magnitude } else { magnitude }
}

/// The number of this rank.
fn number(rank: i64) -> f32 {
    let magnitude = f32::from_bits(u32::try_from(rank.unsigned_abs()).unwrap_or(u32::MAX));
    if rank < 0 { -magnitude } else { magnitude }
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

    fn cells(min: [f32; 3], max: [f32; 3], resolution: Resolution) -> Result<Cells, Error> {
        let inner = Aabb { min: min.into(), max: max.into() };
        Cells::new(&Placement { inner, overflow: [[false; 2]; 3] }, 1000, resolution)
    }

    #[test]
    fn faces_are_the_first_numbers_of_their_cells() {
        for (low, high) in
            [(0.0, 1.0), (-3.7, 11.3), (1e7, 1e7 + 64.0), (-1e-40, 1e-39), (-3e38, 3e38)]
        {
            let cells = cells([low; 3], [high; 3], Resolution::LongestSide(10)).unwrap();
            let mut last = low;
            for i in 0..cells.dims()[0] {
                let bounds = cells.bounds([i, 0, 0]);
                assert_eq!(bounds.min.x, last, "cells leave no gap");
                last = bounds.max.x;
                if bounds.min.x < bounds.max.x {
                    assert_eq!(cells.place(bounds.min)[0], i);
                    assert_eq!(cells.place(bounds.max.map(f32::next_down))[0], i);
                }
            }
            assert_eq!(last, high.next_up());
        }
    }

    #[test]
    fn the_longest_side_has_the_cells_asked_for() {
        for count in 1..400 {
            let cells =
                cells([-0.125; 3], [0.875, 0.375, -0.125], Resolution::LongestSide(count)).unwrap();
            assert_eq!(cells.dims(), [count, count.div_ceil(2), 1]);
        }
    }

    #[test]
    fn sides_of_any_ratio_get_about_the_cells_asked_for() {
        for sides in [[1.0, 1.0, 1.0], [9.0, 1.0, 0.001], [100.0, 3.0, 2.0], [1.0, 0.0, 0.0]] {
            let cells = cells([0.0; 3], sides, Resolution::RecordsPerBrick(2)).unwrap();
            assert!((250..1300).contains(&cells.count()), "{sides:?}: {:?}", cells.dims());
        }
    }

    #[test]
    fn a_number_of_records_per_brick_is_never_refused() {
        let sides = [0.0, 1e-30, 1e-6, 1e-3, 0.015, 0.3, 1.0].map(|side| side * 1.001);
        let most = puncta_core::MAX_RECORDS;
        for (y, z) in sides.iter().flat_map(|&y| sides.map(|z| (y, z))) {
            for records in [1, 1000, 1 << 20, 300_000_000, 600_000_000, most] {
                let inner = Aabb { min: Vec3::ZERO, max: Vec3::new(1.001, y, z) };
                let placement = Placement { inner, overflow: [[true; 2]; 3] };
                let cells = Cells::new(&placement, records, Resolution::RecordsPerBrick(0));
                assert!(cells.is_ok(), "{records} in {inner:?}: {cells:?}");
            }
        }
    }

    #[test]
    fn corners_are_finite() {
        let most = [f32::MAX; 3];
        let cells = cells([f32::MIN; 3], most, Resolution::RecordsPerBrick(5000)).unwrap();
        assert_eq!(cells.corner(), Vec3::MIN);
        let inner = Aabb { min: Vec3::splat(-3e38), max: Vec3::splat(3e38) };
        let placement = Placement { inner, overflow: [[true; 2]; 3] };
        let cells = Cells::new(&placement, 1000, Resolution::LongestSide(10)).unwrap();
        assert_eq!(cells.corner(), Vec3::MIN);
    }

    #[test]
    fn resolutions_beyond_the_limits_are_refused() {
        let cube = |resolution| cells([0.0; 3], [1.0; 3], resolution).map(|cells| cells.dims());
        assert_eq!(cube(Resolution::LongestSide(1024)), Ok([1024; 3]));
        assert_eq!(cube(Resolution::LongestSide(0)), Err(Error::Resolution { dims: [0; 3] }));
        assert_eq!(cube(Resolution::LongestSide(1025)), Err(Error::Resolution { dims: [1025; 3] }));
        let line = |count| cells([0.0; 3], [1.0, 0.0, 0.0], Resolution::LongestSide(count));
        assert!(line(1 << 20).is_ok() && line((1 << 20) + 1).is_err());
        for width in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-40] {
            let error = cube(Resolution::Width(width)).unwrap_err();
            assert!(matches!(error, Error::Width { .. }), "{error}");
        }
        let error = cube(Resolution::Width(1e-30)).unwrap_err();
        assert!(matches!(error, Error::Resolution { .. }), "{error}");
    }
}
