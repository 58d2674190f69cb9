// The view, for shaders: `frame.rs` fills it.
//
// Pixels have whole coordinates at their centres, (0, 0) at the top left. Camera coordinates are right,
// up and forward from the eye.

struct Camera {
    right: vec3<f32>,
    width: u32,
    up: vec3<f32>,
    height: u32,
    forward: vec3<f32>,
    // The smallest view depth at which surfaces are seen.
    near: f32,
    // Where the line of sight meets the picture.
    middle: vec2<f32>,
    // The distance between neighboring rays at view depth 1; 0 if they are parallel.
    step: f32,
    // The distance between neighboring rays, and the number of pixels per such unit.
    pixel: f32,
    per_pixel: f32,
    // The smallest radius that a sphere is drawn with, in pixels.
    radius_min: f32,
    // The number of tiles in a row of tiles.
    across: u32,
    is_perspective: u32,
}

@group(0) @binding(0) var<uniform> camera: Camera;

// For `select` alone: what branches on a uniform is compiled anew by some drivers (lavapipe of Mesa 22)
// each time that uniforms change.
fn is_perspective() -> bool {
    return camera.is_perspective != 0u;
}

// How many rows and columns of pixels make a tile.
const TILE: u32 = 8u;
const INFINITY_BITS: u32 = 0x7f800000u;

// The number of an invocation, of groups of 64 in two dimensions.
fn number(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * 64u + lane;
}
