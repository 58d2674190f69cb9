/*!
A radius for records that come without one.

Half the distance between neighbors makes neighboring spheres touch; scanned surfaces, whose points
are less regular, need more to look closed. So the estimate is the median, over a sample of the
records, of the distance to the nearest other record, times a constant between the two. The sample is
small, and each distance is found by looking at all records: no structure is needed.

The sample is that of the records whose numbers have the smallest hashes. It can be taken in one pass
without knowing how many records there are, and does not fall in step with any order that they may
have, as every 65536th record of a lattice of 256 x 256 x n would.
*/

use crate::hash::mix;
use glam::Vec3;
use puncta_core::{Record, Sphere};

/// How many distances are computed at most.
const DISTANCES_MAX: u64 = 1 << 28;

/// The largest and the smallest number of sampled records.
const SAMPLES: (u64, u64) = (512, 16);

/// The share of the distance to the nearest neighbor that makes a good radius.
const SHARE: f32 = 0.9;

/// How many records are compared with one sample, then with the next: as many as a cache holds.
const BLOCK: usize = 1024;

/// A radius with which these records look like what they are a sample of; records that coincide do
/// not count. It is 1 where there are no two different positions.
#[must_use]
pub fn estimate(records: &[Sphere]) -> f32 {
    let mut sample = Sample::default();
    records.iter().for_each(|record| sample.add(record.position()));
    let mut nearest = Nearest::new(sample.into_items(records.len() as u64));
    nearest.look_at(records);
    nearest.radius()
}

/// A sample of what comes one by one, of a size that depends on how many there will be.
#[derive(Clone, Debug)]
pub(crate) struct Sample<T> {
    added: u64,
    /// What comes with a larger hash is not in the sample.
    bound: u64,
    items: Vec<(u64, T)>,
}

impl<T> Default for Sample<T> {
    fn default() -> Self {
        Self { added: 0, bound: u64::MAX, items: Vec::new() }
    }
}

impl<T> Sample<T> {
    pub(crate) fn add(&mut self, item: T) {
        let hash = mix(self.added);
        self.added += 1;
        if hash <= self.bound {
            self.items.push((hash, item));
            if self.items.len() as u64 == 2 * SAMPLES.0 {
                self.cut(SAMPLES.0);
            }
        }
    }

    /// The sample of `count` items.
    pub(crate) fn into_items(mut self, count: u64) -> Vec<T> {
        self.cut((DISTANCES_MAX / count.max(1)).clamp(SAMPLES.1, SAMPLES.0));
        self.items.into_iter().map(|(_, item)| item).collect()
    }

    /// Keeps the `count` items of the smallest hashes.
    fn cut(&mut self, count: u64) {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        if count < self.items.len() {
            let (_, next, _) = self.items.select_nth_unstable_by_key(count, |(hash, _)| *hash);
            self.bound = next.0;
            self.items.truncate(count);
        }
    }
}

/// The distances from some positions to the nearest records that lie elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct Nearest {
    /// The positions, and the squares of the distances.
    samples: Vec<(Vec3, f64)>,
}

impl Nearest {
    pub(crate) fn new(positions: Vec<Vec3>) -> Self {
        let samples = positions.into_iter().map(|position| (position, f64::INFINITY)).collect();
        Self { samples }
    }

    /// Looks at more records.
    pub(crate) fn look_at(&mut self, records: &[Sphere]) {
        for block in records.chunks(BLOCK) {
            for (position, least) in &mut self.samples {
                // In `f64`, where the squares of all distances are finite and none but zero is 0.
                let position = position.as_dvec3();
                let squares = block
                    .iter()
                    .map(|other| (other.position().as_dvec3() - position).length_squared());
                let nearer = |least: f64, d: f64| if d > 0.0 { least.min(d) } else { least };
                *least = squares.fold(*least, nearer);
            }
        }
    }

    /// The radius that the distances tell.
    pub(crate) fn radius(self) -> f32 {
        let distances = self.samples.into_iter().map(|(_, least)| to_f32(least.sqrt()));
        let mut distances: Vec<f32> = distances.filter(|distance| distance.is_finite()).collect();
        if distances.is_empty() {
            return 1.0;
        }
        let middle = distances.len() / 2;
        let (_, median, _) = distances.select_nth_unstable_by(middle, f32::total_cmp);
        (SHARE * *median).max(f32::MIN_POSITIVE)
    }
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

    /// Points of no order, of which some coincide.
    fn cloud(count: u32) -> Vec<Sphere> {
        let x = |i: u32, axis: u64| (mix(3 * u64::from(i / 2) + axis) >> 44) as f32;
        (0..count).map(|i| Sphere::new([0, 1, 2].map(|axis| x(i, axis)), 0.0)).collect()
    }

    #[test]
    fn a_sample_is_that_of_the_smallest_hashes() {
        for count in [0, 1, 511, 512, 513, 1023, 1024, 1025, 600_000, 3_000_000] {
            let mut sample = Sample::default();
            (0..count).for_each(|item| sample.add(item));
            let mut found = sample.into_items(count);
            let mut expected: Vec<u64> = (0..count).collect();
            expected.sort_unstable_by_key(|&item| mix(item));
            expected.truncate(usize::try_from((1 << 28) / count.max(1)).unwrap().min(512));
            found.sort_unstable_by_key(|&item| mix(item));
            assert_eq!(found, expected, "{count}");
        }
    }

    #[test]
    fn records_can_be_looked_at_in_parts() {
        let records = cloud(5000);
        let mut sample = Sample::default();
        records.iter().for_each(|record| sample.add(record.position()));
        let positions = sample.into_items(5000);
        let distance = |a: &Sphere, b: Vec3| a.position().as_dvec3().distance(b.as_dvec3());
        let mut distances: Vec<f64> = positions
            .iter()
            .map(|&position| {
                let others = records.iter().map(|record| distance(record, position));
                others.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min)
            })
            .collect();
        distances.sort_unstable_by(f64::total_cmp);
        let expected = 0.9 * distances[distances.len() / 2];
        for part in [1, 7, 1024, 5000] {
            let mut nearest = Nearest::new(positions.clone());
            records.chunks(part).for_each(|records| nearest.look_at(records));
            let radius = nearest.radius();
            assert_eq!(radius, estimate(&records));
            assert!((f64::from(radius) / expected - 1.0).abs() < 1e-6, "{radius} {expected}");
        }
    }
}
