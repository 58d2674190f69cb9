//! The twins in WGSL are valid and declare what they must.

use crate::{Arc, Cuboid, Glyph, Node, PRELUDE, Polygon};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// What renderers add: the functions that read words, and calls of all that a glyph declares.
const FRAME: &str = "
@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> found: array<f32>;
fn word(at: u32, k: u32) -> u32 { return words[at + k]; }
fn real(at: u32, k: u32) -> f32 { return bitcast<f32>(word(at, k)); }
fn style_word(k: u32) -> u32 { return words[k]; }
fn style_real(k: u32) -> f32 { return bitcast<f32>(style_word(k)); }
fn table_word(i: u32) -> u32 { return words[i]; }
fn table_real(i: u32) -> f32 { return bitcast<f32>(table_word(i)); }
@compute @workgroup_size(1) fn main() {
    let form: Form = glyph_form(1u, Sight(vec4(1.0), 1.0, 1.0, 1.0));
    let size: vec2<u32> = glyph_size(form);
    let corners: vec3<u32> = glyph_triangle(form, size.y);
    let ball: vec4<f32> = glyph_ball(1u);
    let vertex: vec3<f32> = glyph_vertex(form, corners.x) + glyph_position(1u);
    found[0] = vertex.x + ball.w;
}
";

fn check<G: Glyph>() {
    let source = format!("{PRELUDE}\n{}\n{FRAME}", G::WGSL);
    let name = std::any::type_name::<G>();
    let module = naga::front::wgsl::parse_str(&source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(&source, name)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(&source, name)));
}

#[test]
fn twins_are_valid() {
    check::<Cuboid>();
    check::<Arc>();
    check::<Node>();
    check::<Polygon>();
}
