// Glyphs by mesh shaders: some triangles of one glyph in each group.

const TRIANGLES: u32 = 84u;
const LANES: u32 = 32u;

struct Triangle {
    @builtin(triangle_indices) corners: vec3<u32>,
}

struct Output {
    @builtin(vertices) vertices: array<Shown, 252>,
    @builtin(primitives) primitives: array<Triangle, 84>,
    @builtin(vertex_count) vertex_count: u32,
    @builtin(primitive_count) primitive_count: u32,
}

var<workgroup> output: Output;

@mesh(output)
@workgroup_size(LANES)
fn glyphs_of_group(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let at = part.first + group.x;
    let form = form_at(at);
    let all = triangles_at(at, form);
    let first = min(group.y * TRIANGLES, all);
    let count = min(all - first, TRIANGLES);
    if lane == 0u {
        output.vertex_count = 3u * count;
        output.primitive_count = count;
    }
    for (var i = lane; i < count; i += LANES) {
        let corners = glyph_triangle(form, first + i);
        output.vertices[3u * i] = shown_vertex(at, form, corners.x);
        output.vertices[3u * i + 1u] = shown_vertex(at, form, corners.y);
        output.vertices[3u * i + 2u] = shown_vertex(at, form, corners.z);
        output.primitives[i].corners = 3u * i + vec3(0u, 1u, 2u);
    }
}
