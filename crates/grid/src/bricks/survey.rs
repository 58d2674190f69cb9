/*!
The survey: what a viewer wants to know of all records before it has seen any.

Views are fitted to the box of nearly all records, and colors to the range of nearly all values. To
find these takes a look at everything, which is what one has not got time for with a file that is
larger than memory. So they are taken while the file is made, and are the very numbers that
[`Scene::bounds`], [`Scene::inner_bounds`] and [`inner_range`](puncta_core::inner_range) find.
*/

use super::{field::length, spill::Spill};
use glam::{DVec3, Vec3};
use puncta_core::{Bounds, RangeBins, Record, Scene, Sphere};
use std::ops::Range;

/// The share of records that may lie outside of the inner box on either side of an axis.
pub(crate) const OUTSIDE_BOX: f64 = 0.001;

/// The share of values that may lie outside of a range on either side.
pub(crate) const OUTSIDE_RANGE: f64 = 0.002;

/// As many records as [`Scene::inner_bounds`] looks at.
const SAMPLES: u64 = 1 << 20;

/// What was found so far.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    origin: DVec3,
    /// Each record of so many is sampled.
    step: u64,
    sample: Vec<Sphere>,
    /// The box around all records, radii included, without the origin.
    outer: Bounds,
    /// One for each coordinate, then one for each scalar.
    bins: Vec<RangeBins>,
}

impl Survey {
    /// A survey that has seen nothing.
    pub(crate) fn new(spill: &Spill) -> Self {
        let corner = |corner: Vec3| spill.origin + corner.as_dvec3();
        let (min, max) = (corner(spill.bounds.min), corner(spill.bounds.max));
        let axes = (0..3).map(|axis| RangeBins::new([min[axis], max[axis]]));
        let scalars = spill.ranges.iter().map(|range| RangeBins::new(range.map(f64::from)));
        Self {
            origin: spill.origin,
            step: spill.rows.div_ceil(SAMPLES).max(1),
            sample: Vec::new(),
            outer: Bounds::EMPTY,
            bins: axes.chain(scalars).collect(),
        }
    }

    /// Looks at some rows, which are the first ones of the block.
    pub(crate) fn look(&mut self, block: &Scene, rows: &Range<u64>) {
        let count = length(rows);
        let (axes, scalars) = self.bins.split_at_mut(3);
        for (row, record) in rows.clone().zip(&block.records) {
            let offset = record.position().as_dvec3();
            self.outer.add(offset - f64::from(record.radius));
            self.outer.add(offset + f64::from(record.radius));
            let position = self.origin + offset;
            axes.iter_mut().zip(position.to_array()).for_each(|(bins, x)| bins.add(x));
            if row % self.step == 0 {
                self.sample.push(*record);
            }
        }
        for (bins, scalar) in scalars.iter_mut().zip(&block.attributes.scalars) {
            scalar.values[..count].iter().for_each(|&value| bins.add(value.into()));
        }
    }

    /// What both have seen.
    pub(crate) fn join(mut self, other: Self) -> Self {
        self.sample.extend(other.sample);
        self.outer.add(other.outer.min);
        self.outer.add(other.outer.max);
        self.bins.iter_mut().zip(&other.bins).for_each(|(bins, more)| bins.join(more));
        self
    }

    /// What was found.
    pub(crate) fn finish(self) -> Findings {
        let mut scene = Scene::new(self.sample);
        scene.origin = self.origin;
        Findings {
            outer: Bounds { min: self.outer.min + self.origin, max: self.outer.max + self.origin },
            inner: scene.inner_bounds(OUTSIDE_BOX),
            ranges: self.bins.iter().map(|bins| bins.range(OUTSIDE_RANGE)).collect(),
        }
    }
}

/// What a survey finds.
#[derive(Clone, Debug)]
pub(crate) struct Findings {
    /// The world box around all records, radii included.
    pub(crate) outer: Bounds,
    /// The world box around nearly all records.
    pub(crate) inner: Bounds,
    /// The ranges of nearly all coordinates and of the values of each scalar.
    pub(crate) ranges: Vec<[f64; 2]>,
}
