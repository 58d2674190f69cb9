/*!
The scans: rays from scanners, in columns that turn around the vertical.

A column of rays lies in a half plane. Only parts whose bounding ball meets that half plane can be
hit, and each of them only by rays between two slopes; what remains to be done for a ray is little.
*/

use super::{
    form::Hit,
    kit::{HALF_LENGTH, HALF_WIDTH, HEIGHT, Part},
    plant, share, single, whole,
};
use crate::synthetic::{
    noise::Noise,
    random::{Random, smoothstep, turn},
};
use glam::DVec3;

/// Where the scanners stand, and how many parts of the points each one takes.
const SCANNERS: [(DVec3, u64); 7] = [
    (DVec3::new(-26.5, -1.2, 1.72), 3),
    (DVec3::new(-13.6, -0.9, 1.70), 3),
    (DVec3::new(1.0, -1.6, 1.74), 3),
    (DVec3::new(12.2, -2.4, 1.71), 3),
    (DVec3::new(24.5, -3.9, 1.75), 2),
    (DVec3::new(-5.2, 9.9, 1.73), 2),
    (DVec3::new(20.6, 7.0, 4.92), 2),
];

/// How far down a scanner sees, in turns: below is its tripod.
const LOWEST: f64 = -0.17;
/// How far up: all but the zenith itself.
const HIGHEST: f64 = 0.249;

/// A point that a ray returned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) place: DVec3,
    pub(super) color: [u8; 3],
    pub(super) intensity: f64,
}

/// All scans, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    parts: Vec<Part>,
    /// A ball around each part.
    bounds: Vec<(DVec3, f64)>,
    /// How many points there are in all scans.
    count: u64,
    /// The number of the next scanner.
    next_scanner: usize,
    eye: DVec3,
    /// How many rays and columns the scan has, and which column it has come to.
    rays: u64,
    columns: u64,
    column: u64,
    /// How many rays the column has, and which is the next.
    lines: u64,
    line: u64,
    /// The sine and cosine of the column's angle around the vertical.
    heading: (f64, f64),
    /// The parts that rays of the column can meet.
    near: Vec<Near>,
    range_noise: f64,
    dirt: Noise,
    random: Random,
}

/// A part that a column of rays can meet.
#[derive(Clone, Copy, Debug)]
struct Near {
    part: usize,
    /// Where its bounding ball lies in the half plane of the column.
    out: f64,
    up: f64,
    /// A ray comes near if it goes so far in the direction of the ball.
    least: f64,
}

impl Scan {
    pub(super) fn new(seed: u64, count: u64, range_noise: f64) -> Self {
        let parts = plant::build(seed);
        Self {
            bounds: parts.iter().map(|part| part.form.bound()).collect(),
            parts,
            count,
            next_scanner: 0,
            eye: DVec3::ZERO,
            rays: 0,
            columns: 0,
            column: 0,
            lines: 0,
            line: 0,
            heading: (0.0, 1.0),
            near: Vec::new(),
            range_noise,
            dirt: Noise::new(seed, 0),
            random: Random::new(seed, 0),
        }
    }

    /// The point that the next ray returns.
    pub(super) fn point(&mut self) -> Point {
        while self.line == self.lines {
            self.start_column();
        }
        let share = (self.line as f64 + self.random.unit()) / self.lines as f64;
        self.line += 1;
        let (up, out) = turn(LOWEST + (HIGHEST - LOWEST) * share);
        let ray = DVec3::new(out * self.heading.1, out * self.heading.0, up);
        let mut first = shell(self.eye, ray);
        let mut part = None;
        for near in &self.near {
            if out * near.out + up * near.up >= near.least {
                let candidate = &self.parts[near.part];
                if let Some(hit) = candidate.form.hit(self.eye, ray)
                    && hit.distance < first.distance
                {
                    first = hit;
                    part = Some(near.part);
                }
            }
        }
        let part = part.map(|part| self.parts[part]);
        self.paint(ray, first, part)
    }

