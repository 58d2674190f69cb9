//! What is written is read back.

use super::*;
use crate::mmpld::write;
use glam::DVec3;
use puncta_core::{Scalar, Scene, Sphere};
use std::io::Cursor;

fn written(scene: &Scene) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    write(&mut out, scene).unwrap();
    out.into_inner()
}

/// Spheres of these many radii.
fn scene(records: u16, radii: u16) -> Scene {
    let sphere = |i: u16| {
        let x = f32::from(i);
        Sphere::new([0.1 * x, (1.7 * x).sin(), 3.0 - 0.3 * x], 0.1 + 0.7 * f32::from(i % radii))
    };
    Scene::new((0..records).map(sphere).collect::<Vec<_>>())
}

fn intensities(records: u16) -> Scalar {
    let values = (0..records).map(|i| 0.1 * f32::from(i) - 3.0).collect();
    Scalar { name: "intensity".into(), values }
}

fn colors(records: u16) -> Vec<[u8; 4]> {
    (0..records).map(|i| [i as u8, (i >> 8) as u8, 255 - i as u8, (i / 3) as u8]).collect()
}

/// Positions, radii, colors and intensities, as bits, in an order of their own.
fn rows(scene: &Scene) -> Vec<([u64; 3], u32, [u8; 4], u32)> {
    let mut rows: Vec<_> = (0..scene.records.len())
        .map(|i| {
            let color = scene.attributes.colors.as_ref().map_or([255; 4], |colors| colors[i]);
            let intensity = scene.scalar("intensity").map_or(0, |s| s.values[i].to_bits());
            let position = (scene.position(i) + 0.0).to_array().map(f64::to_bits);
            (position, scene.records[i].radius.to_bits(), color, intensity)
        })
        .collect();
    rows.sort_unstable();
    rows
}

#[test]
fn single_positions_come_back_as_they_were() {
    for attributes in 0..3 {
        let mut scene = scene(1000, 1000);
        match attributes {
            0 => {}
            1 => scene.attributes.colors = Some(colors(1000).into()),
            _ => scene.attributes.scalars.push(intensities(1000)),
        }
        let bytes = written(&scene);
        let loaded = read(&bytes);
        assert_eq!(loaded.scene, scene);
        assert_eq!(loaded.report, Default::default());
        assert_eq!(bytes[6..8], 103_u16.to_le_bytes());
        assert_eq!(bytes[84..86], [2, [0, 2, 3][attributes]]);
    }
}

#[test]
fn an_origin_that_single_precision_holds_needs_no_double() {
    let mut scene = Scene::new(vec![Sphere::new([0.5; 3], 1.0), Sphere::new([-2.0; 3], 0.5)]);
    scene.origin = DVec3::new(4096.0, 0.0, -8192.0);
    let bytes = written(&scene);
    assert_eq!(bytes[84], 2);
    assert_eq!(rows(&read(&bytes).scene), rows(&scene));
}

#[test]
fn double_positions_come_back_with_up_to_256_radii() {
    for (radii, attributes) in [(1, 0), (3, 1), (256, 2)] {
        let mut scene = scene(1000, radii);
        scene.origin = DVec3::new(1e7, -5e6, 64.0);
        match attributes {
            0 => {}
            1 => scene.attributes.colors = Some(colors(1000).into()),
            _ => scene.attributes.scalars.push(intensities(1000)),
        }
        let bytes = written(&scene);
        assert_eq!(bytes[80..84], u32::from(radii).to_le_bytes());
        assert_eq!(bytes[84..86], [4, [6, 6, 7][attributes]]);
        // The reader chooses another origin, whose offsets may round; after that, nothing changes.
        let loaded = read(&bytes);
        assert_eq!(loaded.report, Default::default());
        for (got, wanted) in rows(&loaded.scene).iter().zip(rows(&scene)) {
            assert!(near(got.0, wanted.0));
            assert_eq!((got.1, got.2, got.3), (wanted.1, wanted.2, wanted.3));
        }
        let again = read(&written(&loaded.scene));
        assert!(rows(&again.scene) == rows(&loaded.scene));
    }
}

