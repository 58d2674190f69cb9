//! Tests of extended XYZ.

use super::*;

const TEXT: &str = "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=id:I:1:pos:R:3:species:S:1:\
    velo:R:3:radius:R:1:color:R:3:fixed:L:1\n\
    7 1 2 3 Fe .1 .2 .3 0.5 1 0.5 0 T\n8 4 5 6 Q .4 .5 .6 0.25 0 0.25 1 F\n";

#[test]
fn columns_are_what_the_comment_says() {
    let loaded = read(TEXT);
    assert_eq!(loaded.scene.attributes.elements, Some([26, 0].into()));
    assert_eq!(radii(&loaded), [0.5, 0.25]);
    let colors = Some([[255, 128, 0, 255], [0, 64, 255, 255]].into());
    assert_eq!(loaded.scene.attributes.colors, colors);
    assert_eq!(scalar(&loaded, "velo_y"), [0.2, 0.5]);
    assert_eq!(scalar(&loaded, "id"), [7.0, 8.0]);
    assert_eq!(scalar(&loaded, "fixed"), [1.0, 0.0]);
    assert_eq!(xs(&loaded), [1.0, 4.0]);
}

#[test]
fn atomic_numbers_are_elements() {
    let loaded = read("2\nProperties=Z:I:1:pos:R:3\n8 0 0 0\n1 1 0 0\n");
    assert_eq!(loaded.scene.attributes.elements, Some([8, 1].into()));
    assert_eq!(radii(&loaded), [1.52, 1.2]);
}

#[test]
fn colors_out_of_range_are_told() {
    let text = "2\nProperties=pos:R:3:radius:R:1:color:I:4\n0 0 0 1 300 0 -1 9\n1 0 0 1 1 2 3 4\n";
    let loaded = read(text);
    assert_eq!(loaded.scene.attributes.colors, Some([[255, 0, 0, 9], [1, 2, 3, 4]].into()));
    let clamped = "1 colors lie outside of 0..1 and were clamped";
    assert_eq!(loaded.report.warnings, [clamped]);
    let loaded = read(&TEXT.replace("0.25 1 F", "nan 1 F").replace("1 0.5 0 T", "1 -1 0 T"));
    assert_eq!(loaded.scene.attributes.colors, Some([[255, 0, 0, 255], [255; 4]].into()));
    assert_eq!(loaded.report.skipped, []);
    assert_eq!(loaded.report.warnings[0], "1 colors are not a number; they are white");
    assert_eq!(loaded.report.warnings[1], clamped);
}

#[test]
fn scalars_of_one_name_are_one() {
    let loaded = read("1\nProperties=pos:R:3:a:R:1:a:R:1:a_x:R:1:a:R:3\n0 0 0 1 2 3 4 5 6\n");
    let scalars = &loaded.scene.attributes.scalars;
    let found: Vec<_> = scalars.iter().map(|s| (&*s.name, s.values[0])).collect();
    assert_eq!(found, [("a", 1.0), ("a_x", 3.0), ("a_y", 5.0), ("a_z", 6.0)]);
    let warnings = ["a", "a_x"].map(|name| format!("a second scalar {name} is left out"));
    assert_eq!(loaded.report.warnings[..2], warnings);
}

#[test]
fn bad_values_are_counted() {
    let text = TEXT.replace("0.25 0 0.25 1 F", "-1 0 0.25 1 F");
    assert_eq!(read(&text).report.skipped[0].problem, Problem::Radius);
    for (from, to) in [(" F\n", " maybe\n"), (".4 ", ".4.4 ")] {
        let loaded = read(&TEXT.replace(from, to));
        assert_eq!(loaded.report.skipped[0].problem, Problem::Number, "{to}");
    }
    let loaded = read(&TEXT.replace(" F\n", "\n"));
    assert_eq!(loaded.report.skipped[0].problem, Problem::Columns);
}

#[test]
fn a_word_like_lattice_is_a_warning() {
    let loaded = read("1\nsilicon, lattice=5.43\nSi 0 0 0\n");
    let warning = "line 2: Lattice must have nine numbers, not 1";
    assert_eq!((xs(&loaded), loaded.report.warnings), (vec![0.0], vec![warning.to_owned()]));
}

#[test]
fn a_wrong_header_is_an_error() {
    let error = fail(&TEXT.replace("0 0 9\"", "0 0\""));
    assert_eq!(error, "a.xyz, line 2: Lattice must have nine numbers, not 8");
    let later = format!("{TEXT}1\nProperties=pos:Q:3\nC 0 0 0\n");
    assert_eq!(xs(&read(&later)), [1.0, 4.0]);
}
