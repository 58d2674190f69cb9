// Prisms: the twin of `prism.rs`.

struct Form {
    // How many sides there are; 0 if there is nothing.
    sides: u32,
    radius: f32,
    turn: f32,
    // Where the base and the top are, relative to the position.
    bottom: f32,
    top: f32,
    // Bit 0 if the base is drawn, bit 1 if the top is.
    caps: u32,
}

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u) + real(at, 4u) * 0.5);
}

fn bottom_of(at: u32, position: vec3<f32>) -> f32 {
    return real(at, 2u) - position.z;
}

fn glyph_ball(at: u32) -> vec4<f32> {
    let position = glyph_position(at);
    let bottom = bottom_of(at, position);
    let top = bottom + real(at, 4u);
    let reach = max(-bottom, top);
    let radius = real(at, 3u);
    return vec4(position, sqrt(radius * radius + reach * reach) * 1.00001);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let radius = real(at, 3u);
    let height = real(at, 4u);
    let count = word(at, 5u);
    let bottom = bottom_of(at, glyph_position(at));
    let top = bottom + height;
    let is_there = are_finite(at, 0u, 5u) && is_finite(word(at, 6u)) && has_extent(radius)
        && has_extent(height) && (count == 0u || (count >= 3u && count <= 64u));
    if !is_there {
        return Form(0u, radius, 0.0, bottom, top, 0u);
    }
    var corners = count;
    if count == 0u {
        corners = sides(sight, radius);
    }
    let turn = real(at, 6u);
    let sees_base = may_see(sight, -sight.eye.z, -bottom);
    let sees_top = may_see(sight, sight.eye.z, top);
    let caps = u32(sees_base) | (u32(sees_top) << 1u);
    return Form(corners, radius, turn - floor(turn), bottom, top, caps);
}

fn glyph_size(form: Form) -> vec2<u32> {
    if form.sides == 0u {
        return vec2(0u);
    }
    let caps = countOneBits(form.caps);
    return vec2(2u * form.sides, 2u * form.sides + caps * (form.sides - 2u));
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    let corners = max(form.sides, 3u);
    let corner = vertex % corners;
    let point = circle(form.turn + f32(corner) / f32(corners)) * form.radius;
    return vec3(point, select(form.top, form.bottom, vertex < corners));
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let corners = max(form.sides, 3u);
    if triangle < 2u * corners {
        let here = triangle / 2u;
        let next = (here + 1u) % corners;
        if (triangle & 1u) == 0u {
            return vec3(here, next, corners + next);
        }
        return vec3(here, corners + next, corners + here);
    }
    let rest = triangle - 2u * corners;
    let corner = 1u + rest % (corners - 2u);
    let is_top = form.caps == 2u || rest >= corners - 2u;
    if is_top {
        return vec3(corners, corners + corner, corners + corner + 1u);
    }
    return vec3(0u, corner + 1u, corner);
}
