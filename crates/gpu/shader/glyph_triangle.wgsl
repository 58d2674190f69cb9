// From the records of a run to triangles in the picture.

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

// A triangle of a record in the picture.
struct Triangle {
    names: vec3<u32>,
    a: Corner,
    b: Corner,
    c: Corner,
    // The pixels that it may cover, in the picture: none if it looks away.
    first: vec2<i32>,
    last: vec2<i32>,
    // How many these are.
    area: u32,
}

// A triangle of a form whose record lies at an offset from the reference.
fn triangle_of(run: Run, offset: vec3<f32>, form: Form, number: u32) -> Triangle {
    return triangle_between(run, offset, form, glyph_triangle(form, number));
}

// The triangle between some vertices.
fn triangle_between(run: Run, offset: vec3<f32>, form: Form, names: vec3<u32>) -> Triangle {
    // A loop, so that compilers see the code of a glyph once.
    var corners: array<Corner, 3>;
    for (var k = 0u; k < 3u; k++) {
        corners[k] = corner(run, offset + glyph_vertex(form, names[k]));
    }
    let a = corners[0];
    let b = corners[1];
    let c = corners[2];
    let low_at = min(a.at, min(b.at, c.at)) - WIDER;
    let high_at = max(a.at, max(b.at, c.at)) + WIDER;
    let first = max(run.whole + vec2<i32>(ceil(low_at)), vec2(0));
    let size = vec2(i32(camera.width), i32(camera.height));
    let last = min(run.whole + vec2<i32>(floor(high_at)), size - 1);
    let ab = b.at - a.at;
    let ac = c.at - a.at;
    // In a picture, where rows run downwards, what is seen from in front turns the other way round.
    let is_seen = ab.x * ac.y - ab.y * ac.x < 0.0 && all(first <= last);
    let end = select(first - 1, last, is_seen);
    let sides = vec2<u32>(end - first + 1);
    return Triangle(names, a, b, c, first, end, sides.x * sides.y);
}

fn facet_of(run: Run, id: u32, triangle: Triangle) -> Facet {
    let a = triangle.a;
    let b = triangle.b;
    let c = triangle.c;
    // Camera coordinates are left-handed: this points outwards.
    let normal = cross(c.local - a.local, b.local - a.local);
    let away = dot(normal, run.center + a.local);
    let seen = normal.xy * (camera.pixel * a.depth / away);
    let slope = select(-normal.xy * (camera.pixel / normal.z), seen, is_perspective());
    var facet: Facet;
    facet.slope = vec2(slope.x, -slope.y);
    facet.a = a.at;
    facet.b = c.at;
    facet.c = b.at;
    facet.depth = a.depth;
    facet.nearest = max(min(a.depth, min(b.depth, c.depth)), camera.near);
    facet.farthest = max(a.depth, max(b.depth, c.depth));
    facet.id = id;
    facet.whole = run.whole;
    return facet;
}
