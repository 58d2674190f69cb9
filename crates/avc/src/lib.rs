/*!
Attributed vertex clouds: glyphs that are one small record each, and become geometry only while they
are drawn.

After Scheibel, Buschmann, Trapp and Döllner, *Attributed Vertex Clouds*, GPU Zen, 2017. There the
geometry is made by geometry and tessellation shaders. Here it is a function from a number to a vertex
or a triangle ([`Glyph`]), written once in Rust and once in WGSL, that any stage of a pipeline can call.
*/

mod arc;
mod arrow;
mod block;
mod circle;
mod cuboid;
mod disc;
mod extent;
mod facet;
mod frame;
mod glyph;
mod level;
mod mesh;
mod node;
mod polygon;
mod prism;
mod runs;
mod sight;
mod spans;
mod surface;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod twins;
mod world;

pub use crate::{
    arc::{Arc, ArcForm},
    arrow::{Arrow, ArrowForm},
    block::Block,
    circle::circle,
    cuboid::{BoxForm, Cuboid},
    disc::{Disc, DiscForm},
    facet::{DepthRow, Facet},
    glyph::{Cloud, Fault, Faults, Glyph, Glyphs, Size},
    level::{Level, Levels},
    mesh::Mesh,
    node::{Node, NodeForm, NodeStyle, Trajectories, TrajectoryFaults},
    polygon::{Polygon, PolygonError, PolygonFailure, PolygonForm, PolygonSet},
    prism::{Prism, PrismForm},
    runs::Runs,
    sight::{CHORDS_MAX, Lens, Sight},
    spans::Spans,
    surface::{Meeting, Surface},
    world::{BlockWorld, BlockWorldError, Filling},
};

/// What [`Glyph::WGSL`] can use, but for the functions that read words: `Sight` and the functions of
/// circles.
pub const PRELUDE: &str = include_str!("../shader/prelude.wgsl");
