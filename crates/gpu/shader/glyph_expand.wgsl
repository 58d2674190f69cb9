// The geometry of glyphs as a list.

@group(0) @binding(4) var<storage, read> sights: array<Sight>;
@group(0) @binding(5) var<storage, read_write> sizes: array<vec2<u32>>;
// Where the vertices and the triangles of each record start.
@group(0) @binding(6) var<storage, read> starts: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> vertices: array<f32>;
@group(0) @binding(8) var<storage, read_write> triangles: array<u32>;

@compute @workgroup_size(64)
fn measure(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if is_there(index) {
        sizes[index] = glyph_size(glyph_form(index + BEFORE, sights[index]));
    }
}

// A workgroup for each record: some drivers end a shader that goes through a loop too often.
@compute @workgroup_size(64)
fn expand(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * groups.x + group.x;
    if !is_there(index) {
        return;
    }
    let form = glyph_form(index + BEFORE, sights[index]);
    let size = glyph_size(form);
    if size.y == 0u {
        return;
    }
    let start = starts[index];
    for (var i = lane; i < size.x; i += 64u) {
        let vertex = glyph_vertex(form, i);
        vertices[3u * (start.x + i)] = vertex.x;
        vertices[3u * (start.x + i) + 1u] = vertex.y;
        vertices[3u * (start.x + i) + 2u] = vertex.z;
    }
    for (var i = lane; i < size.y; i += 64u) {
        let triangle = glyph_triangle(form, i);
        triangles[3u * (start.y + i)] = triangle.x;
        triangles[3u * (start.y + i) + 1u] = triangle.y;
        triangles[3u * (start.y + i) + 2u] = triangle.z;
    }
}

// Whether there is such a record. That it looks at what is shared makes that part of every layout.
fn is_there(index: u32) -> bool {
    return index < arrayLength(&sights) && arrayLength(&common_words) > 0u;
}

fn number(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * 64u + lane;
}
