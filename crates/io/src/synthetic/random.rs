/*!
Random numbers and the arithmetic on them, the same on every machine and for all time.

A scene that changes when a library or a processor changes cannot be compared with an older one. So

* the bits come from the permuted congruential generator `Pcg64Mcg` (O'Neill, *PCG: A Family of
  Simple Fast Space-Efficient Statistically Good Algorithms for Random Number Generation*, 2014),
  whose stream is fixed, and its state is set by [`mix`], not by a library;
* bits become numbers by our own formulas: the top 24 bits (of 32) or 53 bits (of 64), times a power
  of two;
* [`exp`], [`ln`], [`cube_root`] and [`turn`] use additions, multiplications and divisions alone,
  which IEEE 754 rounds in one way only. Those of the standard library differ between systems.
*/

use glam::DVec3;
use rand::Rng;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::{LN_2, SQRT_2, TAU};

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(super) struct Random(Pcg64Mcg);

impl Random {
    /// The stream of this number that belongs to a seed; streams are independent of each other.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        let low = mix(seed ^ mix(stream));
        let high = mix(low ^ seed.rotate_left(32));
        Self(Pcg64Mcg::new(u128::from(high) << 64 | u128::from(low)))
    }

    /// 64 random bits.
    #[inline]
    pub(super) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number in `0..1`.
    #[inline]
    pub(super) fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.bits() >> 11) as f64 * STEP
    }

    /// A number in `-1..1`.
    #[inline]
    pub(super) fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A number in `low..high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number of the normal distribution, cut at six standard deviations.
    ///
    /// It is the sum of twelve 21-bit numbers less its mean: a bell that costs no logarithm, and
    /// has no outliers to make holes in a scene's bounds.
    pub(super) fn normal(&mut self) -> f64 {
        const MASK: u64 = (1 << 21) - 1;
        let sum: u64 = (0..4)
            .map(|_| {
                let bits = self.bits();
                (bits & MASK) + (bits >> 21 & MASK) + (bits >> 42 & MASK)
            })
            .sum();
        (sum as f64 + 6.0) / (MASK + 1) as f64 - 6.0
    }

    /// One of these.
    pub(super) fn pick<T: Copy, const N: usize>(&mut self, choices: [T; N]) -> T {
        let index = usize::try_from(share(N as u64, self.bits() >> 32, 1 << 32)).unwrap_or(0);
        choices[index]
    }

    /// Three numbers in `-1..1`.
    #[inline]
    pub(super) fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// Three numbers of the normal distribution.
    pub(super) fn normals(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal())
    }

    /// A direction, none more likely than any other.
    pub(super) fn direction(&mut self) -> DVec3 {
        let z = self.signed();
        let (sin, cos) = turn(self.unit());
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, across * sin, z)
    }

    /// A number in `low..=high` whose chance to exceed `x` falls with `x^-slope`.
    pub(super) fn power_law(&mut self, low: f64, high: f64, slope: f64) -> f64 {
        let (a, b) = (power(low, -slope), power(high, -slope));
        power(a + (b - a) * self.unit(), -1.0 / slope)
    }
}

/// Mixes the bits of a number so that near numbers have nothing in common (`SplitMix64`).
#[inline]
pub(super) fn mix(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

/// The point of a number in a sequence that fills the unit cube evenly.
///
/// It is the additive sequence on the powers of the root of `x^4 = x + 1`, in integers, so that it
/// stays even however far it runs.
#[inline]
pub(super) fn even_point(index: u64) -> DVec3 {
    const STEPS: [u64; 3] = [0xd1b5_4a32_d192_ed03, 0xabc9_8388_fb8f_ac02, 0x8cb9_2ba7_2f3d_8dd7];
    DVec3::from_array(STEPS.map(|step| {
        let bits = step.wrapping_mul(index.wrapping_add(1));
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }))
}

/// Sine and cosine of an angle in turns.
#[inline]
pub(super) fn turn(turns: f64) -> (f64, f64) {
    let quarters = (turns * 4.0).round();
    let x = (turns - quarters * 0.25) * TAU;
    let xx = x * x;
    let series = |first: f64, terms: [f64; 7]| {
        terms.iter().rev().fold(0.0, |sum, term| (sum + 1.0) * -xx / term) * first + first
    };
    let sin = series(x, [6.0, 20.0, 42.0, 72.0, 110.0, 156.0, 210.0]);
    let cos = series(1.0, [2.0, 12.0, 30.0, 56.0, 90.0, 132.0, 182.0]);
    let quadrant = quarters * 0.25 - (quarters * 0.25).floor();
    if quadrant < 0.125 {
        (sin, cos)
    } else if quadrant < 0.375 {
        (cos, -sin)
    } else if quadrant < 0.625 {
        (-sin, -cos)
    } else {
        (-cos, sin)
    }
}

/// The exponential function, for numbers in `-700..700`; others are clamped to that.
#[inline]
pub(super) fn exp(x: f64) -> f64 {
    let x = x.clamp(-700.0, 700.0);
    let doublings = (x / LN_2).round();
    let rest = x - doublings * LN_2;
    let series = (1..=13).rev().fold(1.0, |sum, i| 1.0 + sum * rest / f64::from(i));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is the biased exponent, 1023 and at most 1011 more or less"
    )]
    let biased = (doublings + 1023.0) as u64;
    series * f64::from_bits(biased << 52)
}

/// The natural logarithm of a positive, normal number.
#[inline]
pub(super) fn ln(x: f64) -> f64 {
    const FRACTION: u64 = (1 << 52) - 1;
    let bits = x.to_bits();
    let mut exponent = (bits >> 52 & 0x7ff) as f64 - 1023.0;
    let mut fraction = f64::from_bits(bits & FRACTION | 1023 << 52);
    if fraction > SQRT_2 {
        fraction *= 0.5;
        exponent += 1.0;
    }
    let s = (fraction - 1.0) / (fraction + 1.0);
    let ss = s * s;
    let series = (0..=10_i32).rev().fold(0.0, |sum, i| sum * ss + 1.0 / f64::from(2 * i + 1));
    2.0 * s * series + exponent * LN_2
}

/// The logarithm to base 10 of a positive, normal number.
pub(super) fn log10(x: f64) -> f64 {
    ln(x) * std::f64::consts::LOG10_E
}

/// A positive number to a power.
pub(super) fn power(x: f64, exponent: f64) -> f64 {
    exp(ln(x) * exponent)
}

/// The cube root of a number that is not negative.
#[inline]
pub(super) fn cube_root(x: f64) -> f64 {
    if x > 1e-300 { exp(ln(x) / 3.0) } else { 0.0 }
}

/// The nearest `f32`.
#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest is what is wanted")]
#[inline]
pub(super) fn single(x: f64) -> f32 {
    x as f32
}

/// The whole part of a number; 0 for one that is negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it saturates, and counts lie far below the end of the range"
)]
#[inline]
pub(super) fn whole(x: f64) -> u64 {
    x as u64
}

/// How many of `count` things there are in the first `part` of `all` parts, rounded down.
#[inline]
pub(super) fn share(count: u64, part: u64, all: u64) -> u64 {
    let share = u128::from(count) * u128::from(part) / u128::from(all);
    u64::try_from(share).unwrap_or(u64::MAX)
}

/// Goes smoothly from 0 at `low` to 1 at `high`.
#[inline]
pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_agree_with_those_of_the_standard_library() {
        let mut random = Random::new(1, 1);
        for _ in 0..100_000 {
            let x = random.between(-40.0, 40.0);
            assert!((exp(x) / x.exp() - 1.0).abs() < 1e-14, "exp {x}");
            let y = x.exp();
            assert!((ln(y) - y.ln()).abs() < 1e-14 * (1.0 + x.abs()), "ln {y}");
            assert!((cube_root(y) / y.cbrt() - 1.0).abs() < 1e-14, "cube root of {y}");
            let (sin, cos) = turn(x);
            let (s, c) = ((x - x.round()) * TAU).sin_cos();
            assert!((sin - s).abs() < 1e-13 && (cos - c).abs() < 1e-13, "turn {x}");
        }
        assert_eq!(turn(0.25), (1.0, -0.0));
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(ln(1.0), 0.0);
    }

    /// Means and variances of 10^6 numbers lie within five standard errors of what they should be.
    #[test]
    fn distributions_have_their_moments() {
        const COUNT: u32 = 1_000_000;
        let moments = |mut next: Box<dyn FnMut() -> f64>| {
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..COUNT {
                let x = next();
                sum += x;
                squares += x * x;
            }
            (sum / f64::from(COUNT), squares / f64::from(COUNT))
        };
        let mut random = Random::new(2, 1);
        let (mean, square) = moments(Box::new(move || random.signed()));
        assert!(mean.abs() < 0.003 && (square - 1.0 / 3.0).abs() < 0.0015, "{mean} {square}");
        let mut random = Random::new(2, 2);
        let (mean, square) = moments(Box::new(move || random.normal()));
        assert!(mean.abs() < 0.005 && (square - 1.0).abs() < 0.007, "{mean} {square}");
        let mut random = Random::new(2, 3);
        let (mean, square) = moments(Box::new(move || random.direction().z));
        assert!(mean.abs() < 0.003 && (square - 1.0 / 3.0).abs() < 0.0015, "{mean} {square}");
        let mut random = Random::new(2, 4);
        let above = moments(Box::new(move || {
            f64::from(u8::from(random.power_law(1.0, 100.0, 1.0) > 10.0))
        }));
        // The chance to exceed x is (1/x - 1/100) / (1 - 1/100).
        assert!((above.0 - 0.09 / 0.99).abs() < 0.0015, "{above:?}");
    }

    #[test]
    fn streams_and_seeds_differ() {
        let first = |seed, stream| Random::new(seed, stream).bits();
        let mut all: Vec<u64> = (0..100).flat_map(|i| (0..100).map(move |j| first(i, j))).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 10_000);
    }

    /// Each octant holds an eighth of the points, within half of the standard error of chance.
    #[test]
    fn an_even_sequence_is_even() {
        let mut counts = [0_i32; 8];
        for i in 0..80_000 {
            let half = even_point(i).cmpge(DVec3::splat(0.5)).bitmask();
            counts[half as usize] += 1;
        }
        assert!(counts.iter().all(|count| (count - 10_000).abs() < 50), "{counts:?}");
    }
}
