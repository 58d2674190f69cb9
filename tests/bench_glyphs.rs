//! The example `bench_glyphs` on small scenes: what it writes is complete and cannot contradict itself.
//! Where there is no adapter it fails, unless `PUNCTA_NO_GPU=1`.

#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};
use tempfile::TempDir;

const PIXELS: f64 = 128.0 * 128.0;

fn array(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

/// The tool, unless no GPU is wanted.
fn tool() -> Option<PathBuf> {
    if std::env::var("PUNCTA_NO_GPU").is_ok_and(|value| value == "1") {
        return None;
    }
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let tool = deps.parent().and_then(Path::parent).unwrap().join("examples/bench_glyphs");
    assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
    Some(tool)
}

/// Runs it; gives what it wrote and what it said.
fn run(tool: &Path, arguments: &[&str]) -> (Value, String) {
    let folder = TempDir::new().unwrap();
    let output = Command::new(tool)
        .args(arguments)
        .args(["--size", "128x128", "--runs", "2", "--json", "out.json", "--plot", "out.svg"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json = fs::read(folder.path().join("out.json")).unwrap();
    assert!(fs::read_to_string(folder.path().join("out.svg")).unwrap().contains("</svg>"));
    (serde_json::from_slice(&json).unwrap(), String::from_utf8(output.stdout).unwrap())
}

/// The row of a representation.
fn row<'a>(scene: &'a Value, name: &str) -> &'a Value {
    let rows = array(&scene["rows"]);
    rows.iter().find(|row| row["representation"] == name).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn representations_draw_the_same() {
    let Some(tool) = tool() else { return };
    let (json, said) = run(&tool, &["blocks:6", "caves:12", "cuboids:150", "tubes:400", "arcs:40"]);
    let scenes = array(&json["scenes"]);
    assert_eq!(scenes.len(), 5);
    for scene in scenes {
        let name = scene["scene"].as_str().unwrap();
        assert!(said.contains(&format!("**{name}: ")), "{name} is missing in {said}");
        for row in array(&scene["rows"]) {
            if row["cannot"].is_string() {
                assert!(row["representation"] == "AVC, mesh shader", "{row}");
                continue;
            }
            assert!(row["differing"].as_f64().unwrap() <= 5e-3 * PIXELS, "{row}");
            assert!(row["covered"].as_f64().unwrap() > 0.01 * PIXELS, "{row}");
            assert_eq!(array(&row["frame"]["seconds"]).len(), 2);
            let is_own = row["representation"].as_str().unwrap().contains("Renderer");
            assert_eq!(array(&row["geometry"]["seconds"]).len(), if is_own { 0 } else { 2 });
        }
    }
    let [blocks, .., arcs] = scenes else { panic!() };
    let bytes = |scene: &Value, name: &str| row(scene, name)["glyph_bytes"].as_u64().unwrap();
    assert_eq!(bytes(blocks, "triangles"), 216 * 36 * 28);
    assert_eq!(bytes(blocks, "AVC, pulled"), 216 * 8);
    // Of 6³ cells, 4³ are inside.
    assert_eq!(bytes(blocks, "exposed blocks, pulled"), (216 - 64) * 8);
    assert!(bytes(arcs, "AVC, expanded") < bytes(arcs, "indexed triangles"));
}

/// Much of the scenes lies beside the picture: compute shaders leave it out, and the pictures are the
/// same.
#[test]
fn what_is_beside_the_picture_is_left_out() {
    let Some(tool) = tool() else { return };
    let (json, _) = run(&tool, &["--close", "caves:12", "cuboids:150", "tubes:2000", "arcs:400"]);
    for scene in array(&json["scenes"]) {
        let measured = array(&scene["rows"]).iter().filter(|row| !row["cannot"].is_string());
        for row in measured {
            assert!(row["differing"].as_f64().unwrap() <= 5e-3 * PIXELS, "{row}");
        }
        let vertices = |name| row(scene, name)["vertices"].as_u64();
        // Where it can be counted.
        if let Some((all, some)) = vertices("AVC, pulled").zip(vertices("AVC, expanded")) {
            assert!(some < all / 10 * 9, "{scene}");
        }
    }
}

#[test]
fn what_does_not_fit_is_told() {
    let Some(tool) = tool() else { return };
    let (json, said) = run(&tool, &["cuboids:3000", "--memory", "1"]);
    let scene = &json["scenes"][0];
    for name in ["triangles", "indexed triangles", "strips"] {
        let reason = row(scene, name)["cannot"].as_str().unwrap();
        assert!(reason.contains("of 1048576 that may be used"), "{reason}");
    }
    assert_eq!(row(scene, "AVC, pulled")["glyph_bytes"], 3000 * 24);
    assert!(said.contains("Not measured: triangles (3024000 bytes"), "{said}");
}

#[test]
fn wrong_scenes_are_told() {
    let Some(tool) = tool() else { return };
    for (scene, reason) in [
        ("blocks", "a scene is written as blocks:32"),
        ("blocks:0", "0 is no count"),
        ("blocks:1000", "a world has up to 256 cells along a side"),
        ("spheres:3", "\"spheres\" is none of blocks"),
    ] {
        let output = Command::new(&tool).arg(scene).output().unwrap();
        assert!(!output.status.success());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(reason), "{said}");
    }
}

/// What curves promise is kept, and each tolerance has what it costs.
#[test]
fn curves_are_off_by_no_more_than_the_tolerance() {
    let Some(tool) = tool() else { return };
    let folder = TempDir::new().unwrap();
    let output = Command::new(tool)
        .args(["--errors", "arcs:60", "tubes:60", "--size", "128x128", "--runs", "2"])
        .args(["--json", "out.json"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json = fs::read(folder.path().join("out.json")).unwrap();
    let json: Value = serde_json::from_slice(&json).unwrap();
    for scene in array(&json["errors"]) {
        let rows = array(&scene["rows"]);
        assert_eq!(rows.len(), 7);
        let of =
            |key: &str| -> Vec<f64> { rows.iter().map(|row| row[key].as_f64().unwrap()).collect() };
        let pairs = of("largest_deviation").into_iter().zip(of("tolerance"));
        // Not more, and not much less: random views find the worst of chords.
        assert!(pairs.into_iter().all(|(found, most)| found <= most && found > 0.8 * most));
        assert!(of("triangles_per_glyph").is_sorted_by(|a, b| a >= b));
        assert!(of("mean_deviation").is_sorted());
        assert!(of("points").iter().all(|points| *points > 1e5));
    }
}
