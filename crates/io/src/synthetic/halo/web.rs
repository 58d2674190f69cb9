//! The web: how evenly spread matter moves together into walls, filaments and knots.

use super::{BOX, Random};
use crate::synthetic::noise::Noise;
use glam::DVec3;

/// The potential whose slope moves matter: noise of several sizes.
#[derive(Clone, Debug)]
pub(super) struct Web {
    layers: [Layer; 3],
}

#[derive(Clone, Copy, Debug)]
struct Layer {
    noise: Noise,
    /// The size of its structures.
    size: f64,
    /// How far it moves matter in a step, where its slope is one.
    strength: f64,
}

/// A piece of space that matter started from, and what has become of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Where its middle has gone.
    pub(super) place: DVec3,
    /// What has become of steps along the axes.
    axes: [DVec3; 3],
}

impl Web {
    pub(super) fn new(seed: u64) -> Self {
        // Periods divide the box, so that the web is periodic too.
        let layers = [(6, 1.7), (13, 0.6), (28, 0.16)];
        let mut field = 0;
        Self {
            layers: layers.map(|(period, strength)| {
                field += 1;
                let noise = Noise::new(seed, field).repeating(period);
                Layer { noise, size: BOX / f64::from(period), strength }
            }),
        }
    }

    /// Where matter from this place has gone: in steps up the slope, so that it ends on ridges.
    fn displaced(&self, start: DVec3) -> DVec3 {
        const STEPS: usize = 4;
        let step = |place: DVec3| -> DVec3 {
            let slope =
                |layer: &Layer| layer.noise.with_slope(place / layer.size).1 * layer.strength;
            place + self.layers.iter().map(slope).sum::<DVec3>()
        };
        (0..STEPS).fold(start, |place, _| step(place))
    }

    /// What has become of the space around a place.
    pub(super) fn patch(&self, start: DVec3) -> Patch {
        const STEP: f64 = 0.02;
        let place = self.displaced(start);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z]
            .map(|axis| (self.displaced(start + axis * STEP) - place) / STEP);
        Patch { place, axes }
    }

    /// Where matter has gone from the best of so many places: the one of the highest potential,
    /// towards which matter moves.
    pub(super) fn dense_place(&self, candidates: usize, random: &mut Random) -> DVec3 {
        let (mut best, mut highest) = (DVec3::ZERO, f64::NEG_INFINITY);
        for _ in 0..candidates {
            let start = random.in_cube() * (BOX * 0.5);
            // A layer that moves matter by its slope times a strength is a potential of that
            // strength times its size.
            let height =
                |layer: &Layer| layer.noise.at(start / layer.size) * layer.strength * layer.size;
            let potential = self.layers.iter().map(height).sum();
            if potential > highest {
                (best, highest) = (start, potential);
            }
        }
        self.displaced(best)
    }
}

impl Patch {
    /// Where matter has gone that was so far from the middle.
    pub(super) fn at(&self, from_middle: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        self.place + x * from_middle.x + y * from_middle.y + z * from_middle.z
    }

    /// What a unit of volume has become; negative where it was turned inside out.
    fn volume(&self) -> f64 {
        let [x, y, z] = self.axes;
        x.dot(y.cross(z))
    }

    /// By how much matter has become denser on its way. Where sheets of matter cross, the volume is
    /// zero; the density is cut off there.
    pub(super) fn density(&self) -> f64 {
        const DENSITY_MAX: f64 = 100.0;
        1.0 / self.volume().abs().max(1.0 / DENSITY_MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_web_is_periodic() {
        let web = Web::new(3);
        let start = DVec3::new(12.0, -49.0, 3.3);
        for shift in [DVec3::X, DVec3::Y, DVec3::Z] {
            let there = web.displaced(start + shift * BOX) - shift * BOX;
            assert!((there - web.displaced(start)).length() < 1e-9);
        }
    }

    /// Matter is moved, not made: the signed volumes of all places add up to that of the box.
    #[test]
    fn volumes_add_up() {
        let web = Web::new(3);
        let mut random = Random::new(3, 3);
        let (mut sum, mut squares) = (0.0, 0.0);
        const COUNT: u32 = 40_000;
        for _ in 0..COUNT {
            let start = random.in_cube() * (BOX * 0.5);
            let volume = web.patch(start).volume();
            sum += volume;
            squares += volume * volume;
        }
        let mean = sum / f64::from(COUNT);
        let error = (squares / f64::from(COUNT) - mean * mean).sqrt() / f64::from(COUNT).sqrt();
        assert!(
            (mean - 1.0).abs() < 5.0 * error && error < 0.05,
            "{mean} with an error of {error}"
        );
    }
}
