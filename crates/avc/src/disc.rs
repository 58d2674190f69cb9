//! Discs: flat splats with two sides, of 28 bytes each.

use crate::{
    Cloud, Fault, Glyph, Sight, Size, circle,
    extent::{self, BALL_SLACK, are_finite, has_extent, largest},
    frame::frame,
};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_core::Record;

/// A flat round disc that is seen from both sides, with as many chords as the view needs: 28 bytes.
///
/// Nothing is drawn of one without a radius or a normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Disc {
    /// The centre.
    pub center: [f32; 3],
    /// The direction in which it faces, of any length but zero.
    pub normal: [f32; 3],
    /// The radius.
    pub radius: f32,
}

impl Disc {
    /// A disc around `center`, across `normal`.
    #[must_use]
    pub const fn new(center: [f32; 3], normal: [f32; 3], radius: f32) -> Self {
        Self { center, normal, radius }
    }
}

impl Record for Disc {
    #[inline]
    fn position(&self) -> Vec3 {
        self.center.into()
    }

    #[inline]
    fn radius(&self) -> f32 {
        self.radius * BALL_SLACK
    }
}

/// What is drawn of a [`Disc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscForm {
    /// How many chords there are; 0 if there is nothing.
    chords: u32,
    /// Two radii that are perpendicular.
    right: Vec3,
    up: Vec3,
}

impl Glyph for Disc {
    type Style = [u32; 0];
    type Form<'a> = DiscForm;
    const WGSL: &'static str = concat!(
        include_str!("../shader/extent.wgsl"),
        include_str!("../shader/frame.wgsl"),
        include_str!("../shader/disc.wgsl")
    );

    #[inline]
    fn form(cloud: &Cloud<'_, Self>, index: usize, sight: &Sight) -> DiscForm {
        let Self { center, normal, radius } = cloud.get(index);
        let is_finite = are_finite(&center) && are_finite(&normal) && radius.is_finite();
        if !(is_finite && has_extent(largest(normal.into())) && has_extent(radius)) {
            return DiscForm { chords: 0, right: Vec3::ZERO, up: Vec3::ZERO };
        }
        let [right, up] = frame(normal.into());
        DiscForm { chords: sight.sides(radius), right: right * radius, up: up * radius }
    }

    #[inline]
    fn size(form: &DiscForm) -> Size {
        match form.chords {
            0 => Size::NOTHING,
            chords => Size { vertices: chords + 2, triangles: 2 * chords },
        }
    }

    /// The ring, then the centre of the front and that of the back.
    #[inline]
    fn vertex(form: &DiscForm, vertex: u32) -> Vec3 {
        if vertex >= form.chords {
            return Vec3::ZERO;
        }
        let point = circle(vertex as f32 / form.chords as f32);
        form.right * point.x + form.up * point.y
    }

    /// The fan of the front, then that of the back. They share the ring, and no other edge.
    #[inline]
    fn triangle(form: &DiscForm, triangle: u32) -> [u32; 3] {
        let chords = form.chords.max(3);
        let here = triangle % chords;
        let next = (here + 1) % chords;
        if triangle < chords { [here, next, chords] } else { [next, here, chords + 1] }
    }

    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let Self { center: [x, y, z], normal, radius } = cloud.get(index);
        let [a, b, c] = normal;
        extent::fault(&[x, y, z, a, b, c, radius], &[largest(normal.into()), radius])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{
        check_faults, check_zeros, corners, direction, mesh_of, normal, odd, place, polygon_area,
        sight, size,
    };
    use proptest::prelude::*;

    fn disc() -> impl Strategy<Value = Disc> {
        (place(), direction(), size(), size()).prop_map(|(center, normal, length, radius)| {
            Disc::new(center, normal.map(|x| x * length), radius)
        })
    }

    proptest! {
        /// Half of the triangles face along the normal, and they are a polygon; the others are its back.
        #[test]
        fn a_disc_has_two_sides(disc in disc(), sight in sight()) {
            let mesh = mesh_of(disc, &sight.at_size(disc.radius))?;
            let chords = mesh.triangles.len() / 2;
            prop_assert_eq!(mesh.vertices.len(), chords + 2);
            let unit = Vec3::from(disc.normal).as_dvec3().normalize();
            let mut areas = [0.0; 2];
            for (index, corners) in corners(&mesh).enumerate() {
                let (side, normal) = (usize::from(index >= chords), normal(corners));
                let sign = if side == 0 { 1.0 } else { -1.0 };
                prop_assert!(normal.dot(unit) * sign > 0.99 * normal.length(), "{} {}", normal, unit);
                areas[side] += normal.dot(unit) * sign;
            }
            let radius = f64::from(disc.radius);
            let area = polygon_area(chords as f64) * radius * radius;
            prop_assert!(areas.iter().all(|found| (found - area).abs() < 1e-5 * area), "{:?}", areas);
            prop_assert!(mesh.volume().abs() < 1e-12 * radius.powi(3));
            for &vertex in &mesh.vertices[..chords] {
                let distance = vertex.as_dvec3().length();
                prop_assert!((distance - radius).abs() < 2e-6 * radius);
                prop_assert!(vertex.as_dvec3().dot(unit).abs() < 2e-6 * radius);
            }
        }

        #[test]
        fn odd_discs_are_nothing_and_counted(disc in disc(), word in 0..7_usize, odd in odd()) {
            check_faults(disc, word, odd)?;
        }
    }

    #[test]
    fn a_disc_is_28_bytes_and_nothing_if_they_are_zero() {
        assert_eq!(size_of::<Disc>(), 28);
        check_zeros::<Disc>();
    }
}
