//! The plume: jets and droplets of melt, vapor, and the front that runs ahead of them.

use super::{
    Atom,
    target::{Target, in_cut},
};
use crate::synthetic::{
    noise::Noise,
    random::{Random, cube_root, even_point, ln, smoothstep, turn, whole},
};
use glam::DVec3;
use std::f64::consts::PI;

/// Where everything flies apart from.
const SOURCE: DVec3 = DVec3::new(0.0, 0.0, -0.25);
/// The middle of the front's cap, a ball that is cut off below.
const CAP: DVec3 = DVec3::new(0.0, 0.0, 0.95);
const CAP_RADIUS: f64 = 0.9;
/// The height of the cap as a share of its radius.
const CAP_HEIGHT: f64 = 0.82;
/// Where the cap ends and the roll begins, in turns from the top.
const CAP_END: f64 = 0.27;
/// The radius of the roll at the brim of the cap.
const ROLL: f64 = 0.21;

/// How many droplets are tried; some would touch others and are left out.
const DROPS: usize = 6000;

/// What flies above the block.
#[derive(Clone, Debug)]
pub(super) struct Plume {
    drops: Vec<Drop>,
    /// The drop that is being filled, and how many atoms it has by now.
    current: usize,
    filled: u64,
    fold: Noise,
    /// How much of the front lies where it is torn, in comparison with where it is whole.
    haze: f64,
    /// Whether the front is cut open like the block.
    cut: bool,
}

/// A droplet, or a piece of a jet: an ellipsoid full of atoms.
#[derive(Clone, Copy, Debug)]
struct Drop {
    center: DVec3,
    /// The direction it is stretched along.
    axis: DVec3,
    stretch: f64,
    radius: f64,
    temperature: f64,
    /// How many atoms it has.
    count: u64,
}

impl Drop {
    fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * self.radius * self.radius * self.radius
    }
}

impl Plume {
    pub(super) fn new(seed: u64, target: &Target) -> Self {
        let fold = Noise::new(seed, 1);
        let mut plume = Self {
            drops: Vec::new(),
            current: 0,
            filled: 0,
            fold,
            haze: 0.0,
            cut: target.is_cut(),
        };
        let mut random = Random::new(seed, 2);
        for jet in 0..22 {
            plume.add_jet(Jet::from_rim(jet, &mut random), target, &mut random);
        }
        for _ in 0..12 {
            plume.add_jet(Jet::from_floor(&mut random), target, &mut random);
        }
        let mut radii: Vec<f64> = (0..DROPS).map(|_| random.power_law(0.004, 0.16, 1.5)).collect();
        // Large ones first: they find no room any more among small ones.
        radii.sort_by(|a, b| b.total_cmp(a));
        for radius in radii {
            plume.try_drop(radius, &mut random);
        }
        plume
    }

    /// Adds the pieces of a jet, which part from each other towards its end.
    fn add_jet(&mut self, jet: Jet, target: &Target, random: &mut Random) {
        let mut along = 0.0;
        if self.cut && in_cut(jet.at(0.0, target, &self.fold)) {
            return;
        }
        while along < 1.0 {
            let (place, next) = (jet.at(along, target, &self.fold), along + 0.004);
            let course = jet.at(next, target, &self.fold) - place;
            let swell = 1.0 + 0.9 * self.fold.at(DVec3::new(jet.turns * 50.0, along * 11.0, 0.5));
            let radius = jet.radius * (1.0 - 0.72 * along) * swell.max(0.2);
            let broken = smoothstep(0.2, 0.65, along);
            if random.unit() >= 0.35 * broken {
                self.drops.push(Drop {
                    center: place,
                    axis: course / course.length().max(1e-9),
                    stretch: 1.9 - 0.7 * broken,
                    radius,
                    temperature: 2850.0 - 500.0 * along,
                    count: 0,
                });
            }
            let apart = radius * (0.9 + 1.9 * broken * (0.6 + 0.8 * random.unit()));
            along += apart / jet.length;
        }
    }

