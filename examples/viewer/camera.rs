//! The camera: how the mouse and the keys move a view.
//!
//! The camera turns around a target that lies straight ahead of it. It keeps the horizon level:
//! left and right turn around the scene's up axis, up and down stop before the camera looks along
//! it.

use glam::{DQuat, DVec2, DVec3};
use puncta::{Projection, View};

/// The steepest look up or down, in radians.
const STEEPEST: f64 = 89.5 * std::f64::consts::PI / 180.0;

/// The nearest and the farthest that the target may be, in sizes of the scene.
const REACH: [f64; 2] = [1e-6, 1e4];

/// A view that can be moved.
#[derive(Clone, Debug)]
pub(crate) struct Camera {
    view: View,
    target: DVec3,
    up: DVec3,
    /// The size of the scene.
    extent: f64,
    /// The near plane, if it was chosen.
    near: Option<f64>,
}

/// What a turn leaves in place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pivot {
    /// The target: the camera goes around it.
    Target,
    /// The camera: it looks around.
    Eye,
}

impl Camera {
    /// A camera that starts with a view of a scene of this middle and size.
    pub(crate) fn new(view: View, up: DVec3, (center, extent): (DVec3, f64)) -> Self {
        let up = up.normalize_or(DVec3::Y);
        let up = if view.forward().dot(up).abs() > 0.9999 { view.up() } else { up };
        let extent = if extent.is_normal() { extent } else { 1.0 };
        let ahead = view.forward().dot(center - view.eye());
        let distance = if ahead > 1e-3 * extent { ahead } else { extent };
        let target = view.eye() + view.forward() * distance;
        Self { view, target, up, extent, near: None }
    }

    /// Keeps a near plane that was chosen.
    pub(crate) fn with_near(self, near: Option<f64>) -> Self {
        Self { near, ..self }
    }

    pub(crate) const fn view(&self) -> &View {
        &self.view
    }

    pub(crate) fn distance(&self) -> f64 {
        (self.target - self.view.eye()).length()
    }

    /// Changes the number of pixels; a size that cannot be is left alone.
    pub(crate) fn resize(&mut self, (width, height): (u32, u32)) {
        if let Ok(view) = self.view.clone().with_size(width, height) {
            self.view = view;
        }
    }

    /// Turns, in radians, to the right and upwards.
    pub(crate) fn turn(&mut self, pivot: Pivot, yaw: f64, pitch: f64) {
        let elevation = self.view.forward().dot(self.up).clamp(-1.0, 1.0).asin();
        let limit = STEEPEST.max(elevation.abs());
        let pitch = (elevation + pitch).clamp(-limit, limit) - elevation;
        let rotation = DQuat::from_axis_angle(self.up, -yaw)
            * DQuat::from_axis_angle(self.view.right(), pitch);
        let forward = rotation * self.view.forward();
        let (eye, target) = match pivot {
            Pivot::Target => (self.target - forward * self.distance(), self.target),
            Pivot::Eye => (self.view.eye(), self.view.eye() + forward * self.distance()),
        };
        self.place(eye, target);
    }

    /// Moves along with a drag of this many pixels, to the right and down: what lies as far away as
    /// the target follows the pointer.
    pub(crate) fn pan(&mut self, pixels: DVec2) {
        let scale = self.view.pixel_size();
        let scale = if self.view.is_perspective() { scale * self.distance() } else { scale };
        let shift = (self.view.up() * pixels.y - self.view.right() * pixels.x) * scale;
        self.place(self.view.eye() + shift, self.target + shift);
    }

    /// Moves by this many distances to the target, along right, up and forward.
    pub(crate) fn fly(&mut self, steps: DVec3) {
        let axes = [self.view.right(), self.view.up(), self.view.forward()];
        let shift: DVec3 = axes.into_iter().zip(steps.to_array()).map(|(a, s)| a * s).sum();
        let shift = shift * self.distance();
        self.place(self.view.eye() + shift, self.target + shift);
    }

    /// Brings what is at `point` nearer by a factor; it stays where it is in the picture.
    pub(crate) fn zoom(&mut self, factor: f64, point: DVec3) {
        let distance = self.distance();
        let [nearest, farthest] = REACH.map(|reach| reach * self.extent);
        let factor = (distance * factor).clamp(nearest, farthest) / distance;
        let (eye, forward) = (self.view.eye(), self.view.forward());
        let mut shift = (point - eye) * (1.0 - factor);
        if let Projection::Orthographic { height } = self.view.projection() {
            // Going forward changes nothing but what lies behind the camera.
            shift -= forward * forward.dot(shift);
            if let Ok(view) = self.view.clone().with_orthographic(height * factor) {
                self.view = view;
            }
            self.place(eye + shift, self.target + shift);
        } else {
            let eye = eye + shift;
            self.place(eye, eye + forward * (distance * factor));
        }
    }

    /// Brings a point to the middle of the picture, and turns around it from now on.
    pub(crate) fn center(&mut self, point: DVec3) {
        let eye = point - self.view.forward() * self.distance();
        self.place(eye, point);
    }

    /// Chooses how rays spread; what lies as far away as the target keeps its size.
    pub(crate) fn project(&mut self, projection: Projection) {
        let view = self.view.clone();
        let view = match projection {
            Projection::Perspective { fov_y } => view.with_perspective(fov_y),
            Projection::Orthographic { height } => view.with_orthographic(height),
        };
        if let Ok(view) = view {
            self.view = view;
        }
    }

