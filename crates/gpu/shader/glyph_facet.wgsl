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

// Twice the area of the triangle with the origin, of exactly the opposite sign from `b` to `a`.
fn side(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let is_lower = a.x < b.x || (a.x == b.x && a.y < b.y);
    let low = select(b, a, is_lower);
    let high = select(a, b, is_lower);
    let area = low.x * high.y - low.y * high.x;
    return select(-area, area, is_lower);
}

// Draws the pixels of a rectangle, every `step`-th of them from `first` on.
fn draw_rectangle(facet: Facet, first: vec2<u32>, last: vec2<u32>, step: u32) {
    let whole = whole_of(facet.whole);
    let lengths = vec3(
        length(facet.b - facet.a),
        length(facet.c - facet.b),
        length(facet.a - facet.c),
    );
    let outside = -WIDER * lengths;
    for (var row = first.y; row <= last.y; row += step) {
        for (var column = first.x; column <= last.x; column += step) {
            let pixel = vec2<f32>(vec2(i32(column), i32(row)) - whole);
            let a = facet.a - pixel;
            let b = facet.b - pixel;
            let c = facet.c - pixel;
            if !(side(a, b) >= outside.x && side(b, c) >= outside.y && side(c, a) >= outside.z) {
                continue;
            }
            let change = -dot(facet.slope, a);
            var depth = facet.depth + change;
            if camera.is_perspective != 0u {
                depth = facet.depth / (1.0 + change);
            }
            // Of a facet that is seen edge-on, the plane says nothing.
            depth = clamp(depth, facet.nearest, facet.farthest);
            let place = row * camera.width + column;
            if may_show(place, depth) {
                show(place, depth, facet.id);
            }
        }
    }
}
