// A cube for each block.

@vertex
fn vertex(
    @location(0) corner: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) block: vec4<u32>,
) -> Shown {
    let point = vec3<f32>(block.xyz) + (corner + 0.5);
    let id = block.x + camera.side * (block.y + camera.side * block.z);
    return shown(point, 8u * id + face_of(normal));
}

fn face_of(normal: vec3<f32>) -> u32 {
    let axis = u32(dot(abs(normal), vec3(0.0, 1.0, 2.0)) + 0.5);
    return 2u * axis + u32(normal.x + normal.y + normal.z > 0.0);
}
