// Only the records that were seen in the picture before are drawn, and counted.

// A bit for each id.
@group(0) @binding(10) var<storage, read> seen: array<u32>;

fn is_wanted(at: u32) -> bool {
    let id = id_of(at);
    let is_seen = (seen[id >> 5u] & (1u << (id & 31u))) != 0u;
    atomicAdd(&large.recalled, select(0u, 1u - round.pass_of_two, is_seen));
    return is_seen;
}

fn miss(brick: u32) {
    atomicStore(&large.missed, 1u);
}
