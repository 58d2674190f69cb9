//! The plant: everything that stands and hangs in the hall, in meters from the middle of its floor.

use super::{
    form::Form,
    kit::{
        BLUE, CARTON, DARK_STEEL, GREEN, HALF_LENGTH, ORANGE, Part, Plant, RED, SKY, STEEL, WHITE,
        WOOD, YELLOW, ZINC, rgb,
    },
    whole,
};
use crate::synthetic::random::{Random, turn};
use glam::DVec3;

/// All parts of the plant. The seed changes what people move: barrels, crates, the crane.
pub(super) fn build(seed: u64) -> Vec<Part> {
    let mut plant = Plant::default();
    let mut random = Random::new(seed, 1);
    plant.frames();
    plant.crane(random.between(2.0, 12.0), random.between(-5.0, 5.0));
    plant.upright_tanks();
    plant.lying_tanks();
    plant.pipe_rack();
    plant.air_duct();
    plant.machines();
    plant.cabinets();
    plant.platform();
    plant.store(&mut random);
    plant.parts
}

impl Plant {
    /// Columns, girders and purlins, which carry the roof.
    fn frames(&mut self) {
        for frame in 0..=10 {
            let x = (-HALF_LENGTH + 6.0 * f64::from(frame)).clamp(-29.7, 29.7);
            for side in [-1.0, 1.0] {
                let y = 11.7 * side;
                for flange in [-0.17, 0.17] {
                    let (low, high) = (x + flange - 0.015, x + flange + 0.015);
                    self.block([low, y - 0.15, 0.0], [high, y + 0.15, 10.0], STEEL);
                }
                self.block([x - 0.17, y - 0.01, 0.0], [x + 0.17, y + 0.01, 10.0], STEEL);
            }
            self.block([x - 0.12, -12.0, 10.0], [x + 0.12, 12.0, 10.06], STEEL);
            self.block([x - 0.1, -12.0, 8.8], [x + 0.1, 12.0, 8.9], STEEL);
            for bay in 0..12 {
                let (y, up) = (-12.0 + 2.0 * f64::from(bay), f64::from(bay % 2));
                let (from, to) = (8.85 + 1.15 * up, 10.0 - 1.15 * up);
                self.bar([x, y, from], [x, y + 2.0, to], 0.045, STEEL);
                self.bar([x, y, 8.85], [x, y, 10.0], 0.035, STEEL);
            }
            for lamp in [-8.0, -2.7, 2.7, 8.0] {
                self.block([x - 0.7, lamp - 0.15, 8.5], [x + 0.7, lamp + 0.15, 8.6], WHITE);
            }
        }
        for purlin in 0..9 {
            let y = -11.0 + 2.75 * f64::from(purlin);
            self.beam([y - 0.05, y + 0.05], [10.06, 10.26], STEEL);
        }
    }

    /// A bridge crane on its rails, with a hook.
    fn crane(&mut self, x: f64, trolley: f64) {
        for side in [-1.0, 1.0] {
            let y = 11.25 * side;
            self.beam([y - 0.02, y + 0.02], [6.7, 7.3], DARK_STEEL);
            self.beam([y - 0.16, y + 0.16], [7.26, 7.32], DARK_STEEL);
            self.beam([y - 0.16, y + 0.16], [6.68, 6.72], DARK_STEEL);
            self.block([x - 1.6, y - 0.2, 7.35], [x + 1.6, y + 0.2, 7.75], YELLOW);
            for column in 0..=10 {
                let x = -HALF_LENGTH + 6.0 * f64::from(column);
                self.block([x - 0.15, y - 0.2, 6.2], [x + 0.15, y + 0.4 * side, 6.7], STEEL);
            }
        }
        for girder in [-0.8, 0.8] {
            let (low, high) = (x + girder - 0.22, x + girder + 0.22);
            for part in 0..4 {
                let y = -11.2 + 5.6 * f64::from(part);
                self.block([low, y, 7.5], [high, y + 5.6, 8.3], YELLOW);
            }
        }
        self.block([x - 1.1, trolley - 0.7, 8.3], [x + 1.1, trolley + 0.7, 8.75], DARK_STEEL);
        for rope in [-0.12, 0.12] {
            self.bar([x, trolley + rope, 4.3], [x, trolley + rope, 8.3], 0.012, DARK_STEEL);
        }
        self.block([x - 0.15, trolley - 0.22, 3.8], [x + 0.15, trolley + 0.22, 4.3], YELLOW);
        self.drum([x, trolley, 3.4], 0.4, 0.05, DARK_STEEL);
    }

