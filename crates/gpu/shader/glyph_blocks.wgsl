// Blocks of large facets: a workgroup each.

@group(0) @binding(7) var<storage, read_write> counts: Counts;
@group(0) @binding(11) var<storage, read_write> arguments: array<u32, 16>;

// More groups than that lie in two dimensions.
const ACROSS: u32 = 32768u;

// A dispatch over the blocks; and what was recalled is counted.
@compute @workgroup_size(1)
fn over_blocks() {
    let blocks = min(atomicLoad(&large.blocks), arrayLength(&large.block));
    arguments[0] = min(blocks, ACROSS);
    arguments[1] = (blocks + ACROSS - 1u) / ACROSS;
    arguments[2] = 1u;
    atomicAdd(&counts.recalled, atomicExchange(&large.recalled, 0u));
}

@compute @workgroup_size(64)
fn draw_blocks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * ACROSS + group.x;
    if index >= min(atomicLoad(&large.blocks), arrayLength(&large.block)) {
        return;
    }
    let item = large.block[index];
    let facet = large.list[item.x];
    let block = vec2(low(item.y), high(item.y)) * BLOCK;
    let first = max(block, vec2(low(facet.columns), low(facet.rows)));
    let last = min(block + BLOCK - 1u, vec2(high(facet.columns), high(facet.rows)));
    draw_rectangle(facet, first + vec2(lane & 7u, lane >> 3u), last, 8u);
}
