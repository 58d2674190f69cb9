// Vertices that lie in memory, without normals.

@vertex
fn vertex(@location(0) point: vec3<f32>, @location(2) id: u32) -> Shown {
    return shown(point, 8u * id + 7u);
}
