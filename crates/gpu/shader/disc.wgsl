// Spheres relative to their own projected centres: the projection-centred form, in which nothing large
// is subtracted. `disc.rs` of the CPU's renderer has the derivation and the errors.

struct Disc {
    // The fraction of the projected centre's pixel coordinates, radii per pixel, and the view depth of
    // the centre.
    fraction: vec2<f32>,
    scale: f32,
    depth: f32,
    // The slopes of the ray through the centre, and the radius.
    slope: vec2<f32>,
    radius: f32,
    // Where the record lies in its page.
    slot: u32,
    // The whole part of the projected centre's pixel coordinates, as two signed halves of a word.
    whole: u32,
    // The pixels that it may cover, first and last, as two halves of a word.
    columns: u32,
    rows: u32,
    id: u32,
}

fn low(word: u32) -> u32 {
    return word & 0xffffu;
}

fn high(word: u32) -> u32 {
    return word >> 16u;
}

fn pack(a: i32, b: i32) -> u32 {
    return (u32(a) & 0xffffu) | (u32(b) << 16u);
}

fn whole_of(word: u32) -> vec2<i32> {
    return vec2(i32(word << 16u) >> 16u, i32(word) >> 16u);
}

// A positive depth before which a disc has no point, as `nearest_depth` of the core.
fn nearest_of(depth: f32, radius: f32) -> f32 {
    return max(depth - radius - 1e-6 * (abs(depth) + radius), camera.near);
}

struct Hit {
    // The view depth; negative for none.
    depth: f32,
    // The discriminant, and the squared length of the ray's direction: the cosine between the normal
    // and the way back is the root of their quotient.
    q: f32,
    a: f32,
}

// Where the ray of a pixel enters a sphere.
fn hit(disc: Disc, pixel: vec2<i32>) -> Hit {
    let ray = vec2(f32(pixel.x) - camera.middle.x, camera.middle.y - f32(pixel.y)) * camera.step;
    let offset = (vec2<f32>(pixel - whole_of(disc.whole)) - disc.fraction) * disc.scale;
    let u = offset.x;
    let v = -offset.y;
    let e = disc.slope.x * v - disc.slope.y * u;
    let a = 1.0 + (ray.x * ray.x + ray.y * ray.y);
    let q = a - (u * u + v * v + e * e);
    // Written so that what is no number is a miss.
    if !(q >= 0.0) {
        return Hit(-1.0, 0.0, 1.0);
    }
    let reach = disc.radius * ((u * ray.x + v * ray.y) + sqrt(q)) / a;
    let depth = disc.depth - reach;
    if !(depth >= camera.near && bitcast<u32>(depth) < INFINITY_BITS) {
        return Hit(-1.0, 0.0, 1.0);
    }
    return Hit(depth, q, a);
}
