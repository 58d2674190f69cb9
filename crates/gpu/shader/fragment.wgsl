// What fragments show.

// The sphere.
@fragment
fn sphere(in: Corner) {
    let pixel = vec2<i32>(floor(in.position.xy));
    let place = u32(pixel.y) * camera.width + u32(pixel.x);
    if !may_show(place, nearest_of(in.a.w, in.b.z)) {
        return;
    }
    let found = hit(disc_of(in), pixel);
    if found.depth > 0.0 {
        show(place, found.depth, in.c.y);
    }
}

// The geometry itself, at the depth of the sphere's nearest point: to measure what it costs.
@fragment
fn proxy(in: Corner) {
    let pixel = vec2<u32>(in.position.xy);
    show(pixel.y * camera.width + pixel.x, max(in.a.w - in.b.z, camera.near), in.c.y);
}
