//! Writers: the name of a file tells its format.

use crate::{
    error::{Error, ErrorKind, Fault, quote},
    mmpld, ply, xyz,
};
use puncta_core::{Scene, Sphere};
use std::{
    ffi::OsString,
    fs::{self, File},
    io::{self, BufWriter},
    path::{Path, PathBuf},
    process,
    sync::atomic::{AtomicU64, Ordering},
};

/// A writer of one format.
type WriteScene = fn(&mut BufWriter<File>, &Scene<Sphere>) -> Result<(), Fault>;

/// Writes a scene; the name says in which format.
///
/// Names end in `.xyz` or `.extxyz` for extended XYZ, in `.ply` for binary PLY, and in `.mmpld` for
/// MMPLD 1.3, which keeps radii and either colors or the scalar `intensity`, but nothing else. A new file takes the place of an old one of
/// this name once it is complete: a write that is interrupted leaves the old one as it was.
///
/// # Errors
///
/// When the file cannot be written, or its name ends in something else, or an attribute of the
/// scene does not have one value for each record.
pub fn write(path: impl AsRef<Path>, scene: &Scene<Sphere>) -> Result<(), Error> {
    let path = path.as_ref();
    let write = || {
        let write_scene = writer(path)?;
        scene.validate().map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
        replace(path, |file| write_scene(file, scene))
    };
    write().map_err(|fault: Fault| fault.in_file(path))
}

/// The writer for a file of this name.
fn writer(path: &Path) -> Result<WriteScene, Fault> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match extension.as_str() {
        "xyz" | "extxyz" => Ok(|file, scene| Ok(xyz::write(file, scene)?)),
        "ply" => Ok(ply::write),
        "mmpld" => Ok(mmpld::write),
        other => {
            let what =
                "the name of a file to write must end in .xyz, .extxyz, .ply or .mmpld".to_owned();
            let value = if other.is_empty() {
                "without an ending".to_owned()
            } else {
                quote(format!(".{other}").as_bytes())
            };
            Err(ErrorKind::Invalid { what, value }.into())
        }
    }
}

/// Writes a file under another name beside `path`, and renames it when it is complete.
fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let temporary = temporary_name(path);
    let create = || {
        let mut file = BufWriter::with_capacity(1 << 16, File::create_new(&temporary)?);
        write(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        Ok(fs::rename(&temporary, path)?)
    };
    create().inspect_err(|_| {
        // What is left of the file is of no use; that it cannot be removed is not the first error.
        fs::remove_file(&temporary).ok();
    })
}

/// A name beside `path` that nobody else takes.
fn temporary_name(path: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{count}.part", process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_written_file_can_be_read_and_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.XYZ");
        for count in [3, 1] {
            let scene = Scene::new(vec![Sphere::new([0.5, -1.0, 2.0], 0.25); count]);
            write(&path, &scene).unwrap();
            let again = crate::read(&path).unwrap();
            assert_eq!(again.records.len(), count);
            assert_eq!(again.position(count - 1), scene.position(0));
            assert_eq!(again.records[0].radius, 0.25);
        }
        assert_eq!(names(folder.path()), ["a.XYZ"]);
    }

    #[test]
    fn endings_without_a_writer_are_refused() {
        let scene = Scene::new(Vec::new());
        for (name, value) in
            [("a.pdb", "\".pdb\""), ("a.xyz.gz", "\".gz\""), ("a", "without an ending")]
        {
            let error = write(name, &scene).unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("{name}: the name of a file to write must")),
                "{error}"
            );
            assert!(error.ends_with(&format!(", not {value}")), "{error}");
            assert!(!Path::new(name).exists());
        }
    }

    #[test]
    fn a_write_that_fails_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.xyz");
        fs::write(&path, "old").unwrap();
        let fault = replace(&path, |file| {
            file.write_all(&[0; 1 << 17])?;
            Err(io::Error::other("the disk is full").into())
        });
        let error = fault.unwrap_err().in_file("a.xyz").to_string();
        assert_eq!(error, "a.xyz: the disk is full");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["a.xyz"]);
    }

    #[test]
    fn a_scene_that_is_not_whole_is_refused() {
        let mut scene = Scene::new(vec![Sphere::default()]);
        scene.attributes.elements = Some(Vec::new().into());
        let error = write("a.xyz", &scene).unwrap_err().to_string();
        assert_eq!(error, "a.xyz: attribute elements has 0 values for 1 records");
        let nowhere = write("no-such-folder/a.xyz", &Scene::new(Vec::new())).unwrap_err();
        assert!(nowhere.to_string().starts_with("no-such-folder/a.xyz: "));
    }
}
