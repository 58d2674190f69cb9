// Boxes of 7 corners: those that can be seen, and 6 triangles that share them.
//
// Bit k of the number of a corner tells whether it lies on the far side on axis k; corner 0 is the
// nearest. Face k has the triangles (D, A, 0) and (D, 0, B), where A and B are one step away from
// corner 0, and D is two. As D has no other face, it tells which face it is. Where an odd number of
// sides of corner 0 are upper ones, the triangles would be clockwise: there two axes change places.

struct Box {
    low: vec3<f32>,
    id: u32,
    high: vec3<f32>,
    // Bit `2 axis + side` for each face that is drawn.
    faces: u32,
}

struct Near {
    // Whether corner 0 lies on the upper sides.
    upper: vec3<bool>,
    is_turned: bool,
}

fn near_of(solid: Box) -> Near {
    let upper = camera.eye >= 0.5 * (solid.low + solid.high);
    return Near(upper, (upper.x != upper.y) != upper.z);
}

fn turned(number: u32, is_turned: bool) -> u32 {
    let swapped = (number & 4u) | ((number & 1u) << 1u) | ((number >> 1u) & 1u);
    return select(number, swapped, is_turned);
}

// The face whose corner D has this number; 3 if it is of several faces.
fn axis_of(number: u32) -> u32 {
    return select(select(select(3u, 2u, number == 3u), 1u, number == 5u), 0u, number == 6u);
}

fn corner(at: u32, wanted: u32) -> Shown {
    let solid = box_at(at);
    let near = near_of(solid);
    var number = turned(wanted, near.is_turned);
    let axis = axis_of(number);
    var face = 7u;
    if axis < 3u {
        face = 2u * axis + u32(near.upper[axis]);
        // A face that is not drawn has no area.
        number = select(0u, number, (solid.faces >> face & 1u) == 1u);
    }
    let is_far = vec3((number & 1u) != 0u, (number & 2u) != 0u, (number & 4u) != 0u);
    return shown(select(solid.low, solid.high, is_far != near.upper), 8u * solid.id + face);
}
