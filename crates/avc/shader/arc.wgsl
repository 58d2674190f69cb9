// Arcs: the twin of `arc.rs`.

struct Form {
    radii: vec2<f32>,
    height: f32,
    turns: vec2<f32>,
    chords: vec2<u32>,
    first: i32,
    segments: u32,
    is_ring: bool,
    is_pie: bool,
}

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn glyph_ball(at: u32) -> vec4<f32> {
    return vec4(glyph_position(at), length(vec2(real(at, 4u), real(at, 7u))) * 1.000001);
}

// Whether all numbers of the record are finite, by their bits.
fn is_finite(at: u32) -> bool {
    var result = true;
    for (var k = 0u; k < 8u; k++) {
        result = result && (word(at, k) & 0x7f800000u) != 0x7f800000u;
    }
    return result;
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let radii = vec2(real(at, 3u), real(at, 4u));
    let turns = vec2(real(at, 5u), real(at, 6u));
    let height = real(at, 7u);
    let chords = vec2(ring(sight, radii.x), ring(sight, radii.y));
    var form = Form(radii, height, turns, chords, 0i, 0u, turns.y - turns.x >= 1.0, radii.x == 0.0);
    let is_there = radii.x >= 0.0 && radii.y > radii.x && turns.y > turns.x && height > 0.0;
    if !(is_there && is_finite(at)) {
        return form;
    }
    if form.is_ring {
        form.segments = chords.y;
        return form;
    }
    // Whole turns are taken away where that is exact, so that what is left is small.
    let whole = select(0.0, floor(turns.x), abs(turns.x) >= 2.0);
    let steps = f32(chords.y);
    let after = floor((turns.x - whole) * steps) + 1.0;
    let until = ceil((turns.y - whole) * steps);
    form.first = i32(after);
    form.segments = u32(until - after) + 1u;
    return form;
}

// A point of the polygon that stands for the unit circle.
fn polygon(chords: u32, angle: f32) -> vec2<f32> {
    let steps = f32(chords);
    let at = (angle - floor(angle)) * steps;
    let corner = floor(at);
    let share = at - corner;
    let start = circle(corner / steps);
    return start + (circle((corner + 1.0) / steps) - start) * share;
}

fn breaks(form: Form) -> u32 {
    return form.segments + u32(!form.is_ring);
}

fn break_angle(form: Form, index: u32) -> f32 {
    if !form.is_ring && index == 0u {
        return form.turns.x;
    }
    if !form.is_ring && index == form.segments {
        return form.turns.y;
    }
    let corner = form.first + i32(index) - i32(!form.is_ring);
    return f32(u32(corner) & (form.chords.y - 1u)) / f32(form.chords.y);
}

// The vertex at a breakpoint: at the outer bottom, the outer top, the inner top, the inner bottom.
fn corner_at(form: Form, index: u32, corner: u32) -> u32 {
    if !form.is_pie {
        return 4u * index + corner;
    }
    if corner < 2u {
        return 2u * index + corner;
    }
    return 2u * breaks(form) + corner - 2u;
}

fn glyph_size(form: Form) -> vec2<u32> {
    if form.segments == 0u {
        return vec2(0u);
    }
    let ends = select(4u, 0u, form.is_ring);
    if form.is_pie {
        return vec2(2u * breaks(form) + 2u, 4u * form.segments + ends);
    }
    return vec2(4u * breaks(form), 8u * form.segments + ends);
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    var index = vertex >> 2u;
    var corner = vertex & 3u;
    if form.is_pie {
        if vertex < 2u * breaks(form) {
            index = vertex >> 1u;
            corner = vertex & 1u;
        } else {
            index = 0u;
            corner = vertex - 2u * breaks(form) + 2u;
        }
    }
    let z = select(0.0, form.height, corner == 1u || corner == 2u);
    let chords = select(form.chords.x, form.chords.y, corner < 2u);
    let radius = select(form.radii.x, form.radii.y, corner < 2u);
    return vec3(polygon(chords, break_angle(form, index)) * radius, z);
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let faces = select(8u, 4u, form.is_pie);
    let index = triangle / faces;
    let face = triangle % faces;
    if index == form.segments {
        // The ends: two triangles of the profile each.
        let place = select(form.segments, 0u, face < 2u);
        let a = corner_at(form, place, 0u);
        let b = corner_at(form, place, 1u + (face & 1u));
        let c = corner_at(form, place, 2u + (face & 1u));
        return select(vec3(a, c, b), vec3(a, b, c), face < 2u);
    }
    let next = select(index + 1u, 0u, index + 1u == breaks(form));
    if form.is_pie && face == 2u {
        return vec3(corner_at(form, index, 1u), corner_at(form, next, 1u), corner_at(form, 0u, 2u));
    }
    if form.is_pie && face == 3u {
        return vec3(corner_at(form, next, 0u), corner_at(form, index, 0u), corner_at(form, 0u, 3u));
    }
    let low = face >> 1u;
    let high = (low + 1u) & 3u;
    let start = corner_at(form, index, low);
    let across = corner_at(form, next, high);
    if (face & 1u) == 0u {
        return vec3(start, corner_at(form, next, low), across);
    }
    return vec3(start, across, corner_at(form, index, high));
}
