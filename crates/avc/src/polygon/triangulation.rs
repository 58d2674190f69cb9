/*!
Triangles of polygons that close with the walls: every edge of a ring belongs to one of them.

`earcutr` cuts ears, but drops corners that lie on a straight line with their neighbours, also when they
come to do so on the way. Its triangles then end at an edge past the corner. The edges that are missing
form loops of no area, and triangles of no area fill them: nothing of these is drawn, but neighbours
share their edges again, so there is no gap.

# Why the check is enough

Each edge of a ring belongs to one triangle that goes along it in the same direction, and all other edges
to two that go along them in opposite directions. So the walls, the roof and the floor are closed. No
triangle turns clockwise, beyond rounding; so the number of triangles above a point, which is how often the
rings go around it, is never negative. A hole that leaves the outer ring, a ring in the shape of an 8, and
holes that overlap all go around some point a negative number of times, and are found.
*/

use glam::DVec2;
use std::collections::{HashMap, HashSet};

type Edge = [u32; 2];

/// Triangles, counterclockwise, of corners in rings that begin at `starts`, the outer one first; none if
/// there are none that hold.
pub(super) fn triangulate(corners: &[DVec2], starts: &[u32]) -> Option<Vec<[u32; 3]>> {
    let flat: Vec<f64> = corners.iter().flat_map(|corner| [corner.x, corner.y]).collect();
    let holes: Vec<usize> = starts.iter().skip(1).map(|&start| start as usize).collect();
    let cut = earcutr::earcut(&flat, &holes, 2).ok()?;
    let number = |index: usize| u32::try_from(index).ok();
    let mut triangles = Vec::with_capacity(cut.len() / 3);
    for triangle in cut.chunks_exact(3) {
        let [a, b, c] = [number(triangle[0])?, number(triangle[1])?, number(triangle[2])?];
        triangles.push([a, b, c]);
    }
    // All of them turn the same way.
    if triangles.iter().map(|&triangle| turn(corners, triangle)[0]).sum::<f64>() < 0.0 {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    fill(&mut triangles, &edges(corners, starts));
    holds(&triangles, corners, starts).then_some(triangles)
}

/// All edges of the rings, in their direction.
fn edges(corners: &[DVec2], starts: &[u32]) -> Vec<Edge> {
    let ends = starts.iter().skip(1).copied().chain(u32::try_from(corners.len()));
    let ring = |(start, end): (u32, u32)| {
        (start..end).map(move |from| [from, if from + 1 == end { start } else { from + 1 }])
    };
    starts.iter().copied().zip(ends).flat_map(ring).collect()
}

/// Twice the area, and how far rounding may be off.
fn turn(corners: &[DVec2], triangle: [u32; 3]) -> [f64; 2] {
    let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
    let (u, v) = (b - a, c - a);
    // Each difference and each product is rounded, and the last difference.
    let slack = 4.0 * f64::EPSILON * ((u.x * v.y).abs() + (u.y * v.x).abs());
    [u.perp_dot(v), slack]
}

fn sides([a, b, c]: [u32; 3]) -> [Edge; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Adds triangles for the loops of edges that are missing.
fn fill(triangles: &mut Vec<[u32; 3]>, rings: &[Edge]) {
    // How often an edge is wanted, less how often it is there; less than that of the other direction.
    let mut wanted: HashMap<Edge, i32> = HashMap::new();
    let mut want = |[from, to]: Edge, times: i32| {
        let (edge, times) = if from < to { ([from, to], times) } else { ([to, from], -times) };
        *wanted.entry(edge).or_default() += times;
    };
    rings.iter().for_each(|&edge| want(edge, 1));
    triangles.iter().for_each(|&triangle| sides(triangle).iter().for_each(|&edge| want(edge, -1)));
    let mut missing: Vec<Edge> = Vec::new();
    for ([a, b], times) in wanted {
        let edge = if times > 0 { [a, b] } else { [b, a] };
        (0..times.unsigned_abs()).for_each(|_| missing.push(edge));
    }
    // In the same order on each run.
    missing.sort_unstable();
    let mut leaving: HashMap<u32, Vec<u32>> = HashMap::new();
    missing.iter().rev().for_each(|&[from, to]| leaving.entry(from).or_default().push(to));
    for [start, _] in missing {
        let mut path = vec![start];
        let mut places = HashMap::from([(start, 0)]);
        let mut at = start;
        while let Some(next) = leaving.get_mut(&at).and_then(Vec::pop) {
            at = next;
            if let Some(&place) = places.get(&at) {
                // A loop is closed: what led here stays.
                let passed = path.split_off(place + 1);
                passed.iter().for_each(|corner| _ = places.remove(corner));
                triangles.extend(passed.windows(2).map(|pair| [at, pair[0], pair[1]]));
            } else {
                places.insert(at, path.len());
                path.push(at);
            }
        }
    }
}

/// The check of this module.
fn holds(triangles: &[[u32; 3]], corners: &[DVec2], starts: &[u32]) -> bool {
    let mut open: HashSet<Edge> = HashSet::with_capacity(3 * triangles.len());
    let each_once = triangles.iter().flat_map(|&triangle| sides(triangle)).all(|e| open.insert(e));
    let rings_are_there = edges(corners, starts).iter().all(|edge| open.remove(edge));
    let rest_is_paired = open.iter().all(|&[from, to]| open.contains(&[to, from]));
    // A ring's edge whose other direction is there would belong to three.
    let is_clockwise = |&triangle: &[u32; 3]| {
        let [area, slack] = turn(corners, triangle);
        area < -slack
    };
    each_once
        && rings_are_there
        && rest_is_paired
        && !triangles.iter().any(is_clockwise)
        && triangles.len() + 4 == corners.len() + 2 * starts.len()
}
