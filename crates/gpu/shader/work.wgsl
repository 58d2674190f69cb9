// The work of a round of drawing, and how far it went: `round.rs` fills and reads it.

struct Round {
    // How many pieces there are, and how many discs there is room for.
    pieces: u32,
    capacity: u32,
    // Discs of at most so many pixels are drawn by the compute shader, if there is one.
    small: u32,
    // Which of the two times this is, where words have 32 bits.
    pass_of_two: u32,
}

struct Counts {
    chunks: atomic<u32>,
    // Discs that are drawn as geometry are kept from the start, small ones from the end.
    large: atomic<u32>,
    small: atomic<u32>,
    bricks: atomic<u32>,
    records: atomic<u32>,
    recalled: atomic<u32>,
    open: atomic<u32>,
    // Whether anything was missed in any round: see `glyph_any.wgsl`.
    missed: atomic<u32>,
}

@group(0) @binding(2) var<uniform> round: Round;
