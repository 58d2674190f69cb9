// What was counted becomes the arguments of indirect calls. In 32-bit words: a dispatch over chunks, a
// draw of the large discs, a dispatch over the small ones, and one of mesh groups.

@group(0) @binding(7) var<storage, read_write> counts: Counts;
@group(0) @binding(11) var<storage, read_write> arguments: array<u32, 16>;

// How many vertices a disc has; whether discs are instances.
override vertices: u32 = 3u;
override is_instanced: bool = false;

@compute @workgroup_size(1)
fn over_chunks() {
    arguments[0] = atomicLoad(&counts.chunks);
    arguments[1] = 1u;
    arguments[2] = 1u;
}

@compute @workgroup_size(1)
fn over_discs() {
    let large = atomicLoad(&counts.large);
    let small = atomicLoad(&counts.small);
    if is_instanced {
        arguments[4] = vertices;
        arguments[5] = large;
    } else {
        arguments[4] = vertices * large;
        arguments[5] = 1u;
    }
    arguments[6] = 0u;
    arguments[7] = 0u;
    arguments[8] = (small + 63u) / 64u;
    arguments[9] = 1u;
    arguments[10] = 1u;
    arguments[12] = (large + 63u) / 64u;
    arguments[13] = 1u;
    arguments[14] = 1u;
}