    /// The height of the picture at the target.
    pub(crate) fn height(&self) -> f64 {
        let scale = self.view.pixel_size() * f64::from(self.view.height());
        if self.view.is_perspective() { scale * self.distance() } else { scale }
    }

    /// The point that is seen at a pixel, at a view depth or else as far away as the target.
    pub(crate) fn point_at(&self, pixel: DVec2, depth: Option<f64>) -> DVec3 {
        let depth = depth.unwrap_or_else(|| self.distance());
        point_at(&self.view, pixel, depth)
    }

    /// Stands at `eye` and looks to `target`, unless that is impossible.
    fn place(&mut self, eye: DVec3, target: DVec3) {
        let old = &self.view;
        let moved = View::look_at(eye, target, self.up)
            .and_then(|view| view.with_size(old.width(), old.height()))
            .and_then(|view| match old.projection() {
                Projection::Perspective { fov_y } => view.with_perspective(fov_y),
                Projection::Orthographic { height } => view.with_orthographic(height),
            })
            .and_then(|view| match self.near {
                Some(near) => view.with_near(near),
                None => Ok(view),
            });
        if let Ok(view) = moved {
            self.view = view;
            self.target = target;
        }
    }
}

/// The point at a pixel and a view depth.
pub(crate) fn point_at(view: &View, pixel: DVec2, depth: f64) -> DVec3 {
    let ray = view.ray(pixel.x, pixel.y);
    let ray = if view.is_perspective() { ray * depth } else { ray };
    view.eye() + view.right() * ray.x + view.up() * ray.y + view.forward() * depth
}

/// The pixel where a point is seen, and how many pixels a length of 1 has there; `None` behind the
/// camera.
pub(crate) fn pixel_of(view: &View, point: DVec3) -> Option<(DVec2, f64)> {
    let place = view.to_camera(point - view.eye());
    let depth = if view.is_perspective() { place.z } else { 1.0 };
    let scale = 1.0 / (view.pixel_size() * depth);
    let middle = DVec2::new(f64::from(view.width()), f64::from(view.height())) * 0.5 - 0.5;
    let pixel = middle + DVec2::new(place.x, -place.y) * scale;
    (place.z > 0.0 && pixel.is_finite()).then_some((pixel, scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let view = View::look_at(DVec3::new(1.0, 2.0, 9.0), DVec3::ZERO, DVec3::Y).unwrap();
        Camera::new(view.with_size(640, 480).unwrap(), DVec3::Y, (DVec3::ZERO, 4.0))
    }

    #[test]
    fn a_turn_keeps_the_target_in_the_middle_and_the_horizon_level() {
        let mut camera = camera();
        let (target, distance) = (camera.target, camera.distance());
        for _ in 0..100 {
            camera.turn(Pivot::Target, 0.3, 0.2);
        }
        assert!((camera.distance() - distance).abs() < 1e-9);
        let (pixel, _) = pixel_of(camera.view(), target).unwrap();
        assert!((pixel - DVec2::new(319.5, 239.5)).length() < 1e-6);
        assert!(camera.view().right().dot(DVec3::Y).abs() < 1e-9);
        assert!(camera.view().up().y > 0.0, "it stops before it is upside down");
    }

    #[test]
    fn a_zoom_leaves_what_is_under_the_pointer_in_place() {
        for is_flat in [false, true] {
            let mut camera = camera();
            if is_flat {
                camera.project(Projection::Orthographic { height: camera.height() });
            }
            let pixel = DVec2::new(100.0, 400.0);
            let point = camera.point_at(pixel, Some(7.0));
            let before = camera.height();
            camera.zoom(0.5, point);
            let (after, _) = pixel_of(camera.view(), point).unwrap();
            assert!((after - pixel).length() < 1e-6, "{after}");
            assert!((camera.height() / before - 0.5).abs() < 1e-9);
        }
    }

    #[test]
    fn a_pan_moves_the_target_with_the_pointer() {
        let mut camera = camera();
        let target = camera.target;
        camera.pan(DVec2::new(30.0, -20.0));
        let (pixel, _) = pixel_of(camera.view(), target).unwrap();
        assert!((pixel - DVec2::new(349.5, 219.5)).length() < 1e-6, "{pixel}");
    }

    #[test]
    fn pixels_and_points_belong_together() {
        let camera = camera();
        let pixel = DVec2::new(17.0, 333.0);
        let (back, _) = pixel_of(camera.view(), camera.point_at(pixel, None)).unwrap();
        assert!((back - pixel).length() < 1e-6);
        assert!(pixel_of(camera.view(), camera.view().eye() * 2.0).is_none());
    }

    #[test]
    fn nothing_that_is_not_finite_moves_the_camera() {
        let mut camera = camera();
        let view = camera.view().clone();
        camera.turn(Pivot::Eye, f64::NAN, 0.0);
        camera.pan(DVec2::splat(f64::INFINITY));
        camera.fly(DVec3::splat(f64::NAN));
        camera.zoom(f64::NAN, DVec3::ZERO);
        assert_eq!(camera.view(), &view);
    }
}
