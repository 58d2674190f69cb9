/*!
Tests of the shaders of all glyphs, without any driver: put together with [`PRELUDE`] they are valid, need
nothing beyond core WebGPU, and declare what [`Glyph`] says.
*/

use crate::{Arc, Arrow, Block, Cuboid, Disc, Glyph, Node, PRELUDE, Polygon, Prism};
use naga::{
    Module,
    valid::{Capabilities, ValidationFlags, Validator},
};

/// The functions that a renderer brings: words of records, of the style and of the table.
const READING: &str = "
@group(0) @binding(0) var<storage, read> words: array<u32>;
const STRIDE: u32 = 9u;
fn word(at: u32, k: u32) -> u32 { return words[at * STRIDE + k]; }
fn real(at: u32, k: u32) -> f32 { return bitcast<f32>(word(at, k)); }
fn style_word(k: u32) -> u32 { return words[k]; }
fn style_real(k: u32) -> f32 { return bitcast<f32>(words[k]); }
fn table_word(i: u32) -> u32 { return words[i]; }
fn table_real(i: u32) -> f32 { return bitcast<f32>(words[i]); }
";

/// A stage that calls all functions of a glyph, and so has their types checked.
const CALLING: &str = "
@group(0) @binding(1) var<storage, read_write> found: array<vec4<f32>>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let position: vec3<f32> = glyph_position(id.x);
    let ball: vec4<f32> = glyph_ball(id.x);
    let sight = Sight(vec4(1.0), 1.0, 2.0, 3.0);
    let form: Form = glyph_form(id.x, sight);
    let size: vec2<u32> = glyph_size(form);
    let vertex: vec3<f32> = glyph_vertex(form, size.x);
    let triangle: vec3<u32> = glyph_triangle(form, size.y);
    found[id.x] = ball + vec4(position + vertex + vec3<f32>(triangle), 0.0);
}
";

fn module(name: &str, source: &str) -> Result<Module, String> {
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| error.emit_to_string_with_path(source, name))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map_err(|error| error.emit_to_string_with_path(source, name))?;
    Ok(module)
}

fn composed<G: Glyph>() -> String {
    [PRELUDE, READING, G::WGSL, CALLING].concat()
}

fn all() -> [(&'static str, String); 8] {
    [
        ("arc", composed::<Arc>()),
        ("arrow", composed::<Arrow>()),
        ("block", composed::<Block>()),
        ("cuboid", composed::<Cuboid>()),
        ("disc", composed::<Disc>()),
        ("node", composed::<Node>()),
        ("polygon", composed::<Polygon>()),
        ("prism", composed::<Prism>()),
    ]
}

#[test]
fn glyphs_are_core_webgpu() {
    for (name, source) in all() {
        module(name, &source).unwrap_or_else(|what| panic!("{what}"));
    }
}

/// The test notices what it is there for.
#[test]
fn what_is_wrong_is_noticed() {
    let source = composed::<Prism>();
    for (right, wrong) in [
        ("fn glyph_ball(at: u32) -> vec4<f32>", "fn glyph_ball(at: i32) -> vec4<f32>"),
        ("fn glyph_vertex(form: Form, vertex: u32)", "fn glyph_vertices(form: Form, vertex: u32)"),
        ("let top = bottom + height;", "let top = bottom + 1u;"),
    ] {
        assert!(source.contains(right), "{right}");
        assert!(module("prism", &source.replace(right, wrong)).is_err(), "{wrong}");
    }
}
