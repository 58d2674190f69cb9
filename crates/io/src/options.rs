//! What to read of a file, and what came of it.

use crate::{
    builder::{Report, Sink, is_radius},
    elements::Radii,
    error::{Error, ErrorKind, Fault, quote},
    format::Format,
    gzip::{self, Gzip},
    input::Input,
    lammps, las, mmpld, pdb, ply, vtk, xyz,
};
use puncta_core::{Scene, Sphere};
use std::{
    fmt,
    fs::File,
    io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom},
    path::Path,
    sync::Arc,
};

/// How many bytes at the start of a file tell its format.
const HEAD_BYTES: u64 = 4096;

/// Called with the bytes that were read and the bytes of the whole file.
type OnProgress = Arc<dyn Fn(u64, u64) + Send + Sync>;

/// How to read a file.
///
/// # Examples
///
/// ```
/// use puncta_io::ReadOptions;
///
/// let file = b"2\nwater without one H\nO 0.0 0.0 0.1\nH 0.0 0.8 -0.5\n";
/// let loaded = ReadOptions::default().radius_scale(0.5).read_bytes("water.xyz", file)?;
/// assert_eq!(loaded.scene.records.len(), 2);
/// assert_eq!(loaded.scene.attributes.elements, Some([8, 1].into()));
/// assert!(loaded.report.skipped.is_empty());
/// # Ok::<(), puncta_io::Error>(())
/// ```
#[derive(Clone)]
pub struct ReadOptions {
    pub(crate) frame: u64,
    pub(crate) radius: Option<f64>,
    pub(crate) radius_scale: f64,
    pub(crate) radii: Radii,
    pub(crate) scalars: Scalars,
    pub(crate) strict: bool,
    format: Option<Format>,
    on_progress: Option<OnProgress>,
    /// Where the rows go that are read.
    pub(crate) sink: Sink,
}

/// Which scalar columns of a file to keep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Scalars {
    /// All of them.
    #[default]
    All,
    /// Those of these names.
    Named(Vec<String>),
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            frame: 0,
            radius: None,
            radius_scale: 1.0,
            radii: Radii::default(),
            scalars: Scalars::default(),
            strict: false,
            format: None,
            on_progress: None,
            sink: Sink::default(),
        }
    }
}

/// A frame of a file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The records.
    pub scene: Scene<Sphere>,
    /// The format of the file.
    pub format: Format,
    /// What was skipped, and what else was found.
    pub report: Report,
}

impl ReadOptions {
    /// Reads this frame, counted from 0; the first one by default.
    #[must_use]
    pub fn frame(self, frame: u64) -> Self {
        Self { frame, ..self }
    }

    /// Gives all records this radius, whatever the file says.
    #[must_use]
    pub fn radius(self, radius: f64) -> Self {
        Self { radius: Some(radius), ..self }
    }

    /// Multiplies all radii.
    #[must_use]
    pub fn radius_scale(self, scale: f64) -> Self {
        Self { radius_scale: scale, ..self }
    }

    /// Takes these radii for atoms; van der Waals radii by default.
    #[must_use]
    pub fn radii(self, radii: Radii) -> Self {
        Self { radii, ..self }
    }

    /// Keeps these scalar columns; all by default.
    #[must_use]
    pub fn scalars(self, scalars: Scalars) -> Self {
        Self { scalars, ..self }
    }

    /// Makes records that cannot be used an error instead of skipping them.
    #[must_use]
    pub fn strict(self, strict: bool) -> Self {
        Self { strict, ..self }
    }

