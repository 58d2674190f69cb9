// The deepest and the shallowest depth of each tile: hierarchical depth with one level above the pixels.

struct Tile {
    deepest: f32,
    shallowest: f32,
}

@group(0) @binding(8) var<storage, read_write> tiles: array<Tile>;

@compute @workgroup_size(64)
fn find_tiles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = number(group, groups, lane);
    let down = (camera.height + TILE - 1u) / TILE;
    if tile >= camera.across * down {
        return;
    }
    let first = vec2(tile % camera.across, tile / camera.across) * TILE;
    let end = min(first + TILE, vec2(camera.width, camera.height));
    // Depths are positive, so their bits are in their order; what is kept is inverted.
    var most = 0u;
    var least = 0xffffffffu;
    for (var row = first.y; row < end.y; row++) {
        for (var column = first.x; column < end.x; column++) {
            let key = visibility[row * camera.width + column].y;
            most = max(most, key);
            least = min(least, key);
        }
    }
    tiles[tile].deepest = bitcast<f32>(min(~least, INFINITY_BITS));
    tiles[tile].shallowest = bitcast<f32>(min(~most, INFINITY_BITS));
}
