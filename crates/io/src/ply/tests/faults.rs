//! What cannot be read, and what is said about it.

use super::*;
use crate::Problem;

const AXES: [&str; 3] = ["property float x", "property float y", "property float z"];

/// A text of these rows.
fn text(count: &str, rows: &str) -> Vec<u8> {
    let element = format!("element vertex {count}");
    join(&header("ascii", &[&element, AXES[0], AXES[1], AXES[2]]), rows.as_bytes())
}

/// Files, and what is wrong with them.
const WRONG: &[(&str, &str)] = &[
    ("plyx\n", r#"line 1: the first line must be "ply", not "plyx""#),
    (
        "ply\rformat ascii 1.0\r",
        r#"line 1: the first line must be "ply", not "ply\rformat ascii 1.0""#,
    ),
    (
        "ply\nformat ascii 1.0\nelement vertex 1\n",
        "line 4: the file ends before the line end_header",
    ),
    ("ply\nformat ascii 2.0\n", r#"line 2: the version must be 1.0, not "2.0""#),
    ("ply\nformat ascii\n", r#"line 2: the version must be 1.0, not """#),
    (
        "ply\nformat binary 1.0\n",
        "line 2: the format must be ascii, binary_little_endian or binary_big_endian, not \
         \"binary\"",
    ),
    (
        "ply\nformat ascii 1.0\nformat ascii 1.0\n",
        "line 3: a line of the header must be one format, or an element, property, comment, \
         obj_info or end_header, not \"format ascii 1.0\"",
    ),
    ("ply\nelement vertex 1\nend_header\n", "line 3: the header must have a format, not none"),
    (
        "ply\nelement vertex -1\n",
        r#"line 2: the number of an element must be a whole number, not "-1""#,
    ),
    (
        "ply\nelement vertex 18446744073709551616\n",
        r#"line 2: the number of an element must be a whole number, not "18446744073709551616""#,
    ),
    (
        "ply\nelement vertex 1 2\n",
        r#"line 2: the number of an element must be a whole number, not "1 2""#,
    ),
    ("ply\nelement\n", r#"line 2: the number of an element must be a whole number, not """#),
    (
        "ply\nelement a 1\n\nelement a 2\n",
        r#"line 4: each element must have a name of its own, not "a""#,
    ),
    (
        "ply\nproperty float x\n",
        r#"line 2: a property must follow the element it belongs to, not "property float x""#,
    ),
    (
        "ply\nelement a 1\nproperty float x\nproperty int x\n",
        r#"line 4: each property of an element must have a name of its own, not "x""#,
    ),
    (
        "ply\nelement a 1\nproperty half x\n",
        "line 3: the type must be char, uchar, short, ushort, int, uint, float, double, int8, \
         uint8, int16, uint16, int32, uint32, float32 or float64, not \"half\"",
    ),
    (
        "ply\nelement a 1\nproperty list float int x\n",
        r#"line 3: the length of a list must be of a type without fractions, not "float""#,
    ),
    ("ply\nelement a 1\nproperty float\n", r#"line 3: a name must have 1 to 1024 bytes, not """#),
    (
        "ply\nvertex 1\n",
        "line 2: a line of the header must be one format, or an element, property, comment, \
         obj_info or end_header, not \"vertex 1\"",
    ),
    (
        "ply\nformat ascii 1.0\nelement face 1\nelement edge 1\nend_header\n",
        "line 3: there must be an element vertex, not face, edge",
    ),
    ("ply\nformat ascii 1.0\nend_header\n", "line 1: there must be an element vertex, not none"),
    (
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty list int int y\n\
         property float z\nend_header\n",
        r#"line 3: vertex must have a number y, not "x z""#,
    ),
];

#[test]
fn headers_that_are_wrong_are_named() {
    for (text, fault_text) in WRONG {
        let options = ReadOptions::default().format(crate::Format::Ply);
        let error = options.read_bytes("a.ply", text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error, format!("a.ply, {fault_text}"));
    }
}

#[test]
fn headers_have_bounds() {
    let mut many = "ply\nelement vertex 1\n".to_owned();
    (0..4097).for_each(|i| many += &format!("property float p{i}\n"));
    let text = "a.ply, line 4098: elements and properties must be at most 4096, not 4097";
    assert_eq!(fault(many.as_bytes()), text);
    let long = format!("ply\nelement {} 1\n", "n".repeat(1025));
    assert!(fault(long.as_bytes()).starts_with("a.ply, line 2: a name must have 1 to 1024 bytes"));
    let endless = join(b"ply\ncomment ", &vec![b'c'; (1 << 20) + 1]);
    let text = "a.ply, line 2: a line must be shorter than 1048576 bytes, not longer";
    assert_eq!(fault(&endless), text);
}

#[test]
fn counts_are_not_believed() {
    let fault_of = |bytes: &[u8]| fault(bytes).split_once(": ").unwrap().1.to_owned();
    for (count, needed) in [("7", "41"), ("18446744073709551615", "18446744073709551614")] {
        let error = fault_of(&text(count, "0 0 0\n"));
        let wanted =
            format!("the file ends in the vertices: {needed} bytes are needed, 6 are left");
        assert_eq!(error, wanted);
    }
    let short = text("3", "0.001 0.001 0.001\n0 0 0\n\n");
    let wanted = "a.ply, line 11: the file ends before row 3 of the 3 of element vertex";
    assert_eq!(fault(&short), wanted);
    let huge = text("18446744073709551615", "0 0 0\n1 1 1\n");
    let error = ReadOptions::default().read_bytes("a.ply", &gzip(&huge)).unwrap_err();
    assert!(error.to_string().contains("before row 3 of the 18446744073709551615 of"));

    let lines = ["element vertex 18446744073709551615", AXES[0], AXES[1], AXES[2]];
    let binary = join(&header("binary_little_endian", &lines), &[0; 24]);
    let error = fault_of(&binary);
    let needed = u64::MAX;
    assert_eq!(
        error,
        format!("the file ends in the vertices: {needed} bytes are needed, 24 are left")
    );
    let error = ReadOptions::default().read_bytes("a.ply", &gzip(&binary)).unwrap_err();
    let text = "the file ends in the vertices: 65532 bytes are needed, 24 are left";
    assert!(error.to_string().ends_with(text), "{error}");
}

#[test]
fn elements_before_the_vertices_must_be_there() {
    let vertex = ["element vertex 1", AXES[0], AXES[1], AXES[2]];
    let before = |lines: &[&str], format: &str, bytes: &[u8]| {
        fault(&join(&header(format, &[lines, &vertex].concat()), bytes))
            .split_once(": ")
            .unwrap()
            .1
            .to_owned()
    };
    let edge = ["element edge 18446744073709551615", "property int a"];
    let needed = u64::MAX;
    let wanted = format!("the file ends in element edge: {needed} bytes are needed, 12 are left");
    assert_eq!(before(&edge, "binary_little_endian", &[0; 12]), wanted);
    let wanted = "the file ends before row 2 of the 18446744073709551615 of element edge";
    assert_eq!(before(&edge, "ascii", b"1\n"), wanted);
    let face = ["element face 1", "property list int double a"];
    let wanted = "the length of a list must not be negative, not -1";
    assert_eq!(before(&face, "binary_big_endian", &[255; 40]), wanted);
    let wanted = "the file ends in a list: 17179869176 bytes are needed, 36 are left";
    assert_eq!(before(&face, "binary_big_endian", &join(&[127, 255, 255, 255], &[0; 36])), wanted);
}

#[test]
fn rows_that_cannot_be_used_are_counted() {
    let bytes = text("7", "0 0 0\n1 0\n2 0 0 0\n3 x 0\n4 nan 0\n5 0 0\n6 0 1.2.3\n");
    let loaded = read(&bytes);
    assert_eq!(loaded.scene.attributes.ids, Some([0, 5].into()));
    let skipped: Vec<_> =
        loaded.report.skipped.iter().map(|s| (s.problem, s.count, &*s.value)).collect();
    let wanted = [
        (Problem::Columns, 2, r#""1 0""#),
        (Problem::Number, 2, r#""x""#),
        (Problem::Position, 1, "(4, NaN, 0)"),
    ];
    assert_eq!(skipped, wanted);
    let strict = ReadOptions::default().strict(true).read_bytes("a.ply", &bytes).unwrap_err();
    let wanted = r#"a.ply, line 9: a wrong number of columns: "1 0""#;
    assert_eq!(strict.to_string(), wanted);

    let lines = ["element vertex 1", AXES[0], AXES[1], AXES[2]];
    let nan = [f32::NAN, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let bytes = join(&header("binary_little_endian", &lines), &nan);
    let strict = ReadOptions::default().strict(true).read_bytes("a.ply", &bytes).unwrap_err();
    let byte = bytes.len() - 12;
    let wanted = format!("a.ply, byte {byte}: a position that cannot be stored: (NaN, 0, 0)");
    assert_eq!(strict.to_string(), wanted);
}

#[test]
fn lists_in_text_rows_must_be_lists() {
    let lines = ["element vertex 4", AXES[0], AXES[1], AXES[2], "property list uchar int l"];
    let rows = b"0 0 0 2 1 1\n0 0 0 -1\n0 0 0 3 1 1\n0 0 0 1.5 1\n";
    let loaded = read(&join(&header("ascii", &lines), rows));
    assert_eq!(loaded.scene.records.len(), 1);
    let skipped: Vec<_> = loaded.report.skipped.iter().map(|s| (s.problem, s.count)).collect();
    assert_eq!(skipped, [(Problem::Number, 2), (Problem::Columns, 1)]);
}

#[test]
fn what_follows_the_vertices_is_told() {
    let warnings = |bytes: &[u8]| {
        ReadOptions::default().radius(1.0).read_bytes("a.ply", bytes).unwrap().report.warnings
    };
    assert_eq!(warnings(&text("1", "0 0 0\n\n \n")), [""; 0]);
    let wanted = "from line 10 on, text after the last element is ignored";
    assert_eq!(warnings(&text("1", "0 0 0\n\n1 1 1\n")), [wanted]);
    let lines = ["element vertex 1", AXES[0], AXES[1], AXES[2]];
    let bytes = join(&header("binary_little_endian", &lines), &[0; 12]);
    assert_eq!(warnings(&bytes), [""; 0]);
    assert_eq!(warnings(&join(&bytes, &[0; 3])), ["3 bytes after the last element are ignored"]);
}

#[test]
fn cut_files_are_errors_wherever_they_are_cut() {
    let lines = ["element vertex 1", AXES[0], AXES[1], AXES[2]];
    let bytes = join(&header("binary_little_endian", &lines), &[0; 12]);
    for length in 0..bytes.len() {
        assert!(read_with(&ReadOptions::default(), &bytes[..length]).is_err(), "{length}");
    }
}
