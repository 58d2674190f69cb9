//! The examples that draw glyphs as their users meet them: pictures, notes, errors and exit codes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// Runs the tools in a folder of their own.
struct Tools {
    folder: TempDir,
}

/// A small picture with little light.
const SMALL: [&str; 8] =
    ["--size", "96x64", "--sky", "4", "--supersample", "1", "--out", "out.png"];

impl Tools {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn run(&self, tool: &str, arguments: &[&str]) -> Output {
        // Tests lie in `deps`, examples beside it.
        let deps = std::env::current_exe().unwrap();
        let profile = deps.parent().and_then(Path::parent).unwrap();
        let tool = profile.join("examples").join(tool);
        assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
        Command::new(tool).args(arguments).current_dir(self.folder.path()).output().unwrap()
    }

    /// Draws a small picture, which must succeed; its bytes, and what was said and noted.
    fn draw(&self, tool: &str, arguments: &[&str]) -> (Vec<u8>, String, String) {
        let output = self.run(tool, &[arguments, &SMALL].concat());
        let [said, noted] = [text(&output.stdout), text(&output.stderr)];
        assert!(output.status.success(), "{tool} {arguments:?}: {noted}");
        assert!(said.contains("records of") && said.contains("out.png"), "{said}");
        let bytes = fs::read(self.path("out.png")).unwrap();
        assert!(bytes.starts_with(b"\x89PNG"));
        (bytes, said, noted)
    }

