/*!
Noise: smooth random fields, which are functions of a place and keep no state.

It is the gradient noise of Perlin (*Improving Noise*, SIGGRAPH 2002) with gradients from a hash of
the lattice point, and with the derivatives of the field, which displacements need.
*/

use super::random::mix;
use glam::DVec3;

/// A random field; fields of different seeds have nothing in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    seed: u64,
    /// After how many lattice cells the field repeats; 0 for never.
    period: u32,
}

impl Noise {
    /// The field of this number that belongs to a seed.
    pub(super) fn new(seed: u64, field: u64) -> Self {
        Self { seed: mix(seed ^ mix(field ^ 0x6e6f_6973_6521)), period: 0 }
    }

    /// The same, repeating after so many units.
    pub(super) fn repeating(self, period: u32) -> Self {
        Self { period, ..self }
    }

    /// The value: mostly in `-0.5..0.5`, never out of `-2..2`. Its structures are one unit large.
    pub(super) fn at(&self, place: DVec3) -> f64 {
        self.with_slope(place).0
    }

    /// The value and its derivatives.
    pub(super) fn with_slope(&self, place: DVec3) -> (f64, DVec3) {
        let base = place.floor();
        let x = place - base;
        let fade = x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
        let fade_slope = x * x * (x * (x - 2.0) + 1.0) * 30.0;
        let (mut value, mut slope) = (0.0, DVec3::ZERO);
        for corner in 0..8_u32 {
            let step = DVec3::new(
                f64::from(corner & 1),
                f64::from(corner >> 1 & 1),
                f64::from(corner >> 2 & 1),
            );
            let gradient = self.gradient(base + step);
            let height = gradient.dot(x - step);
            // The weight is the fade on the side of this corner, one less it on the other.
            let sign = step * 2.0 - 1.0;
            let w = (DVec3::ONE - step) + sign * fade;
            let dw = sign * fade_slope;
            let weight = w.x * w.y * w.z;
            value += weight * height;
            slope += gradient * weight
                + DVec3::new(dw.x * w.y * w.z, w.x * dw.y * w.z, w.x * w.y * dw.z) * height;
        }
        (value, slope)
    }

    /// The sum of octaves of the field, each of half the size and half the height.
    pub(super) fn octaves(&self, place: DVec3, count: u32) -> f64 {
        let (mut sum, mut height, mut scale) = (0.0, 1.0, 1.0);
        for octave in 0..count {
            // Octaves are shifted: their lattices would meet at the origin else.
            let shift = DVec3::new(0.37, 0.71, 0.53) * f64::from(octave);
            sum += height * self.at(place * scale + shift);
            height *= 0.5;
            scale *= 2.0;
        }
        sum
    }

    /// The gradient at a lattice point.
    #[inline]
    fn gradient(&self, corner: DVec3) -> DVec3 {
        let period = i64::from(self.period);
        let wrap = |x: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "it is whole, and saturates")]
            let x = x as i64;
            if period == 0 { x } else { x.rem_euclid(period) }
        };
        let key = (wrap(corner.x).wrapping_mul(0x1f3d_8b6d_27d4_eb2f))
            ^ (wrap(corner.y).wrapping_mul(0x3c6e_f372_fe94_f82b))
            ^ (wrap(corner.z).wrapping_mul(0x2545_f491_4f6c_dd1d));
        let bits = mix(key.cast_unsigned() ^ self.seed);
        let part = |shift: u32| (bits >> shift & 0xffff) as f64 / 32_767.5 - 1.0;
        DVec3::new(part(0), part(16), part(32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::random::Random;

    #[test]
    fn slopes_are_those_of_the_values() {
        let noise = Noise::new(5, 1);
        let mut random = Random::new(5, 1);
        let mut largest: f64 = 0.0;
        for _ in 0..1000 {
            let place = DVec3::new(random.signed(), random.signed(), random.signed()) * 10.0;
            let (value, slope) = noise.with_slope(place);
            largest = largest.max(value.abs());
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let step = axis * 1e-6;
                let rise = (noise.at(place + step) - noise.at(place - step)) / 2e-6;
                assert!((rise - slope.dot(axis)).abs() < 1e-7, "{place}: {rise}, {slope}");
            }
        }
        assert!((0.4..1.0).contains(&largest), "{largest}");
    }

    #[test]
    fn a_repeating_field_repeats() {
        let noise = Noise::new(5, 2).repeating(4);
        let place = DVec3::new(0.3, 1.2, 3.9);
        assert!((noise.at(place) - noise.at(place + DVec3::new(4.0, -8.0, 12.0))).abs() < 1e-12);
        assert!((noise.at(place) - noise.at(place + DVec3::X)).abs() > 1e-3);
    }
}
