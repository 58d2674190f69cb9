// As many vertices for each glyph as the largest needs; what it has not lies in one point.

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) at: u32) -> Shown {
    let form = form_at(at);
    let triangle = index / 3u;
    if triangle >= glyph_size(form).y {
        return Shown(vec4(2.0, 2.0, 0.0, 1.0), 0u);
    }
    return shown_vertex(at, form, glyph_triangle(form, triangle)[index % 3u]);
}
