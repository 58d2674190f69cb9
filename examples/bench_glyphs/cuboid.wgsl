// Cuboids of 24 bytes: centre and extent.

@group(0) @binding(1) var<storage, read> records: array<f32>;

fn box_at(at: u32) -> Box {
    let first = 6u * at;
    let center = vec3(records[first], records[first + 1u], records[first + 2u]);
    let half = vec3(records[first + 3u], records[first + 4u], records[first + 5u]) * 0.5;
    let is_there = all(half > vec3(0.0));
    return Box(center - half, at, center + half, select(0u, 63u, is_there));
}
