//! Files of both kinds, made from the same parts.

use crate::{Error, Format, Place, Problem, ReadOptions, Scalars, options::Loaded};
use glam::DVec3;

/// A piece of a file: a line, or values of a type.
#[derive(Clone, Copy)]
enum Part<'a> {
    Line(&'a str),
    Values(&'a str, &'a [f64]),
}
use Part::{Line, Values};

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    /// As text, on lines that end in `\n`.
    Text,
    /// As text with all words on lines of their own, which end in `\r\n`.
    Words,
    Binary,
    /// Binary, without an end of line behind values, and with `\r\n` behind lines.
    Packed,
}

const FORMS: [Form; 4] = [Form::Text, Form::Words, Form::Binary, Form::Packed];

#[expect(clippy::cast_possible_truncation, reason = "the values are those of the type")]
#[expect(clippy::cast_sign_loss, reason = "the values are those of the type")]
fn big_endian(kind: &str, value: f64) -> Vec<u8> {
    match kind {
        "char" => (value as i8).to_be_bytes().to_vec(),
        "unsigned_char" => (value as u8).to_be_bytes().to_vec(),
        "short" => (value as i16).to_be_bytes().to_vec(),
        "unsigned_short" => (value as u16).to_be_bytes().to_vec(),
        "int" | "vtkIdType" => (value as i32).to_be_bytes().to_vec(),
        "unsigned_int" => (value as u32).to_be_bytes().to_vec(),
        "long" | "vtktypeint64" => (value as i64).to_be_bytes().to_vec(),
        "unsigned_long" => (value as u64).to_be_bytes().to_vec(),
        "float" => (value as f32).to_be_bytes().to_vec(),
        "double" => value.to_be_bytes().to_vec(),
        // A color: a number from 0 to 1 in a text.
        "color" => vec![(value * 255.0).round() as u8],
        _ => panic!("{kind}"),
    }
}

fn file(form: Form, version: &str, parts: &[Part<'_>]) -> Vec<u8> {
    let is_text = matches!(form, Form::Text | Form::Words);
    let kind = if is_text { "ASCII" } else { "BINARY" };
    let end = if matches!(form, Form::Words | Form::Packed) { "\r\n" } else { "\n" };
    let mut file = format!("# vtk DataFile Version {version}{end}a title{end}{kind}{end}");
    file.push_str("DATASET ");
    let mut file = file.into_bytes();
    for part in parts {
        match part {
            Line(line) => file.extend(format!("{line}{end}").bytes()),
            Values(_, values) if is_text => {
                let gap = if form == Form::Words { end } else { " " };
                let words: Vec<String> = values.iter().map(ToString::to_string).collect();
                file.extend(format!("{}{end}", words.join(gap)).bytes());
            }
            Values(kind, values) => {
                file.extend(values.iter().flat_map(|&value| big_endian(kind, value)));
                if form == Form::Binary {
                    file.push(b'\n');
                }
            }
        }
    }
    file
}

fn read(bytes: &[u8]) -> Result<Loaded, Error> {
    ReadOptions::default().radius(0.1).read_bytes("a.vtk", bytes)
}

fn scalar(loaded: &Loaded, name: &str) -> Vec<f32> {
    let scalar = loaded.scene.scalar(name);
    scalar.unwrap_or_else(|| panic!("no scalar {name}")).values.to_vec()
}

const CORNERS: [f64; 9] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 90.0];

#[test]
fn points_of_all_types_are_read() {
    let kinds = [
        "char",
        "unsigned_char",
        "short",
        "unsigned_short",
        "int",
        "vtkIdType",
        "unsigned_int",
        "long",
        "vtktypeint64",
        "unsigned_long",
        "float",
        "double",
    ];
    for form in FORMS {
        for kind in kinds {
            for dataset in ["POLYDATA", "UNSTRUCTURED_GRID", "structured_grid"] {
                let points = format!("POINTS 3 {kind}");
                let parts = [Line(dataset), Line(&points), Values(kind, &CORNERS)];
                let loaded = read(&file(form, "3.0", &parts)).unwrap();
                assert_eq!(loaded.format, Format::Vtk);
                let positions: Vec<DVec3> = (0..3).map(|i| loaded.scene.position(i)).collect();
                let expected = CORNERS.chunks(3).map(DVec3::from_slice).collect::<Vec<_>>();
                assert_eq!(positions, expected, "{form:?} {kind}");
            }
        }
    }
}

