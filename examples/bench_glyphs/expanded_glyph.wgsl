// Vertices of glyphs by the codes of indices.

@vertex
fn vertex(@builtin(vertex_index) code: u32) -> Shown {
    let at = part.first + (code >> SHIFT);
    return shown_vertex(at, form_at(at), code & ((1u << SHIFT) - 1u));
}
