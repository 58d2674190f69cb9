// The visibility buffer in words of 32 bits: depths first, then ids where the depth is what is there.
// All is drawn twice, by one and the same shader, so that both times see the same depths.

@group(0) @binding(9) var<storage, read_write> visibility: array<atomic<u32>>;

fn show(place: u32, depth: f32, id: u32) {
    let key = ~bitcast<u32>(depth);
    let is_first = round.pass_of_two == 0u;
    let now = atomicLoad(&visibility[2u * place + 1u]);
    if select(now == key, now < key, is_first) {
        atomicMax(&visibility[2u * place + u32(is_first)], select(~id, key, is_first));
    }
}

// Whether what lies no nearer than a depth may be seen at a pixel.
fn may_show(place: u32, nearest: f32) -> bool {
    return atomicLoad(&visibility[2u * place + 1u]) <= ~bitcast<u32>(nearest);
}