    /// Four tanks with domes, on feet, with ladders and nozzles.
    fn upright_tanks(&mut self) {
        let tanks = [
            (-25.0, 5.2, WHITE, GREEN),
            (-19.4, 5.2, WHITE, ORANGE),
            (-13.8, 4.4, SKY, GREEN),
            (-8.2, 6.0, ZINC, ORANGE),
        ];
        for (x, height, paint, outlet) in tanks {
            let (y, radius) = (-7.4, 2.0);
            for foot in 0..4 {
                let (sin, cos) = turn(0.125 + 0.25 * f64::from(foot));
                let place = [x + 1.75 * cos, y + 1.75 * sin, 0.0];
                self.drum(place, 0.8, 0.12, DARK_STEEL);
            }
            self.drum([x, y, 0.8], height - 0.8, radius, paint);
            let center = DVec3::new(x, y, height);
            self.add(Form::Dome { center, radius, height: 0.75 }, paint, 0.8);
            let belly = DVec3::new(x, y, 0.8);
            self.add(Form::Dome { center: belly, radius: 1.9, height: 0.45 }, paint, 0.8);
            for ring in [1.0, 0.5 * height + 0.4, height - 0.1] {
                self.drum([x, y, ring], 0.1, radius + 0.05, paint * 0.8);
            }
            self.drum([x, y, height + 0.6], 0.45, 0.3, paint * 0.9);
            self.drum([x, y, height + 0.95], 0.08, 0.42, DARK_STEEL);
            for rail in [-0.22, 0.22] {
                let at = y + radius + 0.22;
                self.bar([x + rail, at, 0.2], [x + rail, at, height + 0.9], 0.025, YELLOW);
            }
            for rung in 0..20 {
                let (z, at) = (0.4 + 0.3 * f64::from(rung), y + radius + 0.22);
                if z < height + 0.8 {
                    self.bar([x - 0.22, at, z], [x + 0.22, at, z], 0.015, YELLOW);
                }
            }
            // To the rack: out at the foot, along the floor, and up.
            let out = x + 1.0;
            self.pipe(
                &[[out, y + 1.5, 1.3], [out, 0.4, 1.3], [out, 0.4, 4.45], [out, 2.2, 4.45]],
                0.11,
                outlet,
            );
            self.add(
                Form::Dome { center: DVec3::new(out, -3.2, 1.3), radius: 0.24, height: 0.24 },
                BLUE,
                0.7,
            );
            self.bar([out, -3.2, 1.3], [out, -3.2, 1.85], 0.03, DARK_STEEL);
            self.drum([out, -3.2, 1.82], 0.05, 0.2, RED);
        }
    }

    /// Three tanks that lie on saddles, under the rack's far side.
    fn lying_tanks(&mut self) {
        for (x, paint, vent) in [(-24.0, GREEN, YELLOW), (-15.0, ZINC, RED), (-6.0, GREEN, YELLOW)]
        {
            let (y, z) = (7.6, 1.9);
            let foot = DVec3::new(x, y, z);
            self.add(Form::Capsule { foot, axis: DVec3::X * 4.6, radius: 1.25 }, paint, 0.8);
            for saddle in [0.6, 3.8] {
                let x = x + saddle;
                self.block([x - 0.15, y - 1.1, 0.0], [x + 0.15, y + 1.1, 1.25], DARK_STEEL);
            }
            self.drum([x + 2.3, y, 3.0], 0.45, 0.32, paint);
            self.drum([x + 2.3, y, 3.4], 0.08, 0.45, DARK_STEEL);
            self.pipe(&[[x + 3.6, y, 3.0], [x + 3.6, y, 5.35], [x + 3.6, 3.1, 5.35]], 0.09, vent);
        }
    }

    /// A rack with pipes on two levels, along the hall.
    fn pipe_rack(&mut self) {
        for post in 0..12 {
            let x = -27.5 + 5.0 * f64::from(post);
            for y in [1.0, 3.6] {
                self.block([x - 0.1, y - 0.1, 0.0], [x + 0.1, y + 0.1, 5.4], DARK_STEEL);
                self.block([x - 0.2, y - 0.2, 0.0], [x + 0.2, y + 0.2, 0.04], DARK_STEEL);
            }
            for z in [4.1, 5.1] {
                self.block([x - 0.08, 0.9, z], [x + 0.08, 3.7, z + 0.16], DARK_STEEL);
            }
        }
        let pipes = [
            (1.3, 4.44, 0.18, GREEN),
            (1.85, 4.39, 0.13, GREEN),
            (2.3, 4.45, 0.19, ZINC),
            (2.85, 4.36, 0.10, YELLOW),
            (3.2, 4.37, 0.11, BLUE),
            (1.4, 5.52, 0.26, ZINC),
            (2.1, 5.42, 0.16, RED),
            (2.6, 5.38, 0.12, ORANGE),
            (3.1, 5.36, 0.10, YELLOW),
        ];
        for (i, (y, z, radius, paint)) in pipes.into_iter().enumerate() {
            let i = i as f64;
            // Every pipe has a loop that takes up its growth in heat, and ends in a bend.
            let (loop_at, high) = (-6.0 + 1.3 * i, z + 1.0 + 0.1 * i);
            let end = 28.0 - 0.9 * i;
            let points = [
                [-28.5 + 0.3 * i, y, z],
                [loop_at, y, z],
                [loop_at, y, high],
                [loop_at + 2.2, y, high],
                [loop_at + 2.2, y, z],
                [end, y, z],
                [end, y, 0.6 + 0.2 * i],
                [end, -1.0 - 0.25 * i, 0.6 + 0.2 * i],
                [end, -1.0 - 0.25 * i, -0.6],
            ];
            self.pipe(&points, radius, paint);
        }
        self.block([-28.0, 3.75, 4.5], [28.0, 4.15, 4.52], ZINC);
        self.block([-28.0, 3.75, 4.5], [28.0, 3.77, 4.6], ZINC);
    }

