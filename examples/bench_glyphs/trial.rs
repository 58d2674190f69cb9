//! Glyphs made at random, and the curved surfaces that their triangles stand for.

use glam::{DVec3, Vec3};
use puncta::{
    Glyph, Glyphs,
    avc::{Arc, Node, NodeStyle, Size, Trajectories},
};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// A glyph to look at.
pub(crate) struct Trial<G: Glyph> {
    pub(crate) glyphs: Glyphs<G>,
    pub(crate) records: Vec<G>,
    /// Which of the records.
    pub(crate) index: usize,
    /// A length of about its size.
    pub(crate) size: f64,
    /// The radius that its chords are made for.
    pub(crate) radius: f32,
}

/// A glyph that is made at random, with curved triangles.
pub(crate) trait Curved: Glyph {
    fn trial(random: &mut Pcg64Mcg, tolerance: f32) -> Trial<Self>;

    /// What a triangle stands for, if it is curved: told by its number, of so many, and its corners.
    fn target(
        trial: &Trial<Self>,
        triangle: u32,
        size: Size,
        corners: [DVec3; 3],
    ) -> Option<Target>;
}

/// The surface that triangles stand for, relative to the record.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Target {
    /// Around an axis through a point.
    Cylinder {
        point: DVec3,
        axis: DVec3,
        radius: f64,
    },
    Sphere {
        center: DVec3,
        radius: f64,
    },
}

impl Target {
    /// The nearest point of the surface.
    pub(crate) fn nearest(self, from: DVec3) -> DVec3 {
        let (foot, radius) = match self {
            Self::Cylinder { point, axis, radius } => {
                (point + axis * (from - point).dot(axis), radius)
            }
            Self::Sphere { center, radius } => (center, radius),
        };
        foot + (from - foot) * (radius / (from - foot).length())
    }
}

impl Curved for Arc {
    fn trial(random: &mut Pcg64Mcg, tolerance: f32) -> Trial<Self> {
        let outer = narrow(log_uniform(random, 0.01, 10.0));
        let start = random.random_range(-2.0..2.0_f32);
        let turn = random.random_range(0.01..1.3_f32);
        let arc = Self {
            center: around(random).to_array(),
            radii: [outer * random.random_range(0.05..0.95), outer],
            turns: [start, start + turn],
            height: outer * random.random_range(0.05..2.0),
        };
        Trial {
            glyphs: Glyphs::new([]).with_tolerance(tolerance),
            records: vec![arc],
            index: 0,
            size: f64::from(outer),
            radius: outer,
        }
    }

    /// Of each segment, triangles 0 and 1 look outwards, 4 and 5 inwards. The last four are the ends.
    fn target(
        trial: &Trial<Self>,
        triangle: u32,
        size: Size,
        _corners: [DVec3; 3],
    ) -> Option<Target> {
        let side = match triangle % 8 {
            0 | 1 => 1,
            4 | 5 => 0,
            _ => return None,
        };
        let radius = f64::from(trial.records[0].radii[side]);
        let is_curved = triangle < size.triangles / 8 * 8;
        is_curved.then_some(Target::Cylinder { point: DVec3::ZERO, axis: DVec3::Z, radius })
    }
}

impl Curved for Node {
    /// A piece between two bends, a piece with two domes, or a ball.
    fn trial(random: &mut Pcg64Mcg, tolerance: f32) -> Trial<Self> {
        let radius = narrow(log_uniform(random, 0.01, 1.0));
        let kind = random.random_range(0..3);
        let mut style = NodeStyle::tubes(radius);
        if kind == 2 {
            style.kind = NodeStyle::BALL;
            style.ball = radius;
        }
        let (first, mut way) = (around(random), direction(random));
        let mut positions = vec![first.to_array()];
        for _ in 0..if kind == 0 { 3 } else { 1 } {
            // Bends of up to 40 degrees or so, of pieces that are long enough.
            way += direction(random) * random.random_range(0.0..0.6);
            way /= way.length();
            let length = f64::from(radius) * random.random_range(4.0..20.0);
            let last = positions.last().map_or(first, |last| Vec3::from(*last));
            positions.push((last.as_dvec3() + way * length).as_vec3().to_array());
        }
        let mut all = Trajectories::default();
        all.push(&positions, &[0.0, 1.0, 2.0, 3.0]);
        Trial {
            glyphs: Glyphs::new(style).with_tolerance(tolerance),
            records: all.nodes,
            index: usize::from(kind == 0),
            size: f64::from(radius),
            radius: 2.0 * radius,
        }
    }

    /// Of a piece between two bends, the triangles between two rings come first, as many as there are
    /// vertices.
    fn target(
        trial: &Trial<Self>,
        triangle: u32,
        size: Size,
        corners: [DVec3; 3],
    ) -> Option<Target> {
        let style = &trial.glyphs.style;
        let radius = f64::from(style.radii[0]);
        if style.kind == NodeStyle::BALL {
            return Some(Target::Sphere { center: DVec3::ZERO, radius });
        }
        let at = |index: usize| Vec3::from(trial.records[index].position).as_dvec3();
        let way = at(trial.index + 1) - at(trial.index);
        let axis = way / way.length();
        let body = Target::Cylinder { point: DVec3::ZERO, axis, radius };
        if trial.index == 1 {
            return (triangle < size.vertices).then_some(body);
        }
        // Whatever is not between the ends is part of a dome.
        let (slack, end) = (1e-4 * radius, way.length());
        let has = |is: &dyn Fn(f64) -> bool| corners.iter().any(|corner| is(corner.dot(axis)));
        Some(if has(&|along| along < -slack) {
            Target::Sphere { center: DVec3::ZERO, radius }
        } else if has(&|along| along > end + slack) {
            Target::Sphere { center: way, radius }
        } else {
            body
        })
    }
}

pub(crate) fn direction(random: &mut Pcg64Mcg) -> DVec3 {
    loop {
        let [x, y, z] = [0; 3].map(|_| random.random_range(-1.0..1.0));
        let direction = DVec3::new(x, y, z);
        if (0.1..1.0).contains(&direction.length()) {
            return direction / direction.length();
        }
    }
}

pub(crate) fn log_uniform(random: &mut Pcg64Mcg, from: f64, to: f64) -> f64 {
    (random.random_range(from.ln()..to.ln())).exp()
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
fn narrow(value: f64) -> f32 {
    value as f32
}

fn around(random: &mut Pcg64Mcg) -> Vec3 {
    (direction(random) * log_uniform(random, 0.1, 30.0)).as_vec3()
}
