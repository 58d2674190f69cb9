// Glyphs of many triangles. Each lane looks at a record: if it is seen, how many triangles has its form?
// A scan of these numbers gives each triangle a place, and the lanes go over all triangles together.

// The triangles of the records up to each lane, and the forms.
var<workgroup> ends: array<u32, 64>;
var<workgroup> forms: array<Form, 64>;

@compute @workgroup_size(64)
fn draw_glyphs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunks[group.x];
    let run = runs[chunk.run];
    let first = chunk.records & SLOTS;
    var count = 0u;
    var form: Form;
    if lane <= (chunk.records >> 26u) && is_wanted(first + lane) {
        count = look(run, first + lane, &form);
    }
    forms[lane] = form;
    // Not so many that sums could be too large for a word.
    scan(lane, min(count, 64u * TRIANGLES_MAX + 1u));
    let total = ends[63];
    if total > 64u * TRIANGLES_MAX {
        miss(run.brick);
        return;
    }
    for (var triangle = lane; triangle < total; triangle += 64u) {
        let owner = owner_of(triangle);
        let at = first + owner;
        let start = select(0u, ends[max(owner, 1u) - 1u], owner > 0u);
        let offset = glyph_position(at) - run.reference;
        let seen = triangle_of(run, offset, forms[owner], triangle - start);
        if is_small(seen.area) {
            draw_small(facet_of(run, id_of(at), seen), seen);
        } else {
            leave(chunk.run, run, at, seen);
        }
    }
}

// The first lane whose triangles end behind this one.
fn owner_of(triangle: u32) -> u32 {
    var low_end = 0u;
    var high_end = 63u;
    while low_end < high_end {
        let middle = (low_end + high_end) / 2u;
        if ends[middle] > triangle {
            high_end = middle;
        } else {
            low_end = middle + 1u;
        }
    }
    return low_end;
}

fn scan(lane: u32, count: u32) {
    ends[lane] = count;
    workgroupBarrier();
    for (var step = 1u; step < 64u; step *= 2u) {
        var before = 0u;
        if lane >= step {
            before = ends[lane - step];
        }
        workgroupBarrier();
        ends[lane] += before;
        workgroupBarrier();
    }
}
