// The sphere, where fragments behind what the depth buffer holds need not run: no depth lies before that
// of the geometry.

struct Early {
    @builtin(frag_depth) depth: f32,
}

@fragment EARLY
fn sphere_early(in: Corner) -> Early {
    let pixel = vec2<i32>(floor(in.position.xy));
    let found = hit(disc_of(in), pixel);
    if !(found.depth > 0.0) {
        discard;
    }
    show(u32(pixel.y) * camera.width + u32(pixel.x), found.depth, in.c.y);
    return Early(min(depth_of(found.depth), 1.0));
}
