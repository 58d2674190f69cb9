// A dispatch over blocks, a workgroup each; and what was recalled is counted.

@group(0) @binding(7) var<storage, read_write> counts: Counts;
@group(0) @binding(11) var<storage, read_write> arguments: array<u32, 16>;

@compute @workgroup_size(1)
fn over_blocks() {
    let blocks = min(atomicLoad(&large.blocks), room());
    arguments[0] = min(blocks, ACROSS);
    arguments[1] = (blocks + ACROSS - 1u) / ACROSS;
    arguments[2] = 1u;
    atomicAdd(&counts.recalled, atomicLoad(&large.recalled));
    atomicMax(&counts.missed, atomicLoad(&large.missed));
}
