//! Programs with windows, on a screen that is not there: needs `Xvfb`.

use std::{
    fs::File,
    io::{BufRead, BufReader, Read},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::{Duration, Instant},
};

/// How long a window may take: software drivers on busy machines are slow.
pub(crate) const PATIENCE: Duration = Duration::from_secs(120);

/// A screen in memory.
pub(crate) struct Screen {
    server: Child,
    number: String,
}

impl Screen {
    /// A new screen; `None`, and a line that says so, where windows cannot be tested.
    pub(crate) fn new() -> Option<Self> {
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

    /// Runs an example on it.
    pub(crate) fn run(&self, example: &str, arguments: &[&str]) -> Running {
        let mut command = Command::new(path_of(example));
        command.args(arguments).env("DISPLAY", &self.number).env_remove("WAYLAND_DISPLAY");
        Running::new(command)
    }

    /// Does something with the mouse or the keys; `None`, and a line that says so, without `xdotool`.
    pub(crate) fn input(&self, arguments: &str) -> Option<ExitStatus> {
        let mut command = Command::new("xdotool");
        let status = command.args(arguments.split(' ')).env("DISPLAY", &self.number).status().ok();
        if status.is_none() {
            println!("there is no xdotool: nothing is dragged");
        }
        status
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.server.kill().unwrap();
        self.server.wait().unwrap();
    }
}

/// A program that runs.
pub(crate) struct Running {
    child: Child,
    lines: Receiver<String>,
}

impl Running {
    pub(crate) fn new(mut command: Command) -> Self {
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let (told, lines) = mpsc::channel();
        let output = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || output.lines().map_while(Result::ok).try_for_each(|l| told.send(l)));
        Self { child, lines }
    }

    /// The next line that it says and that fits.
    pub(crate) fn line(&mut self, fits: impl Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let line = self.lines.recv_timeout(PATIENCE.saturating_sub(start.elapsed()));
            let line = line.unwrap_or_else(|error| {
                self.child.kill().unwrap();
                let mut said = String::new();
                self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
                panic!("{error}, {}: {said}", self.child.wait().unwrap())
            });
            if fits(&line) {
                return line;
            }
        }
    }

    /// Waits until it ends; its exit code, and what it says of errors.
    pub(crate) fn end(mut self) -> (Option<i32>, String) {
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

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

pub(crate) fn path_of(name: &str) -> PathBuf {
    // Tests lie in `deps`, examples beside it.
    let deps = std::env::current_exe().unwrap();
    let path = deps.parent().and_then(Path::parent).unwrap().join("examples").join(name);
    assert!(path.exists(), "there is no {}: run cargo build --examples", path.display());
    path
}

/// What a picture holds; it must have more than 200 columns and 300 rows.
pub(crate) fn pixels(path: &Path) -> Vec<[u8; 4]> {
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    assert!(info.width > 200 && info.height > 300, "{} x {}", info.width, info.height);
    bytes.as_chunks().0.to_vec()
}

pub(crate) fn covered(pixels: &[[u8; 4]]) -> usize {
    pixels.iter().filter(|pixel| pixel[3] > 0).count()
}

pub(crate) fn differing(a: &[[u8; 4]], b: &[[u8; 4]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}
