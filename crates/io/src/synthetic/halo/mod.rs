/*!
The halos: matter as cosmological simulations find it, clustered on all scales.

Three things share the mass:

* halos, 50 %: their masses follow a power law over three and a half decades. Each has the profile
  of Hernquist (*An analytical model for spherical galaxies and bulges*, Astrophysical Journal 356,
  1990), whose density rises as 1/r towards the centre, as in that of Navarro, Frenk and White. They
  are triaxial, cut where the mean density is 200 times that of the box, and large ones hold
  smaller ones;
* the web, 45 %: evenly spread matter, moved by the slope of a random potential as in the
  approximation of Zel'dovich (*Gravitational instability*, Astronomy and Astrophysics 5, 1970), but
  in several steps, each from where the last one led. So it does not run through the filaments that
  it makes, and stays there. Halos lie where it gathers most;
* 5 % that is spread evenly.

Densities reach from voids to halo centers over more than six decades: a test for whatever assumes
that records are spread evenly. Lengths are Mpc/h in a periodic box from -50 to 50; no direction is
up, and z stands in for it. The scalar `density` is the logarithm to base 10 of the density at the
record in units of the mean, by the formula that the record was placed by; what else lies there is
left out.

The default radius is a fraction of the mean distance of records.
*/

mod web;

use super::{
    Make, Row,
    random::{Random, cube_root, even_point, log10, power, single, turn, whole},
    spec::{Key, Kind, Spec},
};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use web::{Patch, Web};

/// The side of the box.
const BOX: f64 = 100.0;
/// The shares of the mass; what is left is spread evenly.
const SHARE_OF_HALOS: f64 = 0.50;
const SHARE_OF_WEB: f64 = 0.45;
/// How many halos there are, without those in halos.
const HALOS: usize = 5000;
/// Over how large a range their masses go, and how their number falls with mass.
const MASS_RANGE: f64 = 3000.0;
const MASS_SLOPE: f64 = 0.9;
/// How far matter of the web strays from where it should be.
const WARMTH: f64 = 0.16;
/// How many records of the web start from one piece of space.
const PATCH: u64 = 8;
/// The mean density of a halo, in units of the mean.
const VIRIAL: f64 = 200.0;

