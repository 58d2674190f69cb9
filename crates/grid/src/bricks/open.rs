/*!
Brick files that are opened: columns are views of the mapped file.

The file is mapped to memory, and pages of it are loaded when somebody looks at them, and dropped
when the memory is needed for something else. What is checked is read in the ordinary way, so that a
check leaves nothing in memory.
*/

use super::{
    check,
    error::{OpenError, Trouble},
    field::{in_steps, read_at},
    header::{
        Fault, Header, HeaderBytes, MAGIC, PAGE, PAGE_BYTES, Section, Tables, fault, sections,
    },
    shape::Shape,
    sums::{self, RUN, Sums},
};
use crate::Grid;
use memmap2::Mmap;
use puncta_core::{Attributes, Bounds, Column, Scalar, Scene, Sphere};
use std::{fs::File, io, marker::PhantomData, ops::Range, path::Path, sync::Arc};

/// What to check when a brick file is opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verify {
    /// Every byte. The whole file is read once, at the speed of the disk.
    #[default]
    Whole,
    /// The header, the tables, and the length of the file. Records and columns are not looked at:
    /// files of any size open at once, and what was altered in them is not found.
    Tables,
}

/// A scene and its grid in a file that is mapped to memory.
///
/// Columns are [shared](Column::shared): they read as slices and take no memory that the system
/// could not take back. To change one, as sorting does, is to load it as a whole.
///
/// # While it is open
///
/// The file must not be changed. One that is replaced, as [`convert`](crate::convert) does, is not
/// changed: the old one lives on, without a name, until it is closed. But if a program writes to
/// it, what is drawn is of no use, and Rust's promise that shared values stay what they are is
/// broken; if one cuts it short, then the system ends the process that looks at what is gone
/// (`SIGBUS`). No program can prevent that, so keep brick files where others only read them.
///
/// # Examples
///
/// See [`convert`](crate::convert).
#[derive(Debug)]
pub struct BrickFile {
    /// The records, in the order of the bricks, their ids and attributes.
    pub scene: Scene<Sphere>,
    /// The bricks.
    pub grid: Grid,
    inner: Bounds,
    outer: Bounds,
    ranges: Vec<[f64; 2]>,
}

impl BrickFile {
    /// Opens a file and checks every byte of it.
    ///
    /// # Errors
    ///
    /// When the file cannot be read or is not a brick file, was cut short, or altered.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Self::open_with(path, Verify::Whole)
    }

    /// Opens a file and checks what is asked for.
    ///
    /// # Errors
    ///
    /// As [`BrickFile::open`].
    pub fn open_with(path: impl AsRef<Path>, verify: Verify) -> Result<Self, OpenError> {
        let path = path.as_ref();
        open(path, verify).map_err(|problem| match problem {
            Problem::Read(error) => OpenError::Read { path: path.to_owned(), error },
            Problem::Invalid(Fault { byte, what, value }) => {
                OpenError::Invalid { path: path.to_owned(), byte, what, value }
            }
        })
    }

    /// Whether a file that starts with these bytes is a brick file.
    #[must_use]
    pub fn is_start(head: &[u8]) -> bool {
        head.starts_with(&MAGIC)
    }

    /// The world box around all records, radii included: [`Scene::bounds`], without looking at
    /// them.
    #[must_use]
    pub const fn bounds(&self) -> Bounds {
        self.outer
    }

    /// The world box around nearly all records: [`Scene::inner_bounds`] of the scene that was
    /// converted, for a share of 0.001.
    #[must_use]
    pub const fn inner_bounds(&self) -> Bounds {
        self.inner
    }

    /// The range of a world coordinate, x, y or z, of all records but a share of 0.002 at either
    /// end: that of [`inner_range`](puncta_core::inner_range).
    ///
    /// # Panics
    ///
    /// When there is no axis `axis`.
    #[must_use]
    pub fn axis_range(&self, axis: usize) -> [f64; 2] {
        assert!(axis < 3, "there is no axis {axis}");
        self.ranges[axis]
    }

    /// The range of a scalar, likewise; `None` if there is none of this name.
    #[must_use]
    pub fn scalar_range(&self, name: &str) -> Option<[f64; 2]> {
        let mut scalars = self.scene.attributes.scalars.iter();
        let index = scalars.position(|scalar| scalar.name == name)?;
        self.ranges.get(3 + index).copied()
    }
}

