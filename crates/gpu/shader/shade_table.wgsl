// The records that are seen go into a table, by the numbers of their ids.

struct Chunk {
    run: u32,
    records: u32,
}

@group(0) @binding(3) var<storage, read> spheres: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> ids: array<u32>;
@group(0) @binding(5) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(6) var<storage, read> listed: array<Entry>;
@group(0) @binding(7) var<uniform> listed_count: vec4<u32>;
@group(0) @binding(10) var<storage, read> seen: array<u32>;
@group(0) @binding(13) var<storage, read> bases: array<u32>;
@group(0) @binding(14) var<storage, read> colors: array<u32>;
@group(0) @binding(15) var<storage, read_write> table: array<Entry>;

const SLOTS: u32 = 0x3ffffffu;

// The number of an id, if it is seen.
fn number_of(id: u32) -> i32 {
    let word = seen[id >> 5u];
    let bit = 1u << (id & 31u);
    if (word & bit) == 0u {
        return -1;
    }
    return i32(bases[id >> 5u] + countOneBits(word & (bit - 1u)));
}

// Those of chunks of bricks.
@compute @workgroup_size(64)
fn enter(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let chunk = chunks[group.x];
    if lane > (chunk.records >> 26u) {
        return;
    }
    let slot = (chunk.records & SLOTS) + lane;
    let at = number_of(ids[slot]);
    if at < 0 {
        return;
    }
    let disc = place(runs[chunk.run], spheres[slot]);
    let k = vec3(disc.slope, 1.0) * disc.scale;
    let color = colors[slot * shade.per_record];
    table[at] = Entry(turn(k, -disc.fraction), disc.whole, k, color);
}

// Those that the CPU has listed.
@compute @workgroup_size(64)
fn enter_listed(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= listed_count.x {
        return;
    }
    let at = number_of(ids[index]);
    if at >= 0 {
        table[at] = listed[index];
    }
}
