//! Records: the small things a scene is made of.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A thing with a place and an extent; all that sorting, culling and drawing need to know.
///
/// Algorithms are generic over this trait, so nobody's data are copied into a type of ours. Both
/// values are in the units of the data, relative to the origin of the scene.
///
/// # Examples
///
/// A simulation keeps its own struct and renders it as it is:
///
/// ```
/// use glam::Vec3;
/// use puncta_core::{Record, Scene};
///
/// #[derive(Clone, Copy)]
/// struct Ion {
///     place: [f32; 3],
///     charge: i8,
/// }
///
/// impl Record for Ion {
///     fn position(&self) -> Vec3 {
///         self.place.into()
///     }
///     fn radius(&self) -> f32 {
///         if self.charge > 0 { 0.7 } else { 1.8 }
///     }
/// }
///
/// let scene = Scene::new(vec![Ion { place: [1.0, 2.0, 3.0], charge: 1 }]);
/// assert_eq!(scene.bounds().max.z, 3.0 + f64::from(0.7_f32));
/// ```
pub trait Record: Copy + Send + Sync {
    /// The centre, relative to the origin of the scene.
    fn position(&self) -> Vec3;

    /// The radius of a ball around the position that holds the whole record.
    ///
    /// For a sphere this is its radius; for a glyph it is a bound.
    fn radius(&self) -> f32;
}

/// An opaque sphere: 16 bytes, without padding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Sphere {
    /// The centre, relative to the origin of the scene.
    pub center: [f32; 3],
    /// The radius.
    pub radius: f32,
}

impl Sphere {
    /// A sphere around `center`.
    #[must_use]
    pub const fn new(center: [f32; 3], radius: f32) -> Self {
        Self { center, radius }
    }
}

impl Record for Sphere {
    #[inline]
    fn position(&self) -> Vec3 {
        Vec3::from_array(self.center)
    }

    #[inline]
    fn radius(&self) -> f32 {
        self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::Sphere;

    #[test]
    fn a_sphere_is_16_plain_bytes() {
        assert_eq!(size_of::<Sphere>(), 16);
        let sphere = Sphere::new([1.0, 2.0, 3.0], 4.0);
        let floats: [f32; 4] = bytemuck::cast(sphere);
        assert_eq!(floats, [1.0, 2.0, 3.0, 4.0]);
    }
}
