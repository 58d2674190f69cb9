// Cuboids: the twin of `cuboid.rs`.

struct Form {
    half: vec3<f32>,
    faces: u32,
}

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn sides_of(at: u32) -> vec3<f32> {
    return vec3(real(at, 3u), real(at, 4u), real(at, 5u));
}

fn glyph_ball(at: u32) -> vec4<f32> {
    return vec4(glyph_position(at), length(sides_of(at)) * 0.500001);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let extent = sides_of(at);
    let half = extent * 0.5;
    let is_there = has_extent(extent.x) && has_extent(extent.y) && has_extent(extent.z);
    if !(is_there && are_finite(at, 0u, 3u)) {
        return Form(half, 0u);
    }
    return Form(half, box_faces(sight, half));
}

fn glyph_size(form: Form) -> vec2<u32> {
    return vec2(8u, 2u * countOneBits(form.faces));
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    return box_vertex(form.half, vertex);
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    return box_triangle(form.faces, triangle);
}
