//! What the tools that draw glyphs share: options, drawing, light, and the picture's way to a file or
//! a window.

mod backend;
mod built;
mod drawing;
mod light;
mod normals;
mod options;
pub(crate) mod palette;
mod run;
mod sky;

#[path = "../render/parse.rs"]
#[allow(dead_code, reason = "the tool `render` uses more of it")]
mod parse;
#[path = "../render/progress.rs"]
#[allow(dead_code, reason = "a tool uses what its work needs")]
pub(crate) mod progress;

pub(crate) use built::{Built, Outlook};
pub(crate) use options::Drawing as DrawingOptions;
pub(crate) use puncta_viewer::glyphs::Paint;
pub(crate) use run::run;
