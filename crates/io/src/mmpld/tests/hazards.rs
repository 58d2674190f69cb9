//! Files that deviate from the format, as real ones do.

use super::*;
use crate::Problem;

const STRAY: &str = "1 lists of frame 0 are written in a way that is known to be wrong, but fits";

fn points(version: u16, xs: &[f32]) -> Vec<u8> {
    let particles: Vec<_> = xs.iter().map(|&x| singles(&[x, 0.0, 0.0])).collect();
    list(version, (1, 0), &particles)
}

/// Double positions with colors of 16 bits; as MegaMol's writer does it if there are more bytes.
fn double_points(version: u16, more: &[u8], xs: &[f64]) -> Vec<u8> {
    let mut list = header(version, (4, 6), xs.len() as u64);
    list.splice(6..6, more.iter().copied());
    for &x in xs {
        list.extend(doubles(&[x, 0.0, 0.0]));
        list.extend(words(&[0x0101, 0x0202, 0x0303, 0x0404]));
    }
    list
}

fn xs(loaded: &Loaded) -> Vec<f64> {
    (0..loaded.scene.records.len()).map(|i| loaded.scene.position(i).x).collect()
}

#[test]
fn a_missing_time_stamp_is_noticed() {
    for version in [102, 103] {
        // The second one is longer than what is held of a compressed file at first.
        for count in [3_u16, 30_000] {
            let many: Vec<f32> = (0..count).map(f32::from).collect();
            let lists = [points(version, &[7.0]), points(version, &many), points(version, &[8.0])];
            let frame = frame(version, &lists).split_off(4);
            let loaded = read(&file(version, &[frame]));
            assert_eq!(loaded.scene.records.len(), usize::from(count) + 2);
            assert_eq!(xs(&loaded)[0], 7.0);
            assert_eq!(*xs(&loaded).last().unwrap(), 8.0);
            let warning = format!("frame 0 has no time stamp, which version {version} asks for");
            assert_eq!(loaded.report.warnings, [warning]);
        }
    }
}

#[test]
fn a_frame_of_zeros_has_no_lists_rather_than_no_time_stamp() {
    assert_eq!(
        fault(&file(103, &[vec![0; 8]])),
        "a.mmpld: there is nothing to draw: 0 records were skipped"
    );
}

#[test]
fn a_color_too_many_is_passed_over() {
    let color = [1, 2, 3, 255];
    for version in [102, 103] {
        let plain = double_points(version, &[], &[1.0, 2.0]);
        let shifted = double_points(version, &color, &[3.0, 4.0]);
        let last = points(version, &[5.0]);
        for (lists, warnings) in [
            (vec![plain.clone(), last.clone()], vec![]),
            (vec![shifted.clone()], vec![STRAY]),
            (vec![shifted.clone(), plain.clone(), last.clone()], vec![STRAY]),
            (vec![plain, shifted, last], vec![STRAY]),
        ] {
            let loaded = read(&file(version, &[frame(version, &lists)]));
            assert_eq!(loaded.report.warnings, warnings);
            assert_eq!(loaded.report.skipped, []);
            let mut xs = xs(&loaded);
            xs.sort_by(f64::total_cmp);
            assert!(xs.iter().all(|x| [1.0, 2.0, 3.0, 4.0, 5.0].contains(x)), "{xs:?}");
            assert_eq!(
                loaded
                    .scene
                    .attributes
                    .colors
                    .unwrap()
                    .iter()
                    .filter(|c| **c == [1, 2, 3, 4])
                    .count()
                    % 2,
                0
            );
        }
    }
}

#[test]
fn a_color_too_many_and_no_time_stamp() {
    let lists = [double_points(103, &[1, 2, 3, 4], &[1.0]), points(103, &[2.0])];
    let loaded = read(&file(103, &[frame(103, &lists).split_off(4)]));
    assert_eq!(xs(&loaded), [1.0, 2.0]);
    assert_eq!(loaded.report.warnings.len(), 2);
}

#[test]
fn a_cluster_block_may_be_missing_where_there_are_no_positions() {
    let with = list(101, (0, 0), &[]);
    let without = header(101, (0, 0), 0);
    let loaded = read(&file(101, &[frame(101, &[with.clone(), points(101, &[1.0])])]));
    assert_eq!(loaded.report, Default::default());
    let lists = [with, without, points(101, &[1.0])];
    let loaded = read(&file(101, &[frame(101, &lists)]));
    assert_eq!(xs(&loaded), [1.0]);
    assert_eq!(loaded.report.warnings, [STRAY]);
}

