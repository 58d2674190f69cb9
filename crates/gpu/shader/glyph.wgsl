// Chunks of glyphs become pixels, by one workgroup each: what `glyph_alone.wgsl` and `glyph_together.wgsl`
// have in common.
//
// A lane draws a triangle itself if it is small. What is large is left for `glyph_blocks.wgsl`, block by
// block, as far as there is room.
//
// Processors that stand in for a GPU go through all code that is written for a lane, whatever it branches
// on, and through the body of each loop at least once. So there is only one place where pixels are drawn,
// and little else in its way.

struct Chunk {
    run: u32,
    records: u32,
}

@group(0) @binding(5) var<storage, read> chunks: array<Chunk>;

const SLOTS: u32 = 0x3ffffffu;

// By how much a ball is larger than what it holds: more than rounding.
const AROUND: f32 = 1.00001;

// How many pixels this lane has drawn itself, and how many blocks it has left. How many these and triangles
// may be, `solid_shaders.rs` says: drivers end a shader that takes too long. What would be too many pixels is
// left, too; where anything else is too much, the brick is missed.
var<private> spent: u32;
var<private> left: u32;

// How many triangles of a record are to be drawn, and its form: none if it is hidden or covers no pixel's
// centre.
fn look(run: Run, at: u32, form: ptr<function, Form>) -> u32 {
    let ball = glyph_ball(at);
    let disc = place(run, vec4(ball.xyz, ball.w * AROUND));
    let nearest = nearest_of(disc.depth, disc.radius);
    let first = vec2(low(disc.columns), low(disc.rows)) / TILE;
    let last = vec2(high(disc.columns), high(disc.rows)) / TILE;
    let sides = last + 1u - first;
    let is_tested = sides.x * sides.y <= TILES_MAX;
    if low(disc.columns) > high(disc.columns)
        || (is_tested && is_hidden(disc.columns, disc.rows, nearest)) {
        return 0u;
    }
    *form = glyph_form(at, sight_of(run, glyph_position(at)));
    return glyph_size(*form).y;
}

// Whether this lane draws a triangle of so many pixels itself.
fn is_small(area: u32) -> bool {
    let is_small = area <= round.small && spent + area <= SPENT_MAX;
    spent += select(0u, area, is_small);
    return is_small;
}

// Draws all pixels of a triangle that covers few.
fn draw_small(facet: Facet, triangle: Triangle) {
    let edges = edges_of(facet);
    var at = triangle.first;
    while at.y <= triangle.last.y {
        draw_pixel(facet, edges, at);
        let is_last = at.x == triangle.last.x;
        at = select(at + vec2(1, 0), vec2(triangle.first.x, at.y + 1), is_last);
    }
}

// The largest side of a block, in pixels, of a triangle that is not large for one.
const BLOCK: u32 = 64u;

// Leaves a triangle to be drawn block by block: 16 at most. Those that are drawn first are drawn again in
// the second pass.
fn leave(index: u32, run: Run, at: u32, triangle: Triangle) {
    let size = vec2<u32>(triangle.last + 1 - triangle.first);
    let side = max(BLOCK, (max(size.x, size.y) + 3u) / 4u);
    let sides = (size + side - 1u) / side;
    let wanted = select(sides.x * sides.y, 0u, round.pass_of_two == 1u);
    left += wanted;
    // Once there is no more room, nothing is added, so that no sum is too large for a word.
    let is_full = left > LEFT_MAX || atomicLoad(&large.blocks) > room();
    let count = select(wanted, 0u, is_full);
    let slot = atomicAdd(&large.blocks, count);
    if count < wanted || slot + count > room() {
        miss(run.brick);
    }
    for (var i = 0u; i < count; i++) {
        let first = triangle.first + vec2<i32>(vec2(i % sides.x, i / sides.x) * side);
        let last = min(first + i32(side) - 1, triangle.last);
        let block = Block(index, at, pack(first.x, first.y), pack(last.x, last.y), triangle.names);
        large.list[min(slot + i, room())] = block;
    }
}
