// Discs: the twin of `disc.rs`.

struct Form {
    // How many chords there are; 0 if there is nothing.
    chords: u32,
    right: vec3<f32>,
    up: vec3<f32>,
}

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn glyph_ball(at: u32) -> vec4<f32> {
    return vec4(glyph_position(at), real(at, 6u) * 1.00001);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let normal = vec3(real(at, 3u), real(at, 4u), real(at, 5u));
    let radius = real(at, 6u);
    if !(are_finite(at, 0u, 7u) && has_extent(largest(normal)) && has_extent(radius)) {
        return Form(0u, vec3(0.0), vec3(0.0));
    }
    let across = frame(normal, word(at, 5u));
    return Form(sides(sight, radius), across.right * radius, across.up * radius);
}

fn glyph_size(form: Form) -> vec2<u32> {
    if form.chords == 0u {
        return vec2(0u);
    }
    return vec2(form.chords + 2u, 2u * form.chords);
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    if vertex >= form.chords {
        return vec3(0.0);
    }
    let point = circle(f32(vertex) / f32(form.chords));
    return form.right * point.x + form.up * point.y;
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let chords = max(form.chords, 3u);
    let here = triangle % chords;
    let next = (here + 1u) % chords;
    if triangle < chords {
        return vec3(here, next, chords);
    }
    return vec3(next, here, chords + 1u);
}
