// The visibility buffer, to be read: the id in the first word and the depth in the second, both
// inverted, so that nothing is 0.

@group(0) @binding(9) var<storage, read> visibility: array<vec2<u32>>;

fn is_covered(place: u32) -> bool {
    return visibility[place].y != 0u;
}

// The view depth, +inf for none.
fn depth_at(place: u32) -> f32 {
    return bitcast<f32>(min(~visibility[place].y, INFINITY_BITS));
}

fn id_at(place: u32) -> u32 {
    return ~visibility[place].x;
}
