// Blocks of large triangles, by a workgroup each.

@compute @workgroup_size(64)
fn draw_blocks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * ACROSS + group.x;
    if index >= min(atomicLoad(&large.blocks), room()) {
        return;
    }
    let block = large.list[index];
    let run = runs[block.run];
    let position = glyph_position(block.at);
    let form = glyph_form(block.at, sight_of(run, position));
    let triangle = triangle_between(run, position - run.reference, form, block.names);
    let first = vec2(low(block.first), high(block.first)) + vec2(lane & 7u, lane >> 3u);
    let last = vec2(low(block.last), high(block.last));
    draw_rows(facet_of(run, id_of(block.at), triangle), vec2<i32>(first), vec2<i32>(last));
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
