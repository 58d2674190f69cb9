//! The plain twin of the occlusion graph: every ray by itself, in fractions, over a map of cells.

use glam::DVec3;
use proptest::prelude::*;
use puncta_core::{Frame, Scene, Sphere, View, Visible, VisibleBrick};
use puncta_grid::{Fit, Grid, GridConfig, Resolution};
use std::collections::HashMap;

/// What a ray meets: nothing to be seen from there, the camera, or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seen {
    Away,
    Camera,
    Node(usize),
}

/// A grid of cells of width 1, some of its bricks in play, and a view.
#[derive(Clone, Debug)]
pub(crate) struct World {
    pub(crate) grid: Grid,
    pub(crate) visible: Visible,
    pub(crate) view: View,
    pub(crate) origin: DVec3,
}

impl World {
    pub(crate) fn frame(&self) -> Frame<'_, Grid> {
        Frame { view: &self.view, origin: self.origin, bricks: &self.grid }
    }
}

/// A small generator of numbers.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 33) % end
    }
}

/// A grid of these dims in which a cell holds a brick with a chance of `percent`.
pub(crate) fn grid(dims: [u32; 3], percent: u64, dice: &mut Dice) -> Grid {
    let mut spheres = Vec::new();
    for z in 0..dims[2] {
        for y in 0..dims[1] {
            for x in 0..dims[0] {
                // The corners make the grid as large as that.
                let is_corner = [x, y, z] == [0; 3] || [x + 1, y + 1, z + 1] == dims;
                if is_corner || dice.below(100) < percent {
                    for _ in 0..=dice.below(4) {
                        let radius = dice.below(300) as f32 / 1000.0;
                        spheres.push(Sphere::new([x, y, z].map(|i| i as f32), radius));
                    }
                }
            }
        }
    }
    let mut scene = Scene::new(spheres);
    let resolution = Resolution::Width(1.0);
    let config = GridConfig { resolution, fit: Fit::Whole, ..GridConfig::default() };
    let grid = Grid::sort_scene(&mut scene, &config).unwrap();
    // The last positions lie on the upper face of the box, whose cell is the one below.
    assert!(grid.dims().iter().zip(dims).all(|(&is, want)| is == want.max(2) - 1));
    grid
}

