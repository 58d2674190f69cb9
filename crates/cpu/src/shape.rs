//! Shapes: what records are, and how one of them is drawn into a band.

use crate::band::Band;
use puncta_avc::Level;
use puncta_core::{Camera, Record};

/// What records are drawn as.
pub(crate) trait Shape<R: Record>: Sync {
    /// What draws them, one after the other.
    type Brush<'a>: Brush
    where
        Self: 'a,
        R: 'a;

    /// For the records of a scene before a camera.
    fn brush<'a>(&'a self, camera: &'a Camera, records: &'a [R]) -> Self::Brush<'a>;
}

/// Draws records into a band.
pub(crate) trait Brush {
    /// Draws a record at a level of detail.
    fn draw(&mut self, band: &mut Band<'_>, id: u32, level: Level);
}

/// Records are spheres of their radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spheres;

impl<R: Record> Shape<R> for Spheres {
    type Brush<'a>
        = SphereBrush<'a, R>
    where
        R: 'a;

    fn brush<'a>(&'a self, _: &'a Camera, records: &'a [R]) -> SphereBrush<'a, R> {
        SphereBrush { records }
    }
}

/// Draws spheres.
#[derive(Debug)]
pub(crate) struct SphereBrush<'a, R> {
    records: &'a [R],
}

impl<R: Record> Brush for SphereBrush<'_, R> {
    #[inline]
    fn draw(&mut self, band: &mut Band<'_>, id: u32, _level: Level) {
        let record = &self.records[id as usize];
        band.draw_sphere(record.position().as_dvec3(), f64::from(record.radius()), id);
    }
}
