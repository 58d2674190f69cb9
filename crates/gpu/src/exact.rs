/*!
Spheres that `f32` cannot draw, drawn by the CPU in `f64`.

They are larger than some hundred pixels, nearer than their own size, or cut by the near plane: few.
What they show is made in one rectangle around them all, on all cores, and merged into the picture on
the GPU.
*/

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use puncta_core::{Camera, ScreenBound};
use rayon::prelude::*;

/// A sphere in camera coordinates, and what bounds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    pub(crate) bound: ScreenBound,
    pub(crate) id: u32,
}

/// `Patch` of `patch.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Rectangle {
    pub(crate) first: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// The rectangle around balls, and its pixels: ids and depths, both inverted, as in the visibility
/// buffer.
pub(crate) fn draw(camera: &Camera, balls: &[Ball]) -> Option<(Rectangle, Vec<u64>)> {
    let around = |a: [u16; 2], b: [u16; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let all = balls.iter().map(|ball| ball.bound).reduce(|a, b| ScreenBound {
        columns: around(a.columns, b.columns),
        rows: around(a.rows, b.rows),
        nearest: a.nearest.min(b.nearest),
    })?;
    let size = |[first, last]: [u16; 2]| u32::from(last - first) + 1;
    let rectangle = Rectangle {
        first: [all.columns[0].into(), all.rows[0].into()],
        size: [size(all.columns), size(all.rows)],
    };
    let width = rectangle.size[0] as usize;
    let mut pixels = vec![0_u64; width * rectangle.size[1] as usize];
    pixels.par_chunks_mut(width).enumerate().for_each(|(row, pixels)| {
        let row = row + usize::from(all.rows[0]);
        for ball in balls {
            let [top, bottom] = ball.bound.rows.map(usize::from);
            if (top..=bottom).contains(&row) {
                draw_row(camera, ball, row, (all.columns[0], pixels));
            }
        }
    });
    Some((rectangle, pixels))
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn draw_row(camera: &Camera, ball: &Ball, row: usize, (first, pixels): (u16, &mut [u64])) {
    for column in ball.bound.columns[0]..=ball.bound.columns[1] {
        let ray = camera.ray(column.into(), row as f64);
        let depth = camera.depth(ray, ball.center, ball.radius).map(|depth| depth as f32);
        if let Some(depth) = depth.filter(|depth| depth.is_finite()) {
            let key = u64::from(!depth.to_bits()) << 32 | u64::from(!ball.id);
            let pixel = &mut pixels[usize::from(column - first)];
            *pixel = key.max(*pixel);
        }
    }
}