/// Three points with data of all kinds.
fn rich() -> Vec<Part<'static>> {
    vec![
        Line("POLYDATA"),
        Line("FIELD FieldData 2"),
        Line("TIME 1 1 double"),
        Values("double", &[0.5]),
        Line("NULL_ARRAY"),
        Line("POINTS 3 float"),
        Values("float", &CORNERS),
        Line("METADATA"),
        Line("INFORMATION 1"),
        Line("NAME L2_NORM_RANGE LOCATION vtkDataArray"),
        Line("DATA 2 1 90"),
        Line(""),
        Line("VERTICES 3 6"),
        Values("int", &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0]),
        Line("LINES 1 4"),
        Values("int", &[3.0, 0.0, 1.0, 2.0]),
        Line("CELL_DATA 4"),
        Line("SCALARS cell_number int"),
        Line("LOOKUP_TABLE own"),
        Values("int", &[1.0, 2.0, 3.0, 4.0]),
        Line("LOOKUP_TABLE own 1"),
        Values("color", &[1.0, 0.0, 1.0, 0.0]),
        Line("NORMALS cell_normals float"),
        Values("float", &[0.0; 12]),
        Line("POINT_DATA 3"),
        Line("SCALARS mass double 1"),
        Line("LOOKUP_TABLE default"),
        Values("double", &[10.0, 20.0, 30.0]),
        Line("COLOR_SCALARS paint 4"),
        Values("color", &[1.0, 0.0, 0.2, 1.0, 0.0, 1.0, 0.0, 0.4, 0.6, 0.6, 0.6, 0.0]),
        Line("VECTORS velocity float"),
        Values("float", &[3.0, 4.0, 0.0, 0.0, 0.0, 2.0, 2.0, 3.0, 6.0]),
        Line("NORMALS normals double"),
        Values("double", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0]),
        Line("TENSORS stress float"),
        Values("float", &[1.5; 27]),
        Line("TEXTURE_COORDINATES uv 2 float"),
        Values("float", &[0.0, 0.25, 0.5, 0.75, 1.0, 1.25]),
        Line("GLOBAL_IDS ids vtkIdType"),
        Values("int", &[7.0, 8.0, 16_777_217.0]),
        Line("FIELD more 4"),
        Line("a%20b 1 3 short"),
        Values("short", &[-1.0, 0.0, 1.0]),
        Line("METADATA"),
        Line("COMPONENT_NAMES"),
        Line("a"),
        Line(""),
        Line("wrong 1 2 float"),
        Values("float", &[1.0, 2.0]),
        Line("wide 10 3 char"),
        Values("char", &[1.0; 30]),
        Line("radius 1 3 float"),
        Values("float", &[0.25, 0.5, 0.75]),
    ]
}

#[test]
fn data_of_points_become_columns() {
    for form in FORMS {
        let bytes = file(form, "4.2", &rich());
        let loaded = ReadOptions::default().read_bytes("rich.vtk", &bytes).unwrap();
        loaded.scene.validate().unwrap();
        let radii: Vec<f32> = loaded.scene.records.iter().map(|r| r.radius).collect();
        assert_eq!(radii, [0.25, 0.5, 0.75], "{form:?}");
        assert_eq!(scalar(&loaded, "mass"), [10.0, 20.0, 30.0]);
        assert_eq!(scalar(&loaded, "velocity_x"), [3.0, 0.0, 2.0]);
        assert_eq!(scalar(&loaded, "velocity_z"), [0.0, 2.0, 6.0]);
        assert_eq!(scalar(&loaded, "velocity"), [5.0, 2.0, 7.0]);
        assert_eq!(scalar(&loaded, "normals_z"), [0.0, 0.0, -1.0]);
        assert_eq!(scalar(&loaded, "uv_1"), [0.25, 0.75, 1.25]);
        assert_eq!(scalar(&loaded, "a b"), [-1.0, 0.0, 1.0]);
        let colors = [[255, 0, 51, 255], [0, 255, 0, 102], [153, 153, 153, 0]];
        assert_eq!(loaded.scene.attributes.colors, Some(colors.to_vec().into()));
        let warnings = [
            "the integers of ids are rounded to 24 bits",
            "the array wrong of 1 x 2 values is left out",
            "the array wide of 10 x 3 values is left out",
        ];
        assert_eq!(loaded.report.warnings, warnings);
        let names: Vec<_> = loaded.scene.attributes.scalars.iter().map(|s| &*s.name).collect();
        let expected = [
            "mass",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "velocity",
            "normals_x",
            "normals_y",
            "normals_z",
            "uv_0",
            "uv_1",
            "ids",
            "a b",
        ];
        assert_eq!(names, expected);
        let options = ReadOptions::default().scalars(Scalars::Named(vec!["velocity".into()]));
        let loaded = options.radius(3.0).read_bytes("rich.vtk", &bytes).unwrap();
        assert_eq!(loaded.scene.attributes.scalars.len(), 1);
        assert_eq!(scalar(&loaded, "velocity"), [5.0, 2.0, 7.0]);
        assert_eq!(loaded.scene.records[1].radius, 3.0);
    }
}

