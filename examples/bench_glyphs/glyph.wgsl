// Glyphs by the functions of the library.

@group(0) @binding(1) var<storage, read> records: array<u32>;
@group(0) @binding(6) var<storage, read> style: array<u32>;
@group(0) @binding(7) var<storage, read> table: array<u32>;
@group(0) @binding(8) var<storage, read> nearest: array<f32>;

// Zeros where there is no record.
fn word(at: u32, k: u32) -> u32 {
    let is_there = at < arrayLength(&records) / WORDS;
    return select(0u, records[select(0u, at * WORDS + k, is_there)], is_there);
}

fn real(at: u32, k: u32) -> f32 {
    return bitcast<f32>(word(at, k));
}

fn style_word(k: u32) -> u32 {
    return style[k];
}

fn style_real(k: u32) -> f32 {
    return bitcast<f32>(style[k]);
}

fn table_word(k: u32) -> u32 {
    return select(0u, table[select(0u, k, k < arrayLength(&table))], k < arrayLength(&table));
}

fn table_real(k: u32) -> f32 {
    return bitcast<f32>(table_word(k));
}

fn form_at(at: u32) -> Form {
    let eye = vec4(camera.eye - glyph_position(at), 1.0);
    return glyph_form(at, Sight(eye, nearest[at], camera.sharpness, camera.pixel));
}

fn triangles_at(at: u32, form: Form) -> u32 {
    let ball = glyph_ball(at);
    for (var i = 0u; i < 5u; i++) {
        let plane = camera.planes[i];
        let reach = ball.w * length(plane.xyz);
        let slack = 1e-5 * (dot(abs(plane.xyz), abs(ball.xyz)) + abs(plane.w));
        if dot(plane.xyz, ball.xyz) + plane.w + reach < -slack {
            return 0u;
        }
    }
    return glyph_size(form).y;
}

fn triangle_at(form: Form, triangle: u32) -> vec3<u32> {
    return glyph_triangle(form, triangle);
}

// Which face it is, is not told.
fn shown_vertex(at: u32, form: Form, vertex: u32) -> Shown {
    return shown(glyph_position(at) + glyph_vertex(form, vertex), 8u * at + 7u);
}
