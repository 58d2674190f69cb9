// The set of ids in a band of the picture, and a number for each of them.

@group(0) @binding(7) var<storage, read_write> total: array<atomic<u32>, 4>;
@group(0) @binding(10) var<storage, read_write> seen: array<atomic<u32>>;
@group(0) @binding(13) var<storage, read_write> bases: array<u32>;

@compute @workgroup_size(64)
fn mark_band(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    let place = band().x + index;
    if index >= band().y || !is_covered(place) {
        return;
    }
    let id = id_at(place);
    // Neighboring pixels mostly show the same.
    if index > 0u && is_covered(place - 1u) && id_at(place - 1u) == id {
        return;
    }
    atomicOr(&seen[id >> 5u], 1u << (id & 31u));
}

// Ids are numbered word by word, in whatever order the words come: the number of an id is the base of
// its word and the bits below its own.
@compute @workgroup_size(64)
fn number_ids(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let word = number(group, groups, lane);
    if word >= shade.words {
        return;
    }
    let count = countOneBits(atomicLoad(&seen[word]));
    if count > 0u {
        bases[word] = atomicAdd(&total[0], count);
    }
}
