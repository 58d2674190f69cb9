// Blocks: the twin of `block.rs`.

struct Form {
    faces: u32,
}

fn glyph_position(at: u32) -> vec3<f32> {
    let xy = word(at, 0u);
    let cell = vec3(xy & 0xffffu, xy >> 16u, word(at, 1u) & 0xffffu);
    return vec3<f32>(cell) + 0.5;
}

fn glyph_ball(at: u32) -> vec4<f32> {
    return vec4(glyph_position(at), 0.866026);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let kind = (word(at, 1u) >> 16u) & 0xffu;
    if kind == 0u {
        return Form(0u);
    }
    return Form((word(at, 1u) >> 24u) & box_faces(sight, vec3(0.5)));
}

fn glyph_size(form: Form) -> vec2<u32> {
    return vec2(8u, 2u * countOneBits(form.faces));
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    return box_vertex(vec3(0.5), vertex);
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    return box_triangle(form.faces, triangle);
}