/// Whether positions, as bits, differ by no more than rounding offsets of some hundred units.
fn near(a: [u64; 3], b: [u64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (f64::from_bits(*a) - f64::from_bits(b)).abs() < 2e-5)
}

#[test]
fn more_radii_than_lists_are_refused() {
    let mut scene = scene(1000, 257);
    scene.origin = DVec3::splat(1e7);
    let error = write(&mut Cursor::new(Vec::new()), &scene).unwrap_err().in_file("b.mmpld");
    let text = "b.mmpld: the positions need 64 bits, and then MMPLD has one radius for each list: \
                there must be at most 256 radii, not more";
    assert_eq!(error.to_string(), text);
}

#[test]
fn boxes_have_an_extent_and_hold_everything() {
    let floats = |bytes: &[u8], at: usize| -> [f32; 6] {
        std::array::from_fn(|i| {
            f32::from_le_bytes(bytes[at + 4 * i..at + 4 * i + 4].try_into().unwrap())
        })
    };
    let mut flat =
        Scene::new(vec![Sphere::new([1.0, 2.0, 3.0], 0.5), Sphere::new([4.0, 2.0, 3.5], 0.25)]);
    let bytes = written(&flat);
    assert_eq!(floats(&bytes, 12), [1.0, 1.5, 3.0, 4.0, 2.5, 3.5]);
    assert_eq!(floats(&bytes, 36), [0.5, 1.0, 2.5, 4.5, 3.0, 4.0]);
    flat.origin = DVec3::splat(1e7 + 0.1);
    flat.records.to_mut().push(Sphere::new([f32::NAN, f32::INFINITY, 0.0], f32::NAN));
    let bytes = written(&flat);
    let (bounds, clip) = (floats(&bytes, 12), floats(&bytes, 36));
    for axis in 0..3 {
        let at = |i: usize| flat.position(i)[axis];
        assert!(f64::from(bounds[axis]) <= at(0) && at(1) <= f64::from(bounds[axis + 3]));
        assert!(bounds[axis] < bounds[axis + 3]);
        assert!(clip[axis] <= bounds[axis] - 0.5 && clip[axis + 3] >= bounds[axis + 3] + 0.5);
    }
    let loaded = read(&bytes);
    assert_eq!((loaded.scene.records.len(), loaded.report.skipped_count()), (2, 1));
    let empty = written(&Scene::new(Vec::new()));
    assert_eq!(floats(&empty, 12), [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]);
}

#[test]
fn a_file_that_was_not_finished_is_marked() {
    /// Memory that is full after some bytes.
    struct Full(Cursor<[u8; 100]>);
    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.get_mut();
            let place = self.0.position() as usize;
            let room = &mut self.0.get_mut()[place..];
            let count = room.len().min(bytes.len());
            room[..count].copy_from_slice(&bytes[..count]);
            self.0.set_position((place + count) as u64);
            Ok(count)
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    impl std::io::Seek for Full {
        fn seek(&mut self, place: std::io::SeekFrom) -> std::io::Result<u64> {
            self.0.seek(place)
        }
    }
    let mut full = Full(Cursor::new([7; 100]));
    assert!(write(&mut full, &scene(9, 9)).is_err());
    assert_eq!(full.0.get_ref()[..8], *b"MMPLD\0\0\0");
}

#[test]
fn columns_of_another_length_are_refused() {
    let mut scene = scene(9, 9);
    scene.attributes.colors = Some(colors(8).into());
    let error = write(&mut Cursor::new(Vec::new()), &scene).unwrap_err().in_file("b.mmpld");
    assert_eq!(error.to_string(), "b.mmpld: attribute colors has 8 values for 9 records");
}
