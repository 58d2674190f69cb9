// What glyphs can use: the twins of `sight.rs` and `circle.rs`.

struct Sight {
    // The eye relative to the position of the record and 1, or the direction to it and 0.
    eye: vec4<f32>,
    // The smallest view depth that the brick may have; 1 if rays are parallel.
    nearest: f32,
    sharpness: f32,
    pixel: f32,
}

const CHORDS_MAX: u32 = 4096u;

// How many chords a full circle of this radius needs: a power of two.
fn ring(sight: Sight, radius: f32) -> u32 {
    let wanted = radius * sight.sharpness;
    var chords = 4u;
    while chords < CHORDS_MAX && f32(chords * chords) * sight.nearest < wanted {
        chords *= 2u;
    }
    return chords;
}

// The same, if chords need not fit to others: 3, 4, 6, 8, 12, 16 and so on.
fn sides(sight: Sight, radius: f32) -> u32 {
    let wanted = radius * sight.sharpness;
    var chords = 4u;
    while chords < CHORDS_MAX && !(f32(chords * chords) * sight.nearest >= wanted) {
        chords *= 2u;
    }
    let fewer = chords / 4u * 3u;
    return select(chords, fewer, f32(fewer * fewer) * sight.nearest >= wanted);
}

// The point of the unit circle at an angle in turns.
fn circle(angle: f32) -> vec2<f32> {
    let turns = angle - floor(angle);
    let quarter = floor(turns * 4.0 + 0.5);
    let x = (turns * 4.0 - quarter) * 1.5707964;
    let square = x * x;
    let s = x + x * square * (-0.16666655 + square * (0.008332161 - square * 0.00019515296));
    let c = 1.0 - 0.5 * square
        + square * square * (0.041666646 + square * (-0.0013887316 + square * 0.000024433157));
    switch u32(quarter) & 3u {
        case 0u: { return vec2(c, s); }
        case 1u: { return vec2(-s, c); }
        case 2u: { return vec2(-c, -s); }
        default: { return vec2(s, -c); }
    }
}

// Whether a face in the plane at `reach` along a direction may be seen, if the eye lies at `eye` along it.
fn may_see(sight: Sight, eye: f32, reach: f32) -> bool {
    let size = max(max(abs(sight.eye.x), abs(sight.eye.y)), abs(sight.eye.z));
    return eye + 4e-6 * size >= reach * sight.eye.w;
}

// The faces of a box that may be seen: bit `2 axis + side`.
fn box_faces(sight: Sight, half: vec3<f32>) -> u32 {
    var faces = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        let eye = sight.eye[axis];
        faces |= u32(may_see(sight, -eye, half[axis])) << (2u * axis);
        faces |= u32(may_see(sight, eye, half[axis])) << (2u * axis + 1u);
    }
    return faces;
}

// A corner of a box: bit k of its number says on which side it lies on axis k.
fn box_vertex(half: vec3<f32>, vertex: u32) -> vec3<f32> {
    let is_upper = vec3((vertex & 1u) != 0u, (vertex & 2u) != 0u, (vertex & 4u) != 0u);
    return select(-half, half, is_upper);
}

// Two triangles for each of the faces whose bits are set.
fn box_triangle(faces: u32, triangle: u32) -> vec3<u32> {
    var rest = faces;
    for (var i = 0u; i < triangle / 2u; i++) {
        rest &= rest - 1u;
    }
    let face = firstTrailingBit(rest);
    let axis = face >> 1u;
    let side = face & 1u;
    // Counterclockwise from outside, on the side of the larger coordinate.
    let b = 1u << ((axis + 1u) % 3u);
    let c = 1u << ((axis + 2u) % 3u);
    let far = select(c, b, side == 1u);
    let left = select(b, c, side == 1u);
    let base = side << axis;
    if (triangle & 1u) == 0u {
        return vec3(base, base | far, base | b | c);
    }
    return vec3(base, base | b | c, base | left);
}
