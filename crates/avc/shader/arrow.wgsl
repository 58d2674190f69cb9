// Arrows: the twin of `arrow.rs`.

struct Form {
    // How many chords a ring has; 0 if there is nothing.
    chords: u32,
    // How many rings there are: 3, or 1 if there is no shaft.
    rings: u32,
    tail: vec3<f32>,
    neck: vec3<f32>,
    tip: vec3<f32>,
    right: vec3<f32>,
    up: vec3<f32>,
    shaft: f32,
    head: f32,
}

fn start_of(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn vector_of(at: u32) -> vec3<f32> {
    return vec3(real(at, 3u), real(at, 4u), real(at, 5u));
}

fn glyph_position(at: u32) -> vec3<f32> {
    return start_of(at) + vector_of(at) * 0.5;
}

fn glyph_ball(at: u32) -> vec4<f32> {
    let position = glyph_position(at);
    let tail = start_of(at) - position;
    let tip = tail + vector_of(at);
    let reach = max(length(tail), length(tip));
    return vec4(position, (reach + max(real(at, 6u), real(at, 7u))) * 1.00001);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let vector = vector_of(at);
    let shaft = real(at, 6u);
    let head = real(at, 7u);
    let head_length = real(at, 8u);
    let tail = start_of(at) - glyph_position(at);
    let tip = tail + vector;
    let size = largest(vector);
    let is_there = are_finite(at, 0u, 9u) && has_extent(size) && has_extent(head)
        && head_length >= 1e-18 && shaft > -1e-18 && shaft <= 1e18;
    if !is_there {
        return Form(0u, 0u, tail, tail, tip, vec3(0.0), vec3(0.0), shaft, head);
    }
    let scaled = vector / size;
    let share = max(1.0 - min(head_length, 2e18) / size / sqrt(dot(scaled, scaled)), 0.0);
    let across = frame(vector, word(at, 5u));
    return Form(
        sides(sight, max(shaft, head)),
        select(1u, 3u, shaft >= 1e-18),
        tail,
        tail + vector * share,
        tip,
        across.right,
        across.up,
        shaft,
        head,
    );
}

fn glyph_size(form: Form) -> vec2<u32> {
    if form.chords == 0u {
        return vec2(0u);
    }
    return vec2(form.rings * form.chords + 2u, 2u * form.rings * form.chords);
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    let chords = max(form.chords, 3u);
    let has_shaft = form.rings == 3u;
    if vertex == 0u {
        return select(form.neck, form.tail, has_shaft);
    }
    let ring = (vertex - 1u) / chords;
    if ring >= form.rings {
        return form.tip;
    }
    let center = select(form.neck, form.tail, has_shaft && ring == 0u);
    let radius = select(form.head, form.shaft, has_shaft && ring < 2u);
    let point = circle(f32((vertex - 1u) % chords) / f32(chords)) * radius;
    return center + (form.right * point.x + form.up * point.y);
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let chords = max(form.chords, 3u);
    let here = 1u + triangle % chords;
    let next = 1u + (triangle % chords + 1u) % chords;
    let band = triangle / chords;
    if band == 0u {
        return vec3(0u, next, here);
    }
    // Between two rings there are two bands of triangles.
    let below = (band - 1u) / 2u * chords;
    if band == 2u * form.rings - 1u {
        return vec3(below + here, below + next, form.rings * chords + 1u);
    }
    let above = below + chords;
    if (band & 1u) == 1u {
        return vec3(below + here, below + next, above + next);
    }
    return vec3(below + here, above + next, above + here);
}
