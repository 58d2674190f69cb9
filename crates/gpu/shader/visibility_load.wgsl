// As `visibility_wide.wgsl`, where words of 64 bits can also be loaded: most of what is hidden is found
// to be so by a look, which costs less than a maximum.

@group(0) @binding(9) var<storage, read_write> visibility: array<atomic<u64>>;

fn show(place: u32, depth: f32, id: u32) {
    let key = (u64(~bitcast<u32>(depth)) << 32u) | u64(~id);
    if key > atomicLoad(&visibility[place]) {
        atomicMax(&visibility[place], key);
    }
}

// Whether what lies no nearer than a depth may be seen at a pixel.
fn may_show(place: u32, nearest: f32) -> bool {
    return u32(atomicLoad(&visibility[place]) >> 32u) <= ~bitcast<u32>(nearest);
}
