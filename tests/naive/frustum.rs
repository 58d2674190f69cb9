//! Culling, plainly: whether a brick can be seen, by the distance of two convex bodies, and the
//! thesis' test of bounding spheres in clip space.

use glam::{DVec3, DVec4};
use puncta::{Brick, View};

/// How often the nearest points of two bodies are brought nearer.
const ROUNDS: usize = 300;

/// A brick's box in camera coordinates; the boxes of these tests have no origin.
struct Box {
    center: DVec3,
    half: DVec3,
}

impl Box {
    fn new(brick: &Brick) -> Self {
        let (min, max) = (brick.bounds.min.as_dvec3(), brick.bounds.max.as_dvec3());
        Self { center: (min + max) * 0.5, half: (max - min) * 0.5 }
    }
}

/// The inner half spaces of a view, `normal.p + distance >= 0`, in world coordinates.
fn half_spaces(view: &View) -> [DVec4; 5] {
    let half = view.pixel_size() * 0.5;
    let [x, y] = [view.width(), view.height()].map(|side| half * f64::from(side));
    let (right, up, forward) = (view.right(), view.up(), view.forward());
    let side = |axis: DVec3, half: f64| {
        let (normal, distance) =
            if view.is_perspective() { (forward * half + axis, 0.0) } else { (axis, half) };
        let length = normal.length();
        (normal / length).extend(distance / length - normal.dot(view.eye()) / length)
    };
    let near = forward.extend(-view.near() - forward.dot(view.eye()));
    [side(right, x), side(-right, x), side(up, y), side(-up, y), near]
}

/// How far a brick's box is from the frustum, at most and nearly: by alternating projections, with
/// Dykstra's correction so that they end at the nearest point.
fn distance(view: &View, brick: &Brick) -> f64 {
    let spaces = half_spaces(view);
    let Box { center, half } = Box::new(brick);
    let (mut point, mut best) = (center, f64::INFINITY);
    for _ in 0..ROUNDS {
        let mut corrections = [DVec3::ZERO; 5];
        let mut inside = point;
        for _ in 0..50 {
            for (space, correction) in spaces.iter().zip(&mut corrections) {
                let from = inside + *correction;
                let below = (space.truncate().dot(from) + space.w).min(0.0);
                inside = from - space.truncate() * below;
                *correction = from - inside;
            }
        }
        let nearest = center + (inside - center).clamp(-half, half);
        best = best.min((nearest - inside).length());
        if (nearest - point).length() < 1e-12 {
            break;
        }
        point = nearest;
    }
    best
}

/// Whether some ball of a brick can reach into the view.
pub(crate) fn reaches(view: &View, brick: &Brick) -> bool {
    distance(view, brick) <= f64::from(brick.radius_max) + 1e-6
}

/// The thesis' test (section 3.1.3): the ball around the box, grown by the largest radius, in the
/// coordinates of an OpenGL camera with the far plane at infinity. In perspective only.
pub(crate) fn thesis_keeps(view: &View, brick: &Brick) -> bool {
    let Box { center, half } = Box::new(brick);
    let radius = half.length() + f64::from(brick.radius_max);
    let place = view.to_camera(center - view.eye());
    let w = place.z;
    let half = view.pixel_size() * 0.5;
    let [x, y] = [view.width(), view.height()].map(|side| half * f64::from(side));
    // Equations 3.1 to 3.3, with the tangent of the half angle on the other side.
    let within = |w: f64| {
        let delta = |tan: f64| radius * tan.hypot(1.0);
        place.x.abs() <= w * x + delta(x) && place.y.abs() <= w * y + delta(y)
    };
    let near = view.near();
    if w >= near { within(w) } else { w + radius >= near && within(near) }
}
