//! Runs the examples that draw glyphs in a folder of their own.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// Runs the tools in a folder of their own.
pub(crate) struct Tools {
    folder: TempDir,
}

/// A small picture with little light.
const SMALL: [&str; 8] =
    ["--size", "96x64", "--sky", "4", "--supersample", "1", "--out", "out.png"];

impl Tools {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn run(&self, tool: &str, arguments: &[&str]) -> Output {
        // Tests lie in `deps`, examples beside it.
        let deps = std::env::current_exe().unwrap();
        let profile = deps.parent().and_then(Path::parent).unwrap();
        let tool = profile.join("examples").join(tool);
        assert!(tool.exists(), "there is no {}: run cargo build --examples", tool.display());
        Command::new(tool).args(arguments).current_dir(self.folder.path()).output().unwrap()
    }

    /// Draws a small picture, which must succeed; its bytes, and what was said and noted.
    pub(crate) fn draw(&self, tool: &str, arguments: &[&str]) -> (Vec<u8>, String, String) {
        let output = self.run(tool, &[arguments, &SMALL].concat());
        let [said, noted] = [text(&output.stdout), text(&output.stderr)];
        assert!(output.status.success(), "{tool} {arguments:?}: {noted}");
        assert!(said.contains("records of") && said.contains("out.png"), "{said}");
        let bytes = fs::read(self.path("out.png")).unwrap();
        assert!(bytes.starts_with(b"\x89PNG"));
        (bytes, said, noted)
    }

    /// Runs a tool, which must fail as a tool should; returns what it says.
    pub(crate) fn fail(&self, tool: &str, arguments: &[&str]) -> String {
        let output = self.run(tool, &[arguments, &SMALL].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{tool} {arguments:?}: {said}");
        assert!(said.contains("error: ") && !said.contains("panicked"), "{said}");
        assert!(!self.path("out.png").exists(), "a picture was written all the same");
        said
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), content).unwrap();
    }
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
