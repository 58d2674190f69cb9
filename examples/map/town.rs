/*!
A town: houses along the streets of a bent grid, courtyards, towers in the middle, parks and a river.
*/

use super::{
    footprint::{Footprint, Sort},
    lot::{Lot, bend, outline},
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Half the side of the town, in metres.
const REACH: f64 = 1150.0;

/// Blocks, from the middle of a street to that of the next one, and streets.
const BLOCK: [f64; 2] = [104.0, 76.0];
const STREET: f64 = 13.0;
const AVENUE: f64 = 24.0;

/// Half the width of the river, and of what is kept free along it.
const RIVER: f64 = 46.0;
const BANK: f64 = 16.0;

/// Makes the town of a seed.
pub(crate) fn build(seed: u64) -> Vec<Footprint> {
    let mut town = Town { random: Pcg64Mcg::seed_from_u64(seed), made: Vec::new() };
    town.ground();
    let count = BLOCK.map(|side| (REACH / side).floor());
    let mut v = -count[1];
    while v < count[1] {
        let mut u = -count[0];
        while u < count[0] {
            town.block(u, v);
            u += 1.0;
        }
        v += 1.0;
    }
    town.made
}

/// The middle of the river at an x.
fn river(x: f64) -> f64 {
    190.0 * (x / 520.0).sin() - 0.22 * x - 60.0
}

struct Town {
    random: Pcg64Mcg,
    made: Vec<Footprint>,
}

impl Town {
    fn roll(&mut self, low: f64, high: f64) -> f64 {
        self.random.random_range(low..high)
    }

    fn put(&mut self, rings: Vec<Vec<[f64; 2]>>, heights: [f64; 2], sort: Sort) {
        self.made.push(Footprint { rings, heights, sort });
    }

    /// The plain, and the river in it.
    fn ground(&mut self) {
        let side = REACH * 1.12;
        let steps = 64;
        let x = |i: i32| side * (2.0 * f64::from(i) / f64::from(steps) - 1.0);
        let bank = |way: f64| (0..=steps).map(move |i| [x(i), river(x(i)) + way * RIVER]);
        let along = |way: f64| -> Vec<[f64; 2]> {
            let mut ring: Vec<[f64; 2]> = bank(way).collect();
            ring.push([side, way * side]);
            ring.push([-side, way * side]);
            if way > 0.0 { ring } else { ring.into_iter().rev().collect() }
        };
        for way in [1.0, -1.0] {
            self.put(vec![along(way)], [-12.0, 0.0], Sort::Ground);
        }
        let water: Vec<[f64; 2]> =
            bank(-1.0).chain(bank(1.0).collect::<Vec<_>>().into_iter().rev()).collect();
        self.put(vec![water], [-12.0, -5.0], Sort::Water);
    }

    /// One block of the grid.
    fn block(&mut self, u: f64, v: f64) {
        let margin = |k: f64| if k.rem_euclid(4.0) == 0.0 { AVENUE } else { STREET } * 0.5;
        let [width, length] = BLOCK;
        let min = DVec2::new(u * width + margin(u), v * length + margin(v));
        let max =
            DVec2::new((u + 1.0) * width - margin(u + 1.0), (v + 1.0) * length - margin(v + 1.0));
        let lot = Lot { min, max };
        let at = outline(&lot.corners());
        let off = at.iter().map(|p| (p[1] - river(p[0])).abs()).fold(f64::INFINITY, f64::min);
        let is_out = at.iter().any(|p| p.iter().any(|x| x.abs() > REACH));
        if off < RIVER + BANK || is_out {
            return;
        }
        self.put(vec![outline(&lot.chamfered(3.0))], [0.0, 0.6], Sort::Pavement);
        let middle = bend((min + max) * 0.5);
        let center = (-(middle - DVec2::new(120.0, 230.0)).length_squared() / 2.2e5).exp();
        let what = self.roll(0.0, 1.0);
        if self.roll(0.0, 1.0) < 0.35 {
            self.alley(Lot { min: min - 3.5, max: max + 3.5 });
        }
        if what < 0.07 && center < 0.8 {
            self.park(lot);
        } else if what < 0.07 + 0.45 * center {
            self.towers(lot, center);
        } else if what < 0.62 && center > 0.05 {
            self.court(lot, center);
        } else if what < 0.80 - 0.2 * (1.0 - center) {
            self.corners(lot, center);
        } else {
            self.rows(lot);
        }
    }

    /// Grass around a pond.
    fn park(&mut self, lot: Lot) {
        let lot = lot.inset(2.0);
        let (middle, size) = ((lot.min + lot.max) * 0.5, lot.size());
        let wobble = self.roll(0.0, 6.0);
        let pond: Vec<DVec2> = (0..28)
            .map(|i| {
                let angle = f64::from(i) / 28.0 * std::f64::consts::TAU;
                let reach = size.min_element() * (0.26 + 0.06 * (3.0 * angle + wobble).sin());
                middle + DVec2::new(1.35 * angle.cos(), angle.sin()) * reach
            })
            .collect();
        let hole: Vec<[f64; 2]> = pond.iter().map(|&p| bend(p).to_array()).collect();
        self.put(vec![outline(&lot.chamfered(8.0)), hole.clone()], [0.6, 1.8], Sort::Park);
        self.put(vec![hole], [0.6, 1.0], Sort::Water);
        for _ in 0..26 {
            let angle = DVec2::from_angle(self.roll(0.0, std::f64::consts::TAU));
            let place = middle + angle * size * self.roll(0.34, 0.48);
            if (place - middle).abs().cmplt(size * 0.47).all() {
                self.tree(place, 1.8);
            }
        }
    }

    /// A crown of eight sides.
    fn tree(&mut self, place: DVec2, ground: f64) {
        let (radius, turn) = (self.roll(1.6, 3.2), self.roll(0.0, 1.0));
        let corner = |i: u32| bend(place + DVec2::from_angle(f64::from(i) * 0.785 + turn) * radius);
        let crown = (0..8).map(|i| corner(i).to_array()).collect();
        let height = radius * self.roll(1.6, 2.6);
        self.put(vec![crown], [ground + 0.8, ground + height], Sort::Tree);
    }

    /// Trees on the pavement around a block.
    fn alley(&mut self, lot: Lot) {
        let corners = lot.inset(1.2).corners();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % 4];
            let count = ((b - a).length() / 9.0).floor();
            let mut k = 0.5;
            while k < count {
                if self.roll(0.0, 1.0) < 0.8 {
                    self.tree(a.lerp(b, k / count), 0.6);
                }
                k += 1.0;
            }
        }
    }

    /// A closed row of houses around a courtyard.
    fn court(&mut self, lot: Lot, center: f64) {
        let deep = self.roll(11.0, 15.0);
        let lot = lot.inset(2.5);
        let height = self.roll(14.0, 20.0) + 8.0 * center;
        let [outer, inner] = [outline(&lot.chamfered(6.0)), outline(&lot.inset(deep).corners())];
        self.put(vec![outer, inner], [0.6, height], Sort::House);
        self.put(vec![outline(&lot.inset(deep + 1.5).corners())], [0.6, 1.0], Sort::Park);
        if self.roll(0.0, 1.0) < 0.4 {
            let share = self.roll(0.3, 0.7);
            let [yard, _] = lot.inset(deep + 4.0).cut(0, share);
            let low = self.roll(5.0, 9.0);
            self.put(vec![outline(&yard.corners())], [0.6, low], Sort::House);
        }
        if self.roll(0.0, 1.0) < 0.5 {
            // A corner that is higher than the rest.
            let [part, _] = lot.cut(0, deep / lot.size().x);
            let [part, _] = part.cut(1, deep / lot.size().y);
            self.put(
                vec![outline(&part.inset(1.5).chamfered(3.0))],
                [height, height + 7.0],
                Sort::House,
            );
        }
    }

    /// Houses like an L, two in each half.
    fn corners(&mut self, lot: Lot, center: f64) {
        let share = self.roll(0.42, 0.58);
        for (side, half) in lot.inset(3.0).cut(0, share).into_iter().enumerate() {
            let half = half.inset(1.5);
            let (deep, height) = (self.roll(10.0, 14.0), self.roll(8.0, 14.0) + 14.0 * center);
            let Lot { min, max } = half;
            let inner = if side == 0 { min.x + deep } else { max.x - deep };
            let (out, other) = if side == 0 { (min.x, max.x) } else { (max.x, min.x) };
            let middle = min.y + (max.y - min.y) * self.roll(0.55, 0.75);
            let low = [
                DVec2::new(out, min.y),
                DVec2::new(other, min.y),
                DVec2::new(other, min.y + deep),
                DVec2::new(inner, min.y + deep),
                DVec2::new(inner, middle),
                DVec2::new(out, middle),
            ];
            self.put(vec![outline(&low)], [0.6, height], Sort::House);
            let rest = Lot { min: DVec2::new(min.x, middle + 4.0), max };
            let height = self.roll(6.0, 11.0);
            self.put(vec![outline(&rest.corners())], [0.6, height], Sort::House);
        }
    }

    /// Small houses in two rows, with gardens.
    fn rows(&mut self, lot: Lot) {
        self.put(vec![outline(&lot.inset(2.0).corners())], [0.6, 1.0], Sort::Park);
        for row in lot.inset(5.0).cut(1, 0.5) {
            let (mut rest, mut left) = (row.inset(3.0), true);
            while left {
                let step = self.roll(13.0, 18.0) / rest.size().x;
                left = step < 0.75;
                let [house, after] = rest.cut(0, if left { step } else { 1.0 });
                let height = self.roll(4.5, 9.0);
                let gap = self.roll(1.2, 2.4);
                if house.size().x > 2.0 * gap + 3.0 {
                    self.put(
                        vec![outline(&house.inset(gap).corners())],
                        [0.6, height],
                        Sort::House,
                    );
                }
                rest = after;
            }
        }
    }

    /// High houses on a flat one.
    fn towers(&mut self, lot: Lot, center: f64) {
        let lot = lot.inset(3.0);
        let low = self.roll(7.0, 13.0);
        self.put(vec![outline(&lot.chamfered(5.0))], [0.6, low], Sort::House);
        for half in lot.cut(0, 0.5) {
            if self.roll(0.0, 1.0) > 0.45 + 0.5 * center {
                continue;
            }
            let height = self.roll(30.0, 60.0) + 130.0 * center * center * self.roll(0.3, 1.0);
            let lot = half.inset(self.roll(6.0, 10.0));
            let (middle, size) = ((lot.min + lot.max) * 0.5, lot.size());
            match self.random.random_range(0..3) {
                0 => self.put(vec![outline(&lot.corners())], [low, height], Sort::Tower),
                1 => {
                    let round: Vec<[f64; 2]> = (0..24)
                        .map(|i| {
                            let angle =
                                DVec2::from_angle(f64::from(i) / 24.0 * std::f64::consts::TAU);
                            bend(middle + angle * (size.min_element() * 0.5)).to_array()
                        })
                        .collect();
                    self.put(vec![round], [low, height], Sort::Tower);
                }
                _ => {
                    let upper = lot.inset(4.0);
                    let step = low + (height - low) * self.roll(0.5, 0.8);
                    self.put(vec![outline(&lot.chamfered(4.0))], [low, step], Sort::Tower);
                    self.put(vec![outline(&upper.chamfered(4.0))], [step, height], Sort::Tower);
                }
            }
        }
    }
}
