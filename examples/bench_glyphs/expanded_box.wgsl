// Boxes as what indices are made of.

const SHIFT: u32 = 3u;

// The faces that are drawn, by axis.
struct Form {
    axes: u32,
}

fn form_at(at: u32) -> Form {
    let solid = box_at(at);
    let near = near_of(solid);
    let center = 0.5 * (solid.low + solid.high);
    let half = 0.5 * (solid.high - solid.low);
    for (var i = 0u; i < 5u; i++) {
        let plane = camera.planes[i];
        let reach = dot(abs(plane.xyz), half);
        let slack = 1e-5 * (dot(abs(plane.xyz), abs(center)) + abs(plane.w));
        if dot(plane.xyz, center) + plane.w + reach < -slack {
            return Form(0u);
        }
    }
    // What the eye is not in front of cannot be seen.
    let distance = abs(camera.eye - center);
    let may_be_seen = distance >= half - 1e-5 * (distance + half);
    var axes = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        let face = 2u * axis + u32(near.upper[axis]);
        let number = axis_number(axis, near.is_turned);
        axes |= (u32(may_be_seen[axis]) & (solid.faces >> face)) << number;
    }
    return Form(axes);
}

// The place of a face among those of the pattern.
fn axis_number(axis: u32, is_turned: bool) -> u32 {
    return select(axis, axis ^ u32(axis < 2u), is_turned);
}

fn triangles_at(at: u32, form: Form) -> u32 {
    return 2u * countOneBits(form.axes);
}

fn triangle_at(form: Form, triangle: u32) -> vec3<u32> {
    var rest = form.axes;
    for (var i = 0u; i < triangle / 2u; i++) {
        rest &= rest - 1u;
    }
    let axis = firstTrailingBit(rest);
    let a = 1u << ((axis + 1u) % 3u);
    let b = 1u << ((axis + 2u) % 3u);
    return select(vec3(a | b, 0u, b), vec3(a | b, a, 0u), (triangle & 1u) == 0u);
}

@vertex
fn vertex(@builtin(vertex_index) code: u32) -> Shown {
    return corner(part.first + (code >> SHIFT), code & ((1u << SHIFT) - 1u));
}
