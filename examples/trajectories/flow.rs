/*!
Flows: particles that follow a field, each from a place of its own.

* Lorenz: the two wings of the attractor of convection, 1963.
* Thomas: cyclically symmetric, particles wander through a labyrinth.
*/

use super::{glyphs::progress::Bar, path::Path};
use clap::ValueEnum;
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// A field of velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Flow {
    /// The two wings of an attractor
    Lorenz,
    /// A labyrinth that looks the same along each axis
    Thomas,
}

/// How to follow it.
struct Recipe {
    /// The time between two points.
    step: f64,
    /// How far from the middle particles start, and where that is.
    start: (DVec3, f64),
    /// Points that are not kept, until a particle is where they all end up.
    before: usize,
}

/// Runge-Kutta steps between two points.
const SUBSTEPS: usize = 4;

impl Flow {
    fn velocity(self, DVec3 { x, y, z }: DVec3) -> DVec3 {
        match self {
            Self::Lorenz => DVec3::new(10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z),
            Self::Thomas => {
                const DAMPING: f64 = 0.2;
                DVec3::new(y.sin() - DAMPING * x, z.sin() - DAMPING * y, x.sin() - DAMPING * z)
            }
        }
    }

    const fn recipe(self) -> Recipe {
        match self {
            Self::Lorenz => {
                Recipe { step: 0.008, start: (DVec3::new(0.0, 0.0, 25.0), 12.0), before: 150 }
            }
            Self::Thomas => Recipe { step: 0.12, start: (DVec3::ZERO, 3.0), before: 300 },
        }
    }

    fn advance(self, place: DVec3, step: f64) -> DVec3 {
        let a = self.velocity(place);
        let b = self.velocity(place + a * (step * 0.5));
        let c = self.velocity(place + b * (step * 0.5));
        let d = self.velocity(place + c * step);
        place + (a + (b + c) * 2.0 + d) * (step / 6.0)
    }

    /// Follows `count` particles for `points` points each.
    pub(crate) fn follow(self, count: u32, points: u32, seed: u64) -> Vec<Path> {
        let Recipe { step, start: (middle, reach), before } = self.recipe();
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut start = || {
            let [x, y, z] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
            middle + DVec3::new(x, y, z) * reach
        };
        let starts: Vec<DVec3> = (0..count).map(|_| start()).collect();
        let bar = Bar::spinner("following");
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
        let follow = |start: DVec3| {
            let next = |place: DVec3| {
                (0..SUBSTEPS).fold(place, |place, _| self.advance(place, step / SUBSTEPS as f64))
            };
            let mut place = (0..before).fold(start, |place, _| next(place));
            let mut path = Path::default();
            for index in 0..points {
                path.points.push(place.as_vec3().to_array());
                path.times.push(step as f32 * index as f32);
                place = next(place);
            }
            path
        };
        let paths = starts.into_par_iter().map(follow).collect();
        bar.finish();
        paths
    }
}
