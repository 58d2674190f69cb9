//! Shapes: what records are drawn as, spheres or glyphs. Everything else of the renderer is the same.

use crate::{
    Error, Gpu,
    exact::Exact,
    kernel::{Pool, Work},
    picture::Frame,
    round::Bench,
    store::{Layout, Page},
};
use glam::{DVec3, Vec3};
use puncta_avc::Level;
use puncta_core::{Brick, Camera, Content, Picture, Record, Scene, ScreenBound};
use std::{fmt, ops::Range};

/// What records of a type are drawn as.
pub(crate) trait Shape<R: Record>: Draw {
    /// What the CPU draws of records that `f32` cannot draw.
    type Exact: Exact;

    /// Writes the words of records, and of those that are repeated around them.
    fn pack(&self, scene: &Scene<R>, range: Range<usize>, words: &mut Vec<u32>);

    /// Gets ready for drawing before a camera.
    fn prepare(&mut self, gpu: &Gpu, camera: &Camera) -> Result<(), Error>;

    /// How a record of a brick that is not plain is drawn.
    fn close(&self, near: &Near<'_, R>) -> Close<Self::Exact>;

    /// Computes the depths of a picture, whose ids are right, once more in `f64`.
    fn refine(&self, camera: &Camera, content: &Content<'_, R>, picture: &mut Picture);
}

/// How what a shape needs is drawn, whatever the type of the records.
pub(crate) trait Draw: fmt::Debug + Sync {
    /// How records lie on the GPU.
    fn layout(&self) -> Layout;

    /// The smallest radius of what is drawn, in pixels.
    fn radius_min(&self) -> f32;

    /// Whether the records of a brick, which begins at a view depth, must be looked at one by one.
    fn is_near(&self, _brick: &Brick, _nearest: f32) -> bool {
        false
    }

    /// The numbers of pixels that are drawn by one lane.
    fn small(&self, gpu: &Gpu) -> u32;

    /// Room for what becomes of so many records.
    fn scratch(&self, gpu: &Gpu, pool: &mut Pool, records: u32) -> Result<wgpu::Buffer, Error>;

    /// Draws the chunks of a round, once or twice.
    fn draw(&self, work: &mut Work<'_>, place: &Place<'_>, frame: &mut Frame);
}

/// Where the chunks of a round lie, and what they are drawn with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    pub(crate) bench: &'a Bench,
    pub(crate) runs: &'a wgpu::Buffer,
    pub(crate) page: &'a Page,
    pub(crate) chunks: &'a wgpu::Buffer,
    pub(crate) scratch: &'a wgpu::Buffer,
    /// The set of seen ids, if only these are drawn.
    pub(crate) seen: Option<&'a wgpu::Buffer>,
    /// Brings ids and depths together where words have 32 bits.
    pub(crate) claim: &'a crate::kernel::Kernel,
}

/// A record of a brick that is not plain.
#[derive(Debug)]
pub(crate) struct Near<'a, R> {
    pub(crate) camera: &'a Camera,
    pub(crate) scene: &'a Scene<R>,
    pub(crate) index: u32,
    /// How finely the records of its brick are drawn.
    pub(crate) level: Level,
    /// Whether the CPU must draw it.
    pub(crate) by_cpu: bool,
}

/// How it is drawn.
#[derive(Debug)]
pub(crate) enum Close<X> {
    /// Not at all.
    Nothing,
    /// On the GPU, relative to a reference that is given as stored and in camera coordinates.
    Plain(Vec3, DVec3, ScreenBound),
    /// By the CPU.
    Exact(X),
}
