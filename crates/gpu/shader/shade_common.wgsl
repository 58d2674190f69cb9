// What all shaders of `shade.rs` know: the work, and the table of the records that are seen.

struct Shade {
    // The sides of the image, and how many pixels of the picture make one of it, along each side.
    size: vec2<u32>,
    factor: u32,
    ambient: f32,
    // The band of rows of the image that is made.
    first_row: u32,
    rows: u32,
    // 0 if one color is that of all records, else 1.
    per_record: u32,
    // Whether there is a background.
    has_background: u32,
    // Its colors at the top and at the bottom, in sRGB from 0 to 255.
    top: vec3<f32>,
    // How many words the set of ids has.
    words: u32,
    bottom: vec3<f32>,
    spare: u32,
    // From sRGB to light, for each byte.
    decode: array<vec4<f32>, 64>,
}

@group(0) @binding(2) var<uniform> shade: Shade;

// A record that is seen. The squared distance of a pixel's ray from the sphere's centre, in radii and
// times the squared length of the ray's direction, is that of a vector which changes evenly from pixel
// to pixel: `m` at the pixel `whole`, and from there as `turn` says. So nothing large is subtracted.
struct Entry {
    m: vec3<f32>,
    // A pixel, as two signed halves of a word.
    whole: u32,
    k: vec3<f32>,
    // Bytes in sRGB, red the lowest.
    color: u32,
}

// How `m` changes over some pixels.
fn turn(k: vec3<f32>, by: vec2<f32>) -> vec3<f32> {
    return vec3(k.z * by.x, -k.z * by.y, -(k.x * by.y + k.y * by.x));
}

// The pixels of the picture in the band: the first, and how many.
fn band() -> vec2<u32> {
    return vec2(shade.first_row, shade.rows) * shade.factor * camera.width;
}
