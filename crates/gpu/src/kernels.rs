//! The compute shaders that do not know what records are drawn as.

use crate::{
    Error, Gpu,
    kernel::{Kernel, shader},
};

/// The kernels, by what they do.
#[derive(Debug)]
pub(crate) struct Kernels {
    pub(crate) tiles: Kernel,
    pub(crate) cull: Kernel,
    pub(crate) over_chunks: Kernel,
    pub(crate) mark_seen: Kernel,
    pub(crate) claim: Kernel,
    pub(crate) accept: Kernel,
    pub(crate) merge: Kernel,
    pub(crate) clear_outlook: Kernel,
    pub(crate) look: Kernel,
    pub(crate) count_open: Kernel,
    pub(crate) glance: Kernel,
}

const TILES: &str = shader!("camera", "visibility_read", "tiles");
pub(crate) const CULL: &str = shader!("camera", "disc", "work", "place", "hidden", "cull");
pub(crate) const SET_UP: &str =
    shader!("camera", "disc", "work", "place", "hidden", "setup", "recall");
pub(crate) const ARGUMENTS: &str = shader!("work", "arguments");
const SEEN: &str = shader!("camera", "visibility_read", "seen");
const CLAIM: &str = shader!("camera", "claim");
pub(crate) const PATCH: &str = shader!("camera", "patch");
pub(crate) const SURVEY: &str =
    shader!("camera", "disc", "work", "place", "hidden", "visibility_read", "survey");

/// All of these, to be tested.
#[cfg(test)]
pub(crate) const SOURCES: [(&str, &str); 8] = [
    ("tiles", TILES),
    ("cull", CULL),
    ("set up", SET_UP),
    ("arguments", ARGUMENTS),
    ("seen", SEEN),
    ("claim", CLAIM),
    ("patch", PATCH),
    ("survey", SURVEY),
];

impl Kernels {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        gpu.guard("pipelines", || {
            let kernel = |label, source, entry| Kernel::new(gpu, label, (source, entry), &[]);
            Self {
                tiles: kernel("Kernels::tiles", TILES, "find_tiles"),
                cull: kernel("Kernels::cull", CULL, "cull"),
                over_chunks: kernel("Kernels::over_chunks", ARGUMENTS, "over_chunks"),
                mark_seen: kernel("Kernels::mark_seen", SEEN, "mark_seen"),
                claim: kernel("Kernels::claim", CLAIM, "claim"),
                accept: kernel("Kernels::accept", CLAIM, "accept"),
                merge: kernel("Kernels::merge", PATCH, "merge"),
                clear_outlook: kernel("Kernels::clear_outlook", SURVEY, "clear_outlook"),
                look: kernel("Kernels::look", SURVEY, "look"),
                count_open: kernel("Kernels::count_open", SURVEY, "count_open"),
                glance: kernel("Kernels::glance", SURVEY, "glance"),
            }
        })
    }
}