#[test]
fn cells_since_version_5_are_passed_over() {
    for form in FORMS {
        let parts = [
            Line("UNSTRUCTURED_GRID"),
            Line("POINTS 3 double"),
            Values("double", &CORNERS),
            Line("CELLS 3 3"),
            Line("OFFSETS vtktypeint64"),
            Values("vtktypeint64", &[0.0, 1.0, 3.0]),
            Line("CONNECTIVITY vtktypeint64"),
            Values("vtktypeint64", &[0.0, 1.0, 2.0]),
            Line("CELL_TYPES 2"),
            Values("int", &[1.0, 3.0]),
            Line("POLYGONS 0 0"),
            Line("POINT_DATA 3"),
            Line("FIELD FieldData 1"),
            Line("pressure 1 3 unsigned_char"),
            Values("unsigned_char", &[1.0, 2.0, 3.0]),
        ];
        let loaded = read(&file(form, "5.1", &parts)).unwrap();
        assert_eq!(scalar(&loaded, "pressure"), [1.0, 2.0, 3.0], "{form:?}");
    }
}

#[test]
fn bytes_in_tuples_of_three_are_colors() {
    for form in FORMS {
        let parts = [
            Line("STRUCTURED_GRID"),
            Line("DIMENSIONS 3 1 1"),
            Line("POINTS 3 int"),
            Values("int", &CORNERS),
            Line("POINT_DATA 3"),
            Line("FIELD FieldData 1"),
            Line("RGB 3 3 unsigned_char"),
            Values("unsigned_char", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 255.0]),
        ];
        let loaded = read(&file(form, "4.0", &parts)).unwrap();
        let colors = [[1, 2, 3, 255], [4, 5, 6, 255], [7, 8, 255, 255]];
        assert_eq!(loaded.scene.attributes.colors, Some(colors.to_vec().into()));
        assert!(loaded.scene.attributes.scalars.is_empty());
    }
}

#[test]
fn colors_that_are_none_are_told() {
    let parts = [
        Line("POLYDATA"),
        Line("POINTS 3 int"),
        Values("int", &CORNERS),
        Line("POINT_DATA 3"),
        Line("COLOR_SCALARS rgb 3"),
        Values("float", &[f64::NAN, 1.0, 1.0, 2.0, 0.5, -1.0, 0.0, 1.0, 0.2]),
    ];
    let loaded = read(&file(Form::Text, "4.0", &parts)).unwrap();
    let colors = [[255; 4], [255, 128, 0, 255], [0, 255, 51, 255]];
    assert_eq!(loaded.scene.attributes.colors, Some(colors.to_vec().into()));
    let warnings = [
        "1 colors are not a number; they are white",
        "1 colors lie outside of 0..1 and were clamped",
    ];
    assert_eq!(loaded.report.warnings[..2], warnings);
}

#[test]
fn rows_that_cannot_be_used_leave_all_columns() {
    let nan = f64::NAN;
    for form in FORMS {
        let positions = [0.0, 0.0, 0.0, nan, 1.0, 1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0];
        let parts = [
            Line("POLYDATA"),
            Line("POINTS 4 float"),
            Values("float", &positions),
            Line("POINT_DATA 4"),
            Line("SCALARS before float 1"),
            Line("LOOKUP_TABLE default"),
            Values("float", &[0.0, 1.0, 2.0, 3.0]),
            Line("SCALARS radius float 1"),
            Line("LOOKUP_TABLE default"),
            Values("float", &[1.0, 1.0, -2.0, 4.0]),
            Line("SCALARS after float 1"),
            Line("LOOKUP_TABLE default"),
            Values("float", &[0.0, 1.0, 2.0, 3.0]),
        ];
        let bytes = file(form, "1.0", &parts);
        let loaded = ReadOptions::default().read_bytes("a.vtk", &bytes).unwrap();
        loaded.scene.validate().unwrap();
        assert_eq!(loaded.scene.attributes.ids, Some([0, 3].into()));
        assert_eq!(scalar(&loaded, "before"), [0.0, 3.0]);
        assert_eq!(scalar(&loaded, "after"), [0.0, 3.0]);
        let problems: Vec<Problem> = loaded.report.skipped.iter().map(|s| s.problem).collect();
        assert_eq!(problems, [Problem::Position, Problem::Radius]);
        if form == Form::Text {
            assert_eq!(loaded.report.skipped[0].first, Place::Line(6));
        }
        if form == Form::Binary {
            let start = "# vtk DataFile Version 1.0\na title\nBINARY\nDATASET POLYDATA\n\
                         POINTS 4 float\n";
            assert_eq!(loaded.report.skipped[0].first, Place::Byte(start.len() as u64 + 12));
        }
        let error = ReadOptions::default().strict(true).read_bytes("a.vtk", &bytes).unwrap_err();
        let text = error.to_string();
        assert!(text.ends_with("a position that cannot be stored: (NaN, 1, 1)"), "{text}");
    }
}
