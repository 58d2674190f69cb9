// Trajectories: the twin of `node.rs`, `node/joint.rs` and `node/form.rs`.

const NO_NODE: u32 = 0u;
const LINE: u32 = 1u;
const TUBE: u32 = 2u;
const BALL: u32 = 3u;
const FAR: f32 = 1e18;
const SHORT: f32 = 1e-18;

struct Node {
    position: vec3<f32>,
    // The id and 1; 0 if there is none, or a number is not finite.
    trajectory: u32,
    speed: f32,
    acceleration: f32,
}

struct End {
    axis: vec3<f32>,
    u: vec3<f32>,
    v: vec3<f32>,
    lean: vec3<f32>,
    has_dome: bool,
}

struct Form {
    start: End,
    finish: End,
    radii: vec2<f32>,
    way: vec3<f32>,
    sides: u32,
    rows: u32,
    shift: u32,
    bodies: u32,
}

// The number in the lower 16 bits; 0 if it is not normal.
fn half_of(bits: u32) -> f32 {
    if (bits & 0x7c00u) == 0u {
        return 0.0;
    }
    return bitcast<f32>(((bits & 0x8000u) << 16u) | (((bits & 0x7fffu) << 13u) + 0x38000000u));
}

fn node_at(at: u32) -> Node {
    let motion = word(at, 5u);
    var is_finite = (motion & 0x7c00u) != 0x7c00u && (motion & 0x7c000000u) != 0x7c000000u;
    for (var k = 0u; k < 3u; k++) {
        is_finite = is_finite && (word(at, k) & 0x7f800000u) != 0x7f800000u;
    }
    is_finite = is_finite && (word(at, 4u) & 0x7f800000u) != 0x7f800000u;
    let trajectory = select(NO_NODE, word(at, 3u), is_finite);
    return Node(glyph_position(at), trajectory, half_of(motion), half_of(motion >> 16u));
}

fn largest(v: vec3<f32>) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

fn largest_whole(v: vec3<i32>) -> i32 {
    let size = abs(v);
    return max(size.x, max(size.y, size.z));
}

fn leads_to(node: Node, next: Node) -> bool {
    return node.trajectory != NO_NODE && node.trajectory == next.trajectory
        && largest(next.position - node.position) <= FAR;
}

// The larger of the radii of tubes, 0 if they are of no use.
fn radius_max() -> f32 {
    let a = style_real(0u);
    let b = style_real(1u);
    let is_of_use = a >= SHORT && a <= FAR && b >= SHORT && b <= FAR;
    return select(0.0, select(a, b, b > a), is_of_use);
}

fn ball_radius() -> f32 {
    let radius = style_real(5u);
    return select(0.0, radius, radius >= SHORT && radius <= FAR);
}

fn kind_of(node: Node, sight: Sight) -> u32 {
    var kind = style_word(6u);
    if node.acceleration >= style_real(8u) {
        kind = style_word(9u);
    }
    if kind == LINE && sight.nearest < style_real(7u) {
        kind = TUBE;
    }
    let is_selected = style_word(10u) != NO_NODE && node.trajectory == style_word(10u);
    return select(kind, style_word(11u), is_selected);
}

fn radius_at(node: Node) -> f32 {
    let slow = style_real(2u);
    let width = style_real(3u) - slow;
    var share = 0.0;
    if width > 0.0 {
        share = (node.speed - slow) / width;
    }
    share = select(0.0, min(share, 1.0), share > 0.0);
    return style_real(0u) + (style_real(1u) - style_real(0u)) * share;
}

fn thin_radius(node: Node, sight: Sight, is_line: bool) -> f32 {
    let radius = radius_at(node);
    let thin = style_real(4u) * 0.5 * sight.pixel * sight.nearest;
    return select(radius, max(thin, 0.0), is_line && thin < radius);
}

fn sides_of(sight: Sight, radius: f32, is_line: bool) -> u32 {
    let count = sides(sight, radius);
    return select(count, min(count, 4u), is_line);
}

// A way, times the power of two that makes its largest coordinate 1 to 2.
fn scaled(way: vec3<f32>) -> vec3<f32> {
    let exponent = bitcast<u32>(largest(way)) >> 23u;
    return way * bitcast<f32>((254u - clamp(exponent, 1u, 253u)) << 23u);
}

fn direction(way: vec3<f32>) -> vec3<f32> {
    let near = scaled(way);
    return near / length(near);
}

