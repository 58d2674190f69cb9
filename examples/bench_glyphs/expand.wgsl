// Expansion: how many indices each record has, where they start, and which they are.
//
// The places come from sums, not from a counter that all increase: the order is always the same.

const GROUP: u32 = 256u;

@group(0) @binding(3) var<storage, read_write> sums: array<u32>;
@group(0) @binding(4) var<storage, read_write> codes: array<u32>;
// Of an indexed draw; the last one is how many indices were wanted.
@group(0) @binding(5) var<storage, read_write> arguments: array<u32, 6>;

var<workgroup> shared_sums: array<u32, GROUP>;

// The sum of what the invocations up to this one give.
fn sum_up(lane: u32, value: u32) -> u32 {
    shared_sums[lane] = value;
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var sum = shared_sums[lane];
        if lane >= step {
            sum += shared_sums[lane - step];
        }
        workgroupBarrier();
        shared_sums[lane] = sum;
        workgroupBarrier();
    }
    return shared_sums[lane];
}

@compute @workgroup_size(GROUP)
fn count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let local = group.x * GROUP + lane;
    var indices = 0u;
    if local < part.count {
        let at = part.first + local;
        indices = 3u * triangles_at(at, form_at(at));
    }
    let sum = sum_up(lane, indices);
    if lane == GROUP - 1u {
        sums[group.x] = sum;
    }
}

// One workgroup: sums become places.
@compute @workgroup_size(GROUP)
fn scan(@builtin(local_invocation_index) lane: u32) {
    let each = (part.groups + GROUP - 1u) / GROUP;
    let first = min(lane * each, part.groups);
    let end = min(first + each, part.groups);
    var own = 0u;
    for (var i = first; i < end; i++) {
        own += sums[i];
    }
    let sum = sum_up(lane, own);
    var place = sum - own;
    for (var i = first; i < end; i++) {
        let here = sums[i];
        sums[i] = place;
        place += here;
    }
    if lane == GROUP - 1u {
        arguments[0] = min(sum, part.room);
        arguments[1] = 1u;
        arguments[2] = 0u;
        arguments[3] = 0u;
        arguments[4] = 0u;
        arguments[5] = sum;
    }
}

@compute @workgroup_size(GROUP)
fn write(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let local = group.x * GROUP + lane;
    let at = part.first + local;
    var triangles = 0u;
    var form: Form;
    if local < part.count {
        form = form_at(at);
        triangles = triangles_at(at, form);
    }
    var place = sums[group.x] + sum_up(lane, 3u * triangles) - 3u * triangles;
    if place + 3u * triangles > part.room {
        return;
    }
    for (var i = 0u; i < triangles; i++) {
        let numbers = triangle_at(form, i) | vec3(local << SHIFT);
        codes[place] = numbers.x;
        codes[place + 1u] = numbers.y;
        codes[place + 2u] = numbers.z;
        place += 3u;
    }
}
