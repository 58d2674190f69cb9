/*!
The survey: what a viewer wants to know of all records before it has seen any.

Views are fitted to the box of nearly all records, and colors to the range of nearly all values. To
find these takes a look at everything, which is what one has not got time for with a file that is
larger than memory. So they are taken while the file is made, and are the very numbers that
[`Scene::inner_bounds`] and [`inner_range`](puncta_core::inner_range) find.
*/

use super::{
    field::length,
    spill::Spill,
};
use glam::DVec3;
use puncta_core::{Bounds, RangeBins, Scene, Sphere};
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
    /// One for each coordinate, then one for each scalar.
    bins: Vec<RangeBins>,
}

impl Survey {
    /// A survey that has seen nothing.
    pub(crate) fn new(spill: &Spill) -> Self {
        let corner = |corner: glam::Vec3| spill.origin + corner.as_dvec3();
        let (min, max) = (corner(spill.bounds.min), corner(spill.bounds.max));
        let axes = (0..3).map(|axis| RangeBins::new([min[axis], max[axis]]));
        let scalars = spill.ranges.iter().map(|range| RangeBins::new(range.map(f64::from)));
        Self {
            origin: spill.origin,
            step: spill.rows.div_ceil(SAMPLES).max(1),
            sample: Vec::new(),
            bins: axes.chain(scalars).collect(),
        }
    }

    /// Looks at some rows, which are the first ones of the block.
    pub(crate) fn look(&mut self, block: &Scene, rows: &Range<u64>) {
        let count = length(rows);
        let (axes, scalars) = self.bins.split_at_mut(3);
        for (row, record) in rows.clone().zip(&block.records) {
            let position = self.origin + glam::Vec3::from_array(record.center).as_dvec3();
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
        self.bins.iter_mut().zip(&other.bins).for_each(|(bins, more)| bins.join(more));
        self
    }

    /// The inner box and the ranges.
    pub(crate) fn finish(self, origin: DVec3) -> (Bounds, Vec<[f64; 2]>) {
        let mut scene = Scene::new(self.sample);
        scene.origin = origin;
        let ranges = self.bins.iter().map(|bins| bins.range(OUTSIDE_RANGE));
        (scene.inner_bounds(OUTSIDE_BOX), ranges.collect())
    }
}
