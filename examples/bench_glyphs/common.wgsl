// What all representations share: the camera, and what a pixel tells.

struct Camera {
    clip: mat4x4<f32>,
    // What is inside is not negative: left, right, lower, upper, near.
    planes: array<vec4<f32>, 5>,
    eye: vec3<f32>,
    // How far to the right everything is moved, in pictures: then nothing of it is in the picture.
    away: f32,
    sharpness: f32,
    pixel: f32,
    // Cells along a side of a world of blocks.
    side: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> camera: Camera;

struct Shown {
    @builtin(position) place: vec4<f32>,
    // 8 id + face.
    @location(0) @interpolate(flat, first) word: u32,
}

fn shown(point: vec3<f32>, word: u32) -> Shown {
    var place = camera.clip * vec4(point, 1.0);
    place.x += camera.away * place.w;
    return Shown(place, word);
}

@fragment
fn fragment(shown: Shown) -> @location(0) u32 {
    return shown.word;
}
