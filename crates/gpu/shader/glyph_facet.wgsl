// Facets: triangles in the picture, as `facet.rs` of the glyphs has them, in `f32`.
//
// Corners are relative to the pixel of their run, so nothing large is subtracted. A pixel is covered if
// it lies on the inner side of all edges or on them. So that rounding opens no gap, neither within a
// glyph nor between two that were placed from different references, edges count as a little wider.

struct Facet {
    // The corners, relative to `whole`; what is inside lies at the right of each edge in the picture.
    a: vec2<f32>,
    b: vec2<f32>,
    c: vec2<f32>,
    // The depth at the first corner, and its relative change per pixel (absolute if rays are parallel).
    slope: vec2<f32>,
    depth: f32,
    // No corner lies before or behind these.
    nearest: f32,
    farthest: f32,
    id: u32,
    whole: u32,
    // The pixels that it may cover, first and last, as two halves of a word.
    columns: u32,
    rows: u32,
    spare: u32,
}

struct Large {
    facets: atomic<u32>,
    blocks: atomic<u32>,
    recalled: atomic<u32>,
    spare: u32,
    list: array<Facet, FACETS>,
    // The facet, and the block of the picture as two halves of a word.
    block: array<vec2<u32>>,
}

@group(0) @binding(6) var<storage, read_write> large: Large;

const FACETS: u32 = 16384u;
const BLOCK: u32 = 32u;

// By how much edges are wider, in pixels: about what rounding may move them by.
const WIDER: f32 = 2e-5;

// An edge between its lower and its higher corner, so that both of its triangles compute the same.
struct Edge {
    low: vec2<f32>,
    high: vec2<f32>,
    // 1 if it leads from the low corner to the high one, -1 otherwise.
    sign: f32,
    // Twice the area that a pixel may lie outside.
    outside: f32,
}

fn edge(a: vec2<f32>, b: vec2<f32>) -> Edge {
    let is_lower = a.x < b.x || (a.x == b.x && a.y < b.y);
    let outside = -WIDER * length(b - a);
    return Edge(select(b, a, is_lower), select(a, b, is_lower), select(-1.0, 1.0, is_lower), outside);
}

// Whether a pixel lies on the inner side of an edge.
fn is_inside(edge: Edge, pixel: vec2<f32>) -> bool {
    let low = edge.low - pixel;
    let high = edge.high - pixel;
    return edge.sign * (low.x * high.y - low.y * high.x) >= edge.outside;
}

// Where an edge may let a row begin and end: some pixels more than it does, as rounding may move it.
fn reach(edge: Edge, row: f32) -> vec2<f32> {
    let rise = edge.high.y - edge.low.y;
    let slope = (edge.high.x - edge.low.x) / rise;
    let at = edge.low.x + slope * (row - edge.low.y);
    let slack = 1.0 + abs(slope) * 1e-3;
    if edge.sign * rise < 0.0 {
        return vec2(at - slack, PICTURE_FAR);
    }
    if edge.sign * rise > 0.0 {
        return vec2(-PICTURE_FAR, at + slack);
    }
    return vec2(-PICTURE_FAR, PICTURE_FAR);
}

// Beyond all pixels.
const PICTURE_FAR: f32 = 65536.0;

// Draws the pixels of a rectangle, every `step`-th of them from `first` on.
fn draw_rectangle(facet: Facet, first: vec2<u32>, last: vec2<u32>, step: u32) {
    let whole = whole_of(facet.whole);
    let ab = edge(facet.a, facet.b);
    let bc = edge(facet.b, facet.c);
    let ca = edge(facet.c, facet.a);
    for (var row = first.y; row <= last.y; row += step) {
        let y = f32(i32(row) - whole.y);
        let a = reach(ab, y);
        let b = reach(bc, y);
        let c = reach(ca, y);
        let left = whole.x + i32(ceil(clamp(max(a.x, max(b.x, c.x)), -PICTURE_FAR, PICTURE_FAR)));
        let right = whole.x + i32(floor(clamp(min(a.y, min(b.y, c.y)), -PICTURE_FAR, PICTURE_FAR)));
        let skipped = u32(max(left - i32(first.x), 0)) + step - 1u;
        let end = min(i32(last.x), right);
        for (var at = i32(first.x + skipped / step * step); at <= end; at += i32(step)) {
            let pixel = vec2(f32(at - whole.x), y);
            if !(is_inside(ab, pixel) && is_inside(bc, pixel) && is_inside(ca, pixel)) {
                continue;
            }
            let change = dot(facet.slope, pixel - facet.a);
            let nearer = facet.depth / (1.0 + change);
            var depth = select(facet.depth + change, nearer, is_perspective());
            // Of a facet that is seen edge-on, the plane says nothing.
            depth = clamp(depth, facet.nearest, facet.farthest);
            let place = row * camera.width + u32(at);
            if may_show(place, depth) {
                show(place, depth, facet.id);
            }
        }
    }
}
