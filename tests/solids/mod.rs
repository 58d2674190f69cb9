//! The reference for glyphs: every triangle of every record against every pixel's ray, in `f64`, in
//! world coordinates; and the scenes that renderers are tested with.
//!
//! It shares no code with the renderers but what says how finely a record is drawn. For each pixel it
//! tells the answers that may be given: one, unless the answer hangs on a hair. That is what the promise
//! of exactness says: a ray moved by some [`Pixels`], or two depths within `DEPTH_ULPS` and what such a
//! move does to them.

#![allow(dead_code, reason = "not every test uses all of it")]

use glam::DVec3;
use puncta::{
    Brick, Glyph, Glyphs, NO_RECORD, Picture, Scene, View,
    avc::{Lens, Levels, Mesh},
    core::Camera,
};
use rayon::prelude::*;

pub(crate) mod footprint;
mod samples;
pub(crate) mod scenes;

/// Hands all kinds of glyphs to a macro: a name, the type, and how their scenes are drawn: every which one,
/// smaller by which factor along each side, and how many pixels each of them covers at least.
macro_rules! all_glyphs {
    ($each:ident) => {
        $each! {
            cuboids: puncta::Cuboid, 1, 1, 500;
            prisms: puncta::avc::Prism, 2, 4, 100;
            discs: puncta::avc::Disc, 2, 4, 100;
            arrows: puncta::avc::Arrow, 2, 4, 6;
            arcs: puncta::avc::Arc, 2, 4, 100;
            polygons: puncta::avc::Polygon, 2, 4, 100;
            nodes: puncta::avc::Node, 2, 2, 100;
        }
    };
}
pub(crate) use all_glyphs;

/// How far a silhouette may be off, in pixels: what a renderer promises.
pub(crate) type Pixels = f64;

/// What the renderer on the CPU promises.
pub(crate) const CPU: Pixels = 1e-4;

/// How many pixels of a row are looked at together.
const RUN: u32 = 8;

/// Up to how many units in the last place of `f32` two depths count as equal.
const DEPTH_ULPS: f64 = 4.0;

/// The largest relative error of a view depth.
const DEPTH_ERROR: f64 = 1.0 / 4_194_304.0;

/// How a picture compares with the reference.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Verdict {
    pub(crate) pixels: usize,
    pub(crate) covered: usize,
    pub(crate) undecided: usize,
}

impl Verdict {
    fn plus(self, other: Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            covered: self.covered + other.covered,
            undecided: self.undecided + other.undecided,
        }
    }
}

/// A ray: where it starts, relative to the eye, and its direction, along which the view depth grows by
/// one.
#[derive(Clone, Copy, Debug)]
struct Ray {
    start: DVec3,
    direction: DVec3,
}

impl Ray {
    fn new(view: &View, column: f64, row: f64) -> Self {
        let (x, y) = view.ray(column, row).into();
        let aside = view.right() * x + view.up() * y;
        if view.is_perspective() {
            Self { start: DVec3::ZERO, direction: view.forward() + aside }
        } else {
            Self { start: aside, direction: view.forward() }
        }
    }

    /// The view depth at which it meets a triangle, and whether from in front (Möller and Trumbore,
    /// *Fast, Minimum Storage Ray/Triangle Intersection*, 1997).
    fn meet(&self, [a, b, c]: [DVec3; 3]) -> Option<(f64, bool)> {
        let (u, v) = (b - a, c - a);
        let p = self.direction.cross(v);
        let determinant = u.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let from = self.start - a;
        let s = from.dot(p) / determinant;
        let q = from.cross(u);
        let t = self.direction.dot(q) / determinant;
        let depth = v.dot(q) / determinant;
        (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then_some((depth, determinant > 0.0))
    }
}

/// A pixel's ray, and eight around it.
fn rays(view: &View, (column, row): (u32, u32), hair: Pixels) -> [Ray; 9] {
    let diagonal = hair * std::f64::consts::FRAC_1_SQRT_2;
    let around = [
        [0.0, 0.0],
        [hair, 0.0],
        [-hair, 0.0],
        [0.0, hair],
        [0.0, -hair],
        [diagonal, diagonal],
        [diagonal, -diagonal],
        [-diagonal, diagonal],
        [-diagonal, -diagonal],
    ];
    around.map(|[x, y]| Ray::new(view, f64::from(column) + x, f64::from(row) + y))
}

/// A record's triangles, relative to the eye.
#[derive(Clone, Debug)]
struct Solid {
    /// What the user knows it by.
    id: u32,
    triangles: Vec<[DVec3; 3]>,
}

impl Solid {
    /// The triangles that rays of a row, or up to two hairs away, may meet, for each [`RUN`] of its
    /// pixels: all others lie on one side of a plane of such rays.
    fn of_row(&self, view: &View, row: u32, hair: Pixels) -> Vec<Vec<[DVec3; 3]>> {
        let slack = 2.0 * hair * view.pixel_size();
        let ray = |column: u32, row: u32| view.ray(f64::from(column), f64::from(row));
        // How far the corners lie beyond the plane of rays of this slope along an axis, at most.
        let beyond = |triangle: &[DVec3; 3], (axis, slope): (DVec3, f64)| {
            let far = triangle.map(|corner| {
                let spread = if view.is_perspective() { corner.dot(view.forward()) } else { 1.0 };
                let at = corner.dot(axis) - slope * spread;
                at + slack * spread.abs() + 1e-9 * corner.length()
            });
            far[0].max(far[1]).max(far[2])
        };
        let (up, right, y) = (view.up(), view.right(), ray(0, row).y);
        let in_row: Vec<&[DVec3; 3]> = self
            .triangles
            .iter()
            .filter(|it| beyond(it, (up, y)) >= 0.0 && beyond(it, (-up, -y)) >= 0.0)
            .collect();
        let run = |first: u32| {
            let (left, end) = (ray(first, row).x, ray(first + RUN - 1, row).x);
            let is_near = |it: &&[DVec3; 3]| {
                beyond(it, (right, left)) >= 0.0 && beyond(it, (-right, -end)) >= 0.0
            };
            in_row.iter().copied().filter(is_near).copied().collect()
        };
        (0..view.width()).step_by(RUN as usize).map(run).collect()
    }

