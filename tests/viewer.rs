//! The example `viewer` as its users meet it, on a screen that is not there: needs `Xvfb`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may panic, and says what it leaves out"
)]

use std::{
    fs::File,
    io::{BufRead, BufReader, Read},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::{Duration, Instant},
};

const SCENE: &str = "cube:n=3000,r=0.05";

/// How long a window may take: software drivers on busy machines are slow.
const PATIENCE: Duration = Duration::from_secs(120);

/// A screen in memory.
struct Screen {
    server: Child,
    number: String,
}

impl Screen {
    /// A new screen; `None`, and a line that says so, where windows cannot be tested.
    fn new() -> Option<Self> {
        if std::env::var_os("PUNCTA_NO_GPU").is_some_and(|value| value == "1") {
            println!("PUNCTA_NO_GPU: no window is opened");
            return None;
        }
        // Without -noreset it starts anew after its last client, and refuses the next for a moment.
        let server = Command::new("Xvfb")
            .args(["-noreset", "-displayfd", "1", "-screen", "0", "800x600x24"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let Ok(mut server) = server else {
            println!("there is no Xvfb: no window is opened");
            return None;
        };
        let mut number = String::new();
        BufReader::new(server.stdout.as_mut().unwrap()).read_line(&mut number).unwrap();
        Some(Self { server, number: format!(":{}", number.trim()) })
    }

    fn viewer(&self, arguments: &[&str]) -> Viewer {
        let mut command = Command::new(example("viewer"));
        command.args(arguments).env("DISPLAY", &self.number).env_remove("WAYLAND_DISPLAY");
        Viewer::new(command)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.server.kill().unwrap();
        self.server.wait().unwrap();
    }
}

/// A viewer that runs.
struct Viewer {
    child: Child,
    lines: Receiver<String>,
}

impl Viewer {
    fn new(mut command: Command) -> Self {
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let (told, lines) = mpsc::channel();
        let output = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || output.lines().map_while(Result::ok).try_for_each(|l| told.send(l)));
        Self { child, lines }
    }

    /// What it says of the next picture that fits.
    fn settled(&mut self, fits: impl Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let line = self.lines.recv_timeout(PATIENCE.saturating_sub(start.elapsed()));
            let line = line.unwrap_or_else(|error| {
                self.child.kill().unwrap();
                let mut said = String::new();
                self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
                panic!("{error}, {}: {said}", self.child.wait().unwrap())
            });
            assert!(line.starts_with("settled "), "{line}");
            if fits(&line) {
                return line;
            }
        }
    }

    /// Waits until it ends; its exit code, and what it says of errors.
    fn end(mut self) -> (Option<i32>, String) {
        let start = Instant::now();
        while self.child.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < PATIENCE, "it does not end");
            thread::sleep(Duration::from_millis(50));
        }
        let mut said = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap().code(), said)
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        // It may have ended by itself.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

fn example(name: &str) -> PathBuf {
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let path = deps.parent().and_then(Path::parent).unwrap().join("examples").join(name);
    assert!(path.exists(), "there is no {}: run cargo build --examples", path.display());
    path
}

/// The pixels of the picture that a viewer writes before it ends.
fn screenshot(screen: &Screen, arguments: &[&str]) -> Vec<[u8; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let common = [SCENE, "--size", "600x400", "--background", "transparent", "--screenshot"];
    let arguments = [&common[..], &[path.to_str().unwrap()], arguments].concat();
    let (code, said) = screen.viewer(&arguments).end();
    assert_eq!(code, Some(0), "{said}");
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    assert!(info.width > 200 && info.height > 300, "{} x {}", info.width, info.height);
    bytes.as_chunks().0.to_vec()
}

fn covered(pixels: &[[u8; 4]]) -> usize {
    pixels.iter().filter(|pixel| pixel[3] > 0).count()
}

fn differing(a: &[[u8; 4]], b: &[[u8; 4]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
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
    let pointer = |arguments: &str| {
        let arguments = arguments.split(' ');
        Command::new("xdotool").args(arguments).env("DISPLAY", &screen.number).status()
    };
    if pointer("version").is_err() {
        println!("there is no xdotool: nothing is dragged");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("key.png");
    let arguments = [SCENE, "--backend", "cpu", "--size", "600x400", "--supersample", "1", "--log"];
    let mut viewer = screen.viewer(&[&arguments[..], &["--out", out.to_str().unwrap()]].concat());
    let part = |line: &str, name: &str| {
        line.split_once(name).unwrap().1.split([']', ' ']).next().unwrap().to_owned()
    };
    let eye = |line: &str| line.split_once("eye=").unwrap().1.split_once(']').unwrap().0.to_owned();
    let first = viewer.settled(|_| true);
    let drag =
        "mousemove 100 150 mousedown 1 sleep 0.2 mousemove 140 150 sleep 0.2 mousemove 180 160";
    assert!(pointer(&format!("{drag} sleep 0.2 mouseup 1")).unwrap().success());
    let turned = viewer.settled(|line| eye(line) != eye(&first));
    assert_ne!(eye(&turned), eye(&first));
    let count = |line: &str| part(line, "covered=").parse::<u32>().unwrap();
    assert!(pointer("click --repeat 3 --delay 50 4").unwrap().success());
    viewer.settled(|line| count(line) > count(&turned) * 5 / 4);
    // Without a window manager nothing has the focus.
    let focus = "search --onlyvisible --name puncta windowfocus --sync %1";
    assert!(pointer(&format!("{focus} key p")).unwrap().success());
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
        let (code, said) = screen.viewer(&arguments).end();
        assert_eq!(code, Some(1), "{said}");
        let line = said.lines().find(|line| line.starts_with("error: ") && line.contains(reason));
        assert!(line.is_some() && !said.contains("panicked"), "{said}");
    }
}

#[test]
fn a_window_needs_a_display() {
    let mut command = Command::new(example("viewer"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let (code, said) = Viewer::new(command).end();
    if cfg!(target_os = "linux") {
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains("error: there is no display") && !said.contains("panicked"),
            "{said}"
        );
    }
}
