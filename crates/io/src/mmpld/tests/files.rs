//! Valid files of all versions and types.

use super::*;
use crate::ErrorKind;
use puncta_core::Sphere;
use std::{env, fs, path::Path};

/// What each vertex type stores for the particle `i`, and where it is then.
fn position(vertex: u8, i: u8) -> (Vec<u8>, [f64; 3], f32) {
    let x = 0.25 * f32::from(i);
    match vertex {
        1 => (singles(&[x, 0.5, 2.0]), [x.into(), 0.5, 2.0], 0.5),
        2 => (singles(&[x, 0.5, 2.0, 0.125]), [x.into(), 0.5, 2.0], 0.125),
        3 => (words(&[257 * u16::from(i), 0, 65535]), [f64::from(i) / 255.0, 0.0, 1.0], 0.5),
        _ => (doubles(&[0.1 * f64::from(i), 0.5, 2.0]), [0.1 * f64::from(i), 0.5, 2.0], 0.5),
    }
}

/// What each color type stores, and the color and intensity it is.
fn color(color: u8) -> (Vec<u8>, Option<[u8; 4]>, Option<f32>) {
    match color {
        0 => (vec![], Some([10, 20, 30, 255]), None),
        1 => (vec![1, 2, 3], Some([1, 2, 3, 255]), None),
        2 => (vec![1, 2, 3, 4], Some([1, 2, 3, 4]), None),
        3 => (singles(&[7.5]), None, Some(7.5)),
        4 => (singles(&[0.0, 0.2, 1.0]), Some([0, 51, 255, 255]), None),
        5 => (singles(&[0.0, 0.2, 1.0, 0.4]), Some([0, 51, 255, 102]), None),
        6 => (words(&[0, 257, 514, 65535]), Some([0, 1, 2, 255]), None),
        _ => (doubles(&[0.1]), None, Some(0.1)),
    }
}

#[test]
fn all_versions_and_types_are_read() {
    for version in 100..=103 {
        for (vertex_type, color_type) in (1..=4).flat_map(|v| (0..=7).map(move |c| (v, c))) {
            let (color_bytes, rgba, intensity) = color(color_type);
            let particle = |i| join(&position(vertex_type, i).0, &color_bytes);
            let list = list(version, (vertex_type, color_type), &[0, 1, 2].map(particle));
            let loaded = read(&file(version, &[frame(version, &[list])]));
            let case = format!("version {version}, types {vertex_type} and {color_type}");
            let scene = &loaded.scene;
            assert_eq!(scene.records.len(), 3, "{case}");
            for i in 0..3_u8 {
                let (_, mut at, radius) = position(vertex_type, i);
                if vertex_type == 3 {
                    // The list box is [0, 2], that of the file [-1, 3].
                    let (least, side) = if version == 103 { (0.0, 2.0) } else { (-1.0, 4.0) };
                    at = at.map(|part| least + side * part);
                }
                let sphere = scene.records[usize::from(i)];
                assert_eq!(
                    scene.position(i.into()).to_array().map(|x| x as f32),
                    at.map(|x| x as f32)
                );
                assert_eq!(sphere.radius, radius, "{case}");
            }
            assert_eq!(scene.attributes.colors, rgba.map(|rgba| [rgba; 3].into()), "{case}");
            let scalar = scene.scalar("intensity").map(|scalar| scalar.values.clone());
            assert_eq!(scalar, intensity.map(|intensity| [intensity; 3].into()), "{case}");
            assert_eq!(loaded.report.warnings.len(), usize::from(vertex_type == 3), "{case}");
            assert_eq!(loaded.report.skipped, []);
        }
    }
}

#[test]
fn lists_are_joined() {
    let first = list(102, (2, 3), &[singles(&[1.0, 0.0, 0.0, 0.25, 5.0])]);
    let none = list(102, (0, 0), &[]);
    let second = list(102, (1, 0), &[singles(&[2.0, 0.0, 0.0]), singles(&[3.0, 0.0, 0.0])]);
    let loaded = read(&file(102, &[frame(102, &[first, none, second])]));
    let spheres = [([1.0, 0.0, 0.0], 0.25), ([2.0, 0.0, 0.0], 0.5), ([3.0, 0.0, 0.0], 0.5)];
    let spheres = spheres.map(|(center, radius)| Sphere::new(center, radius));
    assert_eq!(loaded.scene.records, spheres);
    let global = [10, 20, 30, 255];
    assert_eq!(loaded.scene.attributes.colors, Some([[255; 4], global, global].into()));
    let intensities = &loaded.scene.scalar("intensity").unwrap().values;
    assert!(intensities[0] == 5.0 && intensities[1].is_nan() && intensities[2].is_nan());
    assert_eq!(loaded.report, Default::default());
}

#[test]
fn frames_are_found_by_the_seek_table() {
    let frames = [1.0_f32, 2.0, 3.0]
        .map(|x| frame(103, &[list(103, (1, 2), &[join(&singles(&[x, 0.0, 0.0]), &[9; 4])])]));
    let bytes = file(103, &frames);
    for (index, x) in [(0, 1.0), (1, 2.0), (2, 3.0)] {
        let loaded = read_with(&ReadOptions::default().frame(index), &bytes).unwrap();
        assert_eq!(loaded.scene.position(0).x, x);
        assert_eq!(loaded.report, Default::default());
    }
    for frame in [3, u64::MAX] {
        let error = read_with(&ReadOptions::default().frame(frame), &bytes).unwrap_err();
        assert!(matches!(error.kind, ErrorKind::NoSuchFrame { frames: 3, .. }));
    }
    let error = ReadOptions::default().frame(3).read_bytes("a.mmpld", &bytes).unwrap_err();
    assert_eq!(error.to_string(), "a.mmpld: there is no frame 3: the file has 3, counted from 0");
}

#[test]
fn bytes_behind_the_last_frame_are_ignored() {
    let list = list(100, (1, 2), &[join(&singles(&[1.0; 3]), &[9; 4])]);
    let bytes = join(&file(100, &[frame(100, &[list])]), b"more");
    assert_eq!(read(&bytes).report, Default::default());
}

#[test]
fn many_particles_and_lists_in_a_compressed_file() {
    // One list is read as a stream, two must be held; both are longer than what is held at first.
    let particle = |i: u32| singles(&[i as f32, 0.0, 0.0, 1.0]);
    for lists in [1, 2] {
        let one = list(103, (2, 0), &(0..40_000).map(particle).collect::<Vec<_>>());
        let loaded = read(&file(103, &[frame(103, &vec![one; lists])]));
        assert_eq!(loaded.scene.records.len(), lists * 40_000);
        assert_eq!(loaded.scene.position(lists * 40_000 - 1).x, 39_999.0);
        assert_eq!(loaded.report, Default::default());
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "a skipped test says so")]
fn sample_files_are_read_to_their_last_byte() {
    let Ok(folder) = env::var("PUNCTA_DATA") else {
        println!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let mut files = 0;
    for entry in fs::read_dir(Path::new(&folder).join("mmpld")).unwrap() {
        let path = entry.unwrap().path();
        let loaded = read(&fs::read(&path).unwrap());
        // Those of double positions have three axes of five particles besides.
        let records = if path.to_string_lossy().contains("double") { 19 } else { 4 };
        assert_eq!(loaded.scene.records.len(), records);
        assert_eq!(loaded.report, Default::default(), "{}", path.display());
        files += 1;
    }
    assert_eq!(files, 17);
}