    fn start_column(&mut self) {
        while self.column == self.columns {
            self.start_scanner();
        }
        let before = |column: u64| share(self.rays, column, self.columns);
        self.lines = before(self.column + 1) - before(self.column);
        self.line = 0;
        let heading = turn((self.column as f64 + 0.5) / self.columns as f64);
        self.column += 1;
        self.heading = heading;
        self.near.clear();
        for (part, (center, radius)) in self.bounds.iter().enumerate() {
            let to = *center - self.eye;
            let across = to.y * heading.1 - to.x * heading.0;
            let out = to.x * heading.1 + to.y * heading.0;
            if across.abs() < *radius && out > -*radius {
                let cut = radius * radius - across * across;
                let least = (out * out + to.z * to.z - cut).max(0.0).sqrt();
                let inside = out * out + to.z * to.z <= cut;
                let least = if inside { f64::NEG_INFINITY } else { least };
                self.near.push(Near { part, out, up: to.z, least });
            }
        }
    }

    fn start_scanner(&mut self) {
        let all: u64 = SCANNERS.iter().map(|(_, share)| share).sum();
        let index = self.next_scanner % SCANNERS.len();
        self.next_scanner += 1;
        let before = |end: usize| {
            let shares: u64 = SCANNERS[..end].iter().map(|(_, share)| share).sum();
            share(self.count, shares, all)
        };
        self.rays = before(index + 1) - before(index);
        self.eye = SCANNERS[index].0;
        // Columns are as far apart as the rays of a column.
        self.columns = whole((self.rays as f64 / (HIGHEST - LOWEST)).sqrt()).max(1);
        self.column = 0;
    }

    /// The point where a ray meets a part, or the hall itself.
    fn paint(&mut self, ray: DVec3, hit: Hit, part: Option<Part>) -> Point {
        let place = self.eye + ray * hit.distance;
        let dirt = self.dirt.octaves(place * DVec3::new(0.9, 0.9, 0.45), 2);
        let (paint, gloss) = match part {
            Some(part) => (part.paint, part.gloss),
            None => self.shell_paint(place, hit.normal, dirt),
        };
        let down = smoothstep(1.2, 0.0, place.z);
        let light = 0.80 + 0.22 * hit.normal.z + 0.05 * hit.normal.x - 0.10 * down;
        let speckle = 1.0 + 0.035 * self.random.normal();
        let color = paint * light * (1.0 + 0.16 * dirt) * speckle * 255.0;
        let slant = -hit.normal.dot(ray);
        let weak = 1.0 / (1.0 + hit.distance * hit.distance / 900.0);
        let bright = 0.3 + 0.7 * paint.element_sum() / 3.0;
        let intensity = gloss * bright * (0.35 + 0.65 * slant) * weak;
        let error = self.range_noise * self.random.normal();
        Point {
            place: place + ray * error,
            color: color.to_array().map(byte),
            intensity: (intensity * (1.0 + 0.05 * self.random.normal())).clamp(0.0, 1.0),
        }
    }

