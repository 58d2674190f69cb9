/*!
What is known of the bricks of a frame: their runs, on the CPU and on the GPU.

It is found when a brick is first in play, for all bricks that come together, on all cores.
*/

use crate::{
    Error, Gpu,
    kernel::storage,
    runs::{Run, is_plain},
};
use puncta_core::{Bounder, Brick, Camera, Content, Record, ScreenBound};
use rayon::prelude::*;

/// What is known of a brick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Known {
    /// Nothing yet.
    #[default]
    Unknown,
    /// It lies beside the picture.
    Outside,
    /// It has this run.
    Plain(u32),
    /// It has this run, which says where it lies, but its records must be looked at one by one.
    Close(u32),
}

/// The runs of a frame.
#[derive(Debug, Default)]
pub(crate) struct Table {
    known: Vec<Known>,
    runs: Vec<Run>,
    buffer: Option<wgpu::Buffer>,
    /// How many of the runs are in the buffer.
    written: usize,
}

impl Table {
    /// Forgets everything: another picture begins, of so many bricks.
    pub(crate) fn clear(&mut self, bricks: usize) {
        self.known.clear();
        self.known.resize(bricks, Known::Unknown);
        self.runs.clear();
        self.written = 0;
    }

    /// What is known of a brick, and the index of its run if it has one.
    pub(crate) fn known(&self, brick: u32) -> Known {
        self.known.get(brick as usize).copied().unwrap_or_default()
    }

    /// Finds the runs of bricks; spheres are at least as large as `radius_min` pixels.
    pub(crate) fn learn<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (camera, radius_min): (&Camera, f32),
        bricks: &[u32],
    ) {
        let bounder = Bounder::new(camera);
        let find = |&index: &u32| {
            let brick = grown(&content.bricks[index as usize], camera, radius_min);
            let bound = bounder.bound(&brick.bounds, brick.radius_max);
            if bound.is_empty() {
                return None;
            }
            Some((Run::of_brick(camera, (index, &brick), &bound), is_plain(camera, &brick)))
        };
        let unknown = |index: &&u32| self.known(**index) == Known::Unknown;
        let new: Vec<u32> = bricks.iter().filter(unknown).copied().collect();
        let found: Vec<_> = new.par_iter().with_min_len(256).map(find).collect();
        for (index, found) in new.into_iter().zip(found) {
            // A brick may be in play more than once.
            if self.known(index) != Known::Unknown {
                continue;
            }
            self.known[index as usize] = match found {
                None => Known::Outside,
                Some((run, true)) => Known::Plain(self.push(run)),
                Some((run, false)) => Known::Close(self.push(run)),
            };
        }
    }

    /// Adds a run; returns its index.
    pub(crate) fn push(&mut self, run: Run) -> u32 {
        self.runs.push(run);
        u32::try_from(self.runs.len() - 1).unwrap_or(u32::MAX)
    }

    /// The buffer with all runs.
    pub(crate) fn buffer(&mut self, gpu: &Gpu) -> Result<wgpu::Buffer, Error> {
        let bytes = size_of_val(self.runs.as_slice()) as u64;
        let limit = gpu.binding_bytes_max();
        if bytes > limit {
            return Err(Error::TooManyBricks { bricks: self.runs.len(), bytes, limit });
        }
        let buffer = match self.buffer.take().filter(|buffer| buffer.size() >= bytes) {
            Some(buffer) => buffer,
            None => {
                self.written = 0;
                storage(gpu, "Table::runs", (bytes * 2).clamp(1 << 16, limit.max(bytes)))?
            }
        };
        if self.written < self.runs.len() {
            let new: &[u8] = bytemuck::cast_slice(&self.runs[self.written..]);
            let start = (self.written * size_of::<Run>()) as u64;
            gpu.guard("runs", || gpu.queue.write_buffer(&buffer, start, new))?;
            self.written = self.runs.len();
        }
        self.buffer = Some(buffer.clone());
        Ok(buffer)
    }
}

/// A brick whose spheres are at least so many pixels large, wherever in it they lie.
#[expect(clippy::cast_possible_truncation, reason = "it is rounded up")]
fn grown(brick: &Brick, camera: &Camera, radius_min: f32) -> Brick {
    let mut brick = brick.clone();
    if radius_min > 0.0 {
        let middle = (brick.bounds.min + brick.bounds.max).as_dvec3() * 0.5;
        let reach = (brick.bounds.max - brick.bounds.min).as_dvec3().length() * 0.5;
        let far = if camera.is_perspective() { camera.place(middle).z + reach } else { 1.0 };
        let least = f64::from(radius_min) * camera.pixel_size() * far.max(0.0) * (1.0 + 1e-6);
        brick.radius_max = brick.radius_max.max((least as f32).next_up());
    }
    brick
}

/// The bound of a sphere, as that of a brick.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in the picture")]
pub(crate) fn bound_of_sphere(
    camera: &Camera,
    center: glam::DVec3,
    radius: f64,
) -> Option<ScreenBound> {
    let screen = camera.screen_box(center, radius)?;
    if screen.columns.is_empty() || screen.rows.is_empty() {
        return None;
    }
    let ends = |range: &std::ops::RangeInclusive<i64>| [*range.start() as u16, *range.end() as u16];
    Some(ScreenBound {
        columns: ends(&screen.columns),
        rows: ends(&screen.rows),
        nearest: puncta_core::depth_below(
            puncta_core::nearest_depth(center.z, radius).max(camera.near() * (1.0 - 1e-6)),
        ),
    })
}
