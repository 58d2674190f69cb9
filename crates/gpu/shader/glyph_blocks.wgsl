// Blocks of large triangles, by a workgroup each.

const ACROSS: u32 = 32768u;

@compute @workgroup_size(64)
fn draw_blocks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * ACROSS + group.x;
    let block = large.list[min(index, room())];
    let run = runs[block.run];
    let position = glyph_position(block.at);
    let form = glyph_form(block.at, sight_of(run, position));
    let triangle = triangle_of(run, position - run.reference, form, block.number);
    let first = triangle.first + vec2<i32>(vec2(low(block.place), high(block.place)) * BLOCK);
    let last = min(first + i32(BLOCK) - 1, triangle.last);
    if index < min(atomicLoad(&large.blocks), room()) {
        let facet = facet_of(run, id_of(block.at), triangle);
        draw_rows(facet, first + vec2(i32(lane & 7u), i32(lane >> 3u)), last);
    }
}

// Draws every eighth pixel of every eighth row.
fn draw_rows(facet: Facet, first: vec2<i32>, last: vec2<i32>) {
    let edges = edges_of(facet);
    for (var row = first.y; row <= last.y; row += 8) {
        let y = f32(row - facet.whole.y);
        let a = reach(edges.ab, y);
        let b = reach(edges.bc, y);
        let c = reach(edges.ca, y);
        let left = clamp(max(a.x, max(b.x, c.x)), -PICTURE_FAR, PICTURE_FAR);
        let right = clamp(min(a.y, min(b.y, c.y)), -PICTURE_FAR, PICTURE_FAR);
        let skipped = max(facet.whole.x + i32(ceil(left)) - first.x, 0) + 7;
        let end = min(last.x, facet.whole.x + i32(floor(right)));
        for (var column = first.x + skipped / 8 * 8; column <= end; column += 8) {
            draw_pixel(facet, edges, vec2(column, row));
        }
    }
}
