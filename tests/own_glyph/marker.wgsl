struct Form { half: f32, height: f32, is_there: bool }

fn glyph_position(at: u32) -> vec3<f32> { return vec3(real(at, 0u), real(at, 1u), real(at, 2u)); }
fn glyph_ball(at: u32) -> vec4<f32> { return vec4(glyph_position(at), real(at, 3u) * 1.5); }
fn glyph_form(at: u32, sight: Sight) -> Form {
    let height = real(at, 3u);
    return Form(height * 0.5, height, height > 1e-18 && height < 1e18 && real(at, 4u) >= style_real(0u));
}
fn glyph_size(form: Form) -> vec2<u32> { return select(vec2(0u), vec2(5u, 6u), form.is_there); }
fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    let side = select(vec2(-form.half), vec2(form.half), vec2((vertex & 1u) != 0u, (vertex & 2u) != 0u));
    return select(vec3(side, form.height), vec3(0.0), vertex == 4u);
}
fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    switch triangle {
        case 0u: { return vec3(0u, 1u, 3u); }
        case 1u: { return vec3(0u, 3u, 2u); }
        case 2u: { return vec3(1u, 0u, 4u); }
        case 3u: { return vec3(3u, 1u, 4u); }
        case 4u: { return vec3(2u, 3u, 4u); }
        default: { return vec3(0u, 2u, 4u); }
    }
}
