//! ply

use crate::{
    ReadOptions,
    builder::Report,
    error::{ErrorKind, Fault},
    input::Input,
};
use puncta_core::Scene;

/// Reads a frame.
pub(crate) fn read(
    _input: &mut Input<'_>,
    _options: &ReadOptions,
) -> Result<(Scene, Report), Fault> {
    Err(ErrorKind::Decoder("not yet".into()).into())
}