/// Two layers of bricks, seen from the left and below by parallel rays, and the nodes of the first,
/// the second and the last name:
///
/// ```text
/// dense last        middling also
/// thin  thin                 middling
///       thin
/// ```
pub(crate) fn way_around() -> (World, [usize; 3]) {
    let (dense, last, also) = ([0, 2, 0], [1, 2, 0], [1, 2, 2]);
    let thin = [[0, 1, 0], [1, 1, 0], [1, 0, 0], last, also].map(|cell| (cell, 1));
    let middling = [[0, 2, 2], [1, 1, 2]].map(|cell| (cell, 8));
    let mut spheres = Vec::new();
    for (cell, count) in thin.into_iter().chain(middling).chain([(dense, 20)]) {
        // Within the cells of width 1 that start at the least position.
        let center = cell.map(|i: u32| i as f32 * 1.25);
        spheres.extend(vec![Sphere::new(center, 0.25); count]);
    }
    let mut scene = Scene::new(spheres);
    let resolution = Resolution::Width(1.0);
    let config = GridConfig { resolution, fit: Fit::Whole, ..GridConfig::default() };
    let grid = Grid::sort_scene(&mut scene, &config).unwrap();
    assert_eq!(grid.dims(), [2, 3, 3]);
    let nodes = [dense, last, also].map(|place| grid.brick_at(place).unwrap() as usize);
    let view = View::look_at(DVec3::new(-9.0, -10.0, 0.0), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_orthographic(10.0).unwrap();
    let visible = Visible::all(grid.bricks(), DVec3::ZERO, &view);
    (World { grid, visible, view, origin: DVec3::ZERO }, nodes)
}

/// All bricks of a grid, seen from a place.
pub(crate) fn seen_from(grid: Grid, eye: [f64; 3]) -> World {
    let view = View::look_at(eye.into(), DVec3::ZERO, DVec3::Y).unwrap();
    let visible = Visible::all(grid.bricks(), DVec3::ZERO, &view);
    World { grid, visible, view, origin: DVec3::ZERO }
}

/// Where to put the camera, in cells: all ways to be on faces, edges, corners and lines of centers.
fn place(dims: [u32; 3]) -> impl Strategy<Value = DVec3> {
    let along = move |axis: usize| {
        let dim = f64::from(dims[axis]);
        prop_oneof![
            3 => (-4_i32..2 * dims[axis] as i32 + 4).prop_map(|half| f64::from(half) * 0.5),
            3 => -2.0 * dim..3.0 * dim,
            1 => prop_oneof![Just(-1e12), Just(1e12), Just(-3e30), Just(1e5), Just(dim)],
            1 => (0..=dims[axis]).prop_map(|face| f64::from(face) - f64::EPSILON * 64.0),
        ]
    };
    (along(0), along(1), along(2)).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn direction() -> impl Strategy<Value = DVec3> {
    let along = || prop_oneof![(-3_i32..4).prop_map(f64::from), -1.0..1.0];
    let is_some = |direction: &DVec3| direction.length() > 1e-3;
    (along(), along(), along()).prop_map(|(x, y, z)| DVec3::new(x, y, z)).prop_filter("0", is_some)
}

fn view(eye: DVec3, forward: DVec3, is_perspective: bool) -> Option<View> {
    let up = if forward.x.abs() < forward.y.abs() { DVec3::X } else { DVec3::Y };
    // A target at the middle of nothing: the direction does not matter in perspective.
    let target = if eye.abs().max_element() > 1e9 { DVec3::ZERO } else { eye + forward };
    let view = View::look_at(eye, target, up).ok()?;
    if is_perspective { Some(view) } else { view.with_orthographic(10.0).ok() }
}

/// Worlds of all kinds.
pub(crate) fn world() -> impl Strategy<Value = World> {
    let dims = prop_oneof![
        [1_u32..14, 1_u32..14, 1_u32..14],
        [20_u32..60, 1_u32..2, 1_u32..2],
        [1_u32..3, 1_u32..30, 17_u32..40],
    ];
    let seeds = (any::<u64>(), prop_oneof![Just(1_u64), Just(5), Just(20), Just(50), Just(97)]);
    let shift = prop_oneof![Just(0.0), Just(1e7)];
    (dims, seeds, shift).prop_flat_map(|(dims, (seed, percent), shift)| {
        let camera = (place(dims), direction(), prop::bool::weighted(0.75));
        (camera, 0_u64..3).prop_filter_map("a degenerate view", move |(camera, dropped)| {
            let mut dice = Dice(seed);
            let grid = grid(dims.map(|dim| dim + 1), percent, &mut dice);
            let origin = DVec3::new(shift, -shift, 2.0 * shift);
            let corner = grid.cells().corner().as_dvec3();
            let view = view(origin + corner + camera.0, camera.1, camera.2)?;
            let mut visible = Visible::all(grid.bricks(), origin, &view);
            visible.bricks.retain(|_| dice.below(10) >= dropped);
            for last in (1..visible.bricks.len()).rev() {
                if dropped > 0 {
                    visible.bricks.swap(last, dice.below(last as u64 + 1) as usize);
                }
            }
            Some(World { grid, visible, view, origin })
        })
    })
}

/// The way of a ray: it ends at a point, or it has a direction. In units of 2^-17 cell.
enum Way {
    To([i128; 3]),
    Along([i128; 3]),
}

fn way(world: &World) -> Way {
    let cells = world.grid.cells();
    let eye = (world.view.eye() - world.origin) - cells.corner().as_dvec3();
    let eye = (eye * f64::from(cells.scale())).to_array();
    let largest = |p: [f64; 3]| p.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let end = 2.0_f64.powi(40);
    let along = |p: [f64; 3]| Way::Along(p.map(|x| (x / largest(p) * end).round() as i128));
    if !world.view.is_perspective() {
        along((-world.view.forward()).to_array())
    } else if largest(eye) < end {
        // The odd number next to it; the upper one, if it is even.
        Way::To(eye.map(|x| (x * 65536.0).floor() as i128 * 2 + 1))
    } else {
        along(eye)
    }
}

/// The twin: follows one ray from a side of a cell.
fn follow(way: &Way, start: [i128; 3], axis: usize, cells: &HashMap<[i128; 3], usize>) -> Seen {
    const CELL: i128 = 1 << 17;
    let mut from = start.map(|i| i * CELL + CELL / 2);
    let middle = from[axis];
    let (is_up, is_down) = match way {
        Way::To(end) => (end[axis] > middle + CELL / 2, end[axis] < middle - CELL / 2),
        Way::Along(way) => (way[axis] > 0, way[axis] < 0),
    };
    if !is_up && !is_down {
        return Seen::Away;
    }
    let out = if is_up { 1 } else { -1 };
    from[axis] += out * CELL / 2;
    let to: [i128; 3] = match way {
        Way::To(end) => std::array::from_fn(|i| end[i] - from[i]),
        Way::Along(way) => *way,
    };
    let mut cell = start;
    cell[axis] += out;
    loop {
        if let Some(&node) = cells.get(&cell) {
            return Seen::Node(node);
        }
        let is_camera = match way {
            Way::To(end) => (0..3).all(|i| end[i].div_euclid(CELL) == cell[i]),
            Way::Along(_) => false,
        };
        if is_camera || cell.iter().any(|&i| !(-2..100).contains(&i)) {
            return Seen::Camera;
        }
        // The share of the way at which the next plane of each axis is crossed, as a fraction.
        let share = |i: usize| {
            let plane = (if to[i] > 0 { cell[i] + 1 } else { cell[i] }) * CELL;
            ((plane - from[i]).abs(), to[i].abs())
        };
        let mut first: Option<(usize, (i128, i128))> = None;
        for i in (0..3).filter(|&i| to[i] != 0) {
            let (p, q) = share(i);
            if first.is_none_or(|(_, (r, s))| p * s < r * q) {
                first = Some((i, (p, q)));
            }
        }
        let (axis, _) = first.unwrap();
        cell[axis] += to[axis].signum();
    }
}

/// The edges of all nodes.
pub(crate) fn edges(world: &World) -> Vec<[Seen; 3]> {
    let cell = |brick: &VisibleBrick| world.grid.cell_of(brick.index()).unwrap().map(i128::from);
    let bricks = &world.visible.bricks;
    let cells = bricks.iter().enumerate().map(|(node, brick)| (cell(brick), node)).collect();
    let way = way(world);
    let of = |brick: &VisibleBrick| {
        let edges = [0, 1, 2].map(|axis| follow(&way, cell(brick), axis, &cells));
        // Whatever has no side to look from is where the camera is.
        if edges == [Seen::Away; 3] { [Seen::Camera; 3] } else { edges }
    };
    bricks.iter().map(of).collect()
}

/// The least sums by Dijkstra's algorithm, in its plainest form, and the fewest edges.
pub(crate) fn dijkstra(edges: &[[Seen; 3]], weight: impl Fn(usize) -> f32) -> Vec<f32> {
    let mut sums: Vec<f32> = edges
        .iter()
        .map(|edges| if edges.contains(&Seen::Camera) { 0.0 } else { f32::INFINITY })
        .collect();
    let mut done = vec![false; edges.len()];
    while let Some(next) =
        (0..edges.len()).filter(|&node| !done[node]).min_by(|&a, &b| sums[a].total_cmp(&sums[b]))
    {
        done[next] = true;
        for (node, edges) in edges.iter().enumerate() {
            if edges.contains(&Seen::Node(next)) {
                sums[node] = sums[node].min(sums[next] + weight(next));
            }
        }
    }
    sums
}

/// The fewest edges to the camera, and the least sum over such paths: level by level.
pub(crate) fn shortest(edges: &[[Seen; 3]], weight: impl Fn(usize) -> f32) -> (Vec<u32>, Vec<f32>) {
    let (mut levels, mut sums) = (vec![u32::MAX; edges.len()], vec![f32::INFINITY; edges.len()]);
    for level in 1.. {
        let before = levels.clone();
        for (node, edges) in edges.iter().enumerate().filter(|&(node, _)| before[node] == u32::MAX)
        {
            for &edge in edges {
                let sum = match edge {
                    Seen::Camera if level == 1 => 0.0,
                    Seen::Node(hider) if before[hider] == level - 1 => sums[hider] + weight(hider),
                    _ => continue,
                };
                levels[node] = level;
                sums[node] = sums[node].min(sum);
            }
        }
        if levels == before {
            break;
        }
    }
    (levels, sums)
}
