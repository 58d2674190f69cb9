//! The reference: every record against every pixel's ray, in `f64`, in world coordinates.
//!
//! It shares no code with the renderers. For each pixel it tells the set of answers that may be
//! given: one, unless the answer hangs on a hair. That is what the promise of exactness says: a
//! silhouette within some [`Pixels`] of the ray, or two depths within `DEPTH_ULPS`.

use glam::DVec3;
use puncta::core::{NO_RECORD, Picture, Projection, Record, Scene, View};

/// How far a silhouette may be off, in pixels: what a renderer promises.
pub(crate) type Pixels = f64;

/// What the renderer on the CPU promises.
pub(crate) const CPU: Pixels = 1e-4;

/// Up to how many units in the last place of `f32` two depths count as equal.
const DEPTH_ULPS: f64 = 4.0;

/// The largest relative error of a view depth.
const DEPTH_ERROR: f64 = 1.0 / 4_194_304.0;

/// What a pixel may show.
#[derive(Clone, Debug)]
struct Pixel {
    /// The nearest record whose silhouette is not near the ray.
    nearest: Option<Candidate>,
    /// All records that would be an answer if hairs fell otherwise.
    others: Vec<Candidate>,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    id: u32,
    radius: f64,
    depth: f64,
    /// Whether the ray's hit, and its being beyond the near plane, do not hang on a hair.
    is_sure: bool,
}

/// How a picture compares with the reference.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Verdict {
    pub(crate) pixels: usize,
    pub(crate) covered: usize,
    pub(crate) undecided: usize,
}

/// Compares a picture with the reference; the message names the first pixel that is wrong.
pub(crate) fn compare<R: Record>(
    scene: &Scene<R>,
    view: &View,
    picture: &Picture,
    hair: Pixels,
) -> Result<Verdict, String> {
    let mut verdict = Verdict::default();
    for row in 0..view.height() {
        for column in 0..view.width() {
            let index = (row * view.width() + column) as usize;
            let (id, depth) = (picture.id[index], picture.depth[index]);
            let pixel = reference(scene, view, (column, row), hair);
            check(&pixel, id, depth)
                .map_err(|what| format!("column {column}, row {row}: {what}; {pixel:?}"))?;
            verdict.pixels += 1;
            verdict.covered += usize::from(id != NO_RECORD);
            verdict.undecided += usize::from(!pixel.others.is_empty());
        }
    }
    Ok(verdict)
}

fn check(pixel: &Pixel, id: u32, depth: f32) -> Result<(), String> {
    let nearest = pixel.nearest.map_or(NO_RECORD, |candidate| candidate.id);
    let other = pixel.others.iter().find(|candidate| candidate.id == id);
    if id != nearest && other.is_none() {
        return Err(format!("shows {id} at {depth} instead of {nearest}"));
    }
    if id == NO_RECORD {
        let is_far = depth == f32::INFINITY;
        return if is_far { Ok(()) } else { Err(format!("shows nothing at {depth}")) };
    }
    // The depth at a silhouette changes without bound, within the sphere; elsewhere it must be right.
    let shown = pixel.nearest.into_iter().chain(other.copied()).find(|c| c.id == id);
    let error = |c: Candidate| (f64::from(depth) - c.depth).abs();
    let is_right = |c: Candidate| {
        error(c) <= DEPTH_ERROR * c.depth + if c.is_sure { 0.0 } else { 2.0 * c.radius }
    };
    match shown {
        Some(c) if !is_right(c) => {
            Err(format!("record {id} has depth {depth} instead of {}", c.depth))
        }
        _ => Ok(()),
    }
}

/// What a pixel may show, by looking at every record.
fn reference<R: Record>(scene: &Scene<R>, view: &View, pixel: (u32, u32), hair: Pixels) -> Pixel {
    let to_origin = scene.origin - view.eye();
    let mut candidates: Vec<Candidate> = Vec::new();
    for (index, record) in scene.records.iter().enumerate() {
        let center = to_origin + record.position().as_dvec3();
        let radius = f64::from(record.radius());
        candidates.extend(
            candidate(view, pixel, (center, radius), hair).map(|(depth, is_sure)| Candidate {
                id: index as u32,
                radius,
                depth,
                is_sure,
            }),
        );
    }
    let by_depth = |a: &&Candidate, b: &&Candidate| {
        let ids = (scene.id(a.id), scene.id(b.id));
        a.depth.total_cmp(&b.depth).then(ids.0.cmp(&ids.1))
    };
    let nearest = candidates.iter().filter(|c| c.is_sure).min_by(by_depth).copied();
    let limit = nearest.map_or(f64::INFINITY, |c| c.depth + DEPTH_ULPS * ulp(c.depth));
    let is_other = |c: &Candidate| {
        let is_nearest = nearest.is_some_and(|nearest| nearest.id == c.id);
        // Exactly equal depths are no hair: the lower id must win.
        let is_equal = c.is_sure && nearest.is_some_and(|nearest| nearest.depth == c.depth);
        !is_nearest && !is_equal && c.depth <= limit
    };
    let others = candidates.into_iter().filter(is_other).collect();
    Pixel { nearest, others }
}