/// What is wrong with a file.
enum Problem {
    Read(io::Error),
    Invalid(Fault),
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

impl From<Fault> for Problem {
    fn from(fault: Fault) -> Self {
        Self::Invalid(fault)
    }
}

fn open(path: &Path, verify: Verify) -> Result<BrickFile, Problem> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if !metadata.is_file() {
        return Err(io::Error::other("this is not a regular file").into());
    }
    let length = metadata.len();
    let mut page: HeaderBytes = [0; PAGE_BYTES];
    let whole = usize::try_from(length.min(PAGE)).unwrap_or(0);
    read_at(&file, &mut page[..whole], 0)?;
    if length < PAGE && BrickFile::is_start(&page) {
        return Err(fault(length, format!("the header must have {PAGE} bytes"), length).into());
    }
    let header = Header::decode(&page, length)?;
    // The header says what the length of the file says: that much is there.
    let mut bytes = Vec::new();
    let count = usize::try_from(header.tables_bytes).map_err(io::Error::other)?;
    bytes.try_reserve_exact(count).map_err(io::Error::other)?;
    bytes.resize(count, 0);
    read_at(&file, &mut bytes, header.tables_start)?;
    let found = sums::sum(&bytes);
    if found != header.tables_sum {
        let what = format!("the checksum of the tables must be {found:#010x}");
        return Err(fault(240, what, format!("{:#010x}", header.tables_sum)).into());
    }
    let mut tables = Tables::decode(&header, &bytes)?;
    drop(bytes);
    let bricks = std::mem::take(&mut tables.bricks);
    let grid = check::grid(&header, bricks, std::mem::take(&mut tables.codes))?;
    let names = std::mem::take(&mut tables.names);
    let shape = Shape { colors: header.colors, elements: header.elements, scalars: names };
    let sections = sections(header.records, &shape);
    if verify == Verify::Whole {
        for (section, sums) in sections.iter().zip(&tables.sums) {
            check_sums(&file, section, sums)?;
        }
    }
    let map = Arc::new(map(&file)?);
    let mut scene = scene(&map, &sections, shape);
    scene.origin = header.origin;
    let Header { inner, outer, .. } = header;
    Ok(BrickFile { scene, grid, inner, outer, ranges: tables.ranges })
}

/// Maps a file to memory.
fn map(file: &File) -> io::Result<Mmap> {
    #[expect(unsafe_code, reason = "nobody can promise that a file is not changed")]
    // SAFETY: The values are plain numbers, so every byte is a valid one, and the map lives as long
    // as the slices that are taken of it. That nobody changes the file meanwhile is asked of the
    // user, by the docs of `BrickFile`; it is mapped for reading, so nothing here changes it.
    unsafe {
        Mmap::map(file)
    }
}

/// Compares the bytes of a section with their sums.
fn check_sums(file: &File, section: &Section, sums: &[u32]) -> Result<(), Problem> {
    let step = usize::try_from(RUN).unwrap_or(usize::MAX);
    let wrong = std::sync::Mutex::new(None::<Fault>);
    let work = |buffer: &mut Vec<u8>, bytes: Range<u64>| {
        let mut run = Sums::default();
        let mut at = bytes.start;
        while at < bytes.end {
            let count = usize::try_from(bytes.end - at).unwrap_or(usize::MAX).min(buffer.len());
            let now = &mut buffer[..count];
            read_at(file, now, section.start + at).map_err(Trouble::reading)?;
            run.add(now);
            at += count as u64;
        }
        let index = usize::try_from(bytes.start / RUN).unwrap_or(usize::MAX);
        let (stored, found) = (sums.get(index).copied(), run.finish().first().copied());
        if stored != found
            && let Ok(mut wrong) = wrong.lock()
        {
            let sum =
                |sum: Option<u32>| sum.map_or("none".to_owned(), |sum| format!("{sum:#010x}"));
            let last = section.start + bytes.end - 1;
            let what = format!("the checksum of the bytes up to {last} must be {}", sum(stored));
            let byte = section.start + bytes.start;
            if wrong.as_ref().is_none_or(|first| byte < first.byte) {
                *wrong = Some(fault(byte, what, sum(found)));
            }
        }
        Ok(())
    };
    let read = in_steps((section.padded, step), || vec![0; 1 << 18], work);
    if let Err(Trouble::File { error, .. }) = read {
        return Err(error.into());
    }
    match wrong.into_inner().ok().flatten() {
        Some(fault) => Err(fault.into()),
        None => Ok(()),
    }
}

/// The scene in a mapped file.
fn scene(map: &Arc<Mmap>, sections: &[Section], shape: Shape) -> Scene<Sphere> {
    let mut sections = sections.iter();
    let records = column(map, sections.next());
    let ids = Some(column(map, sections.next()));
    let colors = shape.colors.then(|| column(map, sections.next()));
    let elements = shape.elements.then(|| column(map, sections.next()));
    let names = shape.scalars.into_iter();
    let scalars = names.map(|name| Scalar { name, values: column(map, sections.next()) }).collect();
    let mut scene = Scene::new(records);
    scene.attributes = Attributes { ids, colors, elements, scalars };
    scene
}

/// Values in a mapped file.
struct Values<T> {
    map: Arc<Mmap>,
    bytes: Range<usize>,
    values: PhantomData<fn() -> T>,
}

impl<T: bytemuck::Pod> AsRef<[T]> for Values<T> {
    fn as_ref(&self) -> &[T] {
        // Sections start at pages, and have room for whole values: neither can fail.
        let bytes = self.map.get(self.bytes.clone()).unwrap_or_default();
        bytemuck::try_cast_slice(bytes).unwrap_or_default()
    }
}

/// The values of a section.
fn column<T: bytemuck::Pod + Send + Sync>(map: &Arc<Mmap>, section: Option<&Section>) -> Column<T> {
    let range = |section: &Section| {
        let start = usize::try_from(section.start).ok()?;
        Some(start..start.checked_add(usize::try_from(section.bytes).ok()?)?)
    };
    let bytes = section.and_then(range).unwrap_or(0..0);
    if bytes.is_empty() {
        return Column::new();
    }
    Column::shared(Values { map: Arc::clone(map), bytes, values: PhantomData })
}
