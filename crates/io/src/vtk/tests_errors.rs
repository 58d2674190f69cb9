//! What is odd or wrong in VTK files, and real ones.

use crate::{Error, ReadOptions, options::Loaded};

fn read(text: &str) -> Result<Loaded, Error> {
    ReadOptions::default().radius(0.1).read_bytes("a.vtk", text.as_bytes())
}

const HEAD: &str = "# vtk DataFile Version 2.0\n\nASCII\nDATASET POLYDATA\n";

#[test]
fn odd_texts_are_read() {
    // All on one line, values without their table, strings, and numbers as some libraries write.
    let text = format!(
        "{HEAD}points 2 float 0 1 2 3 4 5 point_data 2 scalars s float\n6 -nan(ind) \
         field f 2\nnames 1 2 string\nfirst name\n\nlast 1 2 bit 1 0 normals n float 0 0 1 \
         1.#QNAN 0 1"
    );
    let loaded = read(&text).unwrap();
    assert_eq!(loaded.scene.records.len(), 2);
    let values = |name| loaded.scene.scalar(name).unwrap().values.to_vec();
    assert!(values("s")[0] == 6.0 && values("s")[1].is_nan());
    assert_eq!(values("last"), [1.0, 0.0]);
    assert!(values("n_x")[1].is_nan());
    assert_eq!(loaded.report.warnings, ["the array names of 1 x 2 values is left out"]);
}

