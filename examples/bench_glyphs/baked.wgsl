// Vertices that lie in memory.

@vertex
fn vertex(
    @location(0) point: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) id: u32,
) -> Shown {
    let axis = u32(dot(abs(normal), vec3(0.0, 1.0, 2.0)) + 0.5);
    let side = u32(normal.x + normal.y + normal.z > 0.0);
    return shown(point, 8u * id + 2u * axis + side);
}
