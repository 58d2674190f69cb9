//! Tests of the builder.

use super::{report::WARNINGS_MAX, *};

fn scene(positions: &[[f64; 3]], precision: Precision) -> Scene {
    let options = ReadOptions::default().radius(1.0);
    let mut builder = Builder::new(&options, precision, &Columns::default());
    for &position in positions {
        builder.push(&Row { position, ..Row::default() }, Place::Line(1)).unwrap();
    }
    builder.finish().unwrap().0
}

#[test]
fn positions_around_zero_are_stored_as_they_are() {
    let scene = scene(&[[0.1, 0.2, 0.3], [0.9, 1.0, -0.25]], Precision::Double);
    assert_eq!(scene.origin, DVec3::ZERO);
    assert_eq!(scene.records[0].center, [0.1, 0.2, 0.3]);
}

#[test]
fn far_positions_keep_their_digits() {
    let positions = [[637_000.01, 851_000.02, 450.03], [637_001.04, 851_002.05, 451.06]];
    let scene = scene(&positions, Precision::Double);
    for (index, position) in positions.iter().enumerate() {
        assert!((scene.position(index) - DVec3::from(*position)).abs().max_element() < 1e-7);
    }
}

#[test]
fn a_box_without_measurable_extent_has_an_origin() {
    let scene = scene(&[[2.0, 0.0, 0.0], [2.0, 1e-320, 0.0]], Precision::Double);
    assert_eq!(scene.origin, DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn strays_do_not_take_the_digits_of_the_rest() {
    let near = |i: u32| [637_000.0 + f64::from(i) * 0.01, 851_000.02, 400.0];
    let positions: Vec<[f64; 3]> = std::iter::once([0.0; 3]).chain((0..5000).map(near)).collect();
    let scene = scene(&positions, Precision::Double);
    assert_eq!(scene.position(0), DVec3::ZERO);
    for (index, position) in positions.iter().enumerate() {
        let error = (scene.position(index) - DVec3::from(*position)).abs().max_element();
        assert!(error < 2e-5, "{index}: {error}");
    }
}

#[test]
fn warnings_have_an_end() {
    let options = ReadOptions::default();
    let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
    (0..1000).for_each(|i| builder.warn(format!("warning {i}")));
    assert_eq!(builder.report.warnings.len(), WARNINGS_MAX + 1);
}

#[test]
fn moving_single_precision_is_exact() {
    let positions: Vec<[f64; 3]> = (0..100_u16)
        .map(|i| [1e7_f32 + f32::from(i), -3e5 + 0.1 * f32::from(i), 77.7].map(f64::from))
        .collect();
    let scene = scene(&positions, Precision::Single);
    assert!(scene.origin.x != 0.0 && scene.origin.y != 0.0);
    for (index, position) in positions.iter().enumerate() {
        assert_eq!(scene.position(index), DVec3::from(*position));
    }
}

#[test]
fn many_rows_of_double_precision_share_one_origin() {
    let positions: Vec<[f64; 3]> =
        (0..100_000_u32).map(|i| [1e7 + f64::from(i) * 0.5, 0.0, 0.0]).collect();
    let scene = scene(&positions, Precision::Double);
    for index in [0, 1, HEAD - 2, HEAD - 1, HEAD, HEAD + 1, 99_999] {
        assert_eq!(scene.position(index), DVec3::from(positions[index]), "{index}");
    }
}

#[test]
fn rows_that_cannot_be_used_are_counted_and_keep_ids_right() {
    let options = ReadOptions::default();
    let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
    let row = |x, radius| Row { position: [x, 0.0, 0.0], radius: Some(radius), ..Row::default() };
    for (x, radius) in [(0.0, 1.0), (f64::NAN, 1.0), (2.0, -1.0), (3.0, 0.0), (4.0, 1.0)] {
        builder.push(&row(x, radius), Place::Line(7)).unwrap();
    }
    let (scene, report) = builder.finish().unwrap();
    assert_eq!(scene.attributes.ids, Some(vec![0, 4].into()));
    assert_eq!(report.skipped_count(), 3);
    assert_eq!(report.skipped[1].value, "-1");
}

#[test]
fn strict_reading_names_the_value() {
    let options = ReadOptions::default().strict(true);
    let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
    let row = Row { position: [0.0, f64::INFINITY, 0.0], ..Row::default() };
    let error = builder.push(&row, Place::Line(3)).unwrap_err().in_file("a.xyz");
    let text = "a.xyz, line 3: a position that cannot be stored: (0, inf, 0)";
    assert_eq!(error.to_string(), text);
}
