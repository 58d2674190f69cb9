//! Blocks: the cells of a world of cubes, of 8 bytes each.

use crate::{BoxForm, Cloud, Fault, Glyph, Sight, Size};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_core::Record;

/// A cube of side 1 that fills a cell of a grid: 8 bytes.
///
/// The cell with the index (x, y, z) reaches from there to (x + 1, y + 1, z + 1). A
/// [`BlockWorld`](crate::BlockWorld) tells which blocks, and which of their faces, can be seen at all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Pod, Zeroable)]
#[repr(C)]
pub struct Block {
    /// The index of the cell.
    pub cell: [u16; 3],
    /// What it is made of. 0 is air, which is nothing.
    pub kind: u8,
    /// The faces that are drawn: bit `2 axis + side`, where side 1 is that of the larger coordinate.
    /// The surface is closed only together with the blocks that cover the other faces.
    pub faces: u8,
}

impl Block {
    /// All faces.
    pub const FACES: u8 = 63;

    /// A block with all its faces.
    #[must_use]
    pub const fn new(cell: [u16; 3], kind: u8) -> Self {
        Self { cell, kind, faces: Self::FACES }
    }
}

impl Record for Block {
    #[inline]
    fn position(&self) -> Vec3 {
        Vec3::from(self.cell.map(f32::from)) + 0.5
    }

    /// Half of the diagonal of a cube, and a little more.
    #[inline]
    fn radius(&self) -> f32 {
        0.866_026
    }
}

impl Glyph for Block {
    type Style = [u32; 0];
    type Form<'a> = BoxForm;
    const WGSL: &'static str = include_str!("../shader/block.wgsl");
    const HAS_FEW_TRIANGLES: bool = true;

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> BoxForm {
        let Self { kind, faces, .. } = cloud.get(index);
        let half = Vec3::splat(0.5);
        let faces = if kind == 0 { 0 } else { u32::from(faces) & sight.faces(half) };
        BoxForm { half, faces }
    }

    #[inline]
    fn size(form: &BoxForm) -> Size {
        Size { vertices: 8, triangles: 2 * form.faces.count_ones() }
    }

    #[inline]
    fn vertex(form: &BoxForm, vertex: u32) -> Vec3 {
        form.vertex(vertex)
    }

    #[inline]
    fn triangle(form: &BoxForm, triangle: u32) -> [u32; 3] {
        form.triangle(triangle)
    }

    /// None: air is nothing, but nothing is wrong with it.
    fn fault(_cloud: &Cloud<'_, Self>, _index: usize) -> Option<Fault> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Glyphs, Mesh};

    fn mesh(block: Block) -> Mesh {
        let glyphs = Glyphs::new([]);
        Mesh::of::<Block>(&Block::form(&glyphs.cloud(&[block]), 0, &Sight::everywhere(1.0)))
    }

    #[test]
    fn a_block_is_8_bytes_and_a_closed_cube() {
        assert_eq!(size_of::<Block>(), 8);
        let block = Block::new([0, 7, u16::MAX], 3);
        assert_eq!(block.position(), Vec3::new(0.5, 7.5, 65535.5));
        let mesh = mesh(block);
        mesh.check().unwrap();
        assert_eq!(mesh.volume(), 1.0);
        let is_in = |vertex: &Vec3| vertex.as_dvec3().length() < f64::from(block.radius());
        assert!(mesh.vertices.iter().all(is_in));
    }

    #[test]
    fn each_bit_is_a_face_that_looks_outwards() {
        for face in 0..6_u8 {
            let mesh = mesh(Block { faces: 1 << face | 192, ..Block::new([1; 3], 1) });
            assert_eq!(mesh.triangles.len(), 2);
            let sign = if face & 1 == 1 { 1.0 } else { -1.0 };
            let outward = Vec3::AXES[usize::from(face / 2)] * sign;
            for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices[v as usize])) {
                assert_eq!((b - a).cross(c - a), outward);
            }
        }
    }

    #[test]
    fn air_is_nothing() {
        assert!(mesh(Block::default()).triangles.is_empty());
        assert!(mesh(Block::new([1; 3], 0)).triangles.is_empty());
        let glyphs = Glyphs::new([]);
        assert_eq!(glyphs.faults(&[Block::default()]).sum(), 0);
    }
}
