// A shaded image in a render pass of a program's own.

struct Composite {
    // The depth of a program's own depth buffer at the view depth t is (z.x t + z.y) / (w.x t + w.y).
    z: vec2<f32>,
    w: vec2<f32>,
    size: vec2<f32>,
    // Whether the pass writes what is linear, to be encoded by its format.
    is_linear: u32,
    spare: u32,
}

@group(0) @binding(0) var<uniform> composite: Composite;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var depths: texture_2d<f32>;

struct Place {
    @builtin(position) position: vec4<f32>,
    // From 0 to 1 over the viewport.
    @location(0) at: vec2<f32>,
}

struct Pixel {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

// One triangle around the viewport.
@vertex
fn vertex(@builtin(vertex_index) v: u32) -> Place {
    let at = vec2(f32(v & 1u), f32(v >> 1u)) * 2.0;
    return Place(vec4(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

fn pixel(at: vec2<f32>) -> vec2<i32> {
    return vec2<i32>(clamp(floor(at * composite.size), vec2(0.0), composite.size - 1.0));
}

// Straight alpha, in what the format of the pass takes.
fn color(at: vec2<i32>) -> vec4<f32> {
    let srgb = textureLoad(image, at, 0);
    let curve = pow((srgb.rgb + 0.055) / 1.055, vec3(2.4));
    let light = select(curve, srgb.rgb / 12.92, srgb.rgb <= vec3(0.04045));
    return vec4(select(srgb.rgb, light, composite.is_linear != 0u), srgb.a);
}

@fragment
fn flat(in: Place) -> @location(0) vec4<f32> {
    return color(pixel(in.at));
}

@fragment
fn deep(in: Place) -> Pixel {
    let at = pixel(in.at);
    let found = color(at);
    // Where nothing is seen, a background lies behind everything; without one, nothing is drawn.
    if found.a == 0.0 {
        discard;
    }
    let view = textureLoad(depths, at, 0).x;
    let end = select(0.0, 1.0, composite.z.x * composite.w.y > 0.0);
    var depth = select(composite.z.x / composite.w.x, end, composite.w.x == 0.0);
    if view < 3.0e38 {
        depth = (composite.z.x * view + composite.z.y) / (composite.w.x * view + composite.w.y);
    }
    return Pixel(found, clamp(depth, 0.0, 1.0));
}
