// What can be drawn of numbers: the twin of `extent.rs`.

// Whether a number is neither NaN nor infinite. Comparisons need not tell, so its bits do.
fn is_finite(bits: u32) -> bool {
    return (bits & 0x7f800000u) != 0x7f800000u;
}

// Whether some numbers of a record are finite.
fn are_finite(at: u32, first: u32, count: u32) -> bool {
    for (var k = first; k < first + count; k++) {
        if !is_finite(word(at, k)) {
            return false;
        }
    }
    return true;
}

fn has_extent(size: f32) -> bool {
    return size >= 1e-18 && size <= 1e18;
}

fn largest(vector: vec3<f32>) -> f32 {
    let sizes = abs(vector);
    return max(max(sizes.x, sizes.y), sizes.z);
}
