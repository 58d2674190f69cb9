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

// How many pixels this lane has looked at, and the most: some drivers end a shader that goes through loops
// more than 65535 times. What is more is left as if it were large.
var<private> spent: u32;
const SPENT_MAX: u32 = 16384u;

// How many triangles of a record are to be drawn, and its form: none if it is hidden or covers no pixel's
// centre.
fn look(run: Run, at: u32, form: ptr<function, Form>) -> u32 {
    let ball = glyph_ball(at);
    let disc = place(run, vec4(ball.xyz, ball.w * AROUND));
    let nearest = nearest_of(disc.depth, disc.radius);
    if low(disc.columns) > high(disc.columns) || is_hidden(disc.columns, disc.rows, nearest) {
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

// Leaves a triangle to be drawn block by block.
fn leave(run: u32, at: u32, number: u32, triangle: Triangle) {
    let sides = vec2<u32>(triangle.last - triangle.first) / BLOCK + 1u;
    let wanted = select(0u, sides.x * sides.y, triangle.area > 0u);
    // Once there is no more room, nothing is added: what is missing is known.
    let is_full = atomicLoad(&large.blocks) > room();
    let count = select(wanted, 0u, is_full);
    let slot = atomicAdd(&large.blocks, count);
    for (var i = 0u; i < count; i++) {
                large.list[min(slot + i, room())] = Block(run, at, number, (i % sides.x) | ((i / sides.x) << 16u));
    }
}
