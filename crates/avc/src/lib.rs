/*!
Attributed vertex clouds: glyphs that are one small record each, and become geometry only while they
are drawn.

After Scheibel, Buschmann, Trapp and Döllner, *Attributed Vertex Clouds*, GPU Zen, 2017. There the
geometry is made by geometry and tessellation shaders. Here it is a function from a number to a vertex
or a triangle ([`Glyph`]), written once in Rust and once in WGSL, that any stage of a pipeline can call.
*/

mod circle;
mod cuboid;
mod facet;
mod glyph;
mod mesh;
mod sight;
mod spans;
mod surface;

pub use crate::{
    circle::circle,
    cuboid::Cuboid,
    facet::{DepthRow, Facet},
    glyph::{Cloud, Fault, Faults, Glyph, Glyphs, Size},
    mesh::Mesh,
    sight::{CHORDS_MAX, Lens, Sight},
    spans::Spans,
    surface::{Meeting, Surface},
};

/// What [`Glyph::WGSL`] can use, but for the functions that read words: `Sight` and the functions of
/// circles.
pub const PRELUDE: &str = include_str!("../shader/prelude.wgsl");
