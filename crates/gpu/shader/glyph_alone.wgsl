// Glyphs of few triangles: a lane draws all those of its record.

@compute @workgroup_size(64)
fn draw_glyphs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunks[group.x];
    let run = runs[chunk.run];
    let at = (chunk.records & SLOTS) + lane;
    var count = 0u;
    var form: Form;
    if lane <= (chunk.records >> 26u) && is_wanted(at) {
        count = look(run, at, &form);
    }
    if count > TRIANGLES_MAX {
        miss(run.brick);
        return;
    }
    let offset = glyph_position(at) - run.reference;
    for (var first = 0u; first < count; first += 32u) {
        // Which triangles are to be drawn here, and which are left: a bit for each. Most cover no pixel's
        // centre; so lanes that go in step have few left.
        var own = 0u;
        var others = 0u;
        for (var k = 0u; k < min(count - first, 32u); k++) {
            let area = triangle_of(run, offset, form, first + k).area;
            let bit = u32(area > 0u) << k;
            let is_own = is_small(area);
            own |= select(0u, bit, is_own);
            others |= select(bit, 0u, is_own);
        }
        while own != 0u {
            let number = first + firstTrailingBit(own);
            own &= own - 1u;
            let seen = triangle_of(run, offset, form, number);
            draw_small(facet_of(run, id_of(at), seen), seen);
        }
        while others != 0u {
            let number = first + firstTrailingBit(others);
            others &= others - 1u;
            leave(chunk.run, run, at, triangle_of(run, offset, form, number));
        }
    }
}
