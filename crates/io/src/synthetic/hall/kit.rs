//! The kit that the plant is built from: paints, boxes, bars, drums and pipes.

use super::{form::Form, whole};
use crate::synthetic::random::turn;
use glam::DVec3;

/// Half the length and half the width of the hall, and its height.
pub(super) const HALF_LENGTH: f64 = 30.0;
pub(super) const HALF_WIDTH: f64 = 12.0;
pub(super) const HEIGHT: f64 = 10.5;

/// A body and its paint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) form: Form,
    /// Red, green and blue, from 0 to 1.
    pub(super) paint: DVec3,
    /// How much light comes back, from 0 to 1.
    pub(super) gloss: f64,
}

/// A color from its bytes.
pub(super) const fn rgb(red: u8, green: u8, blue: u8) -> DVec3 {
    DVec3::new(red as f64 / 255.0, green as f64 / 255.0, blue as f64 / 255.0)
}

pub(super) const STEEL: DVec3 = rgb(126, 142, 152);
pub(super) const DARK_STEEL: DVec3 = rgb(86, 94, 102);
pub(super) const ZINC: DVec3 = rgb(176, 182, 184);
pub(super) const WHITE: DVec3 = rgb(226, 226, 218);
pub(super) const YELLOW: DVec3 = rgb(236, 184, 32);
pub(super) const ORANGE: DVec3 = rgb(222, 112, 34);
pub(super) const RED: DVec3 = rgb(188, 44, 36);
pub(super) const GREEN: DVec3 = rgb(72, 128, 84);
pub(super) const BLUE: DVec3 = rgb(48, 98, 158);
pub(super) const SKY: DVec3 = rgb(150, 188, 206);
pub(super) const WOOD: DVec3 = rgb(176, 138, 92);
pub(super) const CARTON: DVec3 = rgb(168, 128, 84);

/// How long a piece of a beam or a pipe is at most: long bodies meet more rays than they should.
const PIECE: f64 = 6.0;

/// A plant that is being built.
#[derive(Debug, Default)]
pub(super) struct Plant {
    pub(super) parts: Vec<Part>,
}

impl Plant {
    /// Adds a body.
    pub(super) fn add(&mut self, form: Form, paint: DVec3, gloss: f64) {
        self.parts.push(Part { form, paint, gloss });
    }

    /// A box between two corners.
    pub(super) fn block(&mut self, low: [f64; 3], high: [f64; 3], paint: DVec3) {
        let (low, high) = (DVec3::from_array(low), DVec3::from_array(high));
        let form = Form::Block {
            center: (low + high) * 0.5,
            half: (high - low) * 0.5,
            turned: (0.0, 1.0),
        };
        self.add(form, paint, 0.6);
    }

    /// A beam along x, in pieces.
    pub(super) fn beam(&mut self, y: [f64; 2], z: [f64; 2], paint: DVec3) {
        let mut x = -HALF_LENGTH;
        while x < HALF_LENGTH {
            self.block([x, y[0], z[0]], [x + PIECE, y[1], z[1]], paint);
            x += PIECE;
        }
    }

    /// A thin bar with round ends.
    pub(super) fn bar(&mut self, from: [f64; 3], to: [f64; 3], radius: f64, paint: DVec3) {
        let foot = DVec3::from_array(from);
        self.add(Form::Capsule { foot, axis: DVec3::from_array(to) - foot, radius }, paint, 0.6);
    }

    /// A cylinder that stands, with flat ends.
    pub(super) fn drum(&mut self, foot: [f64; 3], height: f64, radius: f64, paint: DVec3) {
        let axis = DVec3::Z * height;
        self.add(Form::Cylinder { foot: DVec3::from_array(foot), axis, radius }, paint, 0.7);
    }

    /// A pipe through these points, with bends at the corners and flanges where pieces meet.
    pub(super) fn pipe(&mut self, points: &[[f64; 3]], radius: f64, paint: DVec3) {
        let points: Vec<DVec3> = points.iter().copied().map(DVec3::from_array).collect();
        let bend = 3.0 * radius;
        let course = |a: DVec3, b: DVec3| (b - a) / (b - a).length();
        for (i, ends) in points.windows(2).enumerate() {
            let along = course(ends[0], ends[1]);
            let first = if i == 0 { ends[0] } else { ends[0] + along * bend };
            let last = if i + 2 == points.len() { ends[1] } else { ends[1] - along * bend };
            self.straight(first, last, radius, paint);
        }
        for corner in points.windows(3) {
            let (before, after) = (course(corner[0], corner[1]), course(corner[1], corner[2]));
            let center = corner[1] - before * bend + after * bend;
            let place = |step: u32| {
                let (sin, cos) = turn(f64::from(step) / 32.0);
                center + (before * sin - after * cos) * bend
            };
            for step in 0..8 {
                let foot = place(step);
                self.add(Form::Capsule { foot, axis: place(step + 1) - foot, radius }, paint, 0.8);
            }
        }
    }

    /// A straight pipe in pieces, with flanges between them; a short one has a flange at its start.
    fn straight(&mut self, first: DVec3, last: DVec3, radius: f64, paint: DVec3) {
        let length = (last - first).length();
        let pieces = (length / PIECE).ceil().max(1.0);
        let axis = (last - first) / pieces;
        let mut foot = first;
        for i in 0..whole(pieces) {
            self.add(Form::Capsule { foot, axis, radius }, paint, 0.8);
            if i > 0 || pieces < 2.0 {
                let thick = axis * (0.09 / axis.length());
                let form =
                    Form::Cylinder { foot: foot - thick * 0.5, axis: thick, radius: radius * 1.55 };
                self.add(form, paint * 0.85, 0.7);
            }
            foot += axis;
        }
    }
}
