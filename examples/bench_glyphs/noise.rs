//! Smooth noise from a seed: what is independent gets another seed.

/// Values between the points of a lattice, which are random.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    seed: u64,
    /// How long a cell of the lattice is.
    scale: f64,
}

impl Noise {
    pub(crate) const fn new(seed: u64, scale: f64) -> Self {
        Self { seed, scale }
    }

    /// The value at a place: 0 to 1.
    #[expect(clippy::cast_possible_truncation, reason = "places are small")]
    pub(crate) fn at(&self, place: [f64; 3]) -> f64 {
        let place = place.map(|x| x / self.scale);
        let cell = place.map(|x| x.floor() as i64);
        let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
        let share = place.map(|x| smooth(x - x.floor()));
        let mut sum = 0.0;
        for corner in 0..8_i64 {
            let bit = |axis: usize| corner >> axis & 1;
            let weight = |axis: usize| if bit(axis) == 1 { share[axis] } else { 1.0 - share[axis] };
            let point = [0, 1, 2].map(|axis| cell[axis] + bit(axis));
            sum += weight(0) * weight(1) * weight(2) * self.random(point);
        }
        sum
    }

    /// The value at a place of a plane.
    pub(crate) fn flat(&self, x: f64, y: f64) -> f64 {
        self.at([x, y, 0.0])
    }

    /// A number of its own for each point of the lattice.
    fn random(&self, point: [i64; 3]) -> f64 {
        let mix = |state: u64, value: u64| {
            // The finalizer of SplitMix64.
            let mut z = (state ^ value).wrapping_add(0x9e37_79b9_7f4a_7c15);
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        let bits = point.iter().fold(mix(0, self.seed), |state, x| mix(state, x.cast_unsigned()));
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}
