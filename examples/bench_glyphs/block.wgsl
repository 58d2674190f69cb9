// Blocks of 8 bytes: a cell, a type, the faces that are drawn.

@group(0) @binding(1) var<storage, read> records: array<vec2<u32>>;

fn box_at(at: u32) -> Box {
    let record = records[at];
    let cell = vec3(record.x & 0xffffu, record.x >> 16u, record.y & 0xffffu);
    let low = vec3<f32>(cell);
    let id = cell.x + camera.side * (cell.y + camera.side * cell.z);
    let is_there = (record.y >> 16u & 0xffu) != 0u;
    return Box(low, id, low + 1.0, select(0u, record.y >> 24u, is_there));
}
