// The set of ids in a picture, a bit for each: so each is there once.

@group(0) @binding(10) var<storage, read_write> seen: array<atomic<u32>>;

@compute @workgroup_size(64)
fn mark_seen(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = number(group, groups, lane);
    if place >= camera.width * camera.height || !is_covered(place) {
        return;
    }
    let id = id_at(place);
    // Neighboring pixels mostly show the same.
    if place > 0u && is_covered(place - 1u) && id_at(place - 1u) == id {
        return;
    }
    atomicOr(&seen[id >> 5u], 1u << (id & 31u));
}
