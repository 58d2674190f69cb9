//! The examples `convergence` and `bench_frame` on small scenes: what they write is complete and
//! cannot contradict itself.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;
use std::{
    fs,
    path::Path,
    process::{Command, Output},
};
use tempfile::TempDir;

const ORDERS: [&str; 6] = ["memory", "depth", "level", "density", "density-fifo", "transmittance"];

fn run(tool: &str, folder: &TempDir, arguments: &[&str]) -> Output {
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let profile = deps.parent().and_then(Path::parent).unwrap();
    let tool = profile.join("examples").join(tool);
    assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
    Command::new(tool).args(arguments).current_dir(folder.path()).output().unwrap()
}

/// Runs a tool that must succeed; returns its JSON and what it says.
fn measure(tool: &str, folder: &TempDir, arguments: &[&str]) -> (Value, String) {
    let files = ["--json", "out.json", "--plot", "out.svg"];
    let output = run(tool, folder, &[arguments, &files].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json = serde_json::from_slice(&fs::read(folder.path().join("out.json")).unwrap()).unwrap();
    (json, String::from_utf8(output.stdout).unwrap())
}

fn array(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn records(value: &Value) -> u64 {
    value["records"].as_u64().unwrap()
}

/// Checks all that must hold of the curve of an order.
fn check_curve(curve: &Value) {
    let (points, in_view) = (array(&curve["points"]), records(&curve["in_view"]));
    let (first, last) = (&points[0], &points[points.len() - 1]);
    assert!(number(&first["error"]) > 0.05 && number(&first["error"]) < 1.0);
    assert_eq!(records(&first["drawn"]), 0);
    for end in ["error", "wrong", "open"] {
        assert_eq!(number(&last[end]), 0.0, "{end}");
    }
    for point in points {
        let parts = ["drawn", "skipped", "left"].map(|part| records(&point[part]));
        assert_eq!(parts.iter().sum::<u64>(), in_view);
        let is_right = point["wrong"] == 0;
        assert!(!is_right || number(&point["error"]) == 0.0, "right pixels of other colors");
        assert!(point["open"].as_u64() >= point["wrong"].as_u64(), "a closed pixel changed");
    }
    for pair in points.windows(2) {
        assert!(records(&pair[0]["drawn"]) <= records(&pair[1]["drawn"]));
        assert!(number(&pair[0]["seconds"]) <= number(&pair[1]["seconds"]));
    }
    let marks = ["50 %", "10 %", "1 %", "0 %", "settled"];
    let marks = marks.map(|mark| &curve["reached"][mark]);
    assert!(marks.windows(2).all(|m| records(&m[0]["drawn"]) <= records(&m[1]["drawn"])));
    for (mark, share) in marks.iter().zip([0.5, 0.1, 0.01, 0.0]) {
        assert!(number(&mark["error"]) <= share * number(&first["error"]));
    }
}

#[test]
fn errors_fall_to_nothing_in_all_orders() {
    let folder = tempfile::tempdir().unwrap();
    let orders = ORDERS.join(",");
    let views = ["--views", "overview,detail,inside", "--orders", &orders, "--turn", "2"];
    let files = ["--size", "96x96", "--pictures", "pictures"];
    let input = ["cube:n=60000,r=0.03", "--budget", "500"];
    let (json, said) = measure("convergence", &folder, &[&input, &views[..], &files].concat());
    assert_eq!(array(&json["views"]).len(), 3);
    for view in array(&json["views"]) {
        let curves = array(&view["orders"]);
        assert_eq!(curves.len(), ORDERS.len());
        for (curve, name) in curves.iter().zip(ORDERS) {
            assert_eq!(curve["order"], name);
            check_curve(curve);
            assert_eq!(curve["points"][0]["error"], curves[0]["points"][0]["error"]);
        }
        let drawn = |order: usize| records(&curves[order]["reached"]["settled"]["drawn"]);
        assert!(drawn(1) < drawn(0), "front to back draws less than any order");
        assert_eq!(array(&view["motions"]).len(), 2);
        for motion in array(&view["motions"]) {
            let count = |name: &str| motion[name].as_u64().unwrap();
            assert!(count("recalled") > 0);
            assert!(count("same") <= count("same_record"));
            assert!(count("pixels") - count("same_record") <= count("open"));
            assert!(2 * count("same_record") > count("pixels"), "the cache shows nothing");
        }
        let name = view["name"].as_str().unwrap();
        assert!(said.contains(name));
        assert!(folder.path().join("pictures").join(format!("{name}.png")).exists());
    }
    let plot = fs::read_to_string(folder.path().join("out.svg")).unwrap();
    assert!(plot.contains("<svg") && ORDERS.iter().all(|order| plot.contains(order)));
}

#[test]
fn without_skipping_all_records_count() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["cube:n=20000,r=0.03", "--size", "64x64", "--no-skip", "--views", "overview"];
    let (json, _) = measure("convergence", &folder, &arguments);
    for curve in array(&json["views"][0]["orders"]) {
        let points = array(&curve["points"]);
        let last = &points[points.len() - 1];
        assert_eq!(records(&last["drawn"]), 20000);
        assert!(points.iter().all(|point| records(&point["skipped"]) == 0));
        assert!(records(&curve["reached"]["0 %"]["drawn"]) <= 20000);
    }
}

#[test]
fn frames_are_measured_part_by_part() {
    let folder = tempfile::tempdir().unwrap();
    let sizes = ["--blocks", "12x5x3,50x8x8", "--grids", "6,10", "--size", "96x96"];
    let often = ["--repetitions", "2", "--slow-repetitions", "1"];
    let input = ["cube:n=60000,r=0.03", "hall:n=30000", "--table", "out.md"];
    let (json, said) = measure("bench_frame", &folder, &[&input[..], &sizes, &often].concat());
    let cases = array(&json["cases"]);
    let bricks: Vec<u64> = cases.iter().map(|case| case["bricks"].as_u64().unwrap()).collect();
    assert_eq!(bricks[..4], [180, 3200, 216, 1000]);
    assert_eq!(bricks.len(), 6);
    assert_eq!(cases[1]["thesis"]["bricks"], 3518);
    for case in cases {
        assert!(number(&case["graph_agrees_with_plain_graph"]) > 0.995);
        for part in ["cull", "graph", "plain graph"].iter().chain(&ORDERS[1..]) {
            assert!(number(&case["parts"][part]["median_seconds"]) > 0.0, "{part}");
        }
    }
    for case in &cases[2..4] {
        let drawn = |way: &str| records(&case["frames"][way]["drawn"]);
        assert!(drawn("depth") < drawn("back to front"));
        assert!(drawn("back to front") <= records(&case["in_view"]));
        assert!(ORDERS.iter().all(|order| (1..=60000).contains(&drawn(order))));
    }
    assert!(said.contains("50x8x8"));
    let table = fs::read_to_string(folder.path().join("out.md")).unwrap();
    assert_eq!(table.lines().count(), 2 + cases.len() + 1 + 2 + 4 * (ORDERS.len() + 1));
    assert!(fs::read_to_string(folder.path().join("out.svg")).unwrap().contains("<svg"));
}

#[test]
fn what_cannot_be_measured_is_an_error_that_names_it() {
    let folder = tempfile::tempdir().unwrap();
    for (tool, arguments, named) in [
        ("convergence", ["missing.xyz", "--size", "9x9"], "missing.xyz"),
        ("convergence", ["cube:n=100", "--size", "0x7"], "0 x 7"),
        ("convergence", ["cube:n=100", "--size", "many"], "many"),
        ("convergence", ["cube:n=100", "--every", "NaN"], "--every"),
        ("convergence", ["cube:n=100", "--turn", "inf"], "--turn"),
        ("bench_frame", ["missing.xyz", "--no-blocks", "--repetitions=1"], "missing.xyz"),
        ("bench_frame", ["cube:n=100", "--repetitions", "0"], "nothing"),
    ] {
        let output = run(tool, &folder, &arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.starts_with("error: ") && said.contains(named), "{said}");
    }
}
