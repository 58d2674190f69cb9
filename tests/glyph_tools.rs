//! The examples that draw glyphs as their users meet them: pictures, notes, errors and exit codes.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic and talk")]

#[path = "glyphs/tools.rs"]
mod tools;

use std::{
    fs,
    time::{Duration, SystemTime},
};
use tools::{Tools, text};

/// A folder with some files.
fn fill(tools: &Tools, folder: &str) {
    for (name, lines) in [("a.rs", 1300), ("b.rs", 40), ("c", 7)] {
        tools.write(&format!("{folder}/{name}"), "a line\n".repeat(lines));
    }
    tools.write(&format!("{folder}/in/d.txt"), "a line that is much longer\n".repeat(150));
    tools.write(&format!("{folder}/in/deep/er/e.TXT"), "one line\n");
    tools.write(&format!("{folder}/in/picture.bin"), [10, 0, 10, 0, 10]);
    tools.write(&format!("{folder}/empty.rs"), "");
    tools.write(&format!("{folder}/.hidden"), "not seen");
    tools.write(&format!("{folder}/target/f.rs"), "nor this");
}

#[test]
fn each_tool_draws_the_same_picture_with_any_number_of_threads() {
    let tools = Tools::new();
    fill(&tools, "project");
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
    fill(&tools, "project");
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

/// Ages make heights, unless there are none to tell apart.
#[test]
fn houses_are_high_by_age() {
    let tools = Tools::new();
    fill(&tools, "project");
    let (fresh, said, _) = tools.draw("city", &["project"]);
    assert!(said.contains("heights show lines"), "{said}");
    let file = fs::File::options().append(true).open(tools.path("project/c")).unwrap();
    file.set_modified(SystemTime::now() - Duration::from_hours(48)).unwrap();
    let (old, said, _) = tools.draw("city", &["project"]);
    assert!(said.contains("heights show age"), "{said}");
    assert!(old != fresh);
}

/// However high houses are, nothing of a city is cut off.
#[test]
fn all_of_a_city_is_in_the_picture() {
    let tools = Tools::new();
    fill(&tools, "project");
    for height in ["size", "lines"] {
        let size = ["--height", height, "--size", "120x80", "--sky", "0", "--out", "whole.png"];
        let output = tools.run("city", &[&["project"], &size[..]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let pixels = decoded(&fs::read(tools.path("whole.png")).unwrap());
        let rows: Vec<&[u8]> = pixels.chunks(pixels.len() / 80).collect();
        let is_plain = |row: &[u8]| {
            let pixels = row.chunks(row.len() / 120);
            pixels.clone().zip(pixels.skip(1)).all(|(a, b)| a == b)
        };
        // Where there is nothing, all pixels of a row look the same.
        assert!(is_plain(rows[0]) && is_plain(rows[79]) && !is_plain(rows[40]), "{height}");
    }
}

#[cfg(unix)]
#[test]
fn links_and_what_cannot_be_read_are_passed_over() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let tools = Tools::new();
    fill(&tools, "project");
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

/// A GPU draws the same: where rounding shows another record, only few pixels differ.
#[test]
fn a_gpu_draws_the_same_pictures() {
    let tools = Tools::new();
    if std::env::var_os("PUNCTA_NO_GPU").is_some() {
        println!("PUNCTA_NO_GPU is set: no GPU is tried");
        let said =
            tools.fail("blocks", &["--cells", "8", "--backend", "gpu", "--adapter", "none such"]);
        assert!(said.contains("no GPU adapter") && said.contains("none such"), "{said}");
        return;
    }
    fill(&tools, "project");
    for (tool, arguments) in [
        ("blocks", &["--cells", "16"][..]),
        ("city", &["project"]),
        ("sunburst", &["project"]),
        ("map", &["--seed", "4"]),
        ("trajectories", &["--count", "9", "--points", "60"]),
    ] {
        let pixels = |backend: &str| {
            let size = ["--size", "200x150", "--sky", "0", "--supersample", "1"];
            let files = ["--backend", backend, "--out", "gpu.png"];
            let output = tools.run(tool, &[arguments, &size, &files].concat());
            assert!(output.status.success(), "{tool}: {}", text(&output.stderr));
            decoded(&fs::read(tools.path("gpu.png")).unwrap())
        };
        let (cpu, gpu) = (pixels("cpu"), pixels("gpu"));
        assert_eq!(cpu.len(), gpu.len());
        let differ = cpu.iter().zip(&gpu).filter(|(a, b)| a != b).count();
        // At most one in a thousand: these pictures are nearly all edges.
        assert!(differ * 1000 <= cpu.len(), "{tool}: {differ} of {} bytes differ", cpu.len());
    }
}

/// The bytes of the pixels of a picture.
fn decoded(png: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}