    /// The smallest view depth, from `near` on, at which a ray meets a triangle from in front.
    fn enter(triangles: &[[DVec3; 3]], ray: &Ray, near: f64) -> Option<f64> {
        let meets = triangles.iter().filter_map(|&triangle| ray.meet(triangle));
        let seen = meets.filter(|&(depth, is_front)| {
            // What f32 cannot hold is not seen either.
            is_front && depth >= near && depth <= f64::from(f32::MAX)
        });
        seen.map(|(depth, _)| depth).reduce(f64::min)
    }
}

/// A record that a pixel may show.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    index: usize,
    id: u32,
    /// The depths at the rays of which it is met: at the pixel's own if there, the smallest and the
    /// largest.
    depth: f64,
    depths: [f64; 2],
    /// Whether all rays meet it, clearly beyond the near plane.
    is_sure: bool,
    /// The depths of its corners: where it is seen edge-on, any between them may be met.
    corners: [f64; 2],
}

/// All records of a scene, as they are seen in a view.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    view: View,
    solids: Vec<Solid>,
}

impl Reference {
    /// Checks on the way that the vertices of each record lie in its ball, and that in the box of the
    /// scene's record.
    pub(crate) fn new<G: Glyph>(
        glyphs: &Glyphs<G>,
        scene: &Scene<G>,
        bricks: &[Brick],
        view: &View,
    ) -> Self {
        let camera = Camera::new(view, scene.origin);
        let lens = Lens::new(&camera, glyphs.tolerance);
        let levels = Levels::new(&camera, bricks);
        let cloud = glyphs.cloud(&scene.records);
        let solid = |index: usize| {
            let position = scene.records[index].position();
            let level = levels.of(u32::try_from(index).unwrap());
            let nearest = lens.nearest(level, &cloud, index);
            let form = G::form(&cloud, index, &lens.sight(position, nearest));
            let ball = G::ball(&cloud, index);
            let place = scene.origin - view.eye();
            Solid {
                id: scene.id(u32::try_from(index).unwrap()),
                triangles: triangles::<G>(&form, position.as_dvec3(), ball)
                    .into_iter()
                    .map(|triangle| triangle.map(|corner| place + corner))
                    .collect(),
            }
        };
        let solids = (0..scene.records.len()).into_par_iter().map(solid).collect();
        Self { view: view.clone(), solids }
    }

    /// Compares a picture with the reference; the message names the first pixel that is wrong.
    pub(crate) fn compare(&self, picture: &Picture, hair: Pixels) -> Result<Verdict, String> {
        let width = self.view.width();
        let row = |row: u32| -> Result<Verdict, String> {
            let mut verdict = Verdict::default();
            let of_row = |solid: &Solid| solid.of_row(&self.view, row, hair);
            let triangles: Vec<Vec<Vec<[DVec3; 3]>>> = self.solids.iter().map(of_row).collect();
            for column in 0..width {
                let pixel = (row * width + column) as usize;
                let (id, depth) = (picture.id[pixel], picture.depth[pixel]);
                let (nearest, others) = self.answers(&triangles, (column, row), hair);
                check(nearest, &others, id, depth).map_err(|what| {
                    format!("column {column}, row {row}: {what}; {nearest:?} {others:?}")
                })?;
                verdict.pixels += 1;
                verdict.covered += usize::from(id != NO_RECORD);
                verdict.undecided += usize::from(!others.is_empty());
            }
            Ok(verdict)
        };
        let rows = (0..self.view.height()).into_par_iter().map(row);
        rows.try_reduce(Verdict::default, |a, b| Ok(a.plus(b)))
    }

