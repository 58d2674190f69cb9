/*!
Readers and writers of particle and point files, and synthetic scenes.

```no_run
let scene = puncta_io::read("atoms.pdb")?;
println!("{} atoms", scene.records.len());
# Ok::<(), puncta_io::Error>(())
```

[`ReadOptions`] chooses a frame, a radius, or the columns to keep, and reports what was skipped. The
[`Format`] is found by content first, then by name; files compressed with gzip are read as they are.

[`ReadOptions::stream`] reads a file that is larger than memory in chunks.

Every reader keeps three promises. What is wrong with a file ends in an [`Error`] that names the
file, the place and the value. Records that cannot be used are skipped, counted and reported. And no
number in a file makes a reader allocate more than the file itself justifies.
*/

mod atoms;
mod builder;
mod color;
pub mod elements;
mod error;
mod feed;
mod file_source;
mod format;
mod gzip;
mod hash;
mod input;
mod lammps;
mod las;
mod mmpld;
pub mod npy;
mod options;
mod pdb;
mod ply;
pub mod png;
mod radius;
mod stream;
pub mod synthetic;
mod table;
mod text;
mod vtk;
mod write;
mod xyz;

pub use crate::{
    builder::{Report, Skipped},
    error::{Error, ErrorKind, Place, Problem},
    file_source::FileSource,
    format::Format,
    options::{Loaded, ReadOptions, Scalars},
    radius::estimate as estimate_radius,
    write::write,
};

use puncta_core::Scene;
use std::path::Path;

/// Reads the first frame of a file with the default options.
///
/// # Errors
///
/// When the file cannot be read: see [`ErrorKind`].
pub fn read(path: impl AsRef<Path>) -> Result<Scene, Error> {
    ReadOptions::default().read(path).map(|loaded| loaded.scene)
}
