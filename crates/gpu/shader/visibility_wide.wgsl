// The visibility buffer where 64-bit atomics are there: for each pixel a word that is larger the nearer
// the surface is, and the larger the lower its id is. So drawing is a maximum, in whatever order.

@group(0) @binding(9) var<storage, read_write> visibility: array<atomic<u64>>;

fn show(place: u32, depth: f32, id: u32) {
    let key = (u64(~bitcast<u32>(depth)) << 32u) | u64(~id);
    atomicMax(&visibility[place], key);
}

// Whether what lies no nearer than a depth may be seen at a pixel; true if that cannot be told.
fn may_show(place: u32, nearest: f32) -> bool {
    return true;
}
