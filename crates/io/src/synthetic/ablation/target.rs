//! The block: its surface, the bubbles in it, how hot it is where, and the crystal it is made of.

use super::Atom;
use crate::synthetic::{
    noise::Noise,
    random::{Random, exp, smoothstep, whole},
};
use glam::DVec3;

/// How deep the block reaches.
const DEPTH: f64 = 0.72;
/// The mean radius of the crater.
const CRATER_RADIUS: f64 = 0.56;
/// The depth of the crater.
const CRATER_DEPTH: f64 = 0.36;
/// How high the rim stands above the block, in the mean.
const RIM: f64 = 0.11;
/// How many bubbles are tried; some would touch others and are left out.
const BUBBLES: usize = 3000;

/// The block.
#[derive(Clone, Debug)]
pub(super) struct Target {
    relief: Noise,
    bubbles: Vec<Bubble>,
    /// Whether the quarter of positive x and negative y is cut away.
    cut: bool,
}

/// Whether a place lies in the quarter that may be cut away.
pub(super) fn in_cut(place: DVec3) -> bool {
    place.x > 0.0 && place.y < 0.0
}

/// An empty ball in the melt.
#[derive(Clone, Copy, Debug)]
struct Bubble {
    center: DVec3,
    radius: f64,
}

impl Target {
    pub(super) fn new(seed: u64, cut: bool) -> Self {
        let mut target = Self { relief: Noise::new(seed, 0), bubbles: Vec::new(), cut };
        let mut random = Random::new(seed, 1);
        // Large ones first: they find no room any more among small ones.
        for i in 0..BUBBLES {
            let done = i as f64 / BUBBLES as f64;
            target.try_bubble(0.12 * (1.0 - 0.8 * done), &mut random);
        }
        target
    }

    /// Whether a quarter is cut away.
    pub(super) const fn is_cut(&self) -> bool {
        self.cut
    }

    /// Adds a bubble of at most this size, unless it is out of the melt or too near to another.
    fn try_bubble(&mut self, largest: f64, random: &mut Random) {
        let mut direction = random.direction();
        direction.z = -direction.z.abs();
        let shell = random.between(0.97, 1.75);
        let center = direction * DVec3::new(CRATER_RADIUS, CRATER_RADIUS, CRATER_DEPTH) * shell;
        // Deep down the pressure is higher and bubbles stay small.
        let radius = largest * random.between(0.6, 1.0) * (1.6 - 0.6 * shell);
        let below = self.surface(center.x, center.y) - center.z;
        let crater = self.crater(center.x, center.y);
        let open = below < 1.4 * radius && crater.1 > 0.8;
        let apart = |other: &Bubble| center.distance(other.center) > radius + other.radius + 0.006;
        if !open && Self::temperature(center.z, crater) > 1000.0 && self.bubbles.iter().all(apart) {
            self.bubbles.push(Bubble { center, radius });
        }
    }

    /// The crater's radius in the direction of a place, and its distance as a share of that.
    fn crater(&self, x: f64, y: f64) -> (f64, f64) {
        let wobble = self.relief.at(DVec3::new(x * 2.2, y * 2.2, 7.5));
        let radius = CRATER_RADIUS * (1.0 + 0.22 * wobble);
        (radius, (x * x + y * y).sqrt() / radius)
    }

    /// The height of the surface.
    pub(super) fn surface(&self, x: f64, y: f64) -> f64 {
        let (_, share) = self.crater(x, y);
        let bowl = -CRATER_DEPTH * smoothstep(1.08, 0.12, share);
        let crest = (share - 1.12) / if share < 1.12 { 0.11 } else { 0.2 };
        let uneven = 0.75 + 1.3 * self.relief.octaves(DVec3::new(x * 4.5, y * 4.5, 2.5), 2);
        let rim = RIM * uneven.max(0.15) * exp(-crest * crest);
        let rough = 0.035 * self.relief.octaves(DVec3::new(x * 9.0, y * 9.0, 5.5), 3);
        bowl + rim + rough * smoothstep(1.5, 0.9, share)
    }

    /// How hot the block is at a height, in kelvin, where the crater has this radius and the axis
    /// is this share of it away.
    fn temperature(z: f64, (radius, share): (f64, f64)) -> f64 {
        let z = if z > 0.0 { 0.4 * z } else { z };
        let shell = (share * share + (z / CRATER_DEPTH) * (z / CRATER_DEPTH)).sqrt();
        let outside = ((shell - 0.92) * radius).max(0.0);
        let wave = (shell - 1.85) / 0.08;
        let wake = (shell - 1.7) / 0.3;
        300.0
            + 1500.0 * exp(-outside / 0.13)
            + 1250.0 * smoothstep(0.44, 0.2, outside)
            + 700.0 * exp(-wave * wave)
            + 250.0 * exp(-wake * wake)
    }

