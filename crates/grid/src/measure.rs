//! What is known about a brick: its box, its largest radius, its density, its mean color.

use crate::dispatch::lanes_of;
use glam::Vec3;
use puncta_core::{Aabb, Brick, Record};
use std::ops::Range;
use wide::f32x4;

/// The brick of these records, the first of which is record `start`.
///
/// `sides` are those of a cell; the density is that of a cell whose sides are at least as long as the
/// box of the records, and as the largest sphere.
#[inline(always)]
pub(crate) fn measure<R: Record>(members: &[R], start: u32, sides: f32x4) -> Brick {
    let (mut least, mut most) = (f32x4::splat(f32::INFINITY), f32x4::splat(f32::NEG_INFINITY));
    let mut cubes = 0.0;
    for record in members {
        let (lanes, radius) = (lanes_of(record), f64::from(record.radius()));
        least = lanes.fast_min(least);
        most = lanes.fast_max(most);
        cubes += radius * radius * radius;
    }
    #[expect(clippy::cast_possible_truncation, reason = "there are no more than MAX_RECORDS")]
    let end = start + members.len() as u32;
    describe(start..end, [least, most], cubes, sides)
}

/// The brick of records with these extremes and this sum of cubed radii.
#[inline(always)]
pub(crate) fn describe(
    records: Range<u32>,
    [least, most]: [f32x4; 2],
    cubes: f64,
    sides: f32x4,
) -> Brick {
    let radius_max = most.to_array()[3];
    let corner = |lanes: f32x4| Vec3::from_slice(&lanes.to_array());
    let sides = sides.fast_max(most - least).fast_max(f32x4::splat(2.0 * radius_max));
    let volume = 4.0 / 3.0 * std::f64::consts::PI * cubes;
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let density = (volume / corner(sides).as_dvec3().element_product()) as f32;
    Brick {
        records,
        bounds: Aabb { min: corner(least), max: corner(most) },
        radius_max,
        density: if density.is_finite() { density } else { 0.0 },
    }
}

/// The mean of the stored values of each channel, rounded to the nearest.
pub(crate) fn mean_color(colors: &[[u8; 4]]) -> [u8; 4] {
    let count = colors.len().max(1) as u64;
    let mut sums = [0_u64; 4];
    for color in colors {
        sums.iter_mut().zip(color).for_each(|(sum, &value)| *sum += u64::from(value));
    }
    sums.map(|sum| u8::try_from((sum + count / 2) / count).unwrap_or(u8::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_color_is_rounded() {
        assert_eq!(
            mean_color(&[[0, 1, 255, 255], [1, 1, 255, 0], [1, 2, 255, 0]]),
            [1, 1, 255, 85]
        );
        assert_eq!(mean_color(&vec![[255; 4]; 1000]), [255; 4]);
    }
}
