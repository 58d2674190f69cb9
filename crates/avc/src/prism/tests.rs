//! Tests of prisms.

use super::*;
use crate::{
    Glyphs, Mesh,
    testing::{
        check_faults, check_zeros, corners, mesh_of, normal, odd, place, polygon_area, sight, size,
    },
};
use glam::{DVec3, Vec4};
use proptest::prelude::*;

fn prism() -> impl Strategy<Value = Prism> {
    let sides = prop_oneof![Just(0), 3..=Prism::SIDES_MAX];
    let turn = prop_oneof![-1.0_f32..1.0, -1e3_f32..1e3, Just(0.0)];
    (place(), size(), size(), sides, turn).prop_map(|(base, radius, height, sides, turn)| Prism {
        base,
        radius,
        height,
        sides,
        turn,
    })
}

proptest! {
    #[test]
    fn a_prism_stands_where_it_should(prism in prism(), sight in sight()) {
        let sight = sight.at_size(prism.radius);
        let mesh = mesh_of(prism, &sight)?;
        let sides = match prism.sides {
            0 => sight.sides(prism.radius),
            sides => sides,
        } as usize;
        prop_assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (2 * sides, 4 * sides - 4));
        let (radius, height) = (f64::from(prism.radius), f64::from(prism.height));
        // Points may be off by 3e-7 of their distance, which moves walls and ends by as much.
        let volume = polygon_area(sides as f64) * radius * radius * height;
        prop_assert!((mesh.volume() - volume).abs() < 4e-6 * volume, "{} {volume}", mesh.volume());
        let position = prism.position().as_dvec3() - DVec3::from(prism.base.map(f64::from));
        for (index, vertex) in mesh.vertices.iter().enumerate() {
            let from_base = position + vertex.as_dvec3();
            let turns = f64::from(prism.turn) + (index % sides) as f64 / sides as f64;
            let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
            let z = if index < sides { 0.0 } else { height };
            let expected = DVec3::new(radius * cos, radius * sin, z);
            prop_assert!((from_base - expected).truncate().length() < 2e-6 * radius);
            prop_assert!((from_base.z - z).abs() <= 2e-7 * height, "{} {z}", from_base.z);
        }
    }

    #[test]
    fn a_prism_looks_outwards(prism in prism(), sight in sight()) {
        let sight = sight.at_size(prism.radius);
        let mesh = mesh_of(prism, &sight)?;
        let walls = mesh.triangles.len() / 2 + 2;
        for (index, corners) in corners(&mesh).enumerate() {
            let (normal, middle) = (normal(corners), (corners[0] + corners[1] + corners[2]) / 3.0);
            if index < walls {
                prop_assert_eq!(normal.z, 0.0);
                prop_assert!(normal.dot(middle) > 0.0);
            } else {
                prop_assert_eq!(normal.truncate().length(), 0.0);
                // The base comes first; it is the one whose points are the ends of the lower ring.
                let is_base = index < walls + walls / 2 - 2;
                prop_assert_eq!(normal.z.signum(), if is_base { -1.0 } else { 1.0 });
            }
        }
    }

    /// Only ends that face away from the eye are left out, and all others are there.
    #[test]
    fn ends_are_left_out_if_they_face_away(
        prism in prism(),
        sight in (1.0_f32..50.0).prop_map(Sight::everywhere),
        eye in [-3.0_f32..3.0, -3.0..3.0, -3.0..3.0],
        is_perspective in any::<bool>(),
    ) {
        let sight = sight.at_size(prism.radius);
        let whole = mesh_of(prism, &sight)?;
        let eye = Vec3::from(eye) * prism.height;
        let sight = Sight { eye: eye.extend(if is_perspective { 1.0 } else { 0.0 }), ..sight };
        let glyphs = Glyphs::new([]);
        let form = Prism::form(&glyphs.cloud(&[prism]), 0, &sight);
        let seen = Mesh::of::<Prism>(&form);
        prop_assert!(seen.triangles.iter().all(|triangle| whole.triangles.contains(triangle)));
        for (triangle, corners) in whole.triangles.iter().zip(corners(&whole)) {
            let eye = sight.eye.as_dvec4();
            let facing = normal(corners).dot(eye.truncate() - corners[0] * eye.w);
            let slack = 1e-4 * f64::from(prism.height) * normal(corners).length();
            let is_there = seen.triangles.contains(triangle);
            let is_end = normal(corners).z != 0.0;
            prop_assert!(is_there || facing < 0.0, "{facing}");
            prop_assert!(!is_there || !is_end || facing > -slack, "{facing}");
        }
    }

    #[test]
    fn odd_prisms_are_nothing_and_counted(prism in prism(), word in 0..7_usize, odd in odd()) {
        check_faults(prism, word, odd)?;
    }

    #[test]
    fn some_numbers_of_sides_are_nothing(prism in prism(), sides in 0..100_u32) {
        let glyphs = Glyphs::new([]);
        let prism = prism.with_sides(sides);
        let form = Prism::form(&glyphs.cloud(&[prism]), 0, &Sight::everywhere(9.0));
        let is_nothing = matches!(sides, 1 | 2 | 65..);
        prop_assert_eq!(Prism::size(&form).triangles == 0, is_nothing);
        prop_assert_eq!(glyphs.faults(&[prism]).no_extent, u64::from(is_nothing));
    }
}

#[test]
fn a_prism_is_28_bytes_and_nothing_if_they_are_zero() {
    assert_eq!(size_of::<Prism>(), 28);
    check_zeros::<Prism>();
}

/// Each of the four answers to what is seen of base and top.
#[test]
fn the_right_end_is_drawn() {
    let glyphs = Glyphs::new([]);
    let prism = [Prism::new([0.0; 3], 1.0, 2.0).with_sides(5)];
    for (eye, ends) in [(3.0, [0.0, 3.0]), (-3.0, [3.0, 0.0]), (0.0, [0.0, 0.0]), (1.0, [0.0, 3.0])]
    {
        let sight = Sight { eye: Vec4::new(9.0, 9.0, eye, 1.0), ..Sight::everywhere(5.0) };
        let mesh = Mesh::of::<Prism>(&Prism::form(&glyphs.cloud(&prism), 0, &sight));
        let normals: Vec<f64> = corners(&mesh).map(|corners| normal(corners).z).collect();
        let count =
            |is_end: fn(&f64) -> bool| normals.iter().copied().filter(is_end).count() as f64;
        assert_eq!([count(|z| *z < 0.0), count(|z| *z > 0.0)], ends);
    }
}