fn is_mitred(a: vec3<f32>, b: vec3<f32>, radius: f32) -> bool {
    let m = largest(a);
    let n = largest(b);
    if m < SHORT || n < SHORT {
        return false;
    }
    let p = vec3<i32>(scaled(a) * 8192.0);
    let q = vec3<i32>(scaled(b) * 8192.0);
    let along = p.x * q.x + p.y * q.y + p.z * q.z;
    if along < 0i {
        return false;
    }
    let across = p.yzx * q.zxy - p.zxy * q.yzx;
    let turn = (largest_whole(across) >> 6u) + 1025i;
    let product = (largest_whole(p) * largest_whole(q) + along) >> 6u;
    return radius * f32(4i * turn) <= select(m, n, n < m) * f32(product);
}

fn end_with(way: vec3<f32>, axis: vec3<f32>, lean: vec3<f32>, has_dome: bool) -> End {
    let size = abs(way);
    var basis = select(vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0), size.y <= size.z);
    if size.x <= size.y && size.x <= size.z {
        basis = vec3(1.0, 0.0, 0.0);
    }
    let across = cross(axis, basis);
    let u = across / length(across);
    return End(axis, u, cross(axis, u), lean, has_dome);
}

// The end of a piece with the way `own`, at the joint of the ways `a` and `b`.
fn end_of(a: vec3<f32>, b: vec3<f32>, own: vec3<f32>, radius: f32) -> End {
    if !is_mitred(a, b, radius) {
        return end_with(own, direction(own), vec3(0.0), true);
    }
    let axis = direction(a);
    let next = direction(b);
    return end_with(a, axis, next / (1.0 + dot(axis, next)), false);
}

fn end_corner(place: End, angle: f32) -> vec3<f32> {
    let point = circle(angle);
    let e = place.u * point.x + place.v * point.y;
    return e - place.axis * dot(e, place.lean);
}

// The angle of a direction in turns, 0 to 1.
fn turns_of(x: f32, y: f32) -> f32 {
    let is_flat = abs(y) < abs(x);
    let low = select(abs(x), abs(y), is_flat);
    let high = select(abs(y), abs(x), is_flat);
    var ratio = 0.0;
    if high > 0.0 {
        ratio = low / high;
    }
    let is_steep = ratio > 0.41421357;
    let t = select(ratio, (ratio - 1.0) / (ratio + 1.0), is_steep);
    let square = t * t;
    let series = (((0.08053744 * square - 0.13877686) * square + 0.19977711) * square - 0.3333295)
        * square * t + t;
    var angle = (select(0.0, 0.7853982, is_steep) + series) * 0.31830987 * 0.5;
    angle = select(0.25 - angle, angle, is_flat);
    angle = select(angle, 0.5 - angle, x < 0.0);
    return select(angle, 1.0 - angle, y < 0.0);
}

fn form_with(start: End, finish: End, radii: vec2<f32>, way: vec3<f32>, count: u32, bodies: u32) -> Form {
    let is_there = radii.x > 0.0 && radii.y > 0.0;
    let rows = max((count + 3u) / 4u, 1u);
    var form = Form(start, finish, radii, way, select(0u, count, is_there), rows, 0u, bodies);
    if !start.has_dome {
        let corner = end_corner(start, 0.0);
        let turns = turns_of(dot(corner, finish.u), dot(corner, finish.v));
        form.shift = u32(floor(turns * f32(count))) % max(count, 1u);
    }
    return form;
}

fn ball_form(radius: f32, count: u32) -> Form {
    let z = vec3(0.0, 0.0, 1.0);
    let end = End(z, vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0), true);
    return form_with(end, end, vec2(radius), vec3(0.0), count, 1u);
}

fn glyph_position(at: u32) -> vec3<f32> {
    return vec3(real(at, 0u), real(at, 1u), real(at, 2u));
}

fn glyph_ball(at: u32) -> vec4<f32> {
    let node = node_at(at);
    let next = node_at(at + 1u);
    var way = vec3(0.0);
    if leads_to(node, next) && largest(next.position - node.position) >= SHORT {
        way = next.position - node.position;
    }
    let reach = max(radius_max() * 1.42, ball_radius());
    let center = node.position + way * 0.5;
    // The centre is rounded, on three axes.
    let rounding = largest(center) * 1.2e-7;
    return vec4(center, (length(way) * 0.5 + reach) * 1.00001 + rounding);
}

