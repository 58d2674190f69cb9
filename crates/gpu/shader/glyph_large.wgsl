// Blocks of large triangles, which groups of lanes draw one after the other.

struct Block {
    run: u32,
    at: u32,
    // The first and the last pixel, each as two halves of a word.
    first: u32,
    last: u32,
    // The vertices of the triangle, which is made anew: of other shaders it may have another number.
    names: vec3<u32>,
}

struct Large {
    blocks: atomic<u32>,
    recalled: atomic<u32>,
    // Whether anything was missed.
    missed: atomic<u32>,
    spare: u32,
    // What there is no room for comes into the last one.
    list: array<Block>,
}

@group(0) @binding(6) var<storage, read_write> large: Large;

// More groups than that lie in two dimensions.
const ACROSS: u32 = 32768u;

// How many blocks there is room for.
fn room() -> u32 {
    return arrayLength(&large.list) - 1u;
}
