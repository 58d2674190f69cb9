// Extruded polygons: the twin of `polygon.rs`.

struct Form {
    height: f32,
    // Its first word in the table.
    first: u32,
    corners: u32,
    rings: u32,
    // The triangles of its roof.
    roof: u32,
}

const NARROW: u32 = 1024u;
const CORNERS_MAX: u32 = 2097152u;

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn glyph_ball(at: u32) -> vec4<f32> {
    return vec4(glyph_position(at), real(at, 3u));
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let height = real(at, 4u);
    let corners = word(at, 6u);
    let rings = word(at, 7u);
    var is_there = height > 0.0;
    for (var k = 0u; k < 5u; k++) {
        is_there = is_there && (word(at, k) & 0x7f800000u) != 0x7f800000u;
    }
    if !is_there || corners < 3u || corners > CORNERS_MAX || rings == 0u || rings > corners / 3u {
        return Form(height, 0u, 0u, 0u, 0u);
    }
    return Form(height, word(at, 5u), corners, rings, corners + 2u * rings - 4u);
}

fn glyph_size(form: Form) -> vec2<u32> {
    return vec2(2u * form.corners, 2u * (form.roof + form.corners));
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    let is_top = vertex >= form.corners;
    let corner = form.first + 2u * select(vertex, vertex - form.corners, is_top);
    return vec3(table_real(corner), table_real(corner + 1u), select(0.0, form.height, is_top));
}

// The first corner of a ring, and behind the last ring how many corners there are.
fn ring_start(form: Form, index: u32) -> u32 {
    if index == 0u {
        return 0u;
    }
    if index >= form.rings {
        return form.corners;
    }
    return table_word(form.first + 2u * form.corners + index - 1u);
}

// The corner after one, on its ring.
fn next_corner(form: Form, corner: u32) -> u32 {
    var index = 0u;
    var above = form.rings;
    while above - index > 1u {
        let middle = (index + above) / 2u;
        if ring_start(form, middle) <= corner {
            index = middle;
        } else {
            above = middle;
        }
    }
    if corner + 1u >= ring_start(form, index + 1u) {
        return ring_start(form, index);
    }
    return corner + 1u;
}

// The corners of a triangle of the roof.
fn roof_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let base = form.first + 2u * form.corners + form.rings - 1u;
    if form.corners <= NARROW {
        return (vec3(table_word(base + triangle)) >> vec3(0u, 10u, 20u)) & vec3(1023u);
    }
    let low = table_word(base + 2u * triangle);
    let high = table_word(base + 2u * triangle + 1u);
    return vec3(low, (low >> 21u) | (high << 11u), high >> 10u) & vec3(CORNERS_MAX - 1u);
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    if triangle < form.roof {
        return roof_triangle(form, triangle) + form.corners;
    }
    if triangle < 2u * form.roof {
        return roof_triangle(form, triangle - form.roof).xzy;
    }
    let half = triangle - 2u * form.roof;
    let from_corner = half >> 1u;
    let to_corner = next_corner(form, from_corner);
    if (half & 1u) == 0u {
        return vec3(from_corner, to_corner, to_corner + form.corners);
    }
    return vec3(from_corner, to_corner + form.corners, from_corner + form.corners);
}
