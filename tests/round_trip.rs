//! What is written is what is read: every writer, scenes of every kind, far and near.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

use glam::DVec3;
use puncta::{
    Grid, GridConfig, Scene, Source, Sphere,
    core::Scalar,
    io::{self, synthetic::Generator},
};

/// A generated scene in the order of a grid, with an attribute of each kind.
fn scene(spec: &str) -> Scene {
    let generator: Generator = spec.parse().unwrap();
    let Ok(mut scene) = generator.into_scene();
    Grid::sort_scene(&mut scene, &GridConfig::longest_side(7)).unwrap();
    // Files have their own order: what was sorted starts anew.
    scene.attributes.ids = None;
    scene
}

fn write_and_read(name: &str, scene: &Scene) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    io::write(&path, scene).unwrap();
    io::read(&path).unwrap()
}

/// Whether two positions are one, but for rounding to an `f32` offset from an origin nearby.
fn is_same(a: DVec3, b: DVec3, extent: f64) -> bool {
    (a - b).abs().max_element() <= extent * 2.0_f64.powi(-23)
}

fn check_spheres(before: &Scene, after: &Scene, name: &str) {
    assert_eq!(before.records.len(), after.records.len(), "{name}");
    let extent = before.bounds().extent().max_element();
    for index in 0..before.records.len() {
        let (a, b) = (before.position(index), after.position(index));
        // Around the origin, files hold the very numbers that were stored.
        let is_same = if before.origin == DVec3::ZERO { a == b } else { is_same(a, b, extent) };
        assert!(is_same, "{name}: record {index} at {a} was read at {b}");
        assert_eq!(before.records[index].radius, after.records[index].radius, "{name}");
    }
}

#[test]
fn every_writer_keeps_every_scene() {
    let specs = ["cube:n=2000", "lattice:n=2000", "ablation:n=3000", "hall:n=3000", "halo:n=3000"];
    for spec in specs {
        let mut before = scene(spec);
        let count = before.records.len();
        before.attributes.colors.get_or_insert_with(|| {
            (0..count).map(|i| [i as u8, (i / 256) as u8, 77, 255]).collect()
        });
        let values = (0..count).map(|i| 0.1 + i as f32).collect();
        before.attributes.scalars.push(Scalar { name: "serial".into(), values });
        for name in ["a.ply", "a.xyz", "a.mmpld"] {
            let after = write_and_read(name, &before);
            let case = format!("{spec} as {name}");
            check_spheres(&before, &after, &case);
            assert_eq!(before.attributes.colors, after.attributes.colors, "{case}");
            if name != "a.mmpld" {
                assert_eq!(before.attributes.scalars, after.attributes.scalars, "{case}");
                assert_eq!(before.attributes.elements, after.attributes.elements, "{case}");
            }
        }
    }
}

#[test]
fn a_second_round_changes_nothing() {
    for name in ["a.ply", "a.xyz", "a.mmpld"] {
        let first = write_and_read(name, &scene("hall:n=2000"));
        let second = write_and_read(name, &first);
        assert!(first == second, "{name}");
    }
}

#[test]
fn radii_over_many_decades_are_kept() {
    let sphere = |i: u8| Sphere::new([f32::from(i), 0.1, -1e-20], 1e-30 * 4_f32.powi(i.into()));
    let before = Scene::new((0..60).map(sphere).collect::<Vec<_>>());
    for name in ["a.ply", "a.xyz", "a.mmpld"] {
        check_spheres(&before, &write_and_read(name, &before), name);
    }
}
