// Where words have 32 bits: pixels whose depth has changed forget their ids, which are drawn next.

@group(0) @binding(9) var<storage, read_write> visibility: array<vec2<u32>>;
@group(0) @binding(10) var<storage, read_write> known: array<u32>;

@compute @workgroup_size(64)
fn claim(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = number(group, groups, lane);
    if place < camera.width * camera.height && known[place] != visibility[place].y {
        known[place] = visibility[place].y;
        visibility[place].x = 0u;
    }
}

// Pixels whose ids are right keep them: after what was drawn with its ids in one go.
@compute @workgroup_size(64)
fn accept(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = number(group, groups, lane);
    if place < camera.width * camera.height {
        known[place] = visibility[place].y;
    }
}