    /// The nearest record that surely is there, and those that would be seen if hairs fell otherwise.
    fn answers(
        &self,
        triangles: &[Vec<Vec<[DVec3; 3]>>],
        pixel: (u32, u32),
        hair: Pixels,
    ) -> (Option<Candidate>, Vec<Candidate>) {
        let rays = rays(&self.view, pixel, hair);
        let near = self.view.near();
        let near_hair = DEPTH_ULPS * ulp(near);
        let mut candidates: Vec<Candidate> = Vec::new();
        for (index, solid) in self.solids.iter().enumerate() {
            let triangles = &triangles[index][(pixel.0 / RUN) as usize];
            if triangles.is_empty() {
                continue;
            }
            let hits = rays.map(|ray| Solid::enter(triangles, &ray, near - near_hair));
            let known = || hits.iter().flatten().copied();
            let Some(low) = known().reduce(f64::min) else { continue };
            let high = known().fold(low, f64::max);
            let is_sure = hits.iter().all(|hit| hit.is_some_and(|depth| depth > near + near_hair));
            let depth = hits[0].unwrap_or(low);
            let corners = triangles.iter().flatten().map(|corner| corner.dot(self.view.forward()));
            let corners = corners.fold([low, high], |[low, high], at| [low.min(at), high.max(at)]);
            candidates.push(Candidate {
                index,
                id: solid.id,
                depth,
                depths: [low, high],
                is_sure,
                corners,
            });
        }
        let by_depth =
            |a: &&Candidate, b: &&Candidate| a.depth.total_cmp(&b.depth).then(a.id.cmp(&b.id));
        let nearest = candidates.iter().filter(|c| c.is_sure).min_by(by_depth).copied();
        let limit = nearest.map_or(f64::INFINITY, |c| c.depths[1] + DEPTH_ULPS * ulp(c.depths[1]));
        let is_other = |c: &Candidate| {
            let is_nearest = nearest.is_some_and(|nearest| nearest.index == c.index);
            // What is exactly the same is no hair: the lower id must win.
            let is_same = |nearest: Candidate| {
                let (a, b) = (&self.solids[nearest.index], &self.solids[c.index]);
                c.is_sure && a.triangles == b.triangles && nearest.id < c.id
            };
            !is_nearest && c.depths[0] <= limit && !nearest.is_some_and(is_same)
        };
        (nearest, candidates.into_iter().filter(is_other).collect())
    }
}

fn check(
    nearest: Option<Candidate>,
    others: &[Candidate],
    id: u32,
    depth: f32,
) -> Result<(), String> {
    let index = |c: &Candidate| u32::try_from(c.index).unwrap();
    if id == NO_RECORD {
        return match nearest {
            Some(nearest) => Err(format!("shows nothing instead of {}", nearest.index)),
            None if depth == f32::INFINITY => Ok(()),
            None => Err(format!("shows nothing at {depth}")),
        };
    }
    let mut answers = nearest.iter().chain(others);
    let Some(shown) = answers.find(|c| index(c) == id) else {
        return Err(format!("shows {id} at {depth} instead of {:?}", nearest.map(|c| c.index)));
    };
    // The depth at a silhouette changes without bound, within the record.
    let [low, high] = if shown.is_sure { shown.depths } else { shown.corners };
    let (low, high) = (low * (1.0 - DEPTH_ERROR), high * (1.0 + DEPTH_ERROR));
    if (low..=high).contains(&f64::from(depth)) {
        Ok(())
    } else {
        Err(format!("record {id} has depth {depth} instead of {low} to {high}"))
    }
}

/// The triangles of a form around a position.
fn triangles<G: Glyph>(
    form: &G::Form<'_>,
    position: DVec3,
    ball: (glam::Vec3, f32),
) -> Vec<[DVec3; 3]> {
    let mesh = Mesh::of::<G>(form);
    let places: Vec<DVec3> =
        mesh.vertices.iter().map(|vertex| position + vertex.as_dvec3()).collect();
    for place in &places {
        let away = place.distance(ball.0.as_dvec3());
        assert!(
            away <= f64::from(ball.1),
            "a vertex {away} from the middle of a ball of {}",
            ball.1
        );
    }
    mesh.triangles.iter().map(|corners| corners.map(|corner| places[corner as usize])).collect()
}

/// The distance between neighboring `f32` at this size.
fn ulp(x: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
    let x = x as f32;
    f64::from(x.next_up()) - f64::from(x)
}