#[test]
fn trailing_bytes_inside_a_frame_are_ignored() {
    let frame = join(&frame(103, &[points(103, &[1.0])]), &[0; 9]);
    let loaded = read(&file(103, &[frame.clone(), frame]));
    assert_eq!(xs(&loaded), [1.0]);
    let warning = "9 of the 71 bytes of frame 0 follow its last list; trailing bytes inside a \
                   frame are ignored";
    assert_eq!(loaded.report.warnings, [warning]);
}

#[test]
fn quantized_positions_take_the_box_that_is_one() {
    let mut short = list(103, (3, 0), &[words(&[0, 65535, 13107])]);
    let at = short.len() - 6 - 24;
    for (bounds, position, owner) in [
        ([0.0, 0.0, 0.0, 10.0, 0.0, 5.0], [0.0, 0.0, 1.0], "their list"),
        ([0.0; 6], [-1.0, 3.0, -0.2], "the file"),
        ([f32::NAN; 6], [-1.0, 3.0, -0.2], "the file"),
        ([1.0, 0.0, 0.0, 0.0, 1.0, 1.0], [-1.0, 3.0, -0.2], "the file"),
    ] {
        short.splice(at..at + 24, singles(&bounds));
        let loaded = read(&file(103, &[frame(103, &[short.clone()])]));
        assert!((loaded.scene.position(0) - glam::DVec3::from(position)).length() < 1e-6);
        let warning = format!(
            "positions are quantized in a way the format does not define; the box of {owner} was \
             taken for theirs"
        );
        assert_eq!(loaded.report.warnings, [warning]);
    }
}

#[test]
fn colors_that_are_none_are_told() {
    let particle = |red| singles(&[0.0, 0.0, 0.0, red, 0.5, 0.5]);
    let list = list(102, (1, 4), &[f32::NAN, 2.0, -1.0, 1.0].map(particle));
    let loaded = read(&file(102, &[frame(102, &[list])]));
    let colors = [[255; 4], [255, 128, 128, 255], [0, 128, 128, 255], [255, 128, 128, 255]];
    assert_eq!(loaded.scene.attributes.colors, Some(colors.to_vec().into()));
    let warnings = [
        "1 colors are not a number; they are white",
        "2 colors lie outside of 0..1 and were clamped",
    ];
    assert_eq!(loaded.report.warnings, warnings);
}

#[test]
fn particles_that_cannot_be_used_are_counted() {
    let mut zero = points(100, &[1.0, 2.0]);
    zero.splice(2..6, singles(&[0.0]));
    let own = [singles(&[3.0, 0.0, 0.0, -1.0]), singles(&[4.0, 0.0, 0.0, 1.0])];
    let far = points(100, &[f32::NAN, 5.0]);
    let bytes = file(100, &[frame(100, &[zero, list(100, (2, 0), &own), far])]);
    let loaded = read(&bytes);
    assert_eq!(xs(&loaded), [4.0, 5.0]);
    assert_eq!(loaded.scene.attributes.ids, Some([3, 5].into()));
    let [radius, position] = &loaded.report.skipped[..] else { panic!("two problems") };
    assert_eq!((radius.problem, radius.count, &*radius.value), (Problem::Radius, 3, "0"));
    assert_eq!((position.problem, position.count), (Problem::Position, 1));
    let error = read_with(&ReadOptions::default().strict(true), &bytes).unwrap_err();
    // 76 bytes of header and table, 4 of the number of lists, 18 of the header of the list.
    let text = "a.mmpld, byte 98: a radius that is not positive and finite: 0";
    assert_eq!(error.to_string(), text);
}

#[test]
fn particles_without_positions_are_left_out() {
    let first = points(102, &[0.0]);
    let at = 84 + first.len() as u64;
    let lists = [first, header(102, (0, 2), 7), header(102, (0, 2), 0), points(102, &[1.0])];
    let bytes = file(102, &[frame(102, &lists)]);
    let loaded = read(&bytes);
    assert_eq!(xs(&loaded), [0.0, 1.0]);
    assert_eq!(loaded.scene.attributes.ids, Some([0, 8].into()));
    let [skipped] = &loaded.report.skipped[..] else { panic!("one problem") };
    let found = (skipped.problem, skipped.count, skipped.first, &*skipped.value);
    assert_eq!(found, (Problem::Position, 7, crate::Place::Byte(at), "none"));
    let error = read_with(&ReadOptions::default().strict(true), &bytes).unwrap_err();
    let text = format!("a.mmpld, byte {at}: a position that cannot be stored: none");
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_huge_number_of_particles_without_positions_takes_no_time() {
    for count in [1 << 63, u64::MAX] {
        let lists = [points(102, &[1.0]), header(102, (0, 2), count), header(102, (0, 2), count)];
        let error = fault(&file(102, &[frame(102, &lists)]));
        let rows = count.saturating_add(1);
        let text = format!("a.mmpld: {rows} records are more than a scene can hold");
        assert_eq!(error, text);
    }
}
