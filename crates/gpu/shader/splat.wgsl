// Small discs, each drawn by one invocation, pixel by pixel.

@group(0) @binding(6) var<storage, read> discs: array<Disc>;
@group(0) @binding(7) var<storage, read_write> counts: Counts;

@compute @workgroup_size(64)
fn splat(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x * 64u + lane;
    if index >= atomicLoad(&counts.small) {
        return;
    }
    let disc = discs[round.capacity - 1u - index];
    let nearest = nearest_of(disc.depth, disc.radius);
    for (var row = low(disc.rows); row <= high(disc.rows); row++) {
        for (var column = low(disc.columns); column <= high(disc.columns); column++) {
            let place = row * camera.width + column;
            if !may_show(place, nearest) {
                continue;
            }
            let found = hit(disc, vec2(i32(column), i32(row)));
            if found.depth > 0.0 {
                show(place, found.depth, disc.id);
            }
        }
    }
}

// As `proxy`: each pixel around it.
@compute @workgroup_size(64)
fn splat_proxy(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x * 64u + lane;
    if index >= atomicLoad(&counts.small) {
        return;
    }
    let disc = discs[round.capacity - 1u - index];
    let depth = max(disc.depth - disc.radius, camera.near);
    for (var row = low(disc.rows); row <= high(disc.rows); row++) {
        for (var column = low(disc.columns); column <= high(disc.columns); column++) {
            show(row * camera.width + column, depth, disc.id);
        }
    }
}

// As `point`: one pixel.
@compute @workgroup_size(64)
fn splat_point(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x * 64u + lane;
    if index >= atomicLoad(&counts.small) {
        return;
    }
    let disc = discs[round.capacity - 1u - index];
    let at = whole_of(disc.whole) + vec2<i32>(floor(disc.fraction + 0.5));
    if all(at >= vec2(0)) && all(at < vec2(i32(camera.width), i32(camera.height))) {
        let depth = max(disc.depth - disc.radius, camera.near);
        show(u32(at.y) * camera.width + u32(at.x), depth, disc.id);
    }
}
