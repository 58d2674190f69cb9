//! The example `bench_gpu` on a small scene: what it writes is complete and cannot contradict
//! itself. Where there is no adapter it fails, unless `PUNCTA_NO_GPU=1`.

#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;
use std::{fs, path::Path, process::Command};
use tempfile::TempDir;

const COUNT: u64 = 3000;
const PIXELS: f64 = 96.0 * 96.0;

fn array(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

/// The strategies that are there; the others say why not.
fn measured(rows: &Value) -> Vec<&Value> {
    let (lacking, measured): (Vec<_>, Vec<_>) =
        array(rows).iter().partition(|row| row["cannot"].is_string());
    assert!(lacking.iter().all(|row| row["setup"] == "mesh" || row["fragment"] == "sphere-early"));
    measured
}

#[test]
fn strategies_of_a_device_are_measured() {
    if std::env::var("PUNCTA_NO_GPU").is_ok_and(|value| value == "1") {
        return;
    }
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let tool = deps.parent().and_then(Path::parent).unwrap().join("examples/bench_gpu");
    assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
    let folder = TempDir::new().unwrap();
    let scene = format!("cube:n={COUNT},r=0.08");
    let output = Command::new(tool)
        .args([&scene, "--size", "96x96", "--runs", "2", "--counts", "4096", "--turns", "3"])
        .args(["--json", "out.json", "--plot", "out.svg"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: Value =
        serde_json::from_slice(&fs::read(folder.path().join("out.json")).unwrap()).unwrap();
    assert!(fs::read_to_string(folder.path().join("out.svg")).unwrap().contains("</svg>"));
    let found = &json["found"][&scene];
    check_strategies(&measured(&found["strategies"]));
    for row in measured(&found["skipping"]) {
        let sum = row["drawn"].as_u64().unwrap() + row["skipped"].as_u64().unwrap();
        assert_eq!(sum, COUNT, "{row}");
        assert!(row["differing"].as_f64().unwrap() <= 1e-3 * PIXELS, "{row}");
        let [with, without] = array(&row["second_view"]) else { panic!("{row}") };
        assert!(with["recalled"].as_u64() > Some(0) && without["recalled"] == 0, "{row}");
        assert!(with["brought_bytes"] == 0 && without["brought_bytes"] == 0, "{row}");
    }
    let latency = array(&found["latency"]);
    assert!(latency.len() == 2 && latency.iter().all(|row| array(&row["seconds"]).len() == 3));
    let brought = array(&json["found"]["uploads"]).iter().map(|row| row["bytes"].as_u64().unwrap());
    // Nothing; all in four ways; all with ids, in segments, where not all fits; nothing.
    let segments = 4096 * 20;
    assert_eq!(brought.collect::<Vec<_>>(), [0, 65536, 65536, 65536, 65536, segments, 0]);
    let said = String::from_utf8(output.stdout).unwrap();
    for title in ["Strategies", "Skipping", "A second view", "Until a new view", "Bringing"] {
        assert!(said.contains(&format!("**{title}")), "{title} is missing in {said}");
    }
}

fn check_strategies(rows: &[&Value]) {
    for setup in ["instanced", "pulled", "triangle", "compute"] {
        let of: Vec<_> = rows.iter().filter(|row| row["setup"] == setup).collect();
        assert!(of.len() >= 3, "{setup}");
        for row in of {
            let (differing, fragment) = (row["differing"].as_f64().unwrap(), &row["fragment"]);
            let is_exact = fragment == "sphere" || fragment == "sphere-early";
            assert_eq!(differing <= 1e-3 * PIXELS, is_exact, "{row}");
            assert_eq!(array(&row["frame"]["seconds"]).len(), 2);
            assert_eq!(array(&row["geometry"]["seconds"]).len(), 2);
        }
    }
}
