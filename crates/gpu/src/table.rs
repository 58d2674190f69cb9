/*!
What is known of the bricks of a frame: their runs, on the CPU and on the GPU.

It is found when a brick is first in play, for all bricks that come together, on all cores.
*/

use crate::{
    Error, Gpu,
    kernel::storage,
    runs::{Run, is_plain},
    shape::Draw,
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
    /// How many of the runs are of bricks; those of single records follow.
    of_bricks: usize,
    /// How many of the runs are in the buffer.
    written: usize,
}

impl Table {
    /// Forgets everything: another picture begins, of so many bricks.
    pub(crate) fn clear(&mut self, bricks: usize) {
        self.known.clear();
        self.known.resize(bricks, Known::Unknown);
        self.runs.clear();
        (self.of_bricks, self.written) = (0, 0);
    }

    /// What is known of a brick, and the index of its run if it has one.
    pub(crate) fn known(&self, brick: u32) -> Known {
        self.known.get(brick as usize).copied().unwrap_or_default()
    }

    /// How many pixels lie in the rectangle around a brick.
    pub(crate) fn pixels(&self, brick: u32) -> u64 {
        let (Known::Plain(run) | Known::Close(run)) = self.known(brick) else { return 0 };
        self.runs.get(run as usize).map_or(0, Run::pixels)
    }

    /// Finds the runs of bricks.
    pub(crate) fn learn<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        (camera, shape): (&Camera, &dyn Draw),
        bricks: &[u32],
    ) {
        let (bounder, radius_min) = (Bounder::new(camera), shape.radius_min());
        let find = |&index: &u32| {
            let brick = grown(&content.bricks[index as usize], camera, radius_min);
            let bound = bounder.bound(&brick.bounds, brick.radius_max);
            if bound.is_empty() {
                return None;
            }
            let is_plain = is_plain(camera, &brick) && !shape.is_near(&brick, bound.nearest);
            Some((Run::of_brick(camera, (index, &brick), &bound), is_plain))
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
        self.of_bricks = self.runs.len();
    }

    /// Adds a run; returns its index.
    pub(crate) fn push(&mut self, run: Run) -> u32 {
        self.runs.push(run);
        u32::try_from(self.runs.len() - 1).unwrap_or(u32::MAX)
    }

    /// How many runs are of single records.
    pub(crate) const fn records(&self) -> usize {
        self.runs.len() - self.of_bricks
    }

    /// Forgets the runs of single records: what they were for is drawn.
    pub(crate) fn forget_records(&mut self) {
        self.runs.truncate(self.of_bricks);
        self.written = self.written.min(self.of_bricks);
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use proptest::prelude::*;
    use puncta_core::{Aabb, View};

    fn camera(eye: [f64; 3], opening: f64, is_perspective: bool, near: f64) -> Option<Camera> {
        let view = View::look_at(DVec3::from(eye), DVec3::new(0.1, 0.2, 0.3), DVec3::Z).ok()?;
        let view = view.with_size(61, 47).ok()?.with_near(near).ok()?;
        let view = if is_perspective {
            view.with_perspective(opening).ok()?
        } else {
            view.with_orthographic(4.0 * opening).ok()?
        };
        Some(Camera::new(&view, DVec3::ZERO))
    }

    proptest! {
        /// No pixel beside the bound shows the sphere, and none in front of its depth; and where
        /// there is no bound, none at all.
        #[test]
        fn spheres_lie_in_their_bounds(
            eye in [-3.0..3.0, -3.0..3.0, -3.0..3.0],
            opening in 0.01_f64..3.0,
            is_perspective in any::<bool>(),
            near in prop_oneof![Just(1e-6), Just(0.3)],
            center in [-3.0..3.0, -3.0..3.0, -3.0..3.0],
            radius in -4.0_f64..1.0,
        ) {
            let Some(camera) = camera(eye, opening, is_perspective, near) else { return Ok(()) };
            let (center, radius) = (camera.place(DVec3::from(center)), 10_f64.powf(radius));
            let bound = bound_of_sphere(&camera, center, radius);
            for (row, column) in (0_u16..47).flat_map(|row| (0_u16..61).map(move |x| (row, x))) {
                let ray = camera.ray(column.into(), row.into());
                let Some(depth) = camera.depth(ray, center, radius) else { continue };
                prop_assert!(bound.is_some());
                let Some(bound) = bound else { continue };
                let holds = |[first, last]: [u16; 2], at: u16| first <= at && at <= last;
                prop_assert!(holds(bound.columns, column) && holds(bound.rows, row));
                prop_assert!(f64::from(bound.nearest) <= depth);
            }
        }

        /// The bound of a brick holds its spheres, whatever the smallest size that they are drawn with.
        #[test]
        fn spheres_that_are_made_larger_lie_in_the_bound_of_their_brick(
            eye in [-9.0..9.0, -9.0..9.0, -9.0..9.0],
            opening in 0.01_f64..2.0,
            is_perspective in any::<bool>(),
            sides in [0.0_f32..2.0, 0.0_f32..2.0, 0.0_f32..2.0],
            share in [0.0_f32..=1.0, 0.0_f32..=1.0, 0.0_f32..=1.0, 0.0_f32..=1.0],
            radius_min in 0.0_f32..3.0,
        ) {
            let Some(camera) = camera(eye, opening, is_perspective, 1e-3) else { return Ok(()) };
            let bounds = Aabb { min: Vec3::ZERO, max: Vec3::from(sides) };
            let brick = Brick { records: 0..1, bounds, radius_max: 0.1, density: 1.0 };
            let brick = grown(&brick, &camera, radius_min);
            let bound = Bounder::new(&camera).bound(&brick.bounds, brick.radius_max);
            let offset = Vec3::new(share[0], share[1], share[2]) * Vec3::from(sides);
            let center = camera.place(offset.as_dvec3());
            let spread = if is_perspective { center.z } else { 1.0 };
            let least = f64::from(radius_min) * camera.pixel_size() * spread;
            let radius = f64::from(0.1 * share[3]).max(least);
            let Some(own) = bound_of_sphere(&camera, center, radius) else { return Ok(()) };
            prop_assert!(bound.columns[0] <= own.columns[0] && own.columns[1] <= bound.columns[1]);
            prop_assert!(bound.rows[0] <= own.rows[0] && own.rows[1] <= bound.rows[1]);
            prop_assert!(bound.nearest <= own.nearest);
        }
    }
}
