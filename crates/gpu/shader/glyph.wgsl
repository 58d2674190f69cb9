// Chunks of glyphs become pixels, by one workgroup each.
//
// Each lane looks at a record: if it is seen, how many triangles has its form? If no record has many, each
// lane draws those of its own. Otherwise a scan of these numbers gives each triangle a place, and the lanes
// go over all triangles together. A lane draws a triangle itself if it is small. Others are left for
// `glyph_blocks.wgsl`, as many as there is room for.

struct Chunk {
    run: u32,
    records: u32,
}

struct Tile {
    deepest: f32,
    shallowest: f32,
}

@group(0) @binding(5) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(8) var<storage, read> tiles: array<Tile>;
// A bit for each id that was seen in the picture before.
@group(0) @binding(10) var<storage, read> seen: array<u32>;

const SLOTS: u32 = 0x3ffffffu;

// By how much a ball is larger than what it holds: more than rounding.
const AROUND: f32 = 1.00001;

// The triangles of the records up to each lane, and whether any record is large.
var<workgroup> ends: array<u32, 64>;
var<workgroup> any_large: atomic<u32>;

// Records with more triangles or vertices than these are shared among lanes: they are larger than boxes.
const FEW: u32 = 12u;
const VERTICES: u32 = 8u;

// How many pixels this lane has looked at, and the most: some drivers end a shader that goes through loops
// more than 65535 times. What is more is left as if it were large.
var<private> spent: u32;
const SPENT_MAX: u32 = 16384u;

@compute @workgroup_size(64)
fn draw_glyphs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunks[group.x];
    let first = chunk.records & SLOTS;
    var count = 0u;
    var form: Form;
    if lane <= (chunk.records >> 26u) {
        count = look(runs[chunk.run], first + lane, &form);
    }
    draw_chunk(runs[chunk.run], first + lane, vec2(lane, count), form);
}

// As `draw_glyphs`, for the records that were seen in the picture before.
@compute @workgroup_size(64)
fn recall_glyphs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunks[group.x];
    let first = chunk.records & SLOTS;
    var count = 0u;
    var form: Form;
    if lane <= (chunk.records >> 26u) {
        let id = id_of(first + lane);
        if (seen[id >> 5u] >> (id & 31u) & 1u) != 0u {
            atomicAdd(&large.recalled, 1u - round.pass_of_two);
            count = look(runs[chunk.run], first + lane, &form);
        }
    }
    draw_chunk(runs[chunk.run], first + lane, vec2(lane, count), form);
}

// Draws the records of a chunk. That of this lane lies at a place and has so many triangles.
fn draw_chunk(run: Run, own: u32, lane: vec2<u32>, form: Form) {
    let is_large = lane.y > FEW || (lane.y > 0u && glyph_size(form).x > VERTICES);
    scan(lane.x, lane.y, is_large);
    if atomicLoad(&any_large) == 0u {
        draw_own(run, own, form, lane.y);
        return;
    }
    let first = own - lane.x;
    let total = ends[63];
    for (var triangle = lane.x; triangle < total; triangle += 64u) {
        // The first record whose triangles end behind this one.
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
        var start = 0u;
        if low_end > 0u {
            start = ends[low_end - 1u];
        }
        let at = first + low_end;
        let position = glyph_position(at);
        let shared_form = glyph_form(at, sight_of(run, position));
        let names = glyph_triangle(shared_form, triangle - start);
        let offset = position - run.reference;
        // A loop, so that compilers see the code of a glyph once.
        var corners: array<Corner, 3>;
        for (var k = 0u; k < 3u; k++) {
            corners[k] = corner(run, offset + glyph_vertex(shared_form, names[k]));
        }
        draw_triangle(run, id_of(at), corners[0], corners[1], corners[2]);
    }
}

// Draws the triangles of one record, whose few vertices are placed once.
fn draw_own(run: Run, at: u32, form: Form, count: u32) {
    if count == 0u {
        return;
    }
    let offset = glyph_position(at) - run.reference;
    let id = id_of(at);
    var corners: array<Corner, 8>;
    for (var vertex = 0u; vertex < min(glyph_size(form).x, VERTICES); vertex++) {
        corners[vertex] = corner(run, offset + glyph_vertex(form, vertex));
    }
    for (var triangle = 0u; triangle < count; triangle++) {
        let names = glyph_triangle(form, triangle) & vec3(VERTICES - 1u);
        draw_triangle(run, id, corners[names.x], corners[names.y], corners[names.z]);
    }
}

fn id_of(at: u32) -> u32 {
    return word(at, WORDS - 1u);
}

