//! The examples `map` and `trajectories` as those meet them who have files: what is read, what is told
//! of it, and errors.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "glyphs/tools.rs"]
mod tools;

use tools::Tools;

/// A TrackVis file of these tracks, and what its header says of their number.
fn trk(tracks: &[&[[f32; 3]]], count: i32) -> Vec<u8> {
    let mut bytes = vec![0; 1000];
    bytes[..5].copy_from_slice(b"TRACK");
    // One scalar for each point, and one property of a track.
    bytes[36] = 1;
    bytes[238] = 1;
    bytes[988..992].copy_from_slice(&count.to_le_bytes());
    bytes[996..1000].copy_from_slice(&1000_i32.to_le_bytes());
    for track in tracks {
        bytes.extend(i32::try_from(track.len()).unwrap().to_le_bytes());
        for point in *track {
            bytes.extend(point.iter().chain(&[0.5]).flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend(7.0_f32.to_le_bytes());
    }
    bytes
}

const TRACKS: [&[[f32; 3]]; 2] = [
    &[[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [2.0, 0.5, 1.0], [3.0, 0.0, 1.0]],
    &[[0.0, 2.0, 0.0], [2.0, 2.0, 2.0]],
];

/// A square with corners `from` and `from + side`, in degrees.
fn square(from: f64, side: f64) -> String {
    let to = from + side;
    format!("[[{from},{from}],[{to},{from}],[{to},{to}],[{from},{to}],[{from},{from}]]")
}

/// A feature with these properties.
fn feature(kind: &str, coordinates: &str, properties: &str) -> String {
    format!(
        r#"{{"type":"Feature","properties":{properties},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}"#
    )
}

fn collection(features: &[String]) -> String {
    format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","))
}

#[test]
fn maps_are_read_and_what_is_no_polygon_is_told() {
    let tools = Tools::new();
    let house = format!("[{},{}]", square(0.0, 0.01), square(0.003, 0.002));
    let two = format!("[[{}],[{}]]", square(0.02, 0.005), square(0.03, 0.005));
    let features = [
        feature("Polygon", &house, r#"{"height":120}"#),
        feature("MultiPolygon", &two, r#"{"building:levels":"7"}"#),
        feature("Polygon", &format!("[{}]", square(0.04, 0.004)), "null"),
        feature("Point", "[1,2]", "null"),
        feature("LineString", "[[1,2],[3,4]]", "{}"),
        feature("Polygon", "[[[0,0],[1,1],[0,0]]]", "{}"),
        feature("Polygon", &format!("[{}]", square(89.0, 2.0)), "{}"),
        feature("Polygon", "[[[0,0],[0.01,0.01],[0.01,0],[0,0.02],[0,0]]]", "{}"),
    ];
    tools.write("town.geojson", collection(&features));
    let (_, said, noted) = tools.draw("map", &["town.geojson"]);
    assert!(said.contains("the highest is 120.0 m"), "{said}");
    // Four polygons and the ground.
    assert!(said.contains("5 polygons with 24 corners"), "{said}");
    for note in [
        "1 points left out",
        "1 lines left out",
        "1 polygons left out: they have less than 3 corners",
        "1 polygons left out: a position is no longitude and latitude",
        "2 polygons have no height",
        "its rings cross",
    ] {
        assert!(noted.contains(note), "{note}: {noted}");
    }
    tools.draw("map", &["town.geojson", "--height", "height", "--stretch", "2"]);
    let other = tools.draw("map", &["--seed", "2"]).0;
    assert!(other != tools.draw("map", &["--seed", "3"]).0);
}

#[test]
fn maps_that_are_none_are_errors() {
    let tools = Tools::new();
    tools.write("broken.geojson", r#"{"type":"FeatureCollection","features":[{"#);
    tools.write("binary.geojson", [0xff, 0xfe, 0, 1]);
    tools.write("empty.geojson", "");
    tools.write("other.geojson", r#"{"type":"Elephant"}"#);
    tools.write("points.geojson", collection(&[feature("Point", "[1,2]", "null")]));
    tools.write("text.geojson", collection(&[feature("Polygon", r#"[["a"]]"#, "null")]));
    let house = feature("Polygon", &format!("[{}]", square(0.0, 1.0)), r#"{"height":1}"#);
    tools.write("house.geojson", collection(&[house]));
    for (file, more, named) in [
        ("missing.geojson", &[][..], "No such file"),
        ("broken.geojson", &[], "line 1"),
        ("binary.geojson", &[], "utf-8"),
        ("empty.geojson", &[], "EOF"),
        ("other.geojson", &[], "Elephant"),
        ("points.geojson", &[], "1 points left out"),
        ("text.geojson", &[], "line 1"),
        ("house.geojson", &["--height", "floors"], "floors"),
    ] {
        let said = tools.fail("map", &[&[file], more].concat());
        assert!(said.contains(file) && said.contains(named), "{said}");
    }
    for (more, named) in [(["--stretch", "0"], "--stretch 0"), (["--colormap", "sky"], "viridis")] {
        let said = tools.fail("map", &[&["house.geojson"], &more[..]].concat());
        assert!(said.contains(named), "{said}");
    }
}

#[test]
fn tracks_are_read_in_both_orders_of_bytes() {
    let tools = Tools::new();
    tools.write("two.trk", trk(&TRACKS, 2));
    tools.write("unknown.trk", trk(&TRACKS, 0));
    let little = trk(&TRACKS, 2);
    let mut big = little.clone();
    for at in [36, 238] {
        big[at..at + 2].reverse();
    }
    for at in [988, 996].into_iter().chain((1000..little.len()).step_by(4)) {
        big[at..at + 4].reverse();
    }
    tools.write("big.trk", big);
    let (two, said, noted) = tools.draw("trajectories", &["two.trk"]);
    assert!(said.contains("two.trk: 2 trajectories, 6 points"), "{said}");
    assert!(noted.is_empty(), "{noted}");
    assert!(two == tools.draw("trajectories", &["unknown.trk"]).0);
    assert!(two == tools.draw("trajectories", &["big.trk"]).0);
    for draw in ["lines", "spheres", "auto"] {
        tools.draw("trajectories", &["two.trk", "--draw", draw, "--color", "id"]);
    }
    assert!(two != tools.draw("trajectories", &["two.trk", "--select", "1"]).0);
    let nan = [[0.0, f32::NAN, 0.0], [0.0; 3], [1.0; 3]];
    tools.write("odd.trk", [trk(&[&nan, &[]], 2), vec![1, 2, 3]].concat());
    let (_, said, noted) = tools.draw("trajectories", &["odd.trk"]);
    assert!(said.contains("2 trajectories, 2 points"), "{said}");
    for note in ["1 tracks have no points", "1 points left out", "3 bytes after the last track"] {
        assert!(noted.contains(note), "{noted}");
    }
}

#[test]
fn tracks_that_are_none_are_errors_that_name_the_byte() {
    let tools = Tools::new();
    let whole = trk(&TRACKS, 2);
    let changed = |at: usize, word: i32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    for (name, bytes, named) in [
        ("empty", vec![], "byte 0"),
        ("short", whole[..500].to_vec(), "byte 500"),
        ("other", changed(0, 7), "no TrackVis file"),
        ("size", changed(996, 4711), "4711"),
        ("minus", changed(988, -3), "byte 988: -3 tracks"),
        ("many", trk(&TRACKS, 3), "byte 988: 3 tracks are promised, but the file ends after 2"),
        ("negative", changed(1000, -1), "byte 1000: a track of -1 points"),
        // Nothing is asked for that is not there.
        ("huge", changed(1000, i32::MAX), "track 0 at byte 1000, of 2147483647 points"),
        ("cut", whole[..1010].to_vec(), "track 0 at byte 1000, of 4 points"),
        ("scalars", changed(36, 0xffff), "byte 36: -1 scalars"),
        ("properties", whole[..whole.len() - 2].to_vec(), "properties"),
        ("none", trk(&[], 0), "no point"),
    ] {
        let file = format!("{name}.trk");
        tools.write(&file, bytes);
        let said = tools.fail("trajectories", &[&file]);
        assert!(said.contains(&file) && said.contains(named), "{said}");
    }
    assert!(tools.fail("trajectories", &["missing.trk"]).contains("missing.trk"));
    tools.write("two.trk", &whole);
    for (more, named) in [
        (["--select", "2"], "--select 2: there are 2"),
        (["--radius", "0"], "--radius 0"),
        (["--width", "NaN"], "--width NaN"),
        (["--colormap", "sky"], "viridis"),
        (["--adapter", "any"], "--backend gpu"),
    ] {
        let said = tools.fail("trajectories", &[&["two.trk"], &more[..]].concat());
        assert!(said.contains(named), "{said}");
    }
}
