//! The windows of the tools that draw glyphs, on a screen that is not there: needs `Xvfb`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may panic, and says what it leaves out"
)]

mod screen;

use screen::{Running, Screen, covered, differing, path_of, pixels};
use std::process::Command;

const SIZE: [&str; 4] = ["--size", "600x400", "--background", "transparent"];

/// No finer picture when the camera rests.
const PLAIN: [&str; 2] = ["--supersample", "1"];

/// Few records, and a place to look at them from that does not depend on the size of the window.
const BLOCKS: [&str; 7] = ["blocks", "--cells", "24", "--eye", "-20,-40,50", "--target", "12,12,5"];
const FLOW: [&str; 5] = ["trajectories", "--count", "10", "--points", "120"];

/// The pixels of the picture that a window writes before it closes.
fn screenshot(screen: &Screen, tool: &[&str], arguments: &[&str]) -> Vec<[u8; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let window = ["--window", "--frames", "3", "--screenshot", path.to_str().unwrap()];
    let (code, said) = screen.run(tool[0], &[&tool[1..], &SIZE, &window, arguments].concat()).end();
    assert_eq!(code, Some(0), "{said}");
    pixels(&path)
}

#[test]
fn a_window_shows_what_is_written_without_one() {
    let Some(screen) = Screen::new() else { return };
    let [cpu, gpu] = ["cpu", "gpu"].map(|backend| {
        let shown = screenshot(&screen, &BLOCKS, &["--backend", backend, "--supersample", "1"]);
        let height = (shown.len() / 600).to_string();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("written.png");
        let size = format!("600x{height}");
        let drawn = ["--size", &size, "--background", "transparent", "--supersample", "1"];
        let out = ["--sky", "0", "--backend", backend, "--out", path.to_str().unwrap()];
        let mut tool = Command::new(path_of("blocks"));
        assert!(
            tool.args([&BLOCKS[1..], &drawn, &out].concat()).output().unwrap().status.success()
        );
        let covered = covered(&shown);
        assert!((shown.len() / 20..shown.len() * 19 / 20).contains(&covered), "{covered}");
        assert_eq!(differing(&shown, &pixels(&path)), 0, "{backend}");
        shown
    });
    assert!(differing(&cpu, &gpu) <= cpu.len() / 1000);
}

#[test]
fn an_orbit_changes_the_picture() {
    let Some(screen) = Screen::new() else { return };
    let still = screenshot(&screen, &FLOW, &PLAIN);
    let turned = screenshot(&screen, &FLOW, &["--supersample", "1", "--orbit", "6,-3"]);
    assert!(covered(&still) > still.len() / 100, "{}", covered(&still));
    assert!(differing(&still, &turned) > covered(&still) / 4);
}

#[test]
fn a_rest_makes_the_picture_finer() {
    let Some(screen) = Screen::new() else { return };
    let plain = screenshot(&screen, &FLOW, &PLAIN);
    let fine = screenshot(&screen, &FLOW, &["--supersample", "3"]);
    let partly = |pixels: &[[u8; 4]]| pixels.iter().any(|pixel| !matches!(pixel[3], 0 | 255));
    assert!(!partly(&plain) && partly(&fine));
}

#[test]
fn a_drag_turns_a_wheel_zooms_and_a_click_picks() {
    let Some(screen) = Screen::new() else { return };
    if screen.input("version").is_none() {
        return;
    }
    let arguments = [&BLOCKS[1..], &SIZE, &PLAIN, &["--window", "--log"]].concat();
    let mut window = screen.run("blocks", &arguments);
    let eye = |line: &str| line.split_once("eye=").map(|(_, rest)| rest.to_owned());
    let count = |line: &str| {
        let count = line.split_once("covered=").and_then(|(_, count)| count.parse::<u32>().ok());
        count.unwrap_or(0)
    };
    let first = window.line(|line| line.starts_with("settled "));
    let drag =
        "mousemove 200 150 mousedown 1 sleep 0.2 mousemove 240 150 sleep 0.2 mousemove 260 160";
    assert!(screen.input(&format!("{drag} sleep 0.2 mouseup 1")).unwrap().success());
    let turned = window.line(|line| line.starts_with("settled ") && eye(line) != eye(&first));
    assert!(screen.input("mousemove 300 180 click --repeat 3 --delay 50 4").unwrap().success());
    window.line(|line| count(line) > count(&turned) * 5 / 4);
    assert!(screen.input("click 1").unwrap().success());
    let picked = window.line(|line| line.starts_with("picked "));
    assert!(picked.starts_with("picked record ") && picked.contains('#'), "{picked}");
}

#[test]
fn what_is_wrong_is_told() {
    let Some(screen) = Screen::new() else { return };
    for (arguments, reason) in
        [(["--window", "--adapter", "any"], "--adapter"), (["--window", "--fov", "0"], "fov")]
    {
        let (code, said) = screen.run("blocks", &[&BLOCKS[1..], &arguments].concat()).end();
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("error: ") && said.contains(reason), "{said}");
        assert!(!said.contains("panicked"), "{said}");
    }
}

#[test]
fn a_window_needs_a_display() {
    let mut command = Command::new(path_of("blocks"));
    command.args(["--cells", "8", "--window"]);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let (code, said) = Running::new(command).end();
    if cfg!(target_os = "linux") {
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains("error: there is no display") && !said.contains("panicked"),
            "{said}"
        );
    }
}
