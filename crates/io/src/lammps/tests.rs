//! Tests of the reader.

use crate::{Error, Format, Loaded, Problem, ReadOptions, Scalars};
use glam::DVec3;

fn load(options: &ReadOptions, text: &str) -> Result<Loaded, Error> {
    options.read_bytes("dump", text.as_bytes())
}

fn read(text: &str) -> Loaded {
    load(&ReadOptions::default(), text).unwrap()
}

fn fail(text: &str) -> String {
    load(&ReadOptions::default(), text).unwrap_err().to_string()
}

/// A frame in a straight box.
fn frame(rows: &[&str], columns: &str) -> String {
    in_box("pp pp pp", ["-1 9", "0 20", "5 6"], columns, rows)
}

fn in_box(kind: &str, bounds: [&str; 3], columns: &str, rows: &[&str]) -> String {
    let (count, bounds, rows) = (rows.len(), bounds.join("\n"), rows.join("\n"));
    format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS {kind}\n{bounds}\n\
         ITEM: ATOMS {columns}\n{rows}\n"
    )
}

fn positions(loaded: &Loaded) -> Vec<[f64; 3]> {
    let scene = &loaded.scene;
    (0..scene.records.len()).map(|index| scene.position(index).to_array()).collect()
}

fn scalar(loaded: &Loaded, name: &str) -> Vec<f32> {
    loaded.scene.scalar(name).unwrap().values.to_vec()
}

