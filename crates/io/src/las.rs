//! las

use crate::{
    ReadOptions,
    builder::Report,
    error::{ErrorKind, Fault},
};
use puncta_core::Scene;
use std::io::{Read, Seek};

/// Reads the points.
pub(crate) fn read(
    _stream: impl Read + Seek + Send + Sync,
    _length: u64,
    _options: &ReadOptions,
) -> Result<(Scene, Report), Fault> {
    Err(ErrorKind::Decoder("not yet".into()).into())
}
