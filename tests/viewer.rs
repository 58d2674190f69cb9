//! The example `viewer` as its users meet it, on a screen that is not there: needs `Xvfb`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may panic, and says what it leaves out"
)]

mod screen;

use screen::{PATIENCE, Running, Screen, covered, differing, path_of, pixels};
use std::{
    process::Command,
    thread,
    time::{Duration, Instant},
};

const SCENE: &str = "cube:n=3000,r=0.05";

/// The pixels of the picture that a viewer writes before it ends.
fn screenshot(screen: &Screen, arguments: &[&str]) -> Vec<[u8; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let common = [SCENE, "--size", "600x400", "--background", "transparent", "--screenshot"];
    let arguments = [&common[..], &[path.to_str().unwrap()], arguments].concat();
    let (code, said) = screen.run("viewer", &arguments).end();
    assert_eq!(code, Some(0), "{said}");
    pixels(&path)
}

#[test]
fn both_backends_show_the_same_picture() {
    let Some(screen) = Screen::new() else { return };
    let [gpu, cpu] = ["gpu", "cpu"].map(|backend| {
        let pixels = screenshot(&screen, &["--backend", backend, "--frames", "3"]);
        let covered = covered(&pixels);
        assert!(covered > pixels.len() / 20, "{backend}: {covered} of {}", pixels.len());
        assert!(covered < pixels.len() * 19 / 20, "{backend}: {covered} of {}", pixels.len());
        pixels
    });
    assert!(differing(&gpu, &cpu) <= gpu.len() / 10_000);
}

#[test]
fn an_orbit_changes_the_picture() {
    let Some(screen) = Screen::new() else { return };
    let still = screenshot(&screen, &["--backend", "cpu", "--supersample", "1"]);
    let turned = ["--backend", "cpu", "--supersample", "1", "--orbit", "6,-3", "--frames", "4"];
    let turned = screenshot(&screen, &turned);
    assert!(differing(&still, &turned) > covered(&still) / 4);
}

#[test]
fn a_drag_turns_a_wheel_zooms_and_a_key_writes() {
    let Some(screen) = Screen::new() else { return };
    if screen.input("version").is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("key.png");
    let arguments = [SCENE, "--backend", "cpu", "--size", "600x400", "--supersample", "1", "--log"];
    let mut viewer =
        screen.run("viewer", &[&arguments[..], &["--out", out.to_str().unwrap()]].concat());
    let part = |line: &str, name: &str| {
        line.split_once(name).unwrap().1.split([']', ' ']).next().unwrap().to_owned()
    };
    let eye = |line: &str| line.split_once("eye=").unwrap().1.split_once(']').unwrap().0.to_owned();
    let first = viewer.line(|line| line.starts_with("settled "));
    let drag =
        "mousemove 100 150 mousedown 1 sleep 0.2 mousemove 140 150 sleep 0.2 mousemove 180 160";
    assert!(screen.input(&format!("{drag} sleep 0.2 mouseup 1")).unwrap().success());
    let turned = viewer.line(|line| eye(line) != eye(&first));
    assert_ne!(eye(&turned), eye(&first));
    let count = |line: &str| part(line, "covered=").parse::<u32>().unwrap();
    assert!(screen.input("click --repeat 3 --delay 50 4").unwrap().success());
    viewer.line(|line| count(line) > count(&turned) * 5 / 4);
    // Without a window manager nothing has the focus.
    let focus = "search --onlyvisible --name puncta windowfocus --sync %1";
    assert!(screen.input(&format!("{focus} key p")).unwrap().success());
    let start = Instant::now();
    while !out.exists() {
        assert!(start.elapsed() < PATIENCE, "the key P writes nothing");
        thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn what_cannot_be_opened_is_told() {
    let Some(screen) = Screen::new() else { return };
    for (name, reason) in [("there-is-no.xyz", "there-is-no.xyz"), ("cube:n=0", "n")] {
        let arguments = [name, "--backend", "cpu", "--screenshot", "never.png"];
        let (code, said) = screen.run("viewer", &arguments).end();
        assert_eq!(code, Some(1), "{said}");
        let line = said.lines().find(|line| line.starts_with("error: ") && line.contains(reason));
        assert!(line.is_some() && !said.contains("panicked"), "{said}");
    }
}

#[test]
fn a_window_needs_a_display() {
    let mut command = Command::new(path_of("viewer"));
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