    /// Adds a droplet in flight, unless it would touch another one.
    fn try_drop(&mut self, radius: f64, random: &mut Random) {
        // What is heavy is slow, and stays near the axis.
        let fastest = 1.0 - 0.5 * smoothstep(0.01, 0.12, radius);
        let speed = random.between(0.16, fastest);
        let across = 0.13 + 0.2 * speed;
        let direction = DVec3::new(random.normal() * across, random.normal() * across, 1.0);
        let center = SOURCE + direction / direction.length() * speed * 1.95;
        let brim = (center - CAP).length() < CAP_RADIUS - 2.0 * radius;
        let stem = center.z < 0.75 && center.truncate().length() < 0.28 + 0.5 * center.z.max(0.0);
        let apart =
            |other: &Drop| center.distance(other.center) > radius + other.radius * other.stretch;
        if (brim || stem) && center.z > 0.1 && self.drops.iter().all(apart) {
            let stretch = 1.0 + 0.9 * random.unit() * random.unit();
            let axis = random.direction() * 0.5 + direction;
            let axis = axis / axis.length();
            let noise = self.fold.at(center * 3.0 + 11.5);
            let temperature = 2000.0 + 1300.0 * smoothstep(0.0, 1.5, center.z) + 800.0 * noise;
            self.drops.push(Drop { center, axis, stretch, radius, temperature, count: 0 });
        }
    }

    /// The volume of all jets and droplets.
    pub(super) fn liquid_volume(&self) -> f64 {
        self.drops.iter().map(Drop::volume).sum()
    }

    /// Gives every droplet its atoms; those that are smaller than one get none. The front is to be
    /// seen through where it is torn, however many times it would cover its area.
    pub(super) fn fill(&mut self, atom_volume: f64, front_cover: f64) {
        self.haze = 0.11 / front_cover;
        for drop in &mut self.drops {
            drop.count = whole(drop.volume() / atom_volume + 0.5);
        }
    }

    /// The next atom of a jet or droplet.
    pub(super) fn next_of_liquid(&mut self, random: &mut Random) -> Option<Atom> {
        let drop = loop {
            let drop = self.drops.get(self.current)?;
            if self.filled < drop.count {
                break drop;
            }
            self.current += 1;
            self.filled = 0;
        };
        // Points that are even in a cube are so in the ball that the cube is mapped to.
        let even = even_point(self.filled + 7919 * self.current as u64);
        self.filled += 1;
        let z = 2.0 * even.y - 1.0;
        let (sin, cos) = turn(even.x);
        let across = (1.0 - z * z).sqrt();
        let unit = DVec3::new(across * cos, across * sin, z) * cube_root(even.z);
        let lump = 1.0 + 0.12 * self.fold.at(drop.center * 40.0 + unit * 1.2);
        let narrow = 1.0 / drop.stretch.sqrt();
        let along = drop.axis.dot(unit);
        let stretched = (unit + drop.axis * along * (drop.stretch / narrow - 1.0)) * narrow;
        let spacing = 1.6 / cube_root(drop.count as f64);
        let place =
            drop.center + (stretched * lump + random.normals() * spacing * 0.25) * drop.radius;
        let temperature = drop.temperature * (1.0 + 0.03 * random.normal());
        Some(Atom { place, temperature })
    }

    /// A single atom of vapor, which fills the plume and runs ahead of it.
    pub(super) fn vapor(&self, random: &mut Random) -> Atom {
        // Few are slow, and the number of fast ones falls off exponentially.
        let slowness = (1.0 - 0.99 * random.unit()) * (1.0 - 0.99 * random.unit());
        let speed = 0.12 - 0.25 * ln(slowness);
        let across = 0.36;
        let direction = DVec3::new(random.normal() * across, random.normal() * across, 1.0);
        let place = SOURCE + direction / direction.length() * speed * 1.9;
        let temperature = 3600.0 + 900.0 * speed.min(1.6);
        Atom { place, temperature: temperature * (1.0 + 0.1 * random.normal()) }
    }

    /// An atom of the front.
    pub(super) fn front(&self, random: &mut Random) -> Atom {
        loop {
            let turns = random.unit();
            let atom = if random.unit() < 0.66 {
                self.cap(turns, random)
            } else {
                self.roll(turns, random)
            };
            if let Some(atom) = atom.filter(|atom| !(self.cut && in_cut(atom.place))) {
                return atom;
            }
        }
    }

