// A dispatch over blocks, a workgroup each; and what was recalled is counted.

@group(0) @binding(7) var<storage, read_write> counts: Counts;
@group(0) @binding(11) var<storage, read_write> arguments: array<u32, 16>;

// More groups than that lie in two dimensions.
const ACROSS: u32 = 32768u;

@compute @workgroup_size(1)
fn over_blocks() {
    let wanted = atomicLoad(&large.blocks);
    let blocks = min(wanted, room());
    arguments[0] = min(blocks, ACROSS);
    arguments[1] = (blocks + ACROSS - 1u) / ACROSS;
    arguments[2] = 1u;
    atomicAdd(&counts.recalled, atomicExchange(&large.recalled, 0u));
    atomicMax(&counts.missed, wanted - blocks);
}