#[test]
fn atoms_are_ordered_by_id() {
    let loaded = read(&frame(&["3 1 1 2 3", "10 2 4 5 6", "1 1 7 8 9"], "id type x y z"));
    assert_eq!(loaded.format, Format::Lammps);
    assert_eq!(positions(&loaded), [[7.0, 8.0, 9.0], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(loaded.scene.attributes.ids, None);
    assert_eq!(scalar(&loaded, "id"), [1.0, 3.0, 10.0]);
    assert_eq!(scalar(&loaded, "type"), [1.0, 1.0, 2.0]);
    assert_eq!(loaded.scene.attributes.elements, None);
    assert!(loaded.report.warnings[0].starts_with("the file gives no radius"));
}

#[test]
fn ids_are_ranks_among_all_rows() {
    let rows = ["7 0 0 0", "5 1 nan 0", "9 2 0 0", "3 x 0 0", "1 4 0 0", "8", "z 6 0 0"];
    let options = ReadOptions::default().scalars(Scalars::Named(Vec::new()));
    let loaded = load(&options, &frame(&rows, "id x y z")).unwrap();
    // The ids in order are 1, 3, 5, 7, 8, 9 and the one that is none.
    assert_eq!(positions(&loaded), [[4.0, 0.0, 0.0], [0.0; 3], [2.0, 0.0, 0.0]]);
    assert_eq!(loaded.scene.attributes.ids, Some([0, 3, 5].into()));
    assert!(loaded.scene.attributes.scalars.is_empty());
    let found: Vec<_> =
        loaded.report.skipped.iter().map(|s| (s.problem, s.count, s.first.to_string())).collect();
    let expected = [
        (Problem::Position, 1, "line 11".to_owned()),
        (Problem::Number, 2, "line 13".to_owned()),
        (Problem::Columns, 1, "line 15".to_owned()),
    ];
    assert_eq!(found, expected);
}

#[test]
fn an_id_that_comes_twice_is_told() {
    let loaded = read(&frame(&["2 0 0 0", "1 1 0 0", "2 2 0 0"], "id x y z"));
    let xs: Vec<f64> = positions(&loaded).iter().map(|position| position[0]).collect();
    assert_eq!(xs, [1.0, 0.0, 2.0]);
    let warning = "1 atoms have the same id as another one before them; the first: 2";
    assert_eq!(loaded.report.warnings[1], warning);
}

#[test]
fn without_ids_the_order_is_that_of_the_file() {
    let loaded = read(&frame(&["2 0 0 1", "1 1 0 1"], "x y z radius"));
    assert_eq!(positions(&loaded), [[2.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    assert!(loaded.report.warnings.is_empty());
}

#[test]
fn columns_are_what_their_names_say() {
    let columns = "element mol z diameter y vx x c_1[2] label";
    let loaded = read(&frame(&["Fe 7 3 1.5 2 -0.1 1 1e-3 a", "O 8 6 1 5 0.2 4 2e-3 b"], columns));
    assert_eq!(positions(&loaded), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(loaded.scene.attributes.elements, Some([26, 8].into()));
    assert_eq!(loaded.scene.records[0].radius, 0.75);
    assert_eq!(scalar(&loaded, "c_1[2]"), [1e-3, 2e-3]);
    assert_eq!(scalar(&loaded, "vx"), [-0.1, 0.2]);
    let names: Vec<_> = loaded.scene.attributes.scalars.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["mol", "vx", "c_1[2]"]);
    let loaded = read(&frame(&["C 0 0 0"], "element x y z"));
    assert_eq!(loaded.scene.records[0].radius, 1.7);
}

#[test]
fn coordinates_have_an_order_of_preference() {
    for (columns, expected) in [
        ("xs x ys y zs z", [2.0, 4.0, 6.0]),
        ("xu x yu y zu zs", [1.0, 3.0, 5.0]),
        ("xs xsu ys ysu zs zsu", [9.0, 60.0, 10.0]),
        ("a xsu b ysu c zsu", [19.0, 80.0, 11.0]),
        ("a x b y c zs", [2.0, 4.0, 11.0]),
    ] {
        let loaded = read(&frame(&["1 2 3 4 5 6"], columns));
        assert_eq!(positions(&loaded), [expected], "{columns}");
    }
}

#[test]
fn fractions_of_a_tilted_box_are_positions() {
    // The box from (1, 2, 3) with the sides 10, 20, 30 and the tilts xy = -4, xz = 6, yz = -5:
    // in x, its corners lie between 1 - 4 and 11 + 6.
    let bounds = ["-3 17 -4", "-3 22 6", "3 33 -5"];
    let rows = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 1 1"];
    let expected = [
        [1.0, 2.0, 3.0],
        [11.0, 2.0, 3.0],
        [-3.0, 22.0, 3.0],
        [7.0, -3.0, 33.0],
        [13.0, 17.0, 33.0],
    ];
    for kind in ["xy xz yz pp pp pp", "", "pp pp ff"] {
        let loaded = read(&in_box(kind, bounds, "xs ys zs", &rows));
        assert_eq!(positions(&loaded), expected, "{kind}");
    }
    let vectors = ["10 0 0 1", "-4 20 0 2", "6 -5 30 3"];
    let loaded = read(&in_box("abc origin pp pp pp", vectors, "xsu ysu zsu", &rows));
    assert_eq!(positions(&loaded), expected);
    let error = fail(&in_box("xy xz yz pp pp pp", bounds, "x y zs", &rows));
    let text = "the coordinates in a tilted box must be scaled on all axes or on none";
    assert_eq!(error, format!("dump, line 9: {text}, not \"x y zs\""));
}

#[test]
fn frames_are_found_by_index() {
    let one = frame(&["1 0 0", "2 0 0"], "x y z");
    let two = frame(&["3 0 0", "4 0 0"], "y x z").replace("ITEM: TIMESTEP\n0\n", "");
    let units = "ITEM: UNITS\nlj\nITEM: TIME\n0.5\nITEM: WEATHER\nfine\n7 degrees\n";
    let text = format!("{units}{one}{units}{two}");
    let load = |frame| load(&ReadOptions::default().frame(frame), &text);
    assert_eq!(positions(&load(0).unwrap())[1], [2.0, 0.0, 0.0]);
    assert_eq!(positions(&load(1).unwrap())[1], [0.0, 4.0, 0.0]);
    assert!(load(1).unwrap().report.skipped.is_empty());
    let error = load(2).unwrap_err().to_string();
    assert_eq!(error, "dump: there is no frame 2: the file has 2, counted from 0");
}

#[test]
fn a_flat_frame_is_told() {
    let loaded = read(&frame(&["1 2 0.5", "3 4 0.5"], "x y radius"));
    assert_eq!(positions(&loaded), [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]);
    assert_eq!(loaded.report.warnings, ["the frame has no z: it lies at z = 0"]);
}

#[test]
fn a_frame_far_from_home_keeps_its_digits() {
    let loaded = read(&frame(&["1000000.25 2 3 1", "1000001.5 2 3 1"], "x y z radius"));
    assert_eq!(positions(&loaded)[0][0], 1_000_000.25);
    assert!(loaded.scene.origin != DVec3::ZERO);
}

#[test]
fn wrong_heads_are_told() {
    let good = frame(&["1 2 3", "4 5 6"], "x y z");
    let bounds = "the box bounds must be";
    let names = "the columns must have x, y and z, or xu, xs, xsu and their like";
    for (from, to, error) in [
        ("\n2\n", "\n-2\n", "line 4: the number of atoms must be a whole number, not \"-2\""),
        ("\n2\n", "\n3\n", "line 12: the frame must have 3 atoms, as it says, not 2"),
        (
            "\n2\n",
            "\n18446744073709551615\n",
            "line 12: the frame must have 18446744073709551615 atoms, as it says, not 2",
        ),
        (
            "OF ATOMS",
            "OF BONDS",
            "line 9: ITEM: NUMBER OF ATOMS must come before the atoms, not \"ITEM: ATOMS x y z\"",
        ),
        ("-1 9", "-1 a", &format!("line 6: {bounds} numbers, not \"a\"")),
        ("-1 9", "-1 nan", &format!("line 6: {bounds} numbers, not \"nan\"")),
        ("-1 9", "-1", &format!("line 6: {bounds} 2 numbers in each line, not \"-1\"")),
        ("0 20", "0 20 1", &format!("line 7: {bounds} 2 numbers in each line, not \"0 20 1\"")),
        (
            "BOUNDS pp",
            "BOUNDS abc",
            &format!("line 6: {bounds} 4 numbers in each line, not \"-1 9\""),
        ),
        ("x y z", "x yy z", &format!("line 9: {names}, not \"x yy z\"")),
        ("x y z", "", &format!("line 9: {names}, not \"\"")),
    ] {
        assert_eq!(fail(&good.replacen(from, to, 1)), format!("dump, {error}"), "{to}");
    }
    let scaled = "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS xs ys zs\n0 0 0\n";
    let error = "scaled coordinates must follow after ITEM: BOX BOUNDS, not \"xs ys zs\"";
    assert_eq!(fail(scaled), format!("dump, line 3: {error}"));
    let early = format!("{}{good}", good.replace("\n2\n", "\n4\n"));
    assert_eq!(fail(&early), "dump, line 12: the frame must have 4 atoms, as it says, not 2");
    assert_eq!(
        fail("ITEM: TIMESTEP\n"),
        "dump: there is no frame 0: the file has 0, counted from 0"
    );
    let cut = "ITEM: NUMBER OF ATOMS\n";
    let error = "line 2: the file ends before the number of atoms";
    assert_eq!(fail(cut), format!("dump, {error}"));
    let none = good.replacen("\n2\n", "\n0\n", 1);
    assert_eq!(fail(&none), "dump: there is nothing to draw: 0 records were skipped");
}

#[test]
fn rows_beyond_the_count_are_told() {
    let more = frame(&["1 2 3 1", "4 5 6 1"], "x y z radius").replacen("\n2\n", "\n1\n", 1);
    let loaded = read(&more);
    assert_eq!(positions(&loaded), [[1.0, 2.0, 3.0]]);
    let warning = "line 11, after the frame, was not read: it starts no item, \"4 5 6 1\"";
    assert_eq!(loaded.report.warnings, [warning]);
    let error = load(&ReadOptions::default().frame(1), &more).unwrap_err().to_string();
    let text = "line 11: a line that is not part of an item must start with ITEM:";
    assert_eq!(error, format!("dump, {text}, not \"4 5 6 1\""));
}

#[test]
fn strict_reading_names_the_line() {
    let options = ReadOptions::default().strict(true);
    let error = load(&options, &frame(&["1 2 3", "4 5"], "x y z")).unwrap_err().to_string();
    assert_eq!(error, "dump, line 11: a wrong number of columns: \"4 5\"");
}

#[test]
fn a_row_of_iodine_is_no_item() {
    let loaded = read(&frame(&["I 1 2 3", "ITE 1 2 4"], "element x y z").replace('\n', "\r\n"));
    assert_eq!(loaded.scene.attributes.elements, Some([53, 0].into()));
}