fn glyph_form(at: u32, sight: Sight) -> Form {
    let widest = radius_max();
    let node = node_at(at);
    if widest == 0.0 || node.trajectory == NO_NODE {
        return ball_form(0.0, 0u);
    }
    let kind = kind_of(node, sight);
    if kind == BALL {
        return ball_form(ball_radius(), sides(sight, 2.0 * ball_radius()));
    }
    let is_line = kind == LINE;
    if !is_line && kind != TUBE {
        return ball_form(0.0, 0u);
    }
    let before = node_at(at - 1u);
    let next = node_at(at + 1u);
    let is_led_to = leads_to(before, node);
    let radius = thin_radius(node, sight, is_line);
    let way = next.position - node.position;
    let goes_on = leads_to(node, next);
    if !goes_on && is_led_to {
        return ball_form(0.0, 0u);
    }
    let round = sides_of(sight, 2.0 * widest, is_line);
    if !goes_on || largest(way) < SHORT {
        return ball_form(radius, round);
    }
    let after = node_at(at + 2u);
    let come = select(vec3(0.0), node.position - before.position, is_led_to);
    let go = select(vec3(0.0), after.position - next.position, leads_to(next, after));
    let start = end_of(come, way, way, widest);
    let finish = end_of(way, go, way, widest);
    let has_dome = start.has_dome || finish.has_dome;
    let count = select(sides_of(sight, widest, is_line), round, has_dome);
    return form_with(start, finish, vec2(radius, thin_radius(next, sight, is_line)), way, count, 2u);
}

// How many rings the domes have, without those of the body.
fn domes(form: Form) -> vec2<u32> {
    return select(vec2(0u), vec2(form.rows - 1u), vec2(form.start.has_dome, form.finish.has_dome));
}

fn rings(form: Form) -> u32 {
    let dome = domes(form);
    return dome.x + form.bodies + dome.y;
}

// How many triangles close the ends.
fn caps(form: Form) -> vec2<u32> {
    let flat_ = max(form.sides, 2u) - 2u;
    return select(vec2(flat_), vec2(form.sides), vec2(form.start.has_dome, form.finish.has_dome));
}

fn glyph_size(form: Form) -> vec2<u32> {
    if form.sides == 0u {
        return vec2(0u);
    }
    let tips = u32(form.start.has_dome) + u32(form.finish.has_dome);
    let bands = 2u * form.sides * (rings(form) - 1u);
    let cap = caps(form);
    return vec2(form.sides * rings(form) + tips, bands + cap.x + cap.y);
}

fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32> {
    let n = max(form.sides, 1u);
    let index = vertex / n;
    let side = vertex % n;
    let below = domes(form).x;
    // The end it belongs to, and how many rows it is away from the body.
    var is_finish = false;
    var row = form.rows;
    if index >= rings(form) {
        is_finish = side > 0u || !form.start.has_dome;
    } else if index < below {
        row = below - index;
    } else {
        let above = index - below;
        is_finish = above > 0u;
        row = max(above + 1u, form.bodies) - form.bodies;
    }
    // Across the axis, and along it.
    var height = vec2(0.0, 1.0);
    if row != form.rows {
        height = circle(f32(row) / f32(4u * form.rows));
    }
    let angle = f32(side) / f32(n);
    if is_finish {
        let corner = end_corner(form.finish, angle);
        return form.way + (corner * height.x + form.finish.axis * height.y) * form.radii.y;
    }
    let corner = end_corner(form.start, angle);
    return (corner * height.x + form.start.axis * -height.y) * form.radii.x;
}

fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32> {
    let n = max(form.sides, 1u);
    let count = rings(form);
    let bands = 2u * n * (count - 1u);
    if triangle >= bands {
        let k = triangle - bands;
        let low = caps(form).x;
        if k < low {
            if form.start.has_dome {
                return vec3(form.sides * count, (k + 1u) % n, k);
            }
            return vec3(0u, k + 2u, k + 1u);
        }
        let last = form.sides * (count - 1u);
        let i = k - low;
        if form.finish.has_dome {
            let tip = last + form.sides + u32(form.start.has_dome);
            return vec3(last + i, last + (i + 1u) % n, tip);
        }
        return vec3(last, last + i + 1u, last + i + 2u);
    }
    let index = triangle / (2u * n);
    let k = (triangle >> 1u) % n;
    let shift = select(0u, form.shift, form.bodies == 2u && index == domes(form).x);
    let low = n * index;
    let high = low + n;
    let far = high + (k + shift) % n;
    let next = high + (k + shift + 1u) % n;
    if (triangle & 1u) == 0u {
        return vec3(low + k, low + (k + 1u) % n, next);
    }
    return vec3(low + k, next, far);
}