    /// A round duct under the roof, with outlets.
    fn air_duct(&mut self) {
        self.pipe(&[[-28.0, 9.4, 8.0], [24.0, 9.4, 8.0], [24.0, 9.4, 4.5]], 0.42, ZINC);
        for outlet in 0..6 {
            let x = -22.0 + 8.0 * f64::from(outlet);
            self.pipe(&[[x, 9.4, 8.0], [x, 7.4, 8.0], [x, 7.4, 6.6]], 0.22, ZINC);
            self.drum([x, 7.4, 6.2], 0.4, 0.42, ZINC);
        }
    }

    /// Five machines with motors and panels.
    fn machines(&mut self) {
        let machines = [
            (-1.0, -7.8, GREEN),
            (4.8, -7.3, BLUE),
            (10.6, -7.8, GREEN),
            (16.4, -7.3, SKY),
            (22.2, -7.8, BLUE),
        ];
        for (x, y, paint) in machines {
            self.block([x - 1.9, y - 1.4, 0.0], [x + 1.9, y + 1.4, 0.25], DARK_STEEL);
            self.block([x - 1.6, y - 1.0, 0.25], [x + 0.2, y + 1.0, 1.7], paint);
            self.block([x - 1.2, y - 0.8, 1.7], [x - 0.2, y + 0.8, 2.6], paint);
            self.block([x + 0.2, y - 0.7, 0.25], [x + 0.9, y + 0.7, 1.1], paint * 0.8);
            let foot = DVec3::new(x + 0.9, y, 0.95);
            self.add(Form::Cylinder { foot, axis: DVec3::X * 0.9, radius: 0.45 }, DARK_STEEL, 0.7);
            let foot = DVec3::new(x + 0.4, y + 0.75, 1.45);
            self.add(Form::Cylinder { foot, axis: -DVec3::Y * 1.5, radius: 0.4 }, ORANGE, 0.7);
            self.block([x - 1.3, y + 1.35, 0.9], [x - 0.5, y + 1.6, 1.8], WHITE);
            self.bar([x - 0.9, y + 1.45, 0.0], [x - 0.9, y + 1.45, 0.9], 0.05, DARK_STEEL);
            self.drum([x - 0.7, y, 2.6], 0.25, 0.06, WHITE);
            self.drum([x - 0.7, y, 2.85], 0.12, 0.07, RED);
            self.pipe(
                &[[x - 0.7, y - 0.4, 2.4], [x - 0.7, y - 0.4, 6.9], [x - 0.7, -11.6, 6.9]],
                0.14,
                ZINC,
            );
            for post in [-1.9, 1.9] {
                self.bar([x + post, y + 1.9, 0.0], [x + post, y + 1.9, 1.1], 0.03, YELLOW);
            }
            for rail in [0.55, 1.1] {
                self.bar([x - 1.9, y + 1.9, rail], [x + 1.9, y + 1.9, rail], 0.025, YELLOW);
            }
        }
    }

    /// Switch cabinets along a wall, with a cable tray above.
    fn cabinets(&mut self) {
        for cabinet in 0..14 {
            let x = 1.0 + 0.9 * f64::from(cabinet) + if cabinet > 6 { 0.5 } else { 0.0 };
            self.block([x, 10.7, 0.1], [x + 0.86, 11.35, 2.2], rgb(202, 204, 196));
            self.block([x + 0.7, 10.66, 1.0], [x + 0.75, 10.7, 1.3], DARK_STEEL);
        }
        self.block([-1.0, 10.8, 2.9], [16.0, 11.3, 2.93], ZINC);
        for drop in 0..6 {
            let x = 1.5 + 2.4 * f64::from(drop);
            self.bar([x, 11.0, 2.2], [x, 11.0, 2.9], 0.04, DARK_STEEL);
        }
    }

