// Records of chunks become discs, unless they cover no pixel's centre or are hidden.

struct Chunk {
    run: u32,
    records: u32,
}

@group(0) @binding(3) var<storage, read> spheres: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> ids: array<u32>;
@group(0) @binding(5) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(6) var<storage, read_write> discs: array<Disc>;
@group(0) @binding(7) var<storage, read_write> counts: Counts;

const SLOTS: u32 = 0x3ffffffu;

@compute @workgroup_size(64)
fn set_up(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let chunk = chunks[group.x];
    if lane > (chunk.records >> 26u) {
        return;
    }
    let slot = (chunk.records & SLOTS) + lane;
    emit(chunk.run, slot);
}

fn emit(run: u32, slot: u32) {
    var disc = place(runs[run], spheres[slot]);
    // As `nearest_depth` of the core.
    let nearest = disc.depth - disc.radius - 1e-6 * (abs(disc.depth) + disc.radius);
    if low(disc.columns) > high(disc.columns) || is_hidden(disc.columns, disc.rows, nearest) {
        return;
    }
    disc.slot = slot;
    disc.id = ids[slot];
    let sides = vec2(high(disc.columns) - low(disc.columns), high(disc.rows) - low(disc.rows)) + 1u;
    if sides.x * sides.y <= round.small {
        discs[round.capacity - 1u - atomicAdd(&counts.small, 1u)] = disc;
    } else {
        discs[atomicAdd(&counts.large, 1u)] = disc;
    }
}
