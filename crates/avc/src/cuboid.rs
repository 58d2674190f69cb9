//! Cuboids along the axes: 24 bytes each.

use crate::{
    Cloud, Fault, Glyph, Sight, Size,
    extent::{self, are_finite, has_extent},
};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_core::Record;

/// A cuboid whose sides lie along the axes: 24 bytes.
///
/// Nothing is drawn of one with a side that is not positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Cuboid {
    /// The centre.
    pub center: [f32; 3],
    /// How long its sides are.
    pub extent: [f32; 3],
}

impl Cuboid {
    /// A cuboid around `center`.
    #[must_use]
    pub const fn new(center: [f32; 3], extent: [f32; 3]) -> Self {
        Self { center, extent }
    }
}

impl Record for Cuboid {
    #[inline]
    fn position(&self) -> Vec3 {
        self.center.into()
    }

    #[inline]
    fn radius(&self) -> f32 {
        Vec3::from(self.extent).length() * 0.500_001
    }
}

/// A box and the faces of it that may be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxForm {
    /// Half of its sides.
    pub half: Vec3,
    /// Bit `2 axis + side` for each face that is drawn.
    pub faces: u32,
}

impl Glyph for Cuboid {
    type Style = [u32; 0];
    type Form<'a> = BoxForm;
    const WGSL: &'static str =
        concat!(include_str!("../shader/extent.wgsl"), include_str!("../shader/cuboid.wgsl"));
    const HAS_FEW_TRIANGLES: bool = true;

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> BoxForm {
        let Self { center, extent } = cloud.get(index);
        let half = Vec3::from(extent) * 0.5;
        let is_there = are_finite(&center) && extent.iter().all(|&side| has_extent(side));
        BoxForm { half, faces: if is_there { sight.faces(half) } else { 0 } }
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

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let Self { center, extent } = cloud.get(index);
        let [x, y, z] = center;
        let [a, b, c] = extent;
        extent::fault(&[x, y, z, a, b, c], &extent)
    }
}

impl BoxForm {
    /// A corner: bit k of its number says on which side it lies on axis k.
    #[must_use]
    #[inline]
    pub fn vertex(&self, vertex: u32) -> Vec3 {
        let side = |axis: usize| {
            if vertex >> axis & 1 == 1 { self.half[axis] } else { -self.half[axis] }
        };
        Vec3::new(side(0), side(1), side(2))
    }

    /// Two triangles for each of the faces.
    #[must_use]
    #[inline]
    pub fn triangle(&self, triangle: u32) -> [u32; 3] {
        let mut rest = self.faces;
        for _ in 0..triangle / 2 {
            rest &= rest.wrapping_sub(1);
        }
        let face = rest.trailing_zeros() & 7;
        let (axis, side) = (face >> 1, face & 1);
        // Counterclockwise from outside, on the side of the larger coordinate.
        let (b, c) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let (far, left) = if side == 1 { (b, c) } else { (c, b) };
        let base = side << axis;
        if triangle & 1 == 0 {
            [base, base | far, base | b | c]
        } else {
            [base, base | b | c, base | left]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Glyphs, Mesh};

    #[test]
    fn a_cuboid_is_closed_and_looks_outwards() {
        let glyphs = Glyphs::<Cuboid>::new([]);
        let records = [Cuboid::new([5.0, 6.0, 7.0], [1.0, 2.0, 3.0])];
        let form = Cuboid::form(&glyphs.cloud(&records), 0, &Sight::everywhere(1.0));
        let mesh = Mesh::of::<Cuboid>(&form);
        mesh.check().unwrap();
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
        assert_eq!(mesh.volume(), 6.0);
    }

    #[test]
    fn cuboids_without_an_extent_are_nothing_and_counted() {
        let glyphs = Glyphs::<Cuboid>::new([]);
        let odd = [0.0, -1.0, f32::NAN, f32::INFINITY];
        let records: Vec<Cuboid> = odd.map(|x| Cuboid::new([0.0; 3], [1.0, x, 1.0])).to_vec();
        let faults = glyphs.faults(&records);
        assert_eq!((faults.no_extent, faults.not_finite), (2, 2));
        let form = Cuboid::form(&glyphs.cloud(&records), 1, &Sight::everywhere(1.0));
        assert_eq!(Cuboid::size(&form).triangles, 0);
    }
}
