//! The example `bricks`, and brick files as `render` draws them.

#![cfg(all(target_endian = "little", any(unix, windows)))]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

use puncta::BrickFile;
use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// An example that is built.
fn tool(name: &str) -> Command {
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let profile = deps.parent().and_then(Path::parent).unwrap();
    let tool = profile.join("examples").join(name);
    assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
    Command::new(tool)
}

fn run(folder: &TempDir, name: &str, arguments: &[&str]) -> Output {
    tool(name).args(arguments).current_dir(folder.path()).output().unwrap()
}

fn succeed(folder: &TempDir, name: &str, arguments: &[&str]) -> String {
    let output = run(folder, name, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn fail(folder: &TempDir, name: &str, arguments: &[&str]) -> String {
    let output = run(folder, name, arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: ") && !said.contains("panicked"), "{said}");
    said
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Atoms of several elements at distances that need many bricks, one of them a stray.
fn atoms() -> String {
    let mut text = "3001\nProperties=species:S:1:pos:R:3:heat:R:1\n".to_owned();
    for i in 0..3000_u32 {
        let at = |k: u32| f64::from(i * k % 6007) / 64.0;
        let element = ["C", "O", "N", "Fe"][i as usize % 4];
        writeln!(text, "{element} {} {} {} {}", at(7) + 1e6, at(129), at(311), i % 91).unwrap();
    }
    text + "H 5e6 0 0 12\n"
}

#[test]
fn a_converted_file_gives_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.xyz"), atoms()).unwrap();
    let convert = ["a.xyz", "--out", "a.bricks", "--memory", "20KiB", "--per-brick", "9"];
    let said = succeed(&folder, "bricks", &convert);
    assert!(said.contains("a.bricks: 3001 records, ") && said.contains("MB/s"), "{said}");
    for more in [&[][..], &["--color-by", "scalar:heat", "--legend"], &["--color-by", "height"]] {
        let draw = |input: &str| {
            let files = ["--depth", "depth.npy", "--ids", "ids.npy", "--out", "p.png"];
            succeed(&folder, "render", &[&[input, "--size", "160x120"], &files[..], more].concat());
            ["depth.npy", "ids.npy", "p.png"]
                .map(|name| fs::read(folder.path().join(name)).unwrap())
        };
        let (original, converted) = (draw("a.xyz"), draw("a.bricks"));
        assert!(original == converted, "{more:?}: another picture");
    }
    let other_grid = ["a.bricks", "--grid", "3", "--size", "9x9", "--unverified"];
    succeed(&folder, "render", &other_grid);
}

#[test]
fn what_cannot_be_converted_or_drawn_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.xyz"), "2\n\nC 0 0 0\nC nan 0 0\n").unwrap();
    let convert = |more: &[&str]| fail(&folder, "bricks", more);
    assert!(convert(&["bad.xyz", "--out", "a.mmpgd"]).contains(".bricks"));
    assert!(convert(&["bad.xyz", "--out", "a.ply"]).contains(".bricks"));
    assert!(convert(&["bad.xyz", "--out", "a.bricks", "--strict"]).contains("line 4"));
    assert!(convert(&["none.xyz", "--out", "a.bricks"]).contains("none.xyz"));
    assert!(convert(&["cube:n=9", "--out", "none/a.bricks"]).contains("none/a.bricks"));
    assert!(convert(&["cube:n=9", "--out", "a.bricks", "--width", "1e-9"]).contains("cells"));
    assert_eq!(names(folder.path()), ["bad.xyz"]);

    succeed(&folder, "bricks", &["bad.xyz", "--out", "a.bricks"]);
    assert!(fail(&folder, "render", &["a.bricks", "--radius", "2"]).contains("radii"));
    assert!(fail(&folder, "render", &["a.bricks", "--frame", "1"]).contains("frame 1"));
    let path = folder.path().join("a.bricks");
    let mut bytes = fs::read(&path).unwrap();
    bytes[4100] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let said = fail(&folder, "render", &["a.bricks"]);
    assert!(said.contains("a.bricks: byte 4096: the checksum"), "{said}");
    fs::write(&path, &bytes[..5000]).unwrap();
    assert!(fail(&folder, "render", &["a.bricks"]).contains("5000"));
}

#[test]
fn a_killed_conversion_leaves_nothing_or_all() {
    let folder = tempfile::tempdir().unwrap();
    let path: PathBuf = folder.path().join("a.bricks");
    let start = || {
        let mut command = tool("bricks");
        command.args(["cube:n=1000000", "--memory", "1MiB", "--out"]).arg(&path);
        command.stdout(Stdio::null()).spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(start().wait().unwrap().success());
    let whole = begun.elapsed();
    let bytes = fs::read(&path).unwrap();
    let mut killed = 0;
    for moment in 0..10_u32 {
        // An old file, or none: that must be there, or the new one.
        let is_old = moment % 2 == 0;
        fs::remove_file(&path).unwrap();
        if is_old {
            fs::write(&path, "old").unwrap();
        }
        let mut child = start();
        thread::sleep(whole * (moment * 7 % 10) / 10 + Duration::from_millis(2));
        child.kill().unwrap();
        killed += u32::from(!child.wait().unwrap().success());
        if cfg!(target_os = "linux") {
            let found = names(folder.path());
            assert!(found.is_empty() || found == ["a.bricks"], "{found:?}");
        }
        match fs::read(&path) {
            Ok(found) if found == b"old" => assert!(is_old),
            Ok(found) => {
                assert!(found == bytes, "a file that is not whole");
                BrickFile::open(&path).unwrap();
            }
            Err(_) => {
                assert!(!is_old, "the old file is gone");
                fs::write(&path, "").unwrap();
            }
        }
    }
    assert!(killed > 0, "none was killed before its end");
}
