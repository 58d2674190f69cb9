/*!
How far what is drawn is off from the surface that is meant, in pixels.

Single glyphs are made at random, and seen at random: near and far, in the middle of the picture and at its
corners, through wide and narrow lenses. Points all over their curved triangles, corners and edges
included, are compared in `f64` with the nearest points of the exact surface, a cylinder or a sphere: how
far from each other do both lie in the picture? Nothing is rounded in this but the corners of triangles,
which are those that are drawn.
*/

use crate::trial::{Curved, direction, log_uniform};
use anyhow::Result;
use glam::{DVec2, DVec3};
use puncta::{
    Bricks, View,
    avc::{Arc, CHORDS_MAX, Lens, Levels, Node, Runs},
    core::Camera,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Steps along each side of a triangle.
const STEPS: u32 = 6;

/// How many triangles of a glyph are looked at.
const TRIANGLES: u32 = 64;

/// What was found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Deviation {
    /// In pixels.
    pub(crate) max: f64,
    pub(crate) mean: f64,
    pub(crate) points: u64,
    /// Glyphs that would need more chords than there may be; they are in nothing else.
    pub(crate) capped: u64,
    /// Glyphs that were looked at.
    pub(crate) glyphs: u64,
}

/// Of arcs, or of tubes and balls.
pub(crate) fn of_arcs(tolerance: f32, glyphs: u32) -> Result<Deviation> {
    measure::<Arc>(tolerance, glyphs)
}

pub(crate) fn of_tubes(tolerance: f32, glyphs: u32) -> Result<Deviation> {
    measure::<Node>(tolerance, glyphs)
}

fn measure<G: Curved>(tolerance: f32, glyphs: u32) -> Result<Deviation> {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let (mut found, mut sum) = (Deviation::default(), 0.0);
    for _ in 0..glyphs {
        let trial = G::trial(&mut random, tolerance);
        let cloud = trial.glyphs.cloud(&trial.records);
        let position = cloud.get(trial.index).position();
        let view = view(&mut random, position.as_dvec3(), trial.size)?;
        let camera = Camera::new(&view, DVec3::ZERO);
        let lens = Lens::new(&camera, tolerance);
        let runs = Runs::with_length(&cloud, 1);
        let levels = Levels::new(&camera, runs.bricks());
        let level = levels.of(u32::try_from(trial.index)?);
        let sight = lens.sight(position, lens.nearest(level, &cloud, trial.index));
        if sight.ring(trial.radius) == CHORDS_MAX || sight.sides(trial.radius) == CHORDS_MAX {
            found.capped += 1;
            continue;
        }
        let form = G::form(&cloud, trial.index, &sight);
        let size = G::size(&form);
        found.glyphs += 1;
        let place = |offset: DVec3| camera.place(position.as_dvec3() + offset);
        for triangle in some(&mut random, size.triangles) {
            let corners = G::triangle(&form, triangle);
            let corners = corners.map(|corner| G::vertex(&form, corner).as_dvec3());
            let Some(target) = G::target(&trial, triangle, size, corners) else { continue };
            for drawn in points(corners) {
                let both = [drawn, target.nearest(drawn)];
                if let Some(pixels) = apart(&camera, both.map(place)) {
                    found.max = found.max.max(pixels);
                    found.points += 1;
                    sum += pixels;
                }
            }
        }
    }
    found.mean = sum / (found.points.max(1) as f64);
    Ok(found)
}

/// All numbers below one, or some of them.
fn some(random: &mut Pcg64Mcg, count: u32) -> Vec<u32> {
    if count <= TRIANGLES {
        return (0..count).collect();
    }
    (0..TRIANGLES).map(|_| random.random_range(0..count)).collect()
}

/// Points all over a triangle.
fn points([a, b, c]: [DVec3; 3]) -> impl Iterator<Item = DVec3> {
    let share = |k: u32| f64::from(k) / f64::from(STEPS);
    (0..=STEPS).flat_map(move |i| {
        (0..=STEPS - i).map(move |j| a + (b - a) * share(i) + (c - a) * share(j))
    })
}

/// How far two points lie from each other in the picture, if they are in it.
fn apart(camera: &Camera, both: [DVec3; 2]) -> Option<f64> {
    let size = DVec2::from(camera.size().map(f64::from));
    let pixel = |place: DVec3| {
        let ray = place.truncate() / if camera.is_perspective() { place.z } else { 1.0 };
        camera.pixel_of(ray)
    };
    if both.iter().any(|place| place.z < camera.near()) {
        return None;
    }
    let [drawn, exact] = both.map(pixel);
    let is_in = |at: DVec2| at.cmpge(DVec2::splat(-0.5)).all() && at.cmple(size - 0.5).all();
    (is_in(drawn) || is_in(exact)).then(|| drawn.distance(exact))
}

/// A view that has a place somewhere in its picture, at a distance of up to a thousand sizes. The near
/// plane is such that the eye may well be inside.
fn view(random: &mut Pcg64Mcg, place: DVec3, size: f64) -> Result<View> {
    let [width, height] = [0; 2].map(|_| random.random_range(64..2048));
    let (forward, up) = (direction(random), direction(random));
    let look = |eye: DVec3| -> Result<View> {
        Ok(View::look_at(eye, eye + forward, up)?.with_size(width, height)?)
    };
    let distance = size * log_uniform(random, 0.1, 1000.0);
    let fov = random.random_range(5.0..120.0_f64).to_radians();
    let is_parallel = random.random_range(0..5) == 0;
    let spread = |view: View| {
        let side = size * 100.0_f64.powf(fov - 1.0);
        if is_parallel { view.with_orthographic(side) } else { view.with_perspective(fov) }
    };
    let column = random.random_range(0.0..f64::from(width));
    let row = random.random_range(0.0..f64::from(height));
    let first = spread(look(DVec3::ZERO)?)?;
    let ray = first.ray(column, row) * if is_parallel { 1.0 } else { distance };
    let eye = place - forward * distance - first.right() * ray.x - first.up() * ray.y;
    let near = size * log_uniform(random, 0.01, 0.3);
    Ok(spread(look(eye)?)?.with_near(near)?)
}
