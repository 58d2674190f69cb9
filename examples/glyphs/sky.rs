//! The sky: a sun that is not quite a point, and light from everywhere above.

use glam::{DVec3, Vec3};
use puncta::{Bounds, View};

/// What falls on a surface that faces the sun, and from the sky on a roof that nothing shades; what
/// comes back from everywhere. Linear, red to blue.
const SUN: Vec3 = Vec3::new(0.88, 0.80, 0.68);
const SKY: Vec3 = Vec3::new(0.40, 0.47, 0.56);
pub(crate) const BOUNCE: Vec3 = Vec3::new(0.060, 0.056, 0.054);

/// The radius of the sun, in radians: large enough for soft edges.
const SUN_RADIUS: f64 = 0.03;

/// Rows and columns of the pictures that are drawn from the sky.
const SIDE: u32 = 2048;

/// Some of the light, from one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    /// Towards where it comes from, of length 1.
    pub(crate) toward: DVec3,
    /// What falls on a surface that faces it.
    pub(crate) color: Vec3,
}

/// A quarter of the beams come from the sun, the others from all over the sky.
pub(crate) fn beams(count: u16, sun: DVec3) -> Vec<Beam> {
    let suns = (count / 4).max(1);
    let skies = count.saturating_sub(suns);
    let sun = sun.normalize_or(DVec3::Z);
    let (across, along) = sun.any_orthonormal_pair();
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let spot = |i: u16| {
        let radius = SUN_RADIUS * ((f64::from(i) + 0.5) / f64::from(suns)).sqrt();
        let (sin, cos) = (f64::from(i) * golden).sin_cos();
        let toward = (sun + (across * cos + along * sin) * radius).normalize_or(DVec3::Z);
        Beam { toward, color: SUN / f32::from(suns) }
    };
    let patch = |i: u16| {
        // Even over the half sphere: each height above the horizon has the same share.
        let z = (f64::from(i) + 0.5) / f64::from(skies);
        let (sin, cos) = (f64::from(i) * golden).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        // A roof sees the patches by half, on average.
        Beam { toward: DVec3::new(cos * flat, sin * flat, z), color: SKY * 2.0 / f32::from(skies) }
    };
    (0..suns).map(spot).chain((0..skies).map(patch)).collect()
}

/// The view of a whole scene along a beam.
pub(crate) fn view(bounds: &Bounds, beam: &Beam) -> Result<View, puncta::core::Error> {
    let radius = (bounds.extent().length() * 0.5).max(f64::MIN_POSITIVE);
    let middle = bounds.center();
    let up = if beam.toward.z.abs() > 0.9 { DVec3::Y } else { DVec3::Z };
    View::look_at(middle + beam.toward * (2.0 * radius), middle, up)?
        .with_size(SIDE, SIDE)?
        .with_orthographic(2.0 * radius)
}
