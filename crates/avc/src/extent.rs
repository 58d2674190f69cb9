/*!
Extents: which numbers can be drawn.

Sizes from 10⁻¹⁸ to 10¹⁸ have squares that `f32` can hold, and sums of these. What is smaller counts as
zero, so that it does not matter whether a processor knows subnormal numbers; what is larger counts as
infinite.
*/

use crate::Fault;
use glam::Vec3;

/// The smallest and the largest size that is drawn.
pub(crate) const EXTENT_MIN: f32 = 1e-18;
/// See [`EXTENT_MIN`].
pub(crate) const EXTENT_MAX: f32 = 1e18;

/// More than what rounding does to a ball, relative to its radius.
///
/// Points of a circle are off by 3 · 10⁻⁷ of its radius and unit vectors by 10⁻⁶; the square roots of
/// WGSL, which have an error of 4.5 units in the last place, by 6 · 10⁻⁷.
pub(crate) const BALL_SLACK: f32 = 1.000_01;

/// Whether something of this size is drawn.
#[inline]
pub(crate) fn has_extent(size: f32) -> bool {
    (EXTENT_MIN..=EXTENT_MAX).contains(&size)
}

/// The largest size of the components.
#[inline]
pub(crate) fn largest(vector: Vec3) -> f32 {
    let sizes = vector.abs();
    sizes.x.max(sizes.y).max(sizes.z)
}

/// Whether some numbers are neither NaN nor infinite.
#[inline]
pub(crate) fn are_finite(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

/// What is wrong with the numbers of a record, of which some are sizes.
pub(crate) fn fault(numbers: &[f32], sizes: &[f32]) -> Option<Fault> {
    if !are_finite(numbers) || sizes.iter().any(|&size| size > EXTENT_MAX) {
        Some(Fault::NotFinite)
    } else if sizes.iter().any(|&size| size < EXTENT_MIN) {
        Some(Fault::NoExtent)
    } else {
        None
    }
}