    /// Reads the file as of this format, whatever its content and name say.
    #[must_use]
    pub fn format(self, format: Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Calls `on_progress` now and then with the bytes that were read and those of the whole file.
    #[must_use]
    pub fn on_progress(self, on_progress: impl Fn(u64, u64) + Send + Sync + 'static) -> Self {
        Self { on_progress: Some(Arc::new(on_progress)), ..self }
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// When the file cannot be read: see [`ErrorKind`].
    pub fn read(&self, path: impl AsRef<Path>) -> Result<Loaded, Error> {
        let path = path.as_ref();
        let read = || {
            let (file, length) = open(path)?;
            self.read_stream(path, file, length)
        };
        read().map_err(|fault: Fault| fault.in_file(path))
    }

    /// Reads a file that is in memory; `name` serves for messages and the format.
    ///
    /// # Errors
    ///
    /// When the file cannot be read: see [`ErrorKind`].
    pub fn read_bytes(&self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<Loaded, Error> {
        let name = name.as_ref();
        let loaded = self
            .read_stream(name, Cursor::new(bytes), bytes.len() as u64)
            .map_err(|fault| fault.in_file(name));
        // So each file of each test is one of this, too.
        #[cfg(test)]
        crate::file_source::tests::assert_same(self, (name, bytes), &loaded);
        loaded
    }

    /// Whether the scalar of this name is to be kept.
    pub(crate) fn wants(&self, name: &str) -> bool {
        match &self.scalars {
            Scalars::All => true,
            Scalars::Named(names) => names.iter().any(|wanted| wanted == name),
        }
    }

    /// The same options, for rows that go elsewhere.
    pub(crate) fn with_sink(&self, sink: Sink) -> Self {
        Self { sink, ..self.clone() }
    }

    /// Reads a stream of `length` bytes.
    pub(crate) fn read_stream(
        &self,
        name: &Path,
        stream: impl Read + Seek + Send + Sync,
        length: u64,
    ) -> Result<Loaded, Fault> {
        self.check()?;
        if length == 0 {
            return Err(ErrorKind::Empty.into());
        }
        let watched = Watched { stream, position: 0, length, options: self };
        let mut stream = BufReader::with_capacity(1 << 18, watched);
        let is_gzip = stream.fill_buf()?.starts_with(&[0x1f, 0x8b]);
        let mut head = Vec::new();
        if is_gzip {
            Gzip::new(&mut stream, length).take(HEAD_BYTES).read_to_end(&mut head)?;
        } else {
            stream.by_ref().take(HEAD_BYTES).read_to_end(&mut head)?;
        }
        stream.seek(SeekFrom::Start(0))?;
        let format = self.find_format(name, &head)?;
        let (scene, report) = match (format, is_gzip) {
            (Format::Las, true) => {
                let bytes = gzip::unpack(stream, length)?;
                let length = bytes.len() as u64;
                las::read(Cursor::new(bytes), length, self)
            }
            (Format::Las, false) => las::read(stream, length, self),
            (_, true) => {
                let mut unpacked = Gzip::new(stream, length);
                let read = self.read_input(format, Input::new(Box::new(&mut unpacked), None))?;
                unpacked.check_rest()?;
                Ok(read)
            }
            (_, false) => self.read_input(format, Input::seekable(Box::new(stream), length)),
        }?;
        Ok(Loaded { scene, format, report })
    }

    fn read_input(&self, format: Format, mut input: Input<'_>) -> Result<(Scene, Report), Fault> {
        match format {
            Format::Xyz => xyz::read(&mut input, self),
            Format::Lammps => lammps::read(&mut input, self),
            Format::Pdb => pdb::read(&mut input, self),
            Format::Mmpld => mmpld::read(&mut input, self),
            Format::Ply => ply::read(&mut input, self),
            // Its columns come one behind the other, so there can be no chunks of rows.
            Format::Vtk => vtk::read(&mut input, &self.with_sink(Sink::Scene)),
            Format::Las => {
                Err(ErrorKind::Decoder("LAS needs a stream that can seek".into()).into())
            }
        }
    }

    fn find_format(&self, name: &Path, head: &[u8]) -> Result<Format, Fault> {
        if head.is_empty() {
            return Err(ErrorKind::Empty.into());
        }
        let found = self.format.or_else(|| Format::from_content(head));
        found.or_else(|| Format::from_name(name)).ok_or_else(|| {
            let head = quote(&head[..head.len().min(16)]);
            ErrorKind::UnknownFormat { head }.into()
        })
    }

    /// Checks the options themselves.
    fn check(&self) -> Result<(), Fault> {
        let wrong = |what: &str, value: f64| {
            let kind = ErrorKind::Invalid { what: what.to_owned(), value: value.to_string() };
            Err(kind.into())
        };
        match self.radius {
            Some(radius) if !is_radius(radius) => {
                wrong("the radius for all records must be positive and finite", radius)
            }
            _ if !is_radius(self.radius_scale) => {
                wrong("the radius scale must be positive and finite", self.radius_scale)
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Debug for ReadOptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ReadOptions")
            .field("frame", &self.frame)
            .field("radius", &self.radius)
            .field("radius_scale", &self.radius_scale)
            .field("radii", &self.radii)
            .field("scalars", &self.scalars)
            .field("strict", &self.strict)
            .field("format", &self.format)
            .finish_non_exhaustive()
    }
}

/// Opens a regular file; also returns its length.
pub(crate) fn open(path: &Path) -> Result<(File, u64), Fault> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(ErrorKind::Folder.into());
    }
    if !metadata.is_file() {
        return Err(ErrorKind::NotRegular.into());
    }
    Ok((file, metadata.len()))
}

/// A stream that tells how far it was read.
struct Watched<'a, S> {
    stream: S,
    position: u64,
    length: u64,
    options: &'a ReadOptions,
}

impl<S: Read> Read for Watched<'_, S> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.options.sink.is_abandoned() {
            return Err(io::Error::other("nobody takes what is read"));
        }
        let read = self.stream.read(buffer)?;
        self.position += read as u64;
        if let Some(on_progress) = &self.options.on_progress {
            on_progress(self.position.min(self.length), self.length);
        }
        Ok(read)
    }
}

impl<S: Seek> Seek for Watched<'_, S> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.position = self.stream.seek(position)?;
        Ok(self.position)
    }
}
