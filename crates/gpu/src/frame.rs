//! The view, as shaders see it.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use puncta_core::View;

/// The side of a tile of hierarchical depth, in pixels.
pub(crate) const TILE: u32 = 8;

/// `Camera` of `camera.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CameraData {
    right: [f32; 3],
    width: u32,
    up: [f32; 3],
    height: u32,
    forward: [f32; 3],
    near: f32,
    middle: [f32; 2],
    step: f32,
    pixel: f32,
    per_pixel: f32,
    radius_min: f32,
    across: u32,
    is_perspective: u32,
}

impl CameraData {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    pub(crate) fn new(view: &View, radius_min: f32) -> Self {
        let axis = |axis: DVec3| axis.as_vec3().to_array();
        let pixel = view.pixel_size();
        let middle = |side: u32| side as f32 * 0.5 - 0.5;
        Self {
            right: axis(view.right()),
            width: view.width(),
            up: axis(view.up()),
            height: view.height(),
            forward: axis(view.forward()),
            near: view.near() as f32,
            middle: [middle(view.width()), middle(view.height())],
            step: if view.is_perspective() { pixel as f32 } else { 0.0 },
            pixel: pixel as f32,
            per_pixel: (1.0 / pixel) as f32,
            radius_min,
            across: view.width().div_ceil(TILE),
            is_perspective: u32::from(view.is_perspective()),
        }
    }
}

/// The number of tiles of a picture.
pub(crate) fn tiles(view: &View) -> u32 {
    view.width().div_ceil(TILE) * view.height().div_ceil(TILE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernels::CULL, shaders::assert_same_layout};

    #[test]
    fn the_camera_is_that_of_the_shaders() {
        assert_same_layout!(
            CULL,
            "Camera",
            CameraData {
                right,
                width,
                up,
                height,
                forward,
                near,
                middle,
                step,
                pixel,
                per_pixel,
                radius_min,
                across,
                is_perspective,
            }
        );
    }
}
