//! Tests of arrows.

use super::*;
use crate::testing::{
    check_faults, check_zeros, corners, direction, mesh_of, normal, odd, place, polygon_area,
    sight, size,
};
use glam::DVec3;
use proptest::prelude::*;

fn arrow() -> impl Strategy<Value = Arrow> {
    let ratio = || -2.0_f32..1.0;
    let shaft = prop_oneof![3 => ratio().prop_map(|x| 10.0_f32.powf(x)), 1 => Just(0.0)];
    (place(), direction(), size(), shaft, [ratio(), ratio()]).prop_map(
        |(start, direction, size, shaft, head)| {
            let [head_radius, head_length] = head.map(|x| 10.0_f32.powf(x) * size);
            let vector = direction.map(|x| x * size);
            Arrow { start, vector, shaft_radius: shaft * size, head_radius, head_length }
        },
    )
}

/// What all tests need of an arrow, in `f64`.
struct Shape {
    along: DVec3,
    length: f64,
    head_length: f64,
    shaft: f64,
    head: f64,
    /// How far points may be off.
    slack: f64,
}

impl Shape {
    fn of(arrow: &Arrow) -> Self {
        let vector = Vec3::from(arrow.vector).as_dvec3();
        let length = vector.length();
        let (shaft, head) = (f64::from(arrow.shaft_radius), f64::from(arrow.head_radius));
        Self {
            along: vector / length,
            length,
            head_length: length.min(f64::from(arrow.head_length)),
            shaft,
            head,
            slack: 2e-6 * (length + shaft.max(head)),
        }
    }

    /// The surface of a cylinder that holds it.
    fn surface(&self) -> f64 {
        let radius = self.shaft.max(self.head);
        std::f64::consts::TAU * radius * (radius + self.length)
    }
}

proptest! {
    #[test]
    fn an_arrow_points_from_its_start_along_its_vector(arrow in arrow(), sight in sight()) {
        let sight = sight.at_size(arrow.shaft_radius.max(arrow.head_radius));
        let mesh = mesh_of(arrow, &sight)?;
        let shape = Shape::of(&arrow);
        let has_shaft = arrow.shaft_radius > 0.0;
        let chords = sight.sides(arrow.shaft_radius.max(arrow.head_radius)) as usize;
        let rings = if has_shaft { 3 } else { 1 };
        let counts = (mesh.vertices.len(), mesh.triangles.len());
        prop_assert_eq!(counts, (rings * chords + 2, 2 * rings * chords));
        // A wall moves the volume by its area and the way that it is moved.
        let [shaft, head] = [shape.shaft, shape.head].map(|x| x * x * polygon_area(chords as f64));
        let volume = shaft * (shape.length - shape.head_length) + head * shape.head_length / 3.0;
        let slack = 2.0 * shape.slack * shape.surface();
        prop_assert!((mesh.volume() - volume).abs() < slack, "{} {}", mesh.volume(), volume);
        let position = arrow.position().as_dvec3() - Vec3::from(arrow.start).as_dvec3();
        for (index, vertex) in mesh.vertices.iter().enumerate() {
            let from_start = position + vertex.as_dvec3();
            let height = from_start.dot(shape.along);
            let radius = (from_start - shape.along * height).length();
            let neck = shape.length - shape.head_length;
            let [h, r] = match index {
                0 => [if has_shaft { 0.0 } else { neck }, 0.0],
                _ if index + 1 == mesh.vertices.len() => [shape.length, 0.0],
                _ if has_shaft && index <= chords => [0.0, shape.shaft],
                _ if has_shaft && index <= 2 * chords => [neck, shape.shaft],
                _ => [neck, shape.head],
            };
            prop_assert!((height - h).abs() < shape.slack, "{index}: {height} {h}");
            prop_assert!((radius - r).abs() < shape.slack, "{index}: {radius} {r}");
        }
    }

    #[test]
    fn an_arrow_looks_outwards(arrow in arrow(), sight in sight()) {
        let sight = sight.at_size(arrow.shaft_radius.max(arrow.head_radius));
        let mesh = mesh_of(arrow, &sight)?;
        let shape = Shape::of(&arrow);
        let position = arrow.position().as_dvec3();
        let start = Vec3::from(arrow.start).as_dvec3() - position;
        let chords = sight.sides(arrow.shaft_radius.max(arrow.head_radius)) as usize;
        let bands = mesh.triangles.len() / chords;
        for (index, corners) in corners(&mesh).enumerate() {
            let band = index / chords;
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0 - start;
            let radial = (middle - shape.along * middle.dot(shape.along)).normalize_or_zero();
            let outward = match band {
                0 => -shape.along,
                _ if band + 1 == bands => {
                    (radial * shape.head_length + shape.along * shape.head).normalize()
                }
                1 | 2 => radial,
                _ if shape.head > shape.shaft => -shape.along,
                _ => shape.along,
            };
            let normal = normal(corners);
            // Moving a corner turns the normal by that way and the longest side.
            let [a, b, c] = corners;
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            let turned = normal.dot(outward) - 0.4 * normal.length();
            prop_assert!(turned > -4.0 * shape.slack * longest, "{band} of {bands}: {normal} {outward}");
        }
    }

    #[test]
    fn odd_arrows_are_nothing_and_counted(arrow in arrow(), word in 0..9_usize, odd in odd()) {
        check_faults(arrow, word, odd)?;
    }

    #[test]
    fn a_cone_stands_on_its_start(start in place(), direction in direction(), size in size()) {
        let cone = Arrow::cone(start, direction, size);
        let mesh = mesh_of(cone, &Sight::everywhere(9.0))?;
        let position = cone.position().as_dvec3() - Vec3::from(start).as_dvec3();
        let slack = 1e-7 * Vec3::from(direction).as_dvec3().length();
        prop_assert!((position + mesh.vertices[0].as_dvec3()).length() < slack);
    }
}

#[test]
fn an_arrow_is_36_bytes_and_nothing_if_they_are_zero() {
    assert_eq!(size_of::<Arrow>(), 36);
    check_zeros::<Arrow>();
}
