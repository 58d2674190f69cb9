//! The example `render` as its users meet it: options, files, errors and exit codes.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    reason = "a test may panic and talk, and its numbers are small"
)]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// Runs the tool in a folder of its own.
struct Tool {
    folder: TempDir,
}

impl Tool {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn run(&self, arguments: &[&str]) -> Output {
        // Tests lie in `deps`, examples beside it.
        let deps = std::env::current_exe().unwrap();
        let profile = deps.parent().and_then(Path::parent).unwrap();
        let tool = profile.join("examples").join("render");
        assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
        Command::new(tool).args(arguments).current_dir(self.folder.path()).output().unwrap()
    }

    /// Runs the tool, which must succeed.
    fn succeed(&self, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        output
    }

    /// Runs the tool, which must fail as a tool should; returns what it says.
    fn fail(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.starts_with("error: ") && !said.contains("panicked"), "{said}");
        said
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The values of an array file, after its header.
    fn array(&self, name: &str) -> Vec<[u8; 4]> {
        let bytes = self.read(name);
        let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        bytes[start..].as_chunks().0.to_vec()
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A small molecule-like file whose coordinates are whole numbers of 1/64, moved along x.
fn xyz(shift: f64) -> String {
    let atoms = (0..200_u32).map(|i| {
        let at = |k: u32| f64::from((i * k) % 641) / 64.0;
        format!("{} {} {} {}\n", ["C", "O", "N"][i as usize % 3], at(7) + shift, at(129), at(311))
    });
    format!("200\na comment\n{}", atoms.collect::<String>())
}

#[test]
fn threads_grids_and_places_give_the_same_bytes() {
    let tool = Tool::new();
    tool.write("near.xyz", xyz(0.0));
    tool.write("far.xyz", xyz(1e7));
    let draw = |file: &str, eye: &str, target: &str, more: &[&str]| {
        let view = ["--size", "160x120", "--eye", eye, "--target", target, "--up", "0,0,1"];
        let files = ["--depth", "depth.npy", "--ids", "ids.npy", "--supersample", "1"];
        tool.succeed(&[&[file], &view[..], &files, more].concat());
        (tool.read("depth.npy"), tool.read("ids.npy"))
    };
    let (eye, target) = ("5,-20,8", "5,5,5");
    let first = draw("near.xyz", eye, target, &[]);
    for more in [["--threads", "1"], ["--threads", "2"], ["--grid", "1"], ["--grid", "13"]] {
        assert!(draw("near.xyz", eye, target, &more) == first, "{more:?}");
    }
    let far = draw("far.xyz", "10000005,-20,8", "10000005,5,5", &[]);
    assert!(far == first, "a moved file gives another picture");

    let ids: Vec<u32> = tool.array("ids.npy").into_iter().map(u32::from_le_bytes).collect();
    let depths: Vec<f32> = tool.array("depth.npy").into_iter().map(f32::from_le_bytes).collect();
    assert_eq!((ids.len(), depths.len()), (160 * 120, 160 * 120));
    assert!(ids.iter().zip(&depths).all(|(id, depth)| (*id == u32::MAX) == depth.is_infinite()));
    assert!(ids.iter().filter(|id| **id < 200).count() > 1000);
}

#[test]
fn statistics_and_pictures_are_written() {
    let tool = Tool::new();
    let input = "cube:n=20000,r=0.02,seed=3";
    tool.succeed(&[input, "--size", "200x150", "--legend", "--json", "s.json", "--out", "p.png"]);
    assert!(tool.read("p.png").starts_with(b"\x89PNG"));
    let statistics: serde_json::Value = serde_json::from_slice(&tool.read("s.json")).unwrap();
    assert_eq!(statistics["particles"], 20000);
    for step in ["read", "sort", "frame", "shade", "write"] {
        assert!(statistics["seconds"][step].as_f64().is_some_and(|seconds| seconds >= 0.0));
    }
    let visible = statistics["visible_particles"].as_u64().unwrap();
    assert!((1000..20000).contains(&visible), "{visible}");
    assert_eq!(statistics["bytes"]["records"], 16 * 20000);
}

#[test]
fn without_an_input_there_is_a_picture() {
    let tool = Tool::new();
    let output = tool.succeed(&["--size", "64x48"]);
    assert!(text(&output.stdout).contains("puncta.png"));
    assert!(tool.path("puncta.png").exists());
    assert!(output.stderr.is_empty(), "no progress bar without a terminal");
}

#[test]
fn what_cannot_be_drawn_is_an_error_that_names_it() {
    let tool = Tool::new();
    tool.write("empty.xyz", "");
    tool.write("garbage", [0, 159, 146, 150, 7, 7, 7]);
    tool.write("few.xyz", "3\n\nC 0 0 0\n");
    tool.write("huge.xyz", "99999999999999\n\nC 0 0 0\n");
    tool.write("nothing.xyz", "1\n\nC nan 0 0\n");
    tool.write("short.mmpld", b"MMPLD\0\x67\x00\x01\x00\x00\x00");
    fs::create_dir(tool.path("folder")).unwrap();
    for (input, named) in [
        ("missing.xyz", "No such file"),
        ("folder", "folder"),
        ("empty.xyz", "empty"),
        ("garbage", "format"),
        ("few.xyz", "line 4"),
        ("huge.xyz", "line"),
        ("nothing.xyz", "1 records were skipped"),
        ("short.mmpld", "byte"),
    ] {
        let said = tool.fail(&[input]);
        assert!(said.contains(input) && said.contains(named), "{said}");
    }
    assert!(tool.fail(&["few.xyz", "--radius", "-1"]).contains("-1"));
    assert!(tool.fail(&["cube:n=0"]).contains('0'));
    assert!(tool.fail(&["cube:m=5"]).contains('m'));
    assert!(!tool.path("puncta.png").exists(), "a picture of nothing was written");
}

#[test]
fn a_look_straight_up_or_down_needs_no_up() {
    let tool = Tool::new();
    for eye in ["0,0,5", "0,0,-5", "0,5,0", "-5,0,0"] {
        for input in ["cube:n=100", "lattice:n=100"] {
            tool.succeed(&[input, "--eye", eye, "--target", "0,0,0", "--size", "9x9"]);
        }
    }
}

#[test]
fn odd_options_are_errors_too() {
    let tool = Tool::new();
    tool.write("two.xyz", "2\n\nC 0 0 0\nO 2 0 0\n");
    for (arguments, named) in [
        (["--eye", "1,0,0", "--target", "1,0,0"], "the eye is at the target"),
        (["--fov", "180", "--size", "9x9"], "180 degrees"),
        (["--ortho", "-3", "--size", "9x9"], "-3"),
        (["--size", "0x7", "--frame", "0"], "0 x 7"),
        (["--size", "999999x7", "--frame", "0"], "999999"),
        (["--frame", "4", "--size", "9x9"], "frame 4"),
        (["--colormap", "sunset", "--size", "9x9"], "viridis"),
        (["--color-by", "scalar:heat", "--size", "9x9"], "heat"),
        (["--color-by", "rgb", "--size", "9x9"], "colors"),
        (["--size", "9000x7", "--supersample", "2"], "--supersample"),
    ] {
        let said = tool.fail(&[&["two.xyz"], &arguments[..]].concat());
        assert!(said.contains(named), "{arguments:?}: {said}");
    }
    assert!(tool.fail(&["cube:n=100", "--grid", "100000"]).contains("cells"));
    assert!(!tool.path("puncta.png").exists(), "a picture was written all the same");
}

#[test]
fn skipped_records_are_told_and_ids_stay_those_of_the_file() {
    let tool = Tool::new();
    tool.write("bad.xyz", "3\n\nC inf 0 0\nC 0 0 0\nC 0 0\n");
    let output = tool.succeed(&["bad.xyz", "--size", "32x32", "--ids", "ids.npy"]);
    let said = text(&output.stderr);
    assert!(said.contains("line 3") && said.contains("line 5"), "{said}");
    let ids: Vec<u32> = tool.array("ids.npy").into_iter().map(u32::from_le_bytes).collect();
    assert!(ids.contains(&1) && ids.iter().all(|id| [1, u32::MAX].contains(id)));
    assert!(tool.fail(&["bad.xyz", "--strict"]).contains("line 3"));
}

/// The same options on a GPU give the same numbers: at most one in 100,000 pixels shows another
/// record, and depths of the same record are those of exact arithmetic.
#[test]
fn a_gpu_draws_the_same_numbers() {
    let tool = Tool::new();
    tool.write("atoms.xyz", xyz(0.0));
    let mut inputs = vec!["atoms.xyz".to_owned(), "cube:n=60000,r=0.02".to_owned()];
    if let Some(data) = std::env::var_os("PUNCTA_DATA") {
        let membrane = PathBuf::from(data).join("bace_membrane.pdb");
        inputs.push(membrane.to_str().unwrap().to_owned());
    }
    if std::env::var_os("PUNCTA_NO_GPU").is_some() {
        println!("PUNCTA_NO_GPU is set: no GPU is tried");
        let said = tool.fail(&["atoms.xyz", "--backend", "gpu", "--adapter", "none such"]);
        assert!(said.contains("no GPU adapter") && said.contains("none such"), "{said}");
        return;
    }
    for input in inputs {
        let numbers = |backend: &str, options: &[&str]| {
            let common = [&input, "--size", "500x400", "--supersample", "1", "--backend", backend];
            tool.succeed(&[&common, options].concat());
        };
        numbers("cpu", &["--ids", "a.npy", "--depth", "a_d.npy", "--out", "a.png"]);
        for setup in ["compute", "triangle"] {
            let files = ["--ids", "b.npy", "--depth", "b_d.npy", "--out", "b.png"];
            numbers("gpu", &[&["--setup", setup], &files[..]].concat());
            let (ids, other_ids) = (tool.array("a.npy"), tool.array("b.npy"));
            let (depths, other_depths) = (tool.array("a_d.npy"), tool.array("b_d.npy"));
            assert!(ids.iter().filter(|id| **id != [255; 4]).count() > 10_000);
            let differ = ids.iter().zip(&other_ids).filter(|(a, b)| a != b).count();
            assert!(differ * 100_000 <= ids.len(), "{input}, {setup}: {differ} ids differ");
            let pixels = ids.iter().zip(&other_ids).zip(depths.iter().zip(&other_depths));
            for (_, (a, b)) in pixels.filter(|((a, b), _)| a == b) {
                let (a, b) = (f32::from_le_bytes(*a), f32::from_le_bytes(*b));
                // Either is off by 2^-22 at most.
                assert!(a == b || (a - b).abs() <= a * 2.0_f32.powi(-21), "{input}: {a} {b}");
            }
        }
    }
    let said = tool.fail(&["atoms.xyz", "--backend", "gpu", "--adapter", "none such"]);
    assert!(said.contains("no GPU adapter") && said.contains("none such"), "{said}");
    tool.fail(&["atoms.xyz", "--setup", "mesh"]);
}
