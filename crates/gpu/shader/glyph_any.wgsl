// All records are drawn.

// Bits for bricks of which something was missed: several bricks share a bit.
@group(0) @binding(12) var<storage, read_write> missed: array<atomic<u32>>;

fn is_wanted(at: u32) -> bool {
    return true;
}

// There was no room for a triangle of a brick, or too much for a lane: the CPU draws this brick later.
fn miss(brick: u32) {
    atomicStore(&large.missed, 1u);
    atomicOr(&missed[(brick >> 5u) % arrayLength(&missed)], 1u << (brick & 31u));
}