    /// Runs a tool, which must fail as a tool should; returns what it says.
    fn fail(&self, tool: &str, arguments: &[&str]) -> String {
        let output = self.run(tool, &[arguments, &SMALL].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{tool} {arguments:?}: {said}");
        assert!(said.contains("error: ") && !said.contains("panicked"), "{said}");
        assert!(!self.path("out.png").exists(), "a picture was written all the same");
        said
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), content).unwrap();
    }

    /// A folder with some files.
    fn fill(&self, folder: &str) {
        for (name, lines) in [("a.rs", 1300), ("b.rs", 40), ("c", 7)] {
            self.write(&format!("{folder}/{name}"), "a line\n".repeat(lines));
        }
        self.write(&format!("{folder}/in/d.txt"), "a line that is much longer\n".repeat(150));
        self.write(&format!("{folder}/in/deep/er/e.TXT"), "one line\n");
        self.write(&format!("{folder}/in/picture.bin"), [10, 0, 10, 0, 10]);
        self.write(&format!("{folder}/empty.rs"), "");
        self.write(&format!("{folder}/.hidden"), "not seen");
        self.write(&format!("{folder}/target/f.rs"), "nor this");
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

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
fn each_tool_draws_the_same_picture_with_any_number_of_threads() {
    let tools = Tools::new();
    tools.fill("project");
    for (tool, arguments) in [
        ("blocks", &["--cells", "24"][..]),
        ("city", &["project"]),
        ("sunburst", &["project"]),
        ("map", &[]),
        ("trajectories", &["--count", "9", "--points", "60"]),
    ] {
        let draw = |threads: &str| tools.draw(tool, &[arguments, &["--threads", threads]].concat());
        let (one, said, _) = draw("1");
        assert!(one == draw("3").0, "{tool}: another picture");
        assert!(said.contains("build") && said.contains("light"), "{said}");
        let headlight = tools.run(tool, &[arguments, &["--size", "40x30", "--sky", "0"]].concat());
        assert!(headlight.status.success(), "{}", text(&headlight.stderr));
        assert!(headlight.stderr.is_empty() || tool == "city" || tool == "sunburst");
        assert!(tools.path(&format!("{tool}.png")).exists(), "{tool}: no picture of its name");
    }
}

#[test]
fn views_can_be_chosen_and_must_be_views() {
    let tools = Tools::new();
    let blocks = ["--cells", "12"];
    let draw = |more: &[&str]| tools.draw("blocks", &[&blocks, more].concat()).0;
    let usual = draw(&[]);
    assert!(usual != draw(&["--eye", "-30,-20,40"]));
    assert!(usual != draw(&["--target", "0,0,0", "--fov", "50"]));
    // Straight from above, z cannot be up.
    draw(&["--eye", "6,6,60", "--target", "6,6,0"]);
    fs::remove_file(tools.path("out.png")).unwrap();
    for (more, named) in [
        (["--eye", "6,6,6", "--target", "6,6,6"], "--eye"),
        (["--fov", "180", "--seed", "1"], "180 degrees"),
    ] {
        let said = tools.fail("blocks", &[&blocks[..], &more].concat());
        assert!(said.contains(named), "{said}");
    }
    let said = tools.run("blocks", &["--cells", "8", "--size", "9000x9", "--out", "out.png"]);
    assert!(text(&said.stderr).contains("--supersample"), "{}", text(&said.stderr));
}

#[test]
fn hidden_blocks_change_nothing() {
    let tools = Tools::new();
    let draw = |more: &[&str]| tools.draw("blocks", &[&["--cells", "40x30x20"], more].concat());
    let (some, said, _) = draw(&[]);
    let (all, all_said, _) = draw(&["--all-blocks"]);
    assert!(some == all, "hidden blocks are seen");
    assert!(said.contains("40 x 30 x 20 = 24000 cells"), "{said}");
    let kept = |said: &str| -> u64 {
        let line = said.lines().find(|line| line.contains("are kept")).unwrap();
        line.split(' ').next().unwrap().parse().unwrap()
    };
    assert!(kept(&said) < kept(&all_said), "{said} {all_said}");
    assert!(draw(&["--seed", "8"]).0 != some);
    for cells in ["0", "3000", "4x4", "4x4x4x4", "few"] {
        let output = tools.run("blocks", &["--cells", cells]);
        assert_eq!(output.status.code(), Some(2), "{cells}");
        assert!(text(&output.stderr).contains("--cells"));
    }
}

#[test]
fn what_is_left_out_of_a_folder_is_told() {
    let tools = Tools::new();
    tools.fill("project");
    for tool in ["city", "sunburst"] {
        let (_, said, noted) = tools.draw(tool, &["project"]);
        assert!(said.contains("project: 6 files in 3 folders"), "{said}");
        assert!(
            noted.contains("1 empty files left out: ") && noted.contains("empty.rs"),
            "{noted}"
        );
        assert!(noted.contains("1 hidden names left out") && noted.contains("target"), "{noted}");
        let everything = ["project", "--hidden", "--without", "in"];
        let (_, said, noted) = tools.draw(tool, &everything);
        assert!(said.contains("project: 5 files in 1 folders"), "{said}");
        assert!(noted.contains("times in left out"), "{noted}");
    }
    let (_, said, _) = tools.draw("city", &["project"]);
    assert!(said.contains(".rs: 2 files") && said.contains(".txt: 2 files"), "{said}");
    let pictures = ["age", "size", "lines"]
        .map(|height| tools.draw("city", &["project", "--height", height]).0);
    assert!(pictures[1] != pictures[2]);
    tools.draw("sunburst", &["project", "--height", "lines", "--color", "kind"]);
}

#[cfg(unix)]
#[test]
fn links_and_what_cannot_be_read_are_passed_over() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let tools = Tools::new();
    tools.fill("project");
    symlink(tools.path("project"), tools.path("project/round")).unwrap();
    symlink(tools.path("nowhere"), tools.path("project/lost")).unwrap();
    let (_, said, noted) = tools.draw("city", &["project"]);
    assert!(said.contains("project: 6 files"), "{said}");
    assert!(noted.contains("2 links and other special files left out"), "{noted}");
    let secret = tools.path("project/in");
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o000)).unwrap();
    // Nothing is closed to those who may do all.
    if fs::read_dir(&secret).is_err() {
        let (_, said, noted) = tools.draw("city", &["project"]);
        assert!(said.contains("project: 3 files"), "{said}");
        assert!(noted.contains("1 folders cannot be read"), "{noted}");
    }
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o700)).unwrap();
}

#[test]
fn folders_that_are_none_are_errors() {
    let tools = Tools::new();
    fs::create_dir(tools.path("empty")).unwrap();
    tools.write("nothing/empty.txt", "");
    tools.write("file.txt", "text");
    for tool in ["city", "sunburst"] {
        for (folder, named) in [
            ("missing", "missing"),
            ("empty", "no file"),
            ("nothing", "1 empty files left out"),
            ("file.txt", "no folder"),
        ] {
            let said = tools.fail(tool, &[folder]);
            assert!(said.contains(folder) && said.contains(named), "{said}");
        }
    }
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