/// Where the ray of a pixel enters a sphere, and whether that is sure; `None` if it surely does not.
fn candidate(
    view: &View,
    (column, row): (u32, u32),
    (center, radius): (DVec3, f64),
    pixels: Pixels,
) -> Option<(f64, bool)> {
    let ray = |dx: f64, dy: f64| view.ray(f64::from(column) + dx, f64::from(row) + dy);
    let at = |(dx, dy): (f64, f64)| enter(view, ray(dx, dy).into(), center, radius);
    // Moving a ray by some pixels moves it at the centre by at most so much, in world units.
    let spread = if view.is_perspective() { center.length() } else { 1.0 };
    let hair = pixels * view.pixel_size() * spread;
    let miss = miss(view, ray(0.0, 0.0).into(), center);
    if miss > radius + hair {
        return None;
    }
    let (middle, step) = (at((0.0, 0.0)), pixels);
    let diagonal = step * std::f64::consts::FRAC_1_SQRT_2;
    let straight = [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)];
    let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corners = corners.map(|(x, y)| (x * diagonal, y * diagonal));
    let hits: Vec<Option<f64>> = if miss < radius - hair {
        vec![middle]
    } else {
        straight.into_iter().chain(corners).map(at).collect()
    };
    let depth = middle.or_else(|| hits.iter().flatten().copied().reduce(f64::min))?;
    let near_hair = DEPTH_ULPS * ulp(view.near());
    // What f32 cannot hold is not seen either.
    if depth < view.near() - near_hair || depth > f64::from(f32::MAX) {
        return None;
    }
    let is_beyond = depth > view.near() + near_hair;
    Some((depth, middle.is_some() && is_beyond && hits.iter().all(Option::is_some)))
}

/// The distance between a ray and a point.
fn miss(view: &View, (x, y): (f64, f64), center: DVec3) -> f64 {
    let lateral = view.right() * x + view.up() * y;
    let (start, direction) = match view.projection() {
        Projection::Perspective { .. } => (DVec3::ZERO, (view.forward() + lateral).normalize()),
        Projection::Orthographic { .. } => (lateral, view.forward()),
    };
    let along = (center - start).dot(direction);
    (center - start - direction * along).length()
}

/// The view depth at which a ray enters a sphere, whether or not it is beyond the near plane.
///
/// The discriminant is that of Haines, Guenther and Akenine-Moeller (Ray Tracing Gems, chapter 7).
fn enter(view: &View, (x, y): (f64, f64), center: DVec3, radius: f64) -> Option<f64> {
    let lateral = view.right() * x + view.up() * y;
    match view.projection() {
        Projection::Perspective { .. } => {
            let direction = (view.forward() + lateral).normalize();
            let along = center.dot(direction);
            let miss = center - direction * along;
            let discriminant = radius * radius - miss.length_squared();
            // Around the eye there is no entry; behind it nothing is seen.
            if discriminant < 0.0 || center.length() <= radius || along <= 0.0 {
                return None;
            }
            let far = along + discriminant.sqrt();
            let distance = (center.length() - radius) * (center.length() + radius) / far;
            Some(distance * direction.dot(view.forward()))
        }
        Projection::Orthographic { .. } => {
            let along = (center - lateral).dot(view.forward());
            let miss = center - lateral - view.forward() * along;
            let discriminant = radius * radius - miss.length_squared();
            (discriminant >= 0.0).then(|| along - discriminant.sqrt())
        }
    }
}

/// The distance between neighboring `f32` at this size.
fn ulp(x: f64) -> f64 {
    let x = x as f32;
    f64::from(x.next_up()) - f64::from(x)
}
