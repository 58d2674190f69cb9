/*!
Files as sources: records in chunks, for files that are larger than memory.

A file is read twice. The first time no rows are kept: it tells how many there are, and what a
reader knows only at the end, as the origin and the radius of rows without one (see
`builder::survey`). The second time its rows come in chunks, from a thread of its own, and they are
those that [`ReadOptions::read`] gives, bit by bit. A third reading, in between, finds the distances
between records where a radius must be estimated.

The reader is to find the same rows each time. If the file was changed in between, so that positions
or radii are others, then the source ends with an error.
*/

#[cfg(test)]
pub(crate) mod tests;

use crate::{
    builder::{Chunks, Outlet, Report, Sink, Survey, estimated},
    error::{Error, Fault},
    feed::Feed,
    format::Format,
    options::{Loaded, ReadOptions, open},
    radius::Nearest,
};
use puncta_core::{Bounds, Record, Scene, Source, Sphere};
use std::{
    fs::File,
    io::Cursor,
    ops::Range,
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

impl ReadOptions {
    /// Reads a file in chunks, in memory that does not depend on how many records it has, where its
    /// format allows that: see [`FileSource`].
    ///
    /// The file is read here once as a whole, and twice if it gives no radius and none is given by
    /// [`radius`](Self::radius); then once more as its records are asked for. What is given to
    /// [`on_progress`](Self::on_progress) is called each time, the last time from another thread.
    ///
    /// # Errors
    ///
    /// When the file cannot be read: see [`ErrorKind`](crate::ErrorKind).
    pub fn stream(&self, path: impl AsRef<Path>) -> Result<FileSource, Error> {
        let path = path.as_ref();
        let start = || {
            let (file, _) = open(path)?;
            FileSource::start(self, path, Bytes::File(file))
        };
        start().map_err(|fault: Fault| fault.in_file(path))
    }

    /// Reads a file that is in memory in chunks; `name` serves for messages and the format.
    ///
    /// # Errors
    ///
    /// When the file cannot be read: see [`ErrorKind`](crate::ErrorKind).
    pub fn stream_bytes(
        &self,
        name: impl AsRef<Path>,
        bytes: impl Into<Arc<[u8]>>,
    ) -> Result<FileSource, Error> {
        let name = name.as_ref();
        FileSource::start(self, name, Bytes::Memory(bytes.into()))
            .map_err(|fault| fault.in_file(name))
    }
}

/// The records of a file, in chunks.
///
/// They are those that [`ReadOptions::read`] gives, bit by bit, with the same origin, attributes
/// and ids, and in the same order. There is one exception: atoms of a LAMMPS dump that is not
/// ordered by their ids keep the order of the file. If the ids are consecutive then
/// [`Attributes::ids`] tells the order that `read` gives; else it tells their rows.
/// [`report`](Self::report) has a warning.
///
/// What is held in memory depends on the format, but only for the last three lines of this table on
/// the size of the file:
///
/// | format | what is held |
/// | --- | --- |
/// | XYZ, PDB, LAMMPS, PLY, MMPLD, LAS, LAZ | 4 MB: a few chunks and buffers (LAZ: 6 MB) |
/// | XYZ, PDB, LAMMPS, PLY, MMPLD of one list, compressed with gzip | the same |
/// | MMPLD of several lists, compressed with gzip | a frame, decompressed |
/// | LAS and LAZ, compressed with gzip | the whole file, decompressed |
/// | VTK | all records: its columns follow each other |
///
/// The file should not change meanwhile; if its records do, then the source ends with
/// [`ErrorKind::Changed`](crate::ErrorKind::Changed). After an error nothing more comes.
///
/// # Examples
///
/// ```
/// use puncta_core::{Scene, Source};
/// use puncta_io::ReadOptions;
///
/// let file = b"3\nwater\nO 0.0 0.0 0.1\nH 0.0 0.8 -0.5\nH 0.0 -0.8 -0.5\n";
/// let mut source = ReadOptions::default().stream_bytes("water.xyz", *file)?;
/// assert_eq!(source.count(), 3);
///
/// let mut chunk = Scene::new(Vec::new());
/// assert_eq!(source.append(&mut chunk, 2)?, 2);
/// assert_eq!(chunk.attributes.elements, Some(vec![8, 1].into()));
/// // Fewer than asked for: this is the end.
/// assert_eq!(source.append(&mut chunk, 2)?, 1);
/// # Ok::<(), puncta_io::Error>(())
/// ```
///
/// [`Attributes::ids`]: puncta_core::Attributes::ids
#[derive(Debug)]
pub struct FileSource {
    path: PathBuf,
    format: Format,
    report: Report,
    centers: Bounds,
    count: u64,
    left: u64,
    /// What was read and not given so far: the rows of a chunk from this one on.
    chunk: Scene,
    next: usize,
    /// Where more comes from.
    feed: Option<Feed>,
}

impl FileSource {
    /// The format of the file.
    #[must_use]
    pub const fn format(&self) -> Format {
        self.format
    }

    /// What was skipped in the whole file, and what else was found: known from the start.
    #[must_use]
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// How many records the file has, whether they were given already or not.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The world box around the centers of all records; radii are not included.
    #[must_use]
    pub const fn centers(&self) -> Bounds {
        self.centers
    }

    /// Finds out what is in a file, and starts to read it.
    fn start(options: &ReadOptions, path: &Path, bytes: Bytes) -> Result<Self, Fault> {
        let bytes = Arc::new(bytes);
        let found = Arc::new(OnceLock::new());
        let surveying = options.with_sink(Sink::Survey(Arc::clone(&found)));
        let Loaded { scene, format, mut report } = bytes.read(&surveying, path)?;
        drop(surveying);
        let Some(mut survey) = Arc::into_inner(found).and_then(OnceLock::into_inner) else {
            return Ok(Self::held(path, format, report, scene));
        };
        let reading = Reading { options: options.clone(), path: path.to_owned(), bytes };
        if let Some(positions) = survey.sample() {
            let mut nearest = Nearest::new(positions);
            let mut feed = reading.clone().start(&survey)?;
            while let Some(chunk) = feed.next()? {
                nearest.look_at(&chunk.records);
            }
            survey.set_estimate(estimated(nearest.radius(), options), &mut report);
        }
        let [min, max] = survey.centers();
        Ok(Self {
            path: path.to_owned(),
            format,
            report,
            centers: Bounds { min, max },
            count: survey.count,
            left: survey.count,
            chunk: Scene::new(Vec::new()),
            next: 0,
            feed: Some(reading.start(&survey)?),
        })
    }

    /// A file whose records are held.
    fn held(path: &Path, format: Format, report: Report, scene: Scene) -> Self {
        let mut centers = Bounds::EMPTY;
        for record in &scene.records {
            centers.add(scene.origin + record.position().as_dvec3());
        }
        let (path, count) = (path.to_owned(), scene.records.len() as u64);
        Self {
            path,
            format,
            report,
            centers,
            count,
            left: count,
            chunk: scene,
            next: 0,
            feed: None,
        }
    }

    /// Takes the next chunk; false at the end.
    fn advance(&mut self) -> Result<bool, Error> {
        let Some(feed) = &mut self.feed else { return Ok(false) };
        match feed.next() {
            Ok(Some(chunk)) => {
                (self.chunk, self.next) = (chunk, 0);
                Ok(true)
            }
            Ok(None) => Ok(false),
            Err(fault) => Err(fault.in_file(&self.path)),
        }
    }
}

impl Source for FileSource {
    type Record = Sphere;
    type Error = Error;

    /// How many records are still to come, exactly.
    fn remaining(&self) -> Option<u64> {
        Some(self.left)
    }

    /// Appends to a scene that is empty, was cleared, or holds what this source gave before.
    fn append(&mut self, scene: &mut Scene, limit: usize) -> Result<usize, Error> {
        let mut appended = 0;
        while appended < limit {
            let rows =
                self.next..self.chunk.records.len().min(self.next.saturating_add(limit - appended));
            if rows.is_empty() {
                if !self.advance()? {
                    break;
                }
                continue;
            }
            self.next = rows.end;
            self.left = self.left.saturating_sub(rows.len() as u64);
            appended += rows.len();
            append_rows(scene, &self.chunk, rows);
        }
        Ok(appended)
    }
}

/// Appends some rows of a chunk and their attributes.
fn append_rows(scene: &mut Scene, chunk: &Scene, rows: Range<usize>) {
    scene.origin = chunk.origin;
    let (to, from) = (&mut scene.attributes, &chunk.attributes);
    scene.records.to_mut().extend_from_slice(&chunk.records[rows.clone()]);
    if let Some(ids) = &from.ids {
        to.ids.get_or_insert_default().to_mut().extend_from_slice(&ids[rows.clone()]);
    }
    if let Some(colors) = &from.colors {
        to.colors.get_or_insert_default().to_mut().extend_from_slice(&colors[rows.clone()]);
    }
    if let Some(elements) = &from.elements {
        to.elements.get_or_insert_default().to_mut().extend_from_slice(&elements[rows.clone()]);
    }
    for (index, scalar) in from.scalars.iter().enumerate() {
        if index == to.scalars.len() {
            let name = scalar.name.clone();
            to.scalars.push(puncta_core::Scalar { name, values: puncta_core::Column::new() });
        }
        to.scalars[index].values.to_mut().extend_from_slice(&scalar.values[rows.clone()]);
    }
}

/// The bytes of a file.
enum Bytes {
    File(File),
    Memory(Arc<[u8]>),
}

impl Bytes {
    /// Reads them from the start.
    fn read(&self, options: &ReadOptions, name: &Path) -> Result<Loaded, Fault> {
        match self {
            Self::File(file) => {
                let length = file.metadata()?.len();
                let mut file = file;
                std::io::Seek::rewind(&mut file)?;
                options.read_stream(name, file, length)
            }
            Self::Memory(bytes) => {
                options.read_stream(name, Cursor::new(&**bytes), bytes.len() as u64)
            }
        }
    }
}

/// What a reader on another thread needs.
#[derive(Clone)]
struct Reading {
    options: ReadOptions,
    path: PathBuf,
    bytes: Arc<Bytes>,
}

impl Reading {
    /// Starts a reader of the rows that were surveyed.
    fn start(self, survey: &Survey) -> Result<Feed, Fault> {
        let survey = Arc::new(survey.clone());
        Feed::start(move |outlet: Outlet| {
            let options = self.options.with_sink(Sink::Chunks(Chunks { survey, outlet }));
            self.bytes.read(&options, &self.path).map(drop)
        })
    }
}