    /// Paint and gloss of floor, walls and roof.
    fn shell_paint(&self, place: DVec3, normal: DVec3, dirt: f64) -> (DVec3, f64) {
        let grey = |level: f64| DVec3::new(level, level, level * 0.98);
        if normal.z > 0.5 {
            let lane = (place.y + 3.4).abs() < 0.06 || (place.y - 0.55).abs() < 0.06;
            let bay = (place.x / 5.8 + 0.5).fract().abs() < 0.02 && place.y < -4.2;
            let joint =
                (place.x / 6.0).fract().abs() < 0.003 || (place.y / 6.0).fract().abs() < 0.003;
            if lane || (bay && place.y > -11.0) {
                return (DVec3::new(0.86, 0.69, 0.16), 0.7);
            }
            let stain = smoothstep(0.15, 0.5, self.dirt.octaves(place * 0.35 + 20.5, 3));
            return (grey(0.60 - 0.22 * stain - if joint { 0.2 } else { 0.0 }), 0.45);
        }
        if normal.z < -0.5 {
            let skylight = (place.y.abs() - 5.5).abs() < 0.8 && (place.x / 6.0).fract().abs() > 0.1;
            return if skylight { (grey(0.95), 0.15) } else { (grey(0.66), 0.5) };
        }
        let along = if normal.x.abs() > 0.5 { place.y } else { place.x };
        let window = (5.4..6.5).contains(&place.z) || (8.0..8.7).contains(&place.z);
        if window && (along / 1.5).fract().abs() > 0.06 && normal.y.abs() > 0.5 {
            return (DVec3::new(0.62, 0.74, 0.80), 0.08);
        }
        let gate = normal.x.abs() > 0.5 && (place.y + 1.2).abs() < 2.6 && place.z < 5.0;
        if gate {
            let slat = (place.z * 2.5).fract() < 0.08;
            return (DVec3::new(0.32, 0.45, 0.62) * if slat { 0.75 } else { 1.0 }, 0.6);
        }
        if place.z < 1.4 + 0.05 * dirt {
            return (DVec3::new(0.52, 0.58, 0.54), 0.5);
        }
        let rib = 0.06 * (along * 4.0 - (along * 4.0).floor() - 0.5).abs();
        (DVec3::new(0.83, 0.83, 0.79) - rib, 0.6)
    }
}

/// Where a ray that starts in the hall meets its floor, walls or roof.
fn shell(eye: DVec3, ray: DVec3) -> Hit {
    let far = |eye: f64, ray: f64, low: f64, high: f64| {
        // A ray that runs along a wall does not meet it.
        if ray == 0.0 { f64::INFINITY } else { (if ray > 0.0 { high } else { low } - eye) / ray }
    };
    let x = far(eye.x, ray.x, -HALF_LENGTH, HALF_LENGTH);
    let y = far(eye.y, ray.y, -HALF_WIDTH, HALF_WIDTH);
    let z = far(eye.z, ray.z, 0.0, HEIGHT);
    if x < y && x < z {
        Hit { distance: x, normal: DVec3::new(-ray.x.signum(), 0.0, 0.0) }
    } else if y < z {
        Hit { distance: y, normal: DVec3::new(0.0, -ray.y.signum(), 0.0) }
    } else {
        Hit { distance: z, normal: DVec3::new(0.0, 0.0, -ray.z.signum()) }
    }
}

/// The byte of a color.
fn byte(level: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is 0 to 255")]
    let byte = single(level).clamp(0.0, 255.0) as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_scanner_stands_in_or_close_to_a_part() {
        for seed in 0..50 {
            let mut random = Random::new(seed, 9);
            for (eye, _) in SCANNERS {
                for part in plant::build(seed) {
                    for _ in 0..20 {
                        // A part near the scanner is met by a ray of one of many directions.
                        let ray = random.direction();
                        if let Some(hit) = part.form.hit(eye, ray) {
                            assert!(hit.distance > 0.3, "{eye} and {part:?}");
                        }
                    }
                }
            }
        }
    }

    /// Columns pass over parts that their rays cannot meet; here no part is passed over.
    #[test]
    fn rays_meet_what_they_meet_when_all_parts_are_tried() {
        let mut scan = Scan::new(4, 20_000, 0.0);
        for _ in 0..20_000 {
            let point = scan.point();
            let way = point.place - scan.eye;
            let ray = way / way.length();
            let nearest = scan
                .parts
                .iter()
                .filter_map(|part| part.form.hit(scan.eye, ray))
                .map(|hit| hit.distance)
                .fold(shell(scan.eye, ray).distance, f64::min);
            assert!((nearest - way.length()).abs() < 1e-6, "{point:?}: {nearest}");
        }
    }
}
