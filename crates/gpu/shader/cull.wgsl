// Pieces of bricks that are not hidden become chunks, of which each is set up by a workgroup.

struct Piece {
    run: u32,
    // Where its records lie in the page, and how many they are.
    slot: u32,
    count: u32,
    // See the constants below.
    flags: u32,
}

// The first piece of its brick, which counts for it.
const IS_FIRST: u32 = 1u;
// To be left out where it is hidden by what is drawn.
const IS_TESTED: u32 = 2u;
// To be left out if its brick was not drawn in the picture before.
const IS_RECALLED: u32 = 4u;
// To be counted among the records that are drawn.
const IS_COUNTED: u32 = 8u;

struct Chunk {
    run: u32,
    // The place in the page in 26 bits; above them the number of records, less one.
    records: u32,
}

@group(0) @binding(3) var<storage, read> pieces: array<Piece>;
@group(0) @binding(5) var<storage, read_write> chunks: array<Chunk>;
@group(0) @binding(7) var<storage, read_write> counts: Counts;
// By brick, whether it was drawn in this picture, and in the one before.
@group(0) @binding(10) var<storage, read_write> drawn: array<u32>;
@group(0) @binding(12) var<storage, read> drawn_before: array<u32>;

const CHUNK: u32 = 64u;

@compute @workgroup_size(64)
fn cull(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= round.pieces {
        return;
    }
    let piece = pieces[index];
    let brick = runs[piece.run].brick;
    if (piece.flags & IS_RECALLED) != 0u && drawn_before[brick] == 0u {
        return;
    }
    if low(runs[piece.run].columns) > high(runs[piece.run].columns) {
        return;
    }
    let nearest = runs[piece.run].nearest;
    if (piece.flags & IS_TESTED) != 0u
        && is_hidden(runs[piece.run].columns, runs[piece.run].rows, nearest) {
        return;
    }
    drawn[brick] = 1u;
    if (piece.flags & IS_FIRST) != 0u {
        atomicAdd(&counts.bricks, 1u);
    }
    if (piece.flags & IS_COUNTED) != 0u {
        atomicAdd(&counts.records, piece.count);
    }
    let number = (piece.count + CHUNK - 1u) / CHUNK;
    let start = atomicAdd(&counts.chunks, number);
    for (var i = 0u; i < number; i++) {
        let count = min(piece.count - i * CHUNK, CHUNK);
        chunks[start + i] = Chunk(piece.run, (piece.slot + i * CHUNK) | ((count - 1u) << 26u));
    }
}
