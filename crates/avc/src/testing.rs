//! What tests of glyphs have in common.

use crate::{Glyph, Glyphs, Mesh, Sight};
use glam::DVec3;
use proptest::prelude::*;
use std::fmt::Debug;

impl Sight {
    /// As many chords for this radius as there were for 1.
    pub(crate) fn at_size(self, radius: f32) -> Self {
        Self { sharpness: self.sharpness / radius, ..self }
    }
}

/// What is drawn of a record, after a check: it is closed, it lies in its ball, and the ball in that of
/// the record.
pub(crate) fn mesh_of<G>(record: G, sight: &Sight) -> Result<Mesh, TestCaseError>
where
    G: Glyph<Style = [u32; 0]>,
{
    let glyphs = Glyphs::new([]);
    let records = [record];
    let cloud = glyphs.cloud(&records);
    let mesh = Mesh::of::<G>(&G::form(&cloud, 0, sight));
    if let Err(what) = mesh.check() {
        return Err(TestCaseError::fail(what));
    }
    let (center, radius) = G::ball(&cloud, 0);
    let center = center.as_dvec3() - record.position().as_dvec3();
    for vertex in &mesh.vertices {
        let distance = (vertex.as_dvec3() - center).length();
        prop_assert!(distance <= f64::from(radius), "{vertex} {distance} {radius}");
    }
    prop_assert!(center.length() + f64::from(radius) <= f64::from(record.radius()));
    Ok(mesh)
}

/// The corners of the triangles.
pub(crate) fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|at| mesh.vertices[at as usize].as_dvec3()))
}

/// The normal of a triangle, as long as its area is large.
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a) / 2.0
}

/// The area of a polygon with as many corners as are given on a circle of radius 1.
pub(crate) fn polygon_area(corners: f64) -> f64 {
    corners / 2.0 * (std::f64::consts::TAU / corners).sin()
}

/// Asserts that a record with an odd number in it is either whole or nothing, and is nothing exactly
/// if it has a fault.
pub(crate) fn check_faults<G>(record: G, word: usize, odd: f32) -> Result<(), TestCaseError>
where
    G: Glyph<Style = [u32; 0]> + Debug,
{
    let mut words: Vec<u32> = bytemuck::cast_slice(&[record]).to_vec();
    let word = word % words.len();
    words[word] = odd.to_bits();
    let record: G = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words));
    let glyphs = Glyphs::new([]);
    let records = [record];
    let cloud = glyphs.cloud(&records);
    let size = G::size(&G::form(&cloud, 0, &Sight::everywhere(20.0)));
    let fault = G::fault(&cloud, 0);
    prop_assert_eq!(fault.is_some(), size.triangles == 0, "{:?} {:?}", record, fault);
    if fault.is_none() {
        let (center, radius) = G::ball(&cloud, 0);
        prop_assert!(center.is_finite() && radius.is_finite(), "{:?}", record);
        mesh_of(record, &Sight::everywhere(20.0))?;
    }
    Ok(())
}

/// Asserts that a record of zeros is nothing.
pub(crate) fn check_zeros<G: Glyph<Style = [u32; 0]>>() {
    let glyphs = Glyphs::new([]);
    let records = [G::zeroed()];
    let form = G::form(&glyphs.cloud(&records), 0, &Sight::everywhere(20.0));
    assert_eq!(G::size(&form).triangles, 0);
    assert_eq!(Mesh::of::<G>(&form), Mesh::default());
    // Also where there is no record, and a triangle is asked for that is not there, nothing panics.
    let form = G::form(&glyphs.cloud(&[]), 7, &Sight::everywhere(20.0));
    let _ = (G::triangle(&form, 0), G::triangle(&form, u32::MAX), G::vertex(&form, u32::MAX));
}

/// Sizes of all magnitudes.
pub(crate) fn size() -> impl Strategy<Value = f32> {
    (-6.0_f32..6.0).prop_map(|exponent| 10.0_f32.powf(exponent))
}

/// Places near the origin and far from it.
pub(crate) fn place() -> impl Strategy<Value = [f32; 3]> {
    let number =
        || (-1.0_f32..1.0, -3..9_i32).prop_map(|(x, exponent)| x * 10.0_f32.powi(exponent));
    [number(), number(), number()]
}

/// Directions, among them those along the axes.
pub(crate) fn direction() -> impl Strategy<Value = [f32; 3]> {
    let number =
        || prop_oneof![2 => -1.0_f32..1.0, 1 => Just(0.0), 1 => Just(-0.0), 1 => -1e-5_f32..1e-5];
    let is_long = |v: &[f32; 3]| v.iter().any(|x| x.abs() > 1e-9);
    [number(), number(), number()].prop_filter("a direction has a length", is_long)
}

/// Levels of detail for something of radius 1: see [`Sight::at_size`].
pub(crate) fn sight() -> impl Strategy<Value = Sight> {
    prop_oneof![20 => 1.0_f32..200.0, 1 => 200.0_f32..5e3].prop_map(Sight::everywhere)
}

/// Numbers that are no sizes, and some that are.
pub(crate) fn odd() -> impl Strategy<Value = f32> {
    let numbers = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        1e-40,
        -1e-40,
        1e-18,
        1e-19,
        -1e-18,
        1e18,
        1.1e18,
        1e38,
    ];
    prop::sample::select(numbers.to_vec())
}
