// As `set_up`, for the records that were seen in the picture before.

// A bit for each id.
@group(0) @binding(10) var<storage, read> seen: array<u32>;

@compute @workgroup_size(64)
fn recall(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let chunk = chunks[group.x];
    if lane > (chunk.records >> 26u) {
        return;
    }
    let slot = (chunk.records & SLOTS) + lane;
    let id = ids[slot];
    if (seen[id >> 5u] & (1u << (id & 31u))) == 0u {
        return;
    }
    atomicAdd(&counts.recalled, 1u);
    emit(chunk.run, slot);
}
