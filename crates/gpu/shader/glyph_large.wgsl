// Blocks of large triangles, which are drawn one after the other.

struct Block {
    run: u32,
    at: u32,
    // The triangle of the record.
    number: u32,
    // Which block of the triangle, counted from its first pixel: its column and row as two halves of a
    // word.
    place: u32,
}

struct Large {
    blocks: atomic<u32>,
    recalled: atomic<u32>,
    spare: vec2<u32>,
    // What there is no room for comes into the last one.
    list: array<Block>,
}

@group(0) @binding(6) var<storage, read_write> large: Large;

// The side of a block, in pixels.
const BLOCK: u32 = 64u;

// How many blocks there is room for.
fn room() -> u32 {
    return arrayLength(&large.list) - 1u;
}
