/*!
A radius for records that come without one.

Half the distance between neighbors makes neighboring spheres touch; scanned surfaces, whose points
are less regular, need more to look closed. So the estimate is the median, over a sample of the
records, of the distance to the nearest other record, times a constant between the two. The sample is
small and evenly spread over the records, and each distance is found by looking at all of them: no
structure is needed.
*/

use puncta_core::{Record, Sphere};

/// How many distances are computed at most.
const DISTANCES_MAX: usize = 1 << 28;

/// The largest and the smallest number of sampled records.
const SAMPLES: (usize, usize) = (512, 16);

/// The share of the distance to the nearest neighbor that makes a good radius.
const SHARE: f32 = 0.9;

/// A radius with which these records look like what they are a sample of; records that coincide do
/// not count. It is 1 where there are no two different positions.
#[must_use]
pub fn estimate(records: &[Sphere]) -> f32 {
    let samples = (DISTANCES_MAX / records.len().max(1)).clamp(SAMPLES.1, SAMPLES.0);
    let step = records.len().div_ceil(samples).max(1);
    let mut distances: Vec<f32> = records
        .iter()
        .step_by(step)
        .map(|record| nearest(record, records))
        .filter(|distance| distance.is_finite())
        .collect();
    if distances.is_empty() {
        return 1.0;
    }
    let middle = distances.len() / 2;
    let (_, median, _) = distances.select_nth_unstable_by(middle, f32::total_cmp);
    (SHARE * *median).max(f32::MIN_POSITIVE)
}

/// The distance from a record to the nearest one that lies elsewhere.
fn nearest(record: &Sphere, records: &[Sphere]) -> f32 {
    // In `f64`, where the squares of all distances are finite and none but zero is zero.
    let position = record.position().as_dvec3();
    let squared = |other: &Sphere| (other.position().as_dvec3() - position).length_squared();
    let least = |least: f64, d: f64| if d > 0.0 { least.min(d) } else { least };
    to_f32(records.iter().map(squared).fold(f64::INFINITY, least).sqrt())
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn to_f32(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_do_not_matter() {
        for unit in [1e-30, 1.0, 1e30_f32] {
            let line = |i: u8| Sphere::new([f32::from(i) * unit, 0.0, 0.0], 0.0);
            let estimate = estimate(&(0..10).map(line).collect::<Vec<_>>()) / unit;
            assert!((estimate - SHARE).abs() < 1e-5, "{unit}: {estimate}");
        }
    }

    #[test]
    fn a_lattice_gives_a_share_of_its_spacing() {
        let lattice: Vec<Sphere> = (0..1000_u16)
            .map(|i| [i % 10, i / 10 % 10, i / 100].map(|x| 2.0 * f32::from(x)))
            .map(|center| Sphere::new(center, 0.0))
            .collect();
        assert_eq!(estimate(&lattice), 2.0 * SHARE);
    }

    #[test]
    fn points_that_coincide_or_stand_alone_have_some_radius() {
        assert_eq!(estimate(&[]), 1.0);
        assert_eq!(estimate(&[Sphere::default()]), 1.0);
        assert_eq!(estimate(&[Sphere::default(); 9]), 1.0);
    }
}
