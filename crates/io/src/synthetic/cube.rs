/*!
The cube: spheres scattered evenly and without order, the scene to measure with.

Its picture is the same everywhere and from everywhere, so its time tells of the renderer alone.
Centres lie in `-1..1` on each axis, on a lattice of 2²⁴ steps: every coordinate is a random integer
`k` as `k · 2⁻²³ - 1`, exact in `f32`.
*/

use super::{
    Make, Row,
    random::Random,
    spec::{Domain, Key, Kind, Spec},
};

pub(super) const KIND: Kind = Kind {
    name: "cube",
    about: "spheres scattered evenly in a cube from -1 to 1: the scene to measure with",
    keys: &[
        Key::count("1000000"),
        Key::new("r", Domain::Length, "0.01", "radius of the spheres"),
        Key::seed(),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Cube {
    radius: f32,
    random: Random,
}

impl Cube {
    pub(super) fn new(spec: &Spec) -> Self {
        Self { radius: spec.radius(), random: Random::new(spec.seed(), 0) }
    }
}

impl Make for Cube {
    #[inline]
    fn row(&mut self) -> Row {
        let (xy, z) = (self.random.bits(), self.random.bits());
        Row {
            position: [coordinate(xy >> 32), coordinate(xy & 0xffff_ffff), coordinate(z >> 32)],
            radius: self.radius,
            ..Row::default()
        }
    }
}

/// The coordinate that 32 random bits make.
#[inline]
fn coordinate(bits: u64) -> f32 {
    const STEP: f32 = 1.0 / (1 << 23) as f32;
    (bits >> 8) as f32 * STEP - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Generator;
    use puncta_core::Source;

    #[test]
    fn the_outermost_coordinates_are_exact() {
        assert_eq!(coordinate(0), -1.0);
        assert_eq!(coordinate(0xffff_ffff), 1.0 - 2.0_f32.powi(-23));
        assert_eq!(coordinate(0x8000_0000), 0.0);
    }

    /// Chi-square of the counts in eight octants, with seven degrees of freedom.
    ///
    /// It exceeds 24.3 for one seed in a thousand; of 20 seeds, none should. And it falls below
    /// 0.6 for one seed in a thousand, which would be more even than chance is.
    #[test]
    fn octants_hold_what_chance_gives_them() {
        for seed in 0..20 {
            let generator: Generator = format!("cube:n=80000,seed={seed}").parse().unwrap();
            let Ok(scene) = generator.into_scene();
            let mut counts = [0_u32; 8];
            for record in &scene.records {
                let octant: usize = (0..3).map(|i| usize::from(record.center[i] >= 0.0) << i).sum();
                counts[octant] += 1;
            }
            let squares: f64 =
                counts.iter().map(|count| (f64::from(*count) - 1e4).powi(2) / 1e4).sum();
            assert!((0.6..24.3).contains(&squares), "seed {seed}: {squares} of {counts:?}");
        }
    }
}
