//! The promise of memory: a binary reader needs at most 1.2 times what the records need in the end,
//! attributes included. The file itself does not count: it lies in memory before.

#![expect(clippy::unwrap_used, reason = "this is a test")]

mod common;

use common::with_peak;
use puncta_core::{Scalar, Scene, Sphere};
use puncta_io::ReadOptions;
use std::fs;

/// Enough that buffers of fixed size do not matter: 16 MB of spheres.
const COUNT: u32 = 1_000_000;

/// A coordinate with digits, different for each record.
fn x(i: u32) -> f32 {
    0.37 * i as f32
}

fn check(name: &str, file: &[u8]) {
    let read = || ReadOptions::default().radius(0.5).read_bytes(name, file).unwrap();
    let (loaded, peak) = with_peak(read);
    let scene = &loaded.scene;
    assert_eq!(scene.records.len(), COUNT as usize, "{name}");
    let end = size_of_val(scene.records.as_slice()) + scene.attributes.bytes();
    let ratio = peak as f64 / end as f64;
    assert!(ratio >= 1.0, "{name}: the counting is wrong, {ratio}");
    assert!(ratio <= 1.2, "{name}: {peak} bytes at once for {end} in the end, {ratio:.3}");
}

fn written(name: &str, scene: &Scene<Sphere>) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    puncta_io::write(&path, scene).unwrap();
    fs::read(path).unwrap()
}

#[test]
fn ply_and_mmpld_keep_the_promise() {
    let sphere = |i| Sphere::new([x(i), 1.0, 2.0], 0.5);
    let mut scene = Scene::new((0..COUNT).map(sphere).collect::<Vec<_>>());
    check("plain.ply", &written("plain.ply", &scene));
    check("plain.mmpld", &written("plain.mmpld", &scene));
    scene.attributes.colors = Some((0..COUNT).map(u32::to_le_bytes).collect());
    check("colors.mmpld", &written("colors.mmpld", &scene));
    scene.attributes.scalars = ["a", "b"]
        .map(|name| Scalar { name: name.to_owned(), values: (0..COUNT).map(x).collect() })
        .into();
    check("scalars.ply", &written("scalars.ply", &scene));
}

#[test]
fn vtk_keeps_the_promise() {
    let mut file = format!(
        "# vtk DataFile Version 3.0\npoints\nBINARY\nDATASET POLYDATA\nPOINTS {COUNT} float\n"
    )
    .into_bytes();
    file.extend((0..COUNT).flat_map(|i| [x(i), 1.0, 2.0]).flat_map(f32::to_be_bytes));
    check("plain.vtk", &file);
    let header = format!("\nPOINT_DATA {COUNT}\nSCALARS speed float 1\nLOOKUP_TABLE default\n");
    file.extend(header.into_bytes());
    file.extend((0..COUNT).map(x).flat_map(f32::to_be_bytes));
    check("scalar.vtk", &file);
}

/// LAS 1.2 with points of format 2: place, intensity and color.
#[test]
fn las_keeps_the_promise() {
    let mut file = vec![0; 227];
    file[..4].copy_from_slice(b"LASF");
    file[24..26].copy_from_slice(&[1, 2]);
    file[94..96].copy_from_slice(&227_u16.to_le_bytes());
    file[96..100].copy_from_slice(&227_u32.to_le_bytes());
    file[104] = 2;
    file[105..107].copy_from_slice(&26_u16.to_le_bytes());
    file[107..111].copy_from_slice(&COUNT.to_le_bytes());
    for axis in 0..3 {
        file[131 + 8 * axis..139 + 8 * axis].copy_from_slice(&0.01_f64.to_le_bytes());
        file[155 + 8 * axis..163 + 8 * axis].copy_from_slice(&1e6_f64.to_le_bytes());
    }
    for i in 0..COUNT {
        let mut point = [0; 26];
        point[..4].copy_from_slice(&i.to_le_bytes());
        point[12..14].copy_from_slice(&[7, 0]);
        point[20..26].copy_from_slice(&[1, 200, 2, 100, 3, 50]);
        file.extend(point);
    }
    check("points.las", &file);
}
