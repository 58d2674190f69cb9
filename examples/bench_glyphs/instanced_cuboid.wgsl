// A cube for each cuboid.

@vertex
fn vertex(
    @location(0) corner: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) center: vec3<f32>,
    @location(3) extent: vec3<f32>,
    @builtin(instance_index) id: u32,
) -> Shown {
    return shown(center + corner * extent, 8u * id + face_of(normal));
}

fn face_of(normal: vec3<f32>) -> u32 {
    let axis = u32(dot(abs(normal), vec3(0.0, 1.0, 2.0)) + 0.5);
    return 2u * axis + u32(normal.x + normal.y + normal.z > 0.0);
}
