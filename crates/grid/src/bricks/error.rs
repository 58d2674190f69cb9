//! What can go wrong with brick files.

use crate::Error;
use std::{io, path::PathBuf};

/// Why a source was not converted to a brick file. No file is left behind, and one that was there
/// before is there still.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConvertError<E> {
    /// The source failed.
    #[error(transparent)]
    Source(E),
    /// The records or the resolution are such that no grid can be made of them.
    #[error(transparent)]
    Grid(#[from] Error),
    /// The source has other columns from some record on.
    #[error("from record {index} on the source has the columns {found}, before it had {before}")]
    Columns {
        /// The index of the first record with other columns.
        index: u64,
        /// The columns it has.
        found: String,
        /// The columns that the records before have.
        before: String,
    },
    /// The name of a scalar is too long to be stored.
    #[error("a scalar has a name of {bytes} bytes; a brick file holds at most {max}", max = u16::MAX)]
    Name {
        /// The length of the name.
        bytes: usize,
    },
    /// A file could not be read or written.
    #[error("{path}: {doing}: {error}", path = path.display())]
    File {
        /// The file that was to be made.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// What the system says.
        error: io::Error,
    },
}

/// What can go wrong below the source.
#[derive(Debug)]
pub(crate) enum Trouble {
    Grid(Error),
    Columns { index: u64, found: String, before: String },
    Name { bytes: usize },
    File { doing: &'static str, error: io::Error },
}

impl Trouble {
    pub(crate) fn reading(error: io::Error) -> Self {
        Self::File { doing: "cannot read what was written there", error }
    }

    pub(crate) fn writing(error: io::Error) -> Self {
        Self::File { doing: "cannot write", error }
    }

    /// The error of a conversion to this file.
    pub(crate) fn at<E>(self, path: impl Into<PathBuf>) -> ConvertError<E> {
        match self {
            Self::Grid(error) => ConvertError::Grid(error),
            Self::Columns { index, found, before } => {
                ConvertError::Columns { index, found, before }
            }
            Self::Name { bytes } => ConvertError::Name { bytes },
            Self::File { doing, error } => ConvertError::File { path: path.into(), doing, error },
        }
    }
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Self {
        Self::Grid(error)
    }
}

/// Why a brick file was not opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The file cannot be read.
    #[error("{path}: {error}", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The file is not what it should be: it is none of these files, or cut short, or altered.
    #[error("{path}: byte {byte}: {what}, not {value}", path = path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The place in the file.
        byte: u64,
        /// What must be there.
        what: String,
        /// What is there.
        value: String,
    },
}
