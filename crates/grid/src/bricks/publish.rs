/*!
Files that appear when they are complete.

On Linux a file is made without a name (`O_TMPFILE`). It gets one when everything is written and on
the disk, by `linkat`; until then it vanishes with the process, however that ends. Where a file of
that name is there already, the new one must be renamed to replace it. So it has a hidden name for
the time between two system calls.

Elsewhere, and on file systems without such files, a file has a hidden name from the start. It is
removed on errors, but stays if the process is killed.
*/

use std::{
    ffi::OsString,
    fs::{self, File},
    io,
    path::{Path, PathBuf},
    process,
    sync::Arc,
};

/// A file in the making.
#[derive(Debug)]
pub(crate) struct Unborn {
    pub(crate) file: Arc<File>,
    path: PathBuf,
    /// The hidden name, if it has one.
    hidden: Option<PathBuf>,
}

impl Unborn {
    /// A file that will have this name.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if let Some(file) = unnamed(path)? {
            return Ok(Self { file: Arc::new(file), path: path.to_owned(), hidden: None });
        }
        let hidden = hidden(path);
        let file = File::options().read(true).write(true).create_new(true).open(&hidden)?;
        Ok(Self { file: Arc::new(file), path: path.to_owned(), hidden: Some(hidden) })
    }

    /// Brings what was written to the disk, then lets the file appear.
    pub(crate) fn publish(mut self) -> io::Result<()> {
        self.file.sync_all()?;
        if self.hidden.is_none() {
            match link(&self.file, &self.path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let hidden = hidden(&self.path);
                    link(&self.file, &hidden)?;
                    self.hidden = Some(hidden);
                }
                linked => linked?,
            }
        }
        if let Some(hidden) = &self.hidden {
            fs::rename(hidden, &self.path)?;
            self.hidden = None;
        }
        sync_folder(&self.path)
    }
}

impl Drop for Unborn {
    fn drop(&mut self) {
        if let Some(hidden) = &self.hidden {
            // What is left is of no use; that it cannot be removed is not the first error.
            fs::remove_file(hidden).ok();
        }
    }
}

/// The folder in which a file of this name lies.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A hidden name beside `path`.
fn hidden(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", process::id()));
    path.with_file_name(name)
}

/// A file without a name, if there can be one.
#[cfg(target_os = "linux")]
fn unnamed(path: &Path) -> io::Result<Option<File>> {
    use rustix::{
        fs::{CWD, Mode, OFlags, openat},
        io::Errno,
    };
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match openat(CWD, folder(path), flags, Mode::from_raw_mode(0o666)) {
        // What kernels and file systems say that have no such files.
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::INVAL) => Ok(None),
        Err(error) => Err(error.into()),
        // Without `/proc` it could never get its name.
        Ok(file) => Ok(Path::new("/proc/self/fd").exists().then(|| file.into())),
    }
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_path: &Path) -> io::Result<Option<File>> {
    Ok(None)
}

/// Gives a file without a name this one.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let open = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, open, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn link(_file: &File, _path: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Brings the name of a file to the disk.
fn sync_folder(path: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder(path))?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn names(folder: &Path) -> Vec<OsString> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_when_they_are_published_and_replace_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bricks");
        for text in ["first", "second"] {
            let before = names(folder.path());
            drop(Unborn::create(&path).unwrap());
            let unborn = Unborn::create(&path).unwrap();
            (&*unborn.file).write_all(text.as_bytes()).unwrap();
            if cfg!(target_os = "linux") {
                assert_eq!(names(folder.path()), before, "it has a name before its time");
            }
            unborn.publish().unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
            assert_eq!(names(folder.path()), ["a.bricks"]);
        }
    }

    #[test]
    fn a_hidden_file_is_removed_or_renamed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bricks");
        let make = || {
            let hidden = hidden(&path);
            let file = Arc::new(File::create_new(&hidden).unwrap());
            Unborn { file, path: path.clone(), hidden: Some(hidden) }
        };
        drop(make());
        assert!(names(folder.path()).is_empty());
        make().publish().unwrap();
        assert_eq!(names(folder.path()), ["a.bricks"]);
    }

    #[test]
    fn places_where_no_file_can_be_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Unborn::create(folder.path()).is_err());
        assert!(Unborn::create(&folder.path().join("missing").join("a.bricks")).is_err());
    }
}
