/*!
The fit: which box the cells fill.

A few strays, far from everything else, would make the box of the data so large that nearly all
records fall into a handful of cells. So the cells are laid over an inner box instead, and what lies
outside belongs to the outermost cells. The inner box is found from a sample of a few thousand
records, spread over all of them: on each axis it goes from the least to the largest sampled
coordinate, but not further beyond the middle 99 of 100 of them than half their extent. For data
without strays this is the box of the sample, and within a hair that of the data.

Then the first look at all records tells how far they really reach. Where that is more than half a
cell beyond the inner box, a layer of cells is added on that side, so that strays are not in bricks
with others.
*/

use crate::cells::Placement;
use glam::Vec3;
use puncta_core::{Aabb, Record};

/// Which box cells fill.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// A box around nearly all of the data: at most a few in a hundred on each axis may lie outside,
    /// and only if they are far off. They go into bricks of their own, beyond the others.
    #[default]
    Robust,
    /// The box around all of the data.
    Whole,
}

/// The least and the largest number of records that are sampled, where there are enough.
const SAMPLES: [usize; 2] = [1 << 12, 1 << 13];

/// One of how many sampled values may be left out at either end.
const TAIL: usize = 200;

/// How far the inner box may go beyond the middle of the sample, in parts of its extent.
const MARGIN: f64 = 0.5;

/// The inner box of the records.
pub(crate) fn inner<R: Record>(records: &[R]) -> Placement {
    let sample: Vec<Vec3> = places(records.len()).map(|at| records[at].position()).collect();
    inner_of(&sample)
}

/// Which of this many records to sample.
pub(crate) fn places(records: usize) -> impl Iterator<Item = usize> {
    let [least, most] = SAMPLES;
    let count = (records / 64).clamp(least, most).min(records);
    (0..count).map(move |i| place(i, count, records))
}

/// The inner box of the records that this sample was taken of.
///
/// What is not finite is passed over. The box of no records is a point.
pub(crate) fn inner_of(sample: &[Vec3]) -> Placement {
    let sample: Vec<Vec3> =
        sample.iter().copied().filter(|position| position.is_finite()).collect();
    let mut values = vec![0.0; sample.len()];
    let mut placement =
        Placement { inner: Aabb { min: Vec3::ZERO, max: Vec3::ZERO }, overflow: [[false; 2]; 3] };
    for axis in 0..3 {
        values.iter_mut().zip(&sample).for_each(|(value, position)| *value = position[axis]);
        let [low, high] = middle(&mut values);
        placement.inner.min[axis] = low;
        placement.inner.max[axis] = high;
    }
    placement
}

/// The box of all records.
pub(crate) fn whole(bounds: Aabb) -> Placement {
    Placement { inner: bounds, overflow: [[false; 2]; 3] }
}

/// The index of sample `i` of `count`: somewhere in the `i`-th of as many equal runs of the records.
///
/// It is not always at the same place of its run, for data may repeat themselves with that step.
fn place(i: usize, count: usize, records: usize) -> usize {
    let at = |i: usize| (i as u128 * records as u128 / count as u128) as usize;
    let (start, end) = (at(i), at(i + 1));
    // Fibonacci hashing: Knuth, *The Art of Computer Programming* 3, section 6.4.
    let random = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
    let random = random as usize;
    start + random % (end - start).max(1)
}

/// From where to where the values go, strays left out.
fn middle(values: &mut [f32]) -> [f32; 2] {
    let Some(last) = values.len().checked_sub(1) else { return [0.0; 2] };
    let tail = values.len() / TAIL;
    let low = *values.select_nth_unstable_by(tail, f32::total_cmp).1;
    let least = values[..=tail].iter().copied().fold(low, f32::min);
    let high = *values.select_nth_unstable_by(last - tail, f32::total_cmp).1;
    let most = values[last - tail..].iter().copied().fold(high, f32::max);
    let (low, high) = (f64::from(low), f64::from(high));
    let margin = (high - low) * MARGIN;
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let clamp = |value: f32| f64::from(value).clamp(low - margin, high + margin) as f32;
    [clamp(least), clamp(most)]
}

/// Layers of cells where the data reach beyond the inner box.
pub(crate) fn overflow(placement: &Placement, bounds: &Aabb, width: f32) -> [[bool; 2]; 3] {
    let Aabb { min, max } = placement.inner;
    std::array::from_fn(|axis| {
        let reach = 0.5 * width;
        [bounds.min[axis] < min[axis] - reach, bounds.max[axis] > max[axis] + reach]
    })
}
