// Frames: the twin of `frame.rs`.

struct Frame {
    right: vec3<f32>,
    up: vec3<f32>,
}

// Two vectors of length 1, across a direction and each other. The bits of its z tell on which side of
// the plane z = 0 it lies.
fn frame(direction: vec3<f32>, z_bits: u32) -> Frame {
    let scaled = direction / largest(direction);
    let unit = scaled / sqrt(dot(scaled, scaled));
    let sign = select(1.0, -1.0, (z_bits >> 31u) == 1u);
    let a = -1.0 / (sign + unit.z);
    let b = unit.x * unit.y * a;
    return Frame(
        vec3(1.0 + sign * unit.x * unit.x * a, sign * b, -sign * unit.x),
        vec3(b, sign + unit.y * unit.y * a, -unit.y),
    );
}