    /// A platform with railing and stairs.
    fn platform(&mut self) {
        let (low, high) = ([18.5, 5.2], [28.5, 11.4]);
        self.block([low[0], low[1], 3.0], [high[0], high[1], 3.2], ZINC * 0.85);
        for x in [18.7, 23.5, 28.3] {
            for y in [5.4, 11.0] {
                self.block([x - 0.1, y - 0.1, 0.0], [x + 0.1, y + 0.1, 3.0], DARK_STEEL);
            }
        }
        for rail in [3.7, 4.2] {
            self.bar([low[0] + 1.4, low[1], rail], [high[0], low[1], rail], 0.025, YELLOW);
            self.bar([low[0], low[1], rail], [low[0], high[1], rail], 0.025, YELLOW);
        }
        for post in 0..8 {
            let x = low[0] + 1.4 + 1.2 * f64::from(post);
            self.bar([x, low[1], 3.2], [x, low[1], 4.2], 0.025, YELLOW);
        }
        for step in 0..15 {
            let (y, z) = (1.3 + 0.26 * f64::from(step), 0.2 + 0.2 * f64::from(step));
            self.block([18.6, y, z], [19.8, y + 0.28, z + 0.04], ZINC * 0.8);
        }
        for rail in [18.6, 19.8] {
            self.bar([rail, 1.3, 1.1], [rail, 5.2, 4.1], 0.025, YELLOW);
            self.bar([rail, 1.3, 0.1], [rail, 5.2, 3.1], 0.06, DARK_STEEL);
        }
        self.block([22.0, 8.0, 3.2], [26.5, 10.8, 5.8], WHITE * 0.92);
        self.block([22.0, 7.97, 4.1], [26.5, 8.0, 5.2], SKY * 0.6);
    }

    /// Barrels, crates and pallets that stand where there was room.
    fn store(&mut self, random: &mut Random) {
        for pallet in 0..9 {
            let x = 3.0 + 1.75 * f64::from(pallet) + random.between(-0.15, 0.15);
            let y = 6.2 + random.between(-0.3, 0.3);
            self.block([x - 0.6, y - 0.4, 0.0], [x + 0.6, y + 0.4, 0.14], WOOD);
            if random.unit() < 0.5 {
                for barrel in 0..4 {
                    let (dx, dy) = (f64::from(barrel % 2) - 0.5, f64::from(barrel / 2) - 0.5);
                    let paint = random.pick([BLUE, BLUE, RED, ZINC]);
                    let place = [x + 0.56 * dx, y + 0.6 * dy, 0.14];
                    self.drum(place, 0.88, 0.28, paint);
                    self.drum([place[0], place[1], 0.44], 0.04, 0.292, paint * 0.9);
                    self.drum([place[0], place[1], 0.72], 0.04, 0.292, paint * 0.9);
                }
            } else {
                let levels = whole(1.0 + 3.0 * random.unit());
                for level in 0..levels {
                    let z = 0.14 + 0.5 * level as f64;
                    let form = Form::Block {
                        center: DVec3::new(x, y, z + 0.25),
                        half: DVec3::new(0.5, 0.36, 0.245),
                        turned: turn(random.between(-0.02, 0.02)),
                    };
                    self.add(form, CARTON * random.between(0.85, 1.1), 0.5);
                }
            }
        }
        let (x, y) = (random.between(-8.0, -4.0), random.between(-3.2, -2.6));
        self.block([x - 1.1, y - 0.55, 0.25], [x + 0.9, y + 0.55, 1.1], ORANGE);
        self.block([x - 0.7, y - 0.5, 2.05], [x + 0.6, y + 0.5, 2.12], DARK_STEEL);
        for (dx, dy) in [(-0.7, -0.5), (-0.7, 0.5), (0.6, -0.5), (0.6, 0.5)] {
            self.bar([x + dx, y + dy, 1.1], [x + dx, y + dy, 2.08], 0.035, DARK_STEEL);
            let foot = DVec3::new(x + dx * 1.1, y + dy * 0.9, 0.3);
            self.add(
                Form::Cylinder { foot, axis: DVec3::Y * 0.2 * dy, radius: 0.3 },
                DARK_STEEL * 0.5,
                0.3,
            );
        }
        for dy in [-0.3, 0.3] {
            self.block([x + 1.0, y + dy - 0.05, 0.1], [x + 1.1, y + dy + 0.05, 2.4], DARK_STEEL);
            self.block([x + 1.1, y + dy - 0.06, 0.12], [x + 2.2, y + dy + 0.06, 0.17], DARK_STEEL);
        }
    }
}