#[test]
fn binary_texts_and_bits_are_passed_over() {
    let mut file = HEAD.replace("ASCII", "BINARY").into_bytes();
    file.extend(b"POINTS 9 char\n");
    file.extend([1; 27]);
    file.extend(b"POINT_DATA 9\nFIELD f 3\nnames 1 9 string\n");
    // Lengths of one, two, four and eight bytes.
    file.extend([0xc0 | 2, b'a', b'b', 0x80, 3, b'c', b'd', b'e', 0x40, 0, 0, 1, b'f']);
    file.extend([0, 0, 0, 0, 0, 0, 0, 1, b'g']);
    file.extend([0xc0; 5]);
    file.extend(b"\nbits 1 9 bit\n");
    file.extend([0b1010_0000, 0b1000_0000]);
    file.extend(b"last 1 9 char\n");
    file.extend([5; 9]);
    let loaded = ReadOptions::default().radius(1.0).read_bytes("a.vtk", &file).unwrap();
    let values = |name| loaded.scene.scalar(name).unwrap().values.to_vec();
    assert_eq!(values("bits"), [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(values("last"), [5.0; 9]);
}

#[test]
fn what_is_wrong_is_told() {
    let first = "line 1: the first line must be # vtk DataFile Version 1.0 to 5.1";
    for (text, expected) in [
        ("# vtk DataFile Version 6.0\n", format!("{first}, not \"# vtk DataFile Version 6.0\"")),
        ("# vtk DataFile Version x\n", format!("{first}, not \"# vtk DataFile Version x\"")),
        ("# vtk DataFile Version 3.0", "line 2: the file ends before the title".into()),
        (
            "# vtk DataFile Version 3.0\nt\nHTML\n",
            "line 3: the third line must be ASCII or BINARY, not \"HTML\"".into(),
        ),
        (
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n",
            "line 4: the dataset must be one that has points to draw: POLYDATA, \
             UNSTRUCTURED_GRID, STRUCTURED_GRID, not \"STRUCTURED_POINTS\""
                .into(),
        ),
    ] {
        assert_eq!(read(text).unwrap_err().to_string(), format!("a.vtk, {expected}"));
    }
    let one = "POINTS 1 float\n1 2 3\n";
    for (text, expected) in [
        ("", "line 4: the file must have a dataset with POINTS, not one without"),
        ("POINTS many float", "line 5: the number of points must be a whole number, not \"many\""),
        ("POINTS 1 real 1", "line 5: the type of values must be a known one, not \"real\""),
        (
            "POINTS 2 float\n0 0 0\n1 1 PI\n",
            "line 7: the values of POINTS must be numbers, not \"PI\"",
        ),
        (
            "POINTS 6000000000000000000 float\n0 0 0",
            "line 5: the file ends in POINTS: 18446744073709551615 bytes are needed, 6 are left",
        ),
        (
            "POINTS 2 float\n100 100 100 1\n",
            "line 6: the file ends before the last values of POINTS",
        ),
        (&format!("{one}{one}"), "line 7: a file must have its points once, not \"POINTS\""),
        ("POINT_DATA 2", "line 5: the points with data must be the 0 points, not \"2\""),
        (
            &format!("{one}POINT_DATA 2"),
            "line 7: the points with data must be the 1 points, not \"2\"",
        ),
        (
            &format!("{one}POINT_DATA 1\nSCALARS a float 1.5\n"),
            "line 8: the width of scalars must be a whole number, not \"1.5\"",
        ),
        (
            &format!("{one}POINT_DATA 1\nSOMETHING a float\n"),
            "line 8: there must be a keyword of this part of the format, not \"SOMETHING\"",
        ),
        (
            &format!("{one}SCALARS a float\n"),
            "line 7: there must be a keyword of this part of the format, not \"SCALARS\"",
        ),
        (
            &format!("{one}CELLS 1 2\nOFFSETS int\n0\nCELL_TYPES"),
            "line 10: after OFFSETS there must be CONNECTIVITY, not \"CELL_TYPES\"",
        ),
    ] {
        let error = read(&format!("{HEAD}{text}")).unwrap_err().to_string();
        assert_eq!(error, format!("a.vtk, {expected}"));
    }
}

#[test]
fn what_is_wrong_in_binary_is_told_by_byte() {
    let head = HEAD.replace("ASCII", "BINARY");
    let at = |offset: usize| head.len() + offset;
    for (text, expected) in [
        (
            "POINTS 2 float\nabcdefghijkl",
            format!("byte {}: the file ends in POINTS: 24 bytes are needed, 12 are left", at(15)),
        ),
        (
            "POINTS 1 float\nabcdefghijkl\nCELLS 4 1\nabc",
            format!("byte {}: the file ends in CELLS: 4 bytes are needed, 3 are left", at(38)),
        ),
        (
            "POINTS 1 float\nabcdefghijkl\nPOINT_DATA 1\nSCALARS a float\n0000",
            format!(
                "byte {}: behind SCALARS there must be LOOKUP_TABLE, not \"0000\"",
                at(28 + 13 + 16)
            ),
        ),
    ] {
        let error = read(&format!("{head}{text}")).unwrap_err().to_string();
        assert_eq!(error, format!("a.vtk, {expected}"));
    }
    let error = ReadOptions::default().frame(1).read_bytes("a.vtk", head.as_bytes()).unwrap_err();
    let text = "a.vtk: there is no frame 1: the file has 1, counted from 0";
    assert_eq!(error.to_string(), text);
}

#[test]
fn columns_without_end_are_refused() {
    let head = format!("{HEAD}POINTS 1 float\n1 2 3\nPOINT_DATA 1\nFIELD f 60000\n");
    let arrays: String = (0..60_000).map(|i| format!("a{i} 1 1 float\n1\n")).collect();
    let error = read(&format!("{head}{arrays}")).unwrap_err().to_string();
    // The first array is announced on line 9, the one too many 4096 arrays of two lines later.
    assert_eq!(error, "a.vtk, line 8201: there must be at most 4096 columns, not 4097");
    let wide: String = (0..500).map(|i| format!("a{i} 9 1 float\n1 2 3 4 5 6 7 8 9\n")).collect();
    let error = read(&format!("{head}{wide}")).unwrap_err().to_string();
    assert!(error.ends_with("there must be at most 4096 columns, not 4104"), "{error}");
    let few: String = (0..4096).map(|i| format!("a{i} 1 1 float\n1\n")).collect();
    let loaded = read(&format!("{}{few}", head.replace("60000", "4096"))).unwrap();
    assert_eq!(loaded.scene.attributes.scalars.len(), 4096);
}

#[test]
fn the_fluid_is_read() {
    let Some(folder) = std::env::var_os("PUNCTA_DATA") else {
        eprintln!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let path = std::path::Path::new(&folder).join("sph_hilbert_18856.vtk");
    let loaded = ReadOptions::default().read(path).unwrap();
    assert_eq!(loaded.scene.records.len(), 18_856);
    let mut ids = loaded.scene.scalar("id").unwrap().values.to_vec();
    ids.sort_by(f32::total_cmp);
    let expected: Vec<f32> = (0..18_856_u16).map(f32::from).collect();
    assert_eq!(ids, expected);
}