pub(super) const KIND: Kind = Kind {
    name: "halo",
    about: "matter clustered as in cosmology: halos in halos, filaments and voids",
    keys: &[
        Key::count("1000000"),
        Key::derived(
            "r",
            "6 / cbrt(n)",
            |spec| 6.0 / cube_root(spec.number("n")),
            "radius of the records",
        ),
        Key::seed(),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Halo {
    /// Halos and the halos in them.
    clumps: Vec<Clump>,
    current: usize,
    web: Web,
    /// The piece of space that matter of the web comes from, and how many records it has by now.
    patch: Patch,
    in_patch: u64,
    /// How many pieces there were.
    patches: u64,
    /// Half the side of a piece.
    patch_half: f64,
    /// How many records there are, and how many are made.
    count: f64,
    made: u64,
    radius: f32,
    random: Random,
}

/// A ball of matter that is dense inside.
#[derive(Clone, Copy, Debug)]
struct Clump {
    center: DVec3,
    /// The axes of its ellipsoid; their lengths multiply to one.
    axes: [DVec3; 3],
    /// Where it is cut, in units of the radius where its profile bends.
    cut: f64,
    /// That radius.
    bend: f64,
    /// The share of all mass that it has.
    share: f64,
    /// The share that it has together with all clumps before it.
    share_so_far: f64,
}

impl Halo {
    pub(super) fn new(spec: &Spec) -> Self {
        let web = Web::new(spec.seed());
        let mut random = Random::new(spec.seed(), 1);
        let count = spec.count() as f64;
        Self {
            clumps: clumps(&web, &mut random),
            current: 0,
            patch: web.patch(DVec3::ZERO),
            in_patch: 0,
            patches: 0,
            patch_half: 0.5 * BOX / cube_root(count * SHARE_OF_WEB / PATCH as f64),
            web,
            count,
            made: 0,
            radius: spec.radius(),
            random: Random::new(spec.seed(), 2),
        }
    }

    /// The place of the next record and the density there.
    fn place(&mut self) -> (DVec3, f64) {
        let share = self.made as f64 / self.count;
        self.made += 1;
        while let Some(clump) = self.clumps.get(self.current) {
            if share < clump.share_so_far {
                return clump.place(&mut self.random);
            }
            self.current += 1;
        }
        let random = self.random.in_cube();
        let even = 1.0 - SHARE_OF_HALOS - SHARE_OF_WEB;
        if share >= SHARE_OF_HALOS + SHARE_OF_WEB {
            return (random * (0.5 * BOX), even);
        }
        if self.in_patch == 0 {
            let start = (even_point(self.patches) - 0.5) * BOX;
            self.patch = self.web.patch(start);
            self.patches += 1;
        }
        self.in_patch = (self.in_patch + 1) % PATCH;
        let blur = self.random.normals() * WARMTH;
        (self.patch.at(random * self.patch_half) + blur, self.patch.density() * SHARE_OF_WEB + even)
    }
}

impl Make for Halo {
    const SCALAR: Option<&'static str> = Some("density");

    fn row(&mut self) -> Row {
        let (place, density) = self.place();
        // The box is periodic: what leaves it comes in on the other side.
        let place = place - (place / BOX).round() * BOX;
        Row {
            position: place.to_array().map(single),
            radius: self.radius,
            value: single(log10(density)),
            ..Row::default()
        }
    }
}

/// All halos, heaviest first, each followed by the halos in it.
fn clumps(web: &Web, random: &mut Random) -> Vec<Clump> {
    let mut masses: Vec<f64> =
        (0..HALOS).map(|_| random.power_law(1.0, MASS_RANGE, MASS_SLOPE)).collect();
    masses.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = masses.iter().sum();
    let mut clumps = Vec::new();
    for (rank, mass) in masses.into_iter().enumerate() {
        // Heavy halos lie in the densest of many places, light ones nearly anywhere in the web.
        let candidates = 3 + 150 / (rank + 4);
        let center = web.dense_place(candidates, random);
        add_halo(center, mass / all * SHARE_OF_HALOS, random, &mut clumps);
    }
    let mut so_far = 0.0;
    for clump in &mut clumps {
        so_far += clump.share;
        clump.share_so_far = so_far;
    }
    clumps
}

/// Adds a halo and the halos in it.
fn add_halo(center: DVec3, share: f64, random: &mut Random, clumps: &mut Vec<Clump>) {
    const SHARE_MIN: f64 = 0.0008;
    let host = Clump::new(center, share, random);
    let first = clumps.len();
    clumps.push(host);
    let guests = whole((share / SHARE_MIN).sqrt() * 8.0).min(40);
    let mut given_away = 0.0;
    for _ in 0..if share > SHARE_MIN { guests } else { 0 } {
        let part = random.power_law(0.0008, 0.03, 0.9);
        let distance = host.bend * host.cut * (0.15 + 0.85 * random.unit());
        let place = center + host.stretch(random.direction()) * distance;
        let mut guest = Clump::new(place, share * part, random);
        // Tides strip the outside of a halo that is in a larger one.
        guest.cut *= 0.6;
        given_away += guest.share;
        clumps.push(guest);
    }
    if let Some(host) = clumps.get_mut(first) {
        host.share -= given_away;
    }
}

impl Clump {
    fn new(center: DVec3, share: f64, random: &mut Random) -> Self {
        let radius = cube_root(share * BOX * BOX * BOX * 3.0 / (4.0 * PI * VIRIAL));
        // Light halos formed early, when all was denser; they are denser inside.
        let cut = 7.0 * power(share / 0.01, -0.08) * random.between(0.8, 1.25);
        let bend = radius / cut;
        let axes = axes(random);
        Self { center, axes, cut, bend, share, share_so_far: 0.0 }
    }

    /// A place in a ball, moved to where it is in the ellipsoid.
    fn stretch(&self, place: DVec3) -> DVec3 {
        self.axes[0] * place.x + self.axes[1] * place.y + self.axes[2] * place.z
    }

    /// A random place in the clump, and the density there.
    fn place(&self, random: &mut Random) -> (DVec3, f64) {
        // The mass within x bends is (x / (1 + x))^2 of the whole.
        let within = self.cut / (1.0 + self.cut);
        let root = within * random.unit().sqrt();
        let x = root / (1.0 - root);
        let place = self.center + self.stretch(random.direction()) * (x * self.bend);
        // Towards the middle the formula has no end, but the records of a scene have.
        let x = x.max(0.003);
        let whole = self.share / (within * within);
        let volume = self.bend * self.bend * self.bend / (BOX * BOX * BOX);
        let around = (1.0 + x) * (1.0 + x) * (1.0 + x);
        (place, 1.0 + whole / (TAU * volume * x * around))
    }
}

/// Three axes at right angles in a random direction, one longer and one shorter than the others.
fn axes(random: &mut Random) -> [DVec3; 3] {
    let long = random.direction();
    // Any vector that is not along the first one gives the second.
    let other = if long.x.abs() < 0.7 { DVec3::X } else { DVec3::Y };
    let middle = long.cross(other);
    let middle = middle / middle.length();
    let short = long.cross(middle);
    let (sin, cos) = turn(random.unit());
    let (middle, short) = (middle * cos + short * sin, short * cos - middle * sin);
    let lengths = DVec3::new(1.0, random.between(0.7, 1.0), random.between(0.55, 0.75));
    let scale = 1.0 / cube_root(lengths.element_product());
    [long * lengths.x * scale, middle * lengths.y * scale, short * lengths.z * scale]
}