    /// The atom at a site of the crystal.
    fn atom(site: DVec3, crater: (f64, f64), side: f64, random: &mut Random) -> Atom {
        let temperature = Self::temperature(site.z, crater);
        let molten = smoothstep(900.0, 1400.0, temperature);
        let place = site + random.normals() * side * (0.02 + 0.13 * molten);
        Atom { place, temperature: temperature * (1.0 + 0.03 * random.normal()) }
    }

    /// The volume of the block without its bubbles, from a grid of columns.
    pub(super) fn volume(&self) -> f64 {
        const COLUMNS: u32 = 240;
        let step = 2.0 / f64::from(COLUMNS);
        let mut runs = Vec::new();
        let mut sum = 0.0;
        for column in 0..COLUMNS * COLUMNS {
            let at = |index: u32| (f64::from(index) + 0.5) * step - 1.0;
            self.runs(at(column % COLUMNS), at(column / COLUMNS), &mut runs);
            sum += runs.iter().map(|(low, high)| high - low).sum::<f64>();
        }
        sum * step * step
    }

    /// Finds where a column of the block is solid: runs of z, from below.
    fn runs(&self, x: f64, y: f64, runs: &mut Vec<(f64, f64)>) {
        runs.clear();
        if self.cut && in_cut(DVec3::new(x, y, 0.0)) {
            return;
        }
        let hole = |bubble: &Bubble| {
            let (dx, dy) = (x - bubble.center.x, y - bubble.center.y);
            let half = bubble.radius * bubble.radius - dx * dx - dy * dy;
            (half > 0.0).then(|| (bubble.center.z - half.sqrt(), bubble.center.z + half.sqrt()))
        };
        // Bubbles lie apart, so holes do not overlap. For now the list has the holes, ...
        runs.extend(self.bubbles.iter().filter_map(hole));
        runs.sort_by(|a, b| a.0.total_cmp(&b.0));
        // ... and now what lies between them.
        let (mut low, top) = (-DEPTH, self.surface(x, y));
        for run in runs.iter_mut() {
            let hole = *run;
            *run = (low, hole.0.min(top));
            low = hole.1;
        }
        runs.push((low, top));
        runs.retain(|(low, high)| low < high);
    }
}

/// The sites of a face-centred cubic crystal that lie in the block, column by column.
#[derive(Clone, Debug)]
pub(super) struct Crystal {
    /// The distance of columns, and how much higher the next site lies in the next column: half
    /// the side of a cell.
    pitch: f64,
    rise: f64,
    /// How many columns there are along x, and along y.
    columns: u64,
    /// The number of the next column.
    next: u64,
    /// Where the present column stands, and how the crater lies to it.
    x: f64,
    y: f64,
    crater: (f64, f64),
    /// Where it is solid, in reverse: the last one is the lowest.
    runs: Vec<(f64, f64)>,
    /// The number of its next site, counted from the bottom in steps of `rise`.
    site: u64,
}

impl Crystal {
    pub(super) fn new(side: f64) -> Self {
        // Columns must fill the block from side to side; the crystal gives way a little for that,
        // and its density stays what it was.
        let half = side * 0.5;
        let columns = whole((2.0 / half).round()).max(1);
        let pitch = 2.0 / columns as f64;
        let rise = half * half * half / (pitch * pitch);
        let (next, x, y, crater, site) = (0, 0.0, 0.0, (1.0, 0.0), 0);
        Self { pitch, rise, columns, next, x, y, crater, runs: Vec::new(), site }
    }

    /// The next atom of the block.
    pub(super) fn next_atom(&mut self, target: &Target, random: &mut Random) -> Option<Atom> {
        loop {
            while let Some((low, high)) = self.runs.last().copied() {
                let z = -DEPTH + (self.site as f64 + 0.5) * self.rise;
                if z >= high {
                    self.runs.pop();
                    continue;
                }
                self.site += 2;
                if z >= low {
                    let site = DVec3::new(self.x, self.y, z);
                    return Some(Target::atom(site, self.crater, 2.0 * self.pitch, random));
                }
            }
            if self.next == self.columns * self.columns {
                return None;
            }
            self.start_column(target);
        }
    }

    fn start_column(&mut self, target: &Target) {
        let (line, column) = (self.next / self.columns, self.next % self.columns);
        self.next += 1;
        let middle = (self.columns - 1) as f64 * 0.5;
        self.x = (column as f64 - middle) * self.pitch;
        self.y = (line as f64 - middle) * self.pitch;
        self.crater = target.crater(self.x, self.y);
        target.runs(self.x, self.y, &mut self.runs);
        self.runs.reverse();
        // Sites of neighboring columns alternate: that makes the crystal face-centred.
        self.site = (line + column) % 2;
    }
}
