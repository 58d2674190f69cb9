//! What can be wrong with a file: which one, where, and the value at fault.

use std::{fmt, io, path::PathBuf};

/// A file that cannot be read or written.
///
/// Its text names the file, the place in it and the value:
/// `atoms.xyz, line 3: x must be a number, not "1.2.3"`.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {kind}", .path.display(), .place.map_or(String::new(), |place| format!(", {place}")))]
pub struct Error {
    /// The file.
    pub path: PathBuf,
    /// Where in the file, if it is about one place.
    pub place: Option<Place>,
    /// What is wrong.
    pub kind: ErrorKind,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// An offset from the start of the (uncompressed) file.
    Byte(u64),
    /// A line, counted from 1.
    Line(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Line(line) => write!(f, "line {line}"),
        }
    }
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The operating system says so.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The path is that of a folder.
    #[error("this is a folder, not a file")]
    Folder,
    /// The path is that of a pipe, a device or the like.
    #[error("this is no regular file")]
    NotRegular,
    /// The file has no content.
    #[error("the file is empty")]
    Empty,
    /// Neither content nor name tell a format that is read here.
    #[error("the format is not known; it starts with {head}")]
    UnknownFormat {
        /// The first bytes.
        head: String,
    },
    /// The file ends too early.
    #[error("the file ends in {what}: {needed} bytes are needed, {left} are left")]
    Truncated {
        /// What is being read.
        what: String,
        /// How many bytes it has.
        needed: u64,
        /// How many the file still has.
        left: u64,
    },
    /// A line or word is missing at the end of the file.
    #[error("the file ends before {what}")]
    MissingLine {
        /// What it should hold.
        what: String,
    },
    /// A value is not what it must be.
    #[error("{what}, not {value}")]
    Invalid {
        /// What the value must be, as in `the number of atoms must be a whole number`.
        what: String,
        /// The value.
        value: String,
    },
    /// The file has no such frame.
    #[error("there is no frame {frame}: the file has {frames}, counted from 0")]
    NoSuchFrame {
        /// The frame asked for.
        frame: u64,
        /// How many frames there are.
        frames: u64,
    },
    /// No record could be used.
    #[error("there is nothing to draw: {skipped} records were skipped")]
    NoRecords {
        /// How many records could not be used.
        skipped: u64,
    },
    /// The file was read more than once, and was not the same each time.
    #[error("the file changed while it was read")]
    Changed,
    /// More records than ids.
    #[error("{0} records are more than a scene can hold")]
    TooManyRecords(u64),
    /// A record cannot be used, and reading is strict.
    #[error("{problem}: {value}")]
    Record {
        /// What is wrong with it.
        problem: Problem,
        /// The value at fault.
        value: String,
    },
    /// A library that decodes the format says so.
    #[error("{0}")]
    Decoder(String),
}

/// Why a record cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Problem {
    /// A coordinate is NaN, infinite, or beyond 8.5e37, so that `f32` cannot hold offsets.
    Position,
    /// The radius is NaN, infinite, zero or negative.
    Radius,
    /// A line with too few or too many columns.
    Columns,
    /// A text that should be a number.
    Number,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "a position that cannot be stored",
            Self::Radius => "a radius that is not positive and finite",
            Self::Columns => "a wrong number of columns",
            Self::Number => "not a number",
        })
    }
}

/// An error whose file is named further up.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) place: Option<Place>,
    pub(crate) kind: ErrorKind,
}

impl Fault {
    /// A value that is not what it must be. Long values are cut.
    pub(crate) fn invalid(place: Place, what: impl Into<String>, value: impl fmt::Display) -> Self {
        let kind = ErrorKind::Invalid { what: what.into(), value: shorten(&value.to_string()) };
        Self { place: Some(place), kind }
    }

    /// A line or word that is missing at the end of the file.
    pub(crate) fn missing(place: Place, what: impl Into<String>) -> Self {
        Self { place: Some(place), kind: ErrorKind::MissingLine { what: what.into() } }
    }

    /// The same fault, in this file.
    pub(crate) fn in_file(self, path: impl Into<PathBuf>) -> Error {
        Error { path: path.into(), place: self.place, kind: self.kind }
    }
}

impl From<ErrorKind> for Fault {
    fn from(kind: ErrorKind) -> Self {
        Self { place: None, kind }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        ErrorKind::Io(error).into()
    }
}

/// A text in quotes that fits on a line.
pub(crate) fn quote(text: &[u8]) -> String {
    format!("\"{}\"", shorten(&text.escape_ascii().to_string()))
}

/// The first characters of a text.
fn shorten(text: &str) -> String {
    const LENGTH_MAX: usize = 60;
    match text.char_indices().nth(LENGTH_MAX) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