    /// A place on the cap at an angle around the axis, if the sheet is not torn there.
    fn cap(&self, turns: f64, random: &mut Random) -> Option<Atom> {
        let (_, end_cos) = turn(CAP_END);
        let cos_down = random.between(end_cos, 1.0);
        let sin_down = (1.0 - cos_down * cos_down).sqrt();
        let (sin, cos) = turn(turns);
        let outward = DVec3::new(sin_down * cos, sin_down * sin, cos_down);
        let thread = self.threads(outward * 3.4);
        if random.unit() > self.haze + smoothstep(0.72, 0.95, thread) {
            return None;
        }
        // Folds grow from the brim, where the sheet must meet the roll, towards the top.
        let folds = smoothstep(end_cos, 0.35, cos_down);
        let fold = 0.20 * self.fold.at(outward * 2.6) + 0.07 * self.fold.at(outward * 7.0);
        // Threads are drawn out into fingers.
        let finger = 0.10 * smoothstep(0.9, 1.0, thread) * random.unit() * random.unit();
        let thickness = 0.007 * random.normal();
        let place = outward * (CAP_RADIUS + fold * folds + finger + thickness);
        let place = CAP + place * DVec3::new(1.0, 1.0, CAP_HEIGHT);
        let hot = 4700.0 + 900.0 * outward.z + 700.0 * (thread - 0.7);
        Some(Atom { place, temperature: hot * (1.0 + 0.03 * random.normal()) })
    }

    /// A place on the roll at the brim of the cap, which winds inwards.
    fn roll(&self, turns: f64, random: &mut Random) -> Option<Atom> {
        let (end_sin, end_cos) = turn(CAP_END);
        let wound = random.unit();
        let (sin, cos) = turn(turns);
        let around = DVec3::new(cos, sin, 0.0);
        let wobble = self.fold.at(around * 2.2 + 3.5);
        let radius = ROLL * (1.0 - 0.75 * wound) * (1.0 + 0.5 * wobble * wound);
        let (roll_sin, roll_cos) = turn(CAP_END + 1.35 * wound);
        let brim = CAP_RADIUS - ROLL;
        let (out, up) = (brim * end_sin + radius * roll_sin, brim * end_cos + radius * roll_cos);
        let place = CAP + around * out + DVec3::Z * (up * CAP_HEIGHT);
        let thread = self.threads(place * 4.2);
        if random.unit() > self.haze + smoothstep(0.6, 0.9, thread) {
            return None;
        }
        let hot = 4700.0 - 900.0 * wound + 700.0 * (thread - 0.7);
        let blur = random.normals() * 0.006;
        Some(Atom { place: place + blur, temperature: hot * (1.0 + 0.03 * random.normal()) })
    }

    /// A field whose highest values, near 1, lie along lines that cross a sheet.
    fn threads(&self, place: DVec3) -> f64 {
        let bend = self.fold.at(place * 0.7 + 5.5) * 0.8;
        let coarse = 1.0 - 2.2 * self.fold.at(place + bend).abs();
        let fine = 1.0 - 2.2 * self.fold.at(place * 2.3 + 9.5).abs();
        coarse.max(fine - 0.12)
    }
}

/// A jet of melt that leaves the crater.
#[derive(Clone, Copy, Debug)]
struct Jet {
    /// Its direction around the axis, in turns.
    turns: f64,
    /// How far from the axis it starts.
    start: f64,
    /// How far outwards it gets, and how far up.
    reach: f64,
    rise: f64,
    radius: f64,
    length: f64,
}

impl Jet {
    /// One of 22 jets of the crown on the rim.
    fn from_rim(jet: u32, random: &mut Random) -> Self {
        let (reach, rise) = (random.between(0.10, 0.34), random.between(0.16, 0.5));
        Self {
            turns: (f64::from(jet) + 0.7 * random.unit()) / 22.0,
            start: 0.6,
            reach,
            rise,
            radius: random.between(0.02, 0.042),
            length: (reach * reach + rise * rise).sqrt(),
        }
    }

    /// A jet from the floor, in the stem of the plume.
    fn from_floor(random: &mut Random) -> Self {
        let (reach, rise) = (random.between(-0.05, 0.38), random.between(0.7, 1.5));
        Self {
            turns: random.unit(),
            start: random.between(0.04, 0.38),
            reach,
            rise,
            radius: random.between(0.016, 0.036),
            length: (reach * reach + rise * rise).sqrt(),
        }
    }

    /// The place that lies so far along, from 0 at the foot to 1 at the tip.
    fn at(&self, along: f64, target: &Target, bend: &Noise) -> DVec3 {
        let (sin, cos) = turn(self.turns);
        let foot = target.surface(self.start * cos, self.start * sin);
        let out = self.start + self.reach * along * along;
        let up = foot - 0.03 + self.rise * along;
        let place = DVec3::new(out * cos, out * sin, up);
        let swerve = |field: f64| bend.at(DVec3::new(self.turns * 31.0, up * 3.4, field));
        let growing = along * 0.5;
        place + DVec3::new(swerve(1.3), swerve(4.3), 0.0) * growing
    }
}
