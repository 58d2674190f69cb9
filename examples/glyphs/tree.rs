//! A folder and all that lies below it: sizes, ages and lines.

use super::glyphs::progress::Bar;
use anyhow::{Context, Result, bail};
use clap::Args;
use std::{
    collections::BTreeMap,
    fs::{self, DirEntry},
    io::Read,
    path::{Path, PathBuf},
    time::SystemTime,
};

/// Which folder, and what not to look at.
#[derive(Clone, Debug, Args)]
pub(crate) struct Where {
    /// The folder whose files are drawn
    #[arg(default_value = ".")]
    pub(crate) folder: PathBuf,

    /// Names of folders and files to leave out
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_value = "target,node_modules"
    )]
    pub(crate) without: Vec<String>,

    /// Take names that start with a dot too
    #[arg(long)]
    pub(crate) hidden: bool,
}

/// A folder with something in it.
#[derive(Debug)]
pub(crate) struct Folder {
    pub(crate) name: String,
    /// The bytes of all files below.
    pub(crate) bytes: u64,
    /// The largest first, as are the folders.
    pub(crate) files: Vec<File>,
    pub(crate) folders: Vec<Self>,
}

/// A file that is not empty.
#[derive(Debug)]
pub(crate) struct File {
    /// What follows the last dot of its name, in lower case.
    pub(crate) kind: String,
    pub(crate) bytes: u64,
    /// Ends of lines; 0 unless they were asked for, and if it is no text.
    pub(crate) lines: u64,
    /// How long ago it was changed, in seconds.
    pub(crate) age: f64,
}

/// What was found.
#[derive(Debug)]
pub(crate) struct Tree {
    pub(crate) root: Folder,
    /// What was left out, in words.
    pub(crate) notes: Vec<String>,
}

impl Folder {
    /// All files below.
    pub(crate) fn all_files(&self) -> Vec<&File> {
        let below = self.folders.iter().flat_map(Self::all_files);
        self.files.iter().chain(below).collect()
    }

    /// The number of folders below.
    pub(crate) fn folder_count(&self) -> usize {
        self.folders.iter().map(|folder| 1 + folder.folder_count()).sum()
    }
}

/// Looks at everything below a folder. Links are not followed.
pub(crate) fn read(options: &Where, with_lines: bool) -> Result<Tree> {
    let path = &options.folder;
    let about = fs::metadata(path).with_context(|| path.display().to_string())?;
    if !about.is_dir() {
        bail!("{}: this is no folder", path.display());
    }
    let mut walk = Walk {
        options,
        with_lines,
        now: SystemTime::now(),
        skipped: BTreeMap::new(),
        bar: Bar::spinner("reading"),
    };
    let entries = fs::read_dir(path).with_context(|| path.display().to_string())?;
    let root = walk.folder(path, entries);
    walk.bar.finish();
    if root.bytes == 0 {
        bail!("{}: there is no file below it that is not empty{}", path.display(), walk.told());
    }
    let notes = walk.skipped.iter().map(|(why, (count, first))| {
        let more = if *count > 1 { ", the first is" } else { ":" };
        format!("{count} {why}{more} {}", first.display())
    });
    Ok(Tree { root, notes: notes.collect() })
}

struct Walk<'a> {
    options: &'a Where,
    with_lines: bool,
    now: SystemTime,
    /// How many there are of each sort, and the first of them.
    skipped: BTreeMap<String, (u64, PathBuf)>,
    bar: Bar,
}

impl Walk<'_> {
    fn skip(&mut self, why: impl Into<String>, path: &Path) {
        self.skipped.entry(why.into()).or_insert((0, path.to_owned())).0 += 1;
    }

    /// What was skipped, for an error.
    fn told(&self) -> String {
        self.skipped.iter().map(|(why, (count, _))| format!("; {count} {why}")).collect()
    }

    fn folder(&mut self, path: &Path, entries: fs::ReadDir) -> Folder {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let mut folder = Folder { name, bytes: 0, files: vec![], folders: vec![] };
        let mut found: Vec<DirEntry> = Vec::new();
        for entry in entries {
            match entry {
                Ok(entry) => found.push(entry),
                Err(error) => self.skip(format!("entries cannot be read ({error})"), path),
            }
        }
        // Systems list them in any order.
        found.sort_by_key(DirEntry::file_name);
        for entry in found {
            self.entry(&entry, &mut folder);
        }
        folder.bytes = folder.files.iter().map(|file| file.bytes).sum::<u64>()
            + folder.folders.iter().map(|folder| folder.bytes).sum::<u64>();
        folder.files.sort_by_key(|file| std::cmp::Reverse(file.bytes));
        folder.folders.sort_by_key(|folder| std::cmp::Reverse(folder.bytes));
        folder
    }

    fn entry(&mut self, entry: &DirEntry, folder: &mut Folder) {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if !self.options.hidden && name.starts_with('.') {
            return self.skip("hidden names left out", &path);
        }
        if self.options.without.contains(&name) {
            return self.skip(format!("times {name} left out"), &path);
        }
        let about = match fs::symlink_metadata(&path) {
            Ok(about) => about,
            Err(error) => return self.skip(format!("files cannot be read ({error})"), &path),
        };
        if about.is_dir() {
            match fs::read_dir(&path) {
                Ok(entries) => {
                    let below = self.folder(&path, entries);
                    if below.bytes > 0 {
                        folder.folders.push(below);
                    }
                }
                Err(error) => self.skip(format!("folders cannot be read ({error})"), &path),
            }
        } else if !about.is_file() {
            self.skip("links and other special files left out", &path);
        } else if about.len() == 0 {
            self.skip("empty files left out", &path);
        } else {
            match self.file(&path, &about) {
                Ok(file) => folder.files.push(file),
                Err(error) => self.skip(format!("files cannot be read ({error})"), &path),
            }
        }
    }

    fn file(&self, path: &Path, about: &fs::Metadata) -> std::io::Result<File> {
        let kind = path.extension().map(|kind| kind.to_string_lossy().to_lowercase());
        let changed = about.modified()?;
        // Clocks may differ: what was changed in the future is new.
        let age = self.now.duration_since(changed).map_or(0.0, |age| age.as_secs_f64());
        let lines = if self.with_lines { lines(path)? } else { 0 };
        Ok(File { kind: kind.unwrap_or_default(), bytes: about.len(), lines, age })
    }
}

/// The number of ends of lines in a file; 0 if it holds a zero, which no text does.
fn lines(path: &Path) -> std::io::Result<u64> {
    let mut file = fs::File::open(path)?;
    let (mut buffer, mut lines) = (vec![0; 1 << 16], 0);
    loop {
        let read = file.read(&mut buffer)?;
        if read == 0 {
            return Ok(lines);
        }
        if buffer[..read].contains(&0) {
            return Ok(0);
        }
        lines += buffer[..read].iter().filter(|byte| **byte == b'\n').count() as u64;
    }
}
