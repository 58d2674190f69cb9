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
    whole: vec2<i32>,
}

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

struct Edges {
    ab: Edge,
    bc: Edge,
    ca: Edge,
}

fn edges_of(facet: Facet) -> Edges {
    return Edges(edge(facet.a, facet.b), edge(facet.b, facet.c), edge(facet.c, facet.a));
}

// Draws a pixel, if the facet covers it.
fn draw_pixel(facet: Facet, edges: Edges, at: vec2<i32>) {
    let pixel = vec2<f32>(at - facet.whole);
    if !(is_inside(edges.ab, pixel) && is_inside(edges.bc, pixel) && is_inside(edges.ca, pixel)) {
        return;
    }
    let change = dot(facet.slope, pixel - facet.a);
    let nearer = facet.depth / (1.0 + change);
    let depth = select(facet.depth + change, nearer, is_perspective());
    // Of a facet that is seen edge-on, the plane says nothing.
    let held = clamp(depth, facet.nearest, facet.farthest);
    show(u32(at.y) * camera.width + u32(at.x), held, facet.id);
}
