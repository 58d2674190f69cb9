// Discs as geometry: what covers them, and what they show.
//
// All set-ups make the same fragments count: a fragment tests its pixel's ray against the sphere, so
// what lies around the disc is left out. The geometry lies at the depth of the sphere's nearest point.

@group(0) @binding(6) var<storage, read> discs: array<Disc>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) a: vec4<f32>,
    @location(1) @interpolate(flat) b: vec3<f32>,
    @location(2) @interpolate(flat) c: vec2<u32>,
}

// Reversed: 1 at the near plane, 0 at infinity.
fn depth_of(depth: f32) -> f32 {
    return camera.near / depth;
}

// A corner at these pixel coordinates, in which centres are whole.
fn corner(disc: Disc, at: vec2<f32>) -> Corner {
    let size = vec2(f32(camera.width), f32(camera.height));
    let ndc = (at + 0.5) / size * 2.0 - 1.0;
    let depth = depth_of(nearest_of(disc.depth, disc.radius));
    return Corner(
        vec4(ndc.x, -ndc.y, min(depth, 1.0), 1.0),
        vec4(disc.fraction, disc.scale, disc.depth),
        vec3(disc.slope, disc.radius),
        vec2(disc.whole, disc.id),
    );
}

// The edges of the pixels that it may cover: corners by the bits of a number.
fn of_quad(disc: Disc, which: u32) -> vec2<f32> {
    let x = select(f32(low(disc.columns)) - 0.5, f32(high(disc.columns)) + 0.5, (which & 1u) != 0u);
    let y = select(f32(low(disc.rows)) - 0.5, f32(high(disc.rows)) + 0.5, (which & 2u) != 0u);
    return vec2(x, y);
}

// A triangle around a circle around the disc's pixels.
fn of_triangle(disc: Disc, which: u32) -> vec2<f32> {
    let at = vec2<f32>(whole_of(disc.whole)) + disc.fraction;
    // As in `outline`, along the direction from the middle of the picture, where it is largest.
    let share = disc.radius / disc.depth;
    let squared = dot(disc.slope, disc.slope);
    let stretch = 1.0 / (1.0 - share * share);
    let reach = share * (1.0 + 0.5 * squared) + sqrt(squared) * (share * share);
    let wide = reach * stretch * camera.per_pixel;
    let radius = select(1.0 / disc.scale, wide, is_perspective()) * 1.0001 + 0.1;
    let places = array(vec2(0.0, 2.0), vec2(1.7320509, -1.0), vec2(-1.7320509, -1.0));
    return at + radius * places[which];
}

// A strip of four for each instance.
@vertex
fn quad_instance(@builtin(vertex_index) v: u32, @builtin(instance_index) i: u32) -> Corner {
    let disc = discs[i];
    return corner(disc, of_quad(disc, v));
}

// Two triangles from six numbers, without instances.
@vertex
fn quad_pulled(@builtin(vertex_index) v: u32) -> Corner {
    let disc = discs[v / 6u];
    let which = (0x321210u >> (v % 6u * 4u)) & 3u;
    return corner(disc, of_quad(disc, which));
}

// One triangle, without instances.
@vertex
fn triangle(@builtin(vertex_index) v: u32) -> Corner {
    let disc = discs[v / 3u];
    return corner(disc, of_triangle(disc, v % 3u));
}

// Only the pixel at the centre.
@vertex
fn point(@builtin(vertex_index) v: u32) -> Corner {
    let disc = discs[v];
    return corner(disc, round_half_up(vec2<f32>(whole_of(disc.whole)) + disc.fraction));
}

fn round_half_up(at: vec2<f32>) -> vec2<f32> {
    return floor(at + 0.5);
}

fn disc_of(corner: Corner) -> Disc {
    var disc: Disc;
    disc.fraction = corner.a.xy;
    disc.scale = corner.a.z;
    disc.depth = corner.a.w;
    disc.slope = corner.b.xy;
    disc.radius = corner.b.z;
    disc.whole = corner.c.x;
    disc.id = corner.c.y;
    return disc;
}
