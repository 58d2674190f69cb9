// From records to discs.
//
// Each run of records has a point of reference. The CPU brings that point before the camera, in `f64`,
// and finds the pixel where it is seen; here, records are placed relative to it, in `f32`. The errors
// are some units of the last place of the distance between a record and its reference, which is why a
// run must not be larger than some hundred pixels (`runs.rs`).

struct Run {
    // The point of reference, in stored coordinates, and a view depth before which there is no surface.
    reference: vec3<f32>,
    nearest: f32,
    // The point of reference in camera coordinates, and the brick.
    center: vec3<f32>,
    brick: u32,
    // The slopes of its ray (0 if rays are parallel), and the pixel where it is seen.
    slope: vec2<f32>,
    whole: vec2<i32>,
    fraction: vec2<f32>,
    // The pixels that the brick may cover, first and last, as two halves of a word.
    columns: u32,
    rows: u32,
}

@group(0) @binding(1) var<storage, read> runs: array<Run>;

// More than the errors of what bounds pixels.
const SLACK: f32 = 0.01;

// The disc of a sphere; it covers no pixel if the first of its columns lies right of the last.
fn place(run: Run, sphere: vec4<f32>) -> Disc {
    let offset = sphere.xyz - run.reference;
    let local = vec3(
        dot(camera.right, offset),
        dot(camera.up, offset),
        dot(camera.forward, offset),
    );
    let center = run.center + local;
    var disc: Disc;
    disc.depth = center.z;
    let spread = select(1.0, center.z, is_perspective());
    disc.slope = select(vec2(0.0), center.xy / center.z, is_perspective());
    let aside = (local.xy - run.slope * local.z) * (camera.per_pixel / spread);
    let at = run.fraction + vec2(aside.x, -aside.y);
    let whole = floor(at);
    disc.fraction = at - whole;
    let pixel = run.whole + vec2<i32>(whole);
    disc.whole = pack(pixel.x, pixel.y);
    disc.radius = max(sphere.w, camera.radius_min * spread * camera.pixel);
    disc.scale = spread * camera.pixel / disc.radius;
    outline(&disc, pixel);
    // Neither a negative radius nor one that is no number.
    if !(sphere.w > 0.0) {
        disc.columns = 1u;
    }
    return disc;
}

// The pixels that a disc may cover, in the picture: see `Camera::outline` of the core.
fn outline(disc: ptr<function, Disc>, pixel: vec2<i32>) {
    let share = (*disc).radius / (*disc).depth;
    let slope = abs((*disc).slope);
    let stretch = 1.0 / (1.0 - share * share);
    var reach = (share * (1.0 + 0.5 * slope * slope) + slope * (share * share)) * stretch;
    reach = select(vec2(1.0 / (*disc).scale), reach * camera.per_pixel, is_perspective());
    reach = reach * 1.00001 + SLACK;
    let last = vec2(i32(camera.width), i32(camera.height)) - 1;
    let first = max(pixel + vec2<i32>(ceil((*disc).fraction - reach)), vec2(0));
    let end = min(pixel + vec2<i32>(floor((*disc).fraction + reach)), last);
    if any(first > end) || !(reach.x < 4096.0 && reach.y < 4096.0) {
        (*disc).columns = 1u;
        (*disc).rows = 0u;
    } else {
        (*disc).columns = pack(first.x, end.x);
        (*disc).rows = pack(first.y, end.y);
    }
}
