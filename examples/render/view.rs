//! The view: what the options say, and a good one where they say nothing.

use crate::{input::Input, options::Options};
use anyhow::Result;
use glam::{DVec3, Vec3Swizzles};
use puncta::{Bounds, View};

/// The share of records on either side of an axis that a fitted view may leave out, if they are
/// strays.
const STRAYS: f64 = 0.001;

/// From how many times the size of the rest on records count as strays.
const STRAY_FACTOR: f64 = 3.0;

pub(crate) fn choose(options: &Options, input: &Input) -> Result<View> {
    let bounds = bounds(input);
    // An outlook suits as a whole: whoever chooses an eye or a target of their own goes without it.
    let is_free = options.eye.is_none() && options.target.is_none();
    let outlook = input.outlook.filter(|_| is_free);
    let chosen_eye = options.eye.or(outlook.map(|outlook| outlook.eye));
    let chosen_target = options.target.or(outlook.map(|outlook| outlook.target));
    let fov = options.fov.or(outlook.map(|outlook| outlook.fov)).unwrap_or(45.0);
    let target = chosen_target.unwrap_or_else(|| bounds.center());
    let up = options.up.unwrap_or_else(|| usual_up(input.up, chosen_eye.map(|eye| target - eye)));
    let aside = aside(up, &bounds);
    let eye = chosen_eye.unwrap_or_else(|| target + aside * bounds.extent().length());
    let with_options = |view: View| -> Result<View> {
        let view = view.with_size(options.size.0, options.size.1)?;
        Ok(match options.ortho {
            Some(height) => view.with_orthographic(height)?,
            None => view.with_perspective(fov.to_radians())?,
        })
    };
    let mut view = with_options(View::look_at(eye, target, up)?)?;
    if chosen_eye.is_none() {
        let fitted = frame(view, input, &bounds);
        // A target of one's own stays in the middle; only the distance is fitted.
        view = match chosen_target {
            Some(target) => {
                let distance = (fitted.eye() - bounds.center()).length();
                with_options(View::look_at(target + aside * distance, target, up)?)?
            }
            None => with_options(fitted)?,
        };
    }
    match options.near {
        Some(near) => Ok(view.with_near(near)?),
        None => Ok(view),
    }
}

/// The direction that is up unless the user says so; another axis for a look straight along it.
fn usual_up(up: DVec3, sight: Option<DVec3>) -> DVec3 {
    let is_along = |sight: DVec3| up.cross(sight).length() <= 1e-6 * sight.length();
    if sight.is_some_and(is_along) { up.zxy() } else { up }
}

/// The box to look at: all records, unless strays make it many times as large as the rest.
pub(crate) fn bounds(input: &Input) -> Bounds {
    let all = input.bounds;
    let inner = match &input.known {
        Some(known) => known.inner,
        None => input.scene.inner_bounds(STRAYS),
    };
    let is_blown_up = all.extent().max_element() > STRAY_FACTOR * inner.extent().max_element();
    if is_blown_up && inner.extent().max_element() > 0.0 { inner } else { all }
}

/// A view of all records in the box to look at.
fn frame(view: View, input: &Input, bounds: &Bounds) -> View {
    let scene = &input.scene;
    if let Some(grid) = input.known.as_ref().and_then(|known| known.grid.as_ref()) {
        return view.framing_bricks(scene, grid.bricks(), bounds);
    }
    let balls = (0..scene.records.len())
        .map(|index| (scene.position(index), f64::from(scene.records[index].radius)));
    let is_inside = |(center, _): &(DVec3, f64)| {
        bounds.min.cmple(*center).all() && center.cmple(bounds.max).all()
    };
    view.framing(balls.filter(is_inside))
}

/// A direction from the front, a little from the right and from above; more from above if the scene
/// is flat.
fn aside(up: DVec3, bounds: &Bounds) -> DVec3 {
    let up = up.normalize_or(DVec3::Y);
    let front = if up.z.abs() > 0.9 { DVec3::NEG_Y } else { DVec3::Z };
    let right = up.cross(front).normalize_or(DVec3::X);
    let front = right.cross(up);
    let height = up.abs().dot(bounds.extent());
    let is_flat = height < 0.2 * bounds.extent().max_element();
    (front + right * 0.45 + up * if is_flat { 0.8 } else { 0.4 }).normalize_or(DVec3::Z)
}
