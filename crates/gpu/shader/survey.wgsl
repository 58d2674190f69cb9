// What the bricks that are left could still change: as `survey.rs` of the CPU's renderer.

struct Left {
    run: u32,
    // The view depth behind which the brick has no surface.
    far: f32,
}

@group(0) @binding(3) var<storage, read> left: array<Left>;
@group(0) @binding(4) var<storage, read_write> gains: array<f32>;
@group(0) @binding(7) var<storage, read_write> counts: Counts;
// For each tile, the least depth at which a brick that is left begins, in bits that keep the order.
@group(0) @binding(10) var<storage, read_write> outlook: array<atomic<u32>>;

// What a covered pixel may gain at most, in pixels that show nothing.
const COVERED: f32 = 0.5;
const SMALLEST: f32 = 1.17549435e-38;

@compute @workgroup_size(64)
fn clear_outlook(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index < arrayLength(&outlook) {
        atomicStore(&outlook[index], 0xffffffffu);
    }
}

// The bits of a number, such that they are in the order of numbers.
fn ordered(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits >> 31u) != 0u);
}

@compute @workgroup_size(64)
fn look(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= round.pieces {
        return;
    }
    gains[index] = gain(left[index]);
}

// Whether a brick is not hidden, as `cull` tests it: what is hidden need not even be brought here.
@compute @workgroup_size(64)
fn glance(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= round.pieces {
        return;
    }
    let run = left[index].run;
    gains[index] = f32(!is_hidden(runs[run].columns, runs[run].rows, runs[run].nearest));
}

fn gain(brick: Left) -> f32 {
    let nearest = runs[brick.run].nearest;
    let columns = vec2(low(runs[brick.run].columns), high(runs[brick.run].columns));
    let rows = vec2(low(runs[brick.run].rows), high(runs[brick.run].rows));
    if columns.x > columns.y || rows.x > rows.y {
        return 0.0;
    }
    let scale = 1.0 / (brick.far - nearest);
    var is_open = false;
    var gain = 0.0;
    for (var y = rows.x / TILE; y <= rows.y / TILE; y++) {
        for (var x = columns.x / TILE; x <= columns.y / TILE; x++) {
            let tile = y * camera.across + x;
            if tiles[tile].deepest < nearest {
                continue;
            }
            let first = max(vec2(x, y) * TILE, vec2(columns.x, rows.x));
            let last = min(vec2(x, y) * TILE + TILE - 1u, vec2(columns.y, rows.y));
            var found = vec2(0.0);
            if bitcast<u32>(tiles[tile].shallowest) == INFINITY_BITS {
                found = vec2(f32((last.x - first.x + 1u) * (last.y - first.y + 1u)));
            } else {
                found = count(first, last, nearest, scale);
            }
            if found.x > 0.0 {
                atomicMin(&outlook[tile], ordered(nearest));
                is_open = true;
                gain += found.y;
            }
        }
    }
    if !is_open {
        return 0.0;
    }
    // What can change something has something to gain, even where the sum is 0 or no number.
    return select(SMALLEST, gain, gain > 0.0);
}

// The open pixels of a rectangle, and what they may gain.
fn count(first: vec2<u32>, last: vec2<u32>, nearest: f32, scale: f32) -> vec2<f32> {
    var found = vec2(0.0);
    for (var row = first.y; row <= last.y; row++) {
        for (var column = first.x; column <= last.x; column++) {
            let place = row * camera.width + column;
            if !is_covered(place) {
                found += 1.0;
            } else if depth_at(place) >= nearest {
                let share = clamp((depth_at(place) - nearest) * scale, 0.0, 1.0);
                found += vec2(1.0, COVERED * share);
            }
        }
    }
    return found;
}

@compute @workgroup_size(64)
fn count_open(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = number(group, groups, lane);
    let down = (camera.height + TILE - 1u) / TILE;
    if tile >= camera.across * down {
        return;
    }
    let nearest = atomicLoad(&outlook[tile]);
    if nearest == 0xffffffffu {
        return;
    }
    let first = vec2(tile % camera.across, tile / camera.across) * TILE;
    let end = min(first + TILE, vec2(camera.width, camera.height));
    var open = 0u;
    for (var row = first.y; row < end.y; row++) {
        for (var column = first.x; column < end.x; column++) {
            open += u32(ordered(depth_at(row * camera.width + column)) >= nearest);
        }
    }
    atomicAdd(&counts.open, open);
}