fn scan(lane: u32, count: u32, is_large: bool) {
    ends[lane] = count;
    if lane == 0u {
        atomicStore(&any_large, 0u);
    }
    workgroupBarrier();
    atomicMax(&any_large, u32(is_large));
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

// What the view is for a record.
fn sight_of(run: Run, position: vec3<f32>) -> Sight {
    var sight: Sight;
    sight.sharpness = bitcast<f32>(common_words[0]);
    sight.pixel = camera.pixel;
    let center = run.center;
    let eye = -(camera.right * center.x + camera.up * center.y + camera.forward * center.z);
    let place = vec4(eye - (position - run.reference), 1.0);
    sight.eye = select(vec4(-camera.forward, 0.0), place, is_perspective());
    sight.nearest = select(1.0, run.nearest, is_perspective());
    return sight;
}

// How many triangles of a record are to be drawn, and its form: none if it is hidden or covers no pixel's
// centre.
fn look(run: Run, at: u32, form: ptr<function, Form>) -> u32 {
    let ball = glyph_ball(at);
    let disc = place(run, vec4(ball.xyz, ball.w * AROUND));
    if low(disc.columns) > high(disc.columns) || is_hidden(disc) {
        return 0u;
    }
    *form = glyph_form(at, sight_of(run, glyph_position(at)));
    return glyph_size(*form).y;
}

fn is_hidden(disc: Disc) -> bool {
    let nearest = nearest_of(disc.depth, disc.radius);
    let columns = vec2(low(disc.columns), high(disc.columns)) / TILE;
    let rows = vec2(low(disc.rows), high(disc.rows)) / TILE;
    for (var row = rows.x; row <= rows.y; row++) {
        for (var column = columns.x; column <= columns.y; column++) {
            if !(tiles[row * camera.across + column].deepest < nearest) {
                return false;
            }
        }
    }
    return true;
}

struct Corner {
    // In camera coordinates, relative to the reference, and the view depth.
    local: vec3<f32>,
    depth: f32,
    // In pixels, relative to the pixel of the run.
    at: vec2<f32>,
}

fn corner(run: Run, offset: vec3<f32>) -> Corner {
    let local = vec3(
        dot(camera.right, offset),
        dot(camera.up, offset),
        dot(camera.forward, offset),
    );
    let depth = run.center.z + local.z;
    let spread = select(1.0, depth, is_perspective());
    let aside = (local.xy - run.slope * local.z) * (camera.per_pixel / spread);
    return Corner(local, depth, run.fraction + vec2(aside.x, -aside.y));
}

// Draws a triangle of a record.
fn draw_triangle(run: Run, id: u32, a: Corner, b: Corner, c: Corner) {
    let ab = b.at - a.at;
    let ac = c.at - a.at;
    // In a picture, where rows run downwards, what is seen from in front turns the other way round.
    if !(ab.x * ac.y - ab.y * ac.x < 0.0) {
        return;
    }
    let low_at = min(a.at, min(b.at, c.at)) - WIDER;
    let high_at = max(a.at, max(b.at, c.at)) + WIDER;
    let first = max(run.whole + vec2<i32>(ceil(low_at)), vec2(0));
    let size = vec2(i32(camera.width), i32(camera.height));
    let last = min(run.whole + vec2<i32>(floor(high_at)), size - 1);
    if any(first > last) {
        return;
    }
    // Camera coordinates are left-handed: this points outwards.
    let normal = cross(c.local - a.local, b.local - a.local);
    var facet: Facet;
    let away = dot(normal, run.center + a.local);
    let seen = normal.xy * (camera.pixel * a.depth / away);
    facet.slope = select(-normal.xy * (camera.pixel / normal.z), seen, is_perspective());
    facet.slope.y = -facet.slope.y;
    facet.a = a.at;
    facet.b = c.at;
    facet.c = b.at;
    facet.depth = a.depth;
    facet.nearest = max(min(a.depth, min(b.depth, c.depth)), camera.near);
    facet.farthest = max(a.depth, max(b.depth, c.depth));
    facet.id = id;
    facet.whole = pack(run.whole.x, run.whole.y);
    facet.columns = pack(first.x, last.x);
    facet.rows = pack(first.y, last.y);
    let sides = vec2<u32>(last - first) + 1u;
    let area = sides.x * sides.y;
    let is_small = area <= round.small && spent + area <= SPENT_MAX;
    if is_small {
        spent += area;
    }
    if is_small || !leave(facet) {
        draw_rectangle(facet, vec2<u32>(first), vec2<u32>(last), 1u);
    }
}

// Leaves a facet to be drawn block by block; returns whether there was room for it. Blocks for which
// there is none are drawn at once.
fn leave(facet: Facet) -> bool {
    let index = atomicAdd(&large.facets, 1u);
    if index >= FACETS {
        return false;
    }
    large.list[index] = facet;
    let first = vec2(low(facet.columns), low(facet.rows));
    let last = vec2(high(facet.columns), high(facet.rows));
    let start = first / BLOCK;
    let to = last / BLOCK;
    var slot = atomicAdd(&large.blocks, (to.x - start.x + 1u) * (to.y - start.y + 1u));
    for (var y = start.y; y <= to.y; y++) {
        for (var x = start.x; x <= to.x; x++) {
            if slot < arrayLength(&large.block) {
                large.block[slot] = vec2(index, x | (y << 16u));
            } else {
                let corner = vec2(x, y) * BLOCK;
                draw_rectangle(facet, max(first, corner), min(last, corner + BLOCK - 1u), 1u);
            }
            slot++;
        }
    }
    return true;
}
