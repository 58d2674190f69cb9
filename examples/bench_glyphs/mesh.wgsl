// Boxes by mesh shaders: 32 of them in a group, as 7 vertices and 6 triangles each.

const GLYPHS: u32 = 32u;

struct Triangle {
    @builtin(triangle_indices) corners: vec3<u32>,
}

struct Output {
    @builtin(vertices) vertices: array<Shown, 224>,
    @builtin(primitives) primitives: array<Triangle, 192>,
    @builtin(vertex_count) vertex_count: u32,
    @builtin(primitive_count) primitive_count: u32,
}

var<workgroup> output: Output;

@mesh(output)
@workgroup_size(GLYPHS)
fn glyphs_of_group(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let count = min(part.count - group.x * GLYPHS, GLYPHS);
    if lane == 0u {
        output.vertex_count = 7u * count;
        output.primitive_count = 6u * count;
    }
    if lane < count {
        let first = 7u * lane;
        for (var i = 0u; i < 7u; i++) {
            output.vertices[first + i] = corner(part.first + group.x * GLYPHS + lane, i);
        }
        for (var axis = 0u; axis < 3u; axis++) {
            let a = 1u << ((axis + 1u) % 3u);
            let b = 1u << ((axis + 2u) % 3u);
            let place = 6u * lane + 2u * axis;
            output.primitives[place].corners = vec3(first) + vec3(a | b, a, 0u);
            output.primitives[place + 1u].corners = vec3(first) + vec3(a | b, 0u, b);
        }
    }
}
