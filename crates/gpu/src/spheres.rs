//! Records as spheres: discs are set up, and become pixels in one of several ways (`raster.rs`).

use crate::{
    Error, Fragment, Gpu, GpuConfig, Setup,
    exact::Ball,
    kernel::{Kernel, Pool, Work},
    kernels::{ARGUMENTS, SET_UP},
    picture::Frame,
    raster::{Canvas, Raster, vertices},
    round::DISC_BYTES,
    runs::is_plain_sphere,
    shape::{Close, Draw, Near, Place, Shape},
    store::Layout,
    table::bound_of_sphere,
};
use puncta_core::{Camera, Content, Picture, Record, Scene};
use rayon::prelude::*;
use std::ops::Range;

/// Draws records as spheres, in one of several ways: see [`Setup`] and [`Fragment`].
#[derive(Debug)]
pub struct Spheres {
    pub(crate) setup: Setup,
    pub(crate) fragment: Fragment,
    radius_min: f32,
    raster: Raster,
    set_up: Kernel,
    recall: Kernel,
    over_discs: Kernel,
}

impl Spheres {
    pub(crate) const LAYOUT: Layout = Layout { words: 4, has_ids: true, before: 0, after: 0 };

    /// The set-up and the fragments of a configuration, or those that suit the device.
    pub(crate) fn new(gpu: &Gpu, config: &GpuConfig) -> Result<Self, Error> {
        let setup = config.setup.unwrap_or_else(|| suited(gpu));
        let fragment = config.fragment.unwrap_or(Fragment::Sphere);
        let (vertices, is_instanced) = vertices(setup, fragment);
        let drawing = [
            ("vertices", f64::from(vertices)),
            ("is_instanced", f64::from(u8::from(is_instanced))),
        ];
        let raster = Raster::new(gpu, setup, fragment)?;
        gpu.guard("pipelines", || Self {
            setup,
            fragment,
            radius_min: config.radius_min_pixels,
            raster,
            set_up: Kernel::new(gpu, "Spheres::set_up", (SET_UP, "set_up"), &[]),
            recall: Kernel::new(gpu, "Spheres::recall", (SET_UP, "recall"), &[]),
            over_discs: Kernel::new(
                gpu,
                "Spheres::over_discs",
                (ARGUMENTS, "over_discs"),
                &drawing,
            ),
        })
    }

    /// A radius in camera coordinates, and a depth: at least as large as is drawn.
    fn radius(&self, camera: &Camera, center: glam::DVec3, radius: f32) -> f64 {
        let spread = if camera.is_perspective() { center.z } else { 1.0 };
        let least = f64::from(self.radius_min) * camera.pixel_size() * spread;
        let radius = f64::from(radius);
        // Of no size means of no picture, whatever is made of small ones.
        if radius > 0.0 { radius.max(least) } else { radius }
    }
}

/// The set-up that suits a device.
fn suited(gpu: &Gpu) -> Setup {
    if gpu.is_wide() { Setup::Compute } else { Setup::Triangle }
}

impl<R: Record> Shape<R> for Spheres {
    type Exact = Ball;

    fn pack(&self, scene: &Scene<R>, range: Range<usize>, words: &mut Vec<u32>) {
        let sphere = |record: &R| record.position().extend(record.radius()).to_array();
        words.extend(scene.records[range].iter().flat_map(sphere).map(f32::to_bits));
    }

    fn prepare(&mut self, _gpu: &Gpu, _camera: &Camera) -> Result<(), Error> {
        Ok(())
    }

    fn close(&self, near: &Near<'_, R>) -> Close<Ball> {
        let (camera, record) = (near.camera, &near.scene.records[near.index as usize]);
        let center = camera.place(record.position().as_dvec3());
        let radius = self.radius(camera, center, record.radius());
        // No ray enters a sphere that holds the eye.
        if camera.is_perspective() && center.length() <= radius {
            return Close::Nothing;
        }
        let Some(bound) = bound_of_sphere(camera, center, radius) else { return Close::Nothing };
        if is_plain_sphere(camera, center, radius) {
            Close::Plain(record.position(), center, bound)
        } else {
            Close::Exact(Ball { center, radius, bound, id: near.scene.id(near.index) })
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn refine(&self, camera: &Camera, content: &Content<'_, R>, picture: &mut Picture) {
        if !self.fragment.is_exact() {
            return;
        }
        let (width, records) = (picture.width as usize, content.scene.records.as_slice());
        let rows = picture.depth.par_chunks_mut(width).zip(picture.id.par_chunks(width));
        rows.enumerate().for_each(|(row, (depths, ids))| {
            for (column, (depth, &id)) in depths.iter_mut().zip(ids).enumerate() {
                let Some(record) = records.get(id as usize) else { continue };
                let center = camera.place(record.position().as_dvec3());
                let radius = self.radius(camera, center, record.radius());
                let ray = camera.ray(column as f64, row as f64);
                if let Some(found) = camera.depth(ray, center, radius) {
                    *depth = found as f32;
                }
            }
        });
    }
}

impl Draw for Spheres {
    fn layout(&self) -> Layout {
        Self::LAYOUT
    }

    fn radius_min(&self) -> f32 {
        self.radius_min
    }

    fn small(&self, gpu: &Gpu) -> u32 {
        self.raster.small(gpu)
    }

    fn scratch(&self, gpu: &Gpu, pool: &mut Pool, records: u32) -> Result<wgpu::Buffer, Error> {
        pool.storage(gpu, "Round::discs", u64::from(records) * DISC_BYTES)
    }

    fn draw(&self, work: &mut Work<'_>, place: &Place<'_>, frame: &mut Frame) {
        let bench = place.bench;
        let Some(ids) = &place.page.ids else { return };
        let mut bindings = vec![
            (0, frame.target.camera.as_entire_binding()),
            (1, place.runs.as_entire_binding()),
            (2, bench.round.as_entire_binding()),
            (3, place.page.records.as_entire_binding()),
            (4, ids.as_entire_binding()),
            (5, place.chunks.as_entire_binding()),
            (6, place.scratch.as_entire_binding()),
            (7, bench.counts.as_entire_binding()),
            (8, frame.target.tiles.as_entire_binding()),
        ];
        let set_up = match place.seen {
            Some(seen) => {
                bindings.push((10, seen.as_entire_binding()));
                &self.recall
            }
            None => &self.set_up,
        };
        set_up.run_indirect(work, &bindings, (&bench.arguments, 0));
        let counted =
            [(7, bench.counts.as_entire_binding()), (11, bench.arguments.as_entire_binding())];
        self.over_discs.run_once(work, &counted);
        self.draw_discs(work, place, frame);
    }
}

impl Spheres {
    /// Draws the discs that were made, once or twice.
    fn draw_discs(&self, work: &mut Work<'_>, place: &Place<'_>, frame: &mut Frame) {
        let (bench, target) = (place.bench, &frame.target);
        let mut canvas = Canvas {
            camera: &target.camera,
            round: &bench.round,
            discs: place.scratch,
            counts: &bench.counts,
            arguments: &bench.arguments,
            visibility: &target.visibility,
            depth: &target.depth,
        };
        let is_kept = std::mem::replace(&mut frame.has_depth, true);
        let load = if is_kept { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
        self.raster.draw(work, &canvas, load);
        if target.claim(work, place.claim) {
            canvas.round = &bench.second;
            self.raster.draw(work, &canvas, wgpu::LoadOp::Load);
        }
    }
}
