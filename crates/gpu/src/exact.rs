/*!
What `f32` cannot draw, drawn by the CPU in `f64`.

Such spheres and glyphs are larger than some hundred pixels, nearer than their own size, or cut by the
near plane: few. Glyphs that are too much for the device (`solid_shaders.rs`) are drawn here, too. What
they show is made in one rectangle around them all, on all cores, and merged into the picture on the GPU.
*/

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use puncta_core::{Camera, ScreenBound};
use rayon::prelude::*;

/// What the CPU draws of one record.
pub(crate) trait Exact: Send + Sync {
    /// The pixels that it may cover, and a depth before which it has no surface.
    fn bound(&self) -> &ScreenBound;

    /// How much memory and work it is, in spheres.
    fn weight(&self) -> usize;

    /// Draws a row into pixels, the first of which lies in a column.
    fn draw_row(&self, camera: &Camera, row: usize, pixels: (u16, &mut [u64]));
}

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

/// The rectangle around items, and its pixels: ids and depths, both inverted, as in the visibility
/// buffer.
pub(crate) fn draw<X: Exact>(camera: &Camera, items: &mut [X]) -> Option<(Rectangle, Vec<u64>)> {
    let around = |a: [u16; 2], b: [u16; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let all = items.iter().map(|item| *item.bound()).reduce(|a, b| ScreenBound {
        columns: around(a.columns, b.columns),
        rows: around(a.rows, b.rows),
        nearest: a.nearest.min(b.nearest),
    })?;
    // The nearest first: of the others, what they hide is not computed.
    items.sort_by(|a, b| a.bound().nearest.total_cmp(&b.bound().nearest));
    let size = |[first, last]: [u16; 2]| u32::from(last - first) + 1;
    let rectangle = Rectangle {
        first: [all.columns[0].into(), all.rows[0].into()],
        size: [size(all.columns), size(all.rows)],
    };
    let width = rectangle.size[0] as usize;
    let mut pixels = vec![0_u64; width * rectangle.size[1] as usize];
    pixels.par_chunks_mut(width).enumerate().for_each(|(row, pixels)| {
        let row = row + usize::from(all.rows[0]);
        for item in &*items {
            let [top, bottom] = item.bound().rows.map(usize::from);
            if (top..=bottom).contains(&row) {
                item.draw_row(camera, row, (all.columns[0], pixels));
            }
        }
    });
    Some((rectangle, pixels))
}

impl Exact for Ball {
    fn bound(&self) -> &ScreenBound {
        &self.bound
    }

    fn weight(&self) -> usize {
        1
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn draw_row(&self, camera: &Camera, row: usize, (first, pixels): (u16, &mut [u64])) {
        // Words before this one are nearer than any of the ball.
        let nearest = !self.bound.nearest.max(0.0).to_bits();
        for column in self.bound.columns[0]..=self.bound.columns[1] {
            let pixel = &mut pixels[usize::from(column - first)];
            if *pixel >> 32 > u64::from(nearest) {
                continue;
            }
            let ray = camera.ray(column.into(), row as f64);
            if let Some(depth) = camera.depth(ray, self.center, self.radius) {
                *pixel = key(depth as f32, self.id).max(*pixel);
            }
        }
    }
}

/// The word of a pixel; 0, which is nothing, for a depth that is not finite.
pub(crate) fn key(depth: f32, id: u32) -> u64 {
    if depth.is_finite() { u64::from(!depth.to_bits()) << 32 | u64::from(!id) } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernels::PATCH, shaders::assert_same_layout, table::bound_of_sphere};
    use proptest::prelude::*;
    use puncta_core::View;

    #[test]
    fn a_rectangle_is_that_of_the_shaders() {
        assert_same_layout!(PATCH, "Patch", Rectangle { first, size });
    }

    /// What a pixel of a picture shows of some balls, as a key.
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn shown_by(camera: &Camera, balls: &[Ball], [column, row]: [u32; 2]) -> u64 {
        let ray = camera.ray(column.into(), row.into());
        let hits = balls.iter().filter_map(|ball| {
            let depth = camera.depth(ray, ball.center, ball.radius)? as f32;
            depth.is_finite().then_some((depth, ball.id))
        });
        let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        nearest.map_or(0, |(depth, id)| key(depth, id))
    }

    proptest! {
        /// Around the eye and cut by the near plane as well: what is drawn is what the camera says of
        /// each pixel, and beside the rectangle there is nothing.
        #[test]
        fn balls_are_drawn_as_the_camera_sees_them(
            is_perspective in any::<bool>(),
            near in prop_oneof![Just(1e-6), Just(0.5)],
            balls in prop::collection::vec(
                ([-3.0..3.0, -3.0..3.0, -3.0..4.0], 0.01..4.0, 0_u32..5),
                0..6,
            ),
        ) {
            let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
            let view = view.with_size(37, 23).unwrap().with_near(near).unwrap();
            let view = if is_perspective { view } else { view.with_orthographic(4.0).unwrap() };
            let camera = Camera::new(&view, DVec3::ZERO);
            let ball = |(center, radius, id): ([f64; 3], f64, u32)| {
                let center = DVec3::from(center);
                let bound = bound_of_sphere(&camera, center, radius)?;
                Some(Ball { center, radius, bound, id })
            };
            let mut balls: Vec<Ball> = balls.into_iter().filter_map(ball).collect();
            let drawn = draw(&camera, &mut balls);
            prop_assert_eq!(drawn.is_some(), !balls.is_empty());
            for (row, column) in (0_u32..23).flat_map(|row| (0_u32..37).map(move |column| (row, column))) {
                let shown = drawn.as_ref().map_or(0, |(rectangle, pixels)| {
                    let x = column.wrapping_sub(rectangle.first[0]);
                    let y = row.wrapping_sub(rectangle.first[1]);
                    let is_in = x < rectangle.size[0] && y < rectangle.size[1];
                    if is_in { pixels[(y * rectangle.size[0] + x) as usize] } else { 0 }
                });
                prop_assert_eq!(shown, shown_by(&camera, &balls, [column, row]));
            }
        }
    }
}
