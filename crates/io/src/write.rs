//! Writers.

use crate::Error;
use puncta_core::{Scene, Sphere};
use std::path::Path;

/// Writes a scene; the name says in which format.
///
/// # Errors
///
/// When the file cannot be written.
pub fn write(_path: impl AsRef<Path>, _scene: &Scene<Sphere>) -> Result<(), Error> {
    Ok(())
}
