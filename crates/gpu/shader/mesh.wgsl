// Discs as quads that mesh shaders make, 64 in a group.

struct Counted {
    chunks: u32,
    large: u32,
}

@group(0) @binding(7) var<storage, read> counted: Counted;

struct Triangle {
    @builtin(triangle_indices) corners: vec3<u32>,
}

struct Quads {
    @builtin(vertices) vertices: array<Corner, 256>,
    @builtin(primitives) primitives: array<Triangle, 128>,
    @builtin(vertex_count) vertex_count: u32,
    @builtin(primitive_count) primitive_count: u32,
}

var<workgroup> quads: Quads;

@mesh(quads) @workgroup_size(64)
fn quads_of_group(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = group.x * 64u;
    let count = min(counted.large - first, 64u);
    if lane == 0u {
        quads.vertex_count = 4u * count;
        quads.primitive_count = 2u * count;
    }
    if lane < count {
        let disc = discs[first + lane];
        let v = 4u * lane;
        for (var i = 0u; i < 4u; i++) {
            quads.vertices[v + i] = corner(disc, of_quad(disc, i));
        }
        quads.primitives[2u * lane].corners = vec3(v, v + 1u, v + 2u);
        quads.primitives[2u * lane + 1u].corners = vec3(v + 2u, v + 1u, v + 3u);
    }
}
