//! The orders that are made from the occlusion graph equal plain ones.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

mod twin;

use proptest::prelude::*;
use puncta_core::{Brick, Stage, VisibleBrick};
use puncta_grid::Grid;
use puncta_occlusion::{Density, DensityFifo, Level, Transmittance};
use twin::{Dice, Seen, World, world};

/// The list after a stage.
fn ordered(world: &World, stage: &mut impl Stage<Grid>) -> Vec<VisibleBrick> {
    let mut visible = world.visible.clone();
    stage.apply(&world.frame(), &mut visible);
    visible.bricks
}

/// The list sorted by comparing keys, then depth, then indices.
fn expected<K: PartialOrd>(world: &World, key: impl Fn(usize) -> K) -> Vec<VisibleBrick> {
    let list = &world.visible.bricks;
    let of = |node: usize| (key(node), list[node].near(), list[node].index());
    let mut nodes: Vec<usize> = (0..list.len()).collect();
    nodes.sort_by(|&a, &b| of(a).partial_cmp(&of(b)).unwrap());
    nodes.into_iter().map(|node| list[node]).collect()
}

fn brick(world: &World, node: usize) -> &Brick {
    &world.grid.bricks()[world.visible.bricks[node].index() as usize]
}

/// The optical thickness of a brick whose balls are of one size, from their cross sections.
fn thickness(brick: &Brick, width: f64) -> f64 {
    let radius = f64::from(brick.radius_max);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let balls = f64::from(brick.density) * width.powi(3) / volume;
    if radius > 0.0 {
        balls * std::f64::consts::PI * radius * radius / (width * width)
    } else {
        0.0
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn levels_then_depth(world in world()) {
        let (levels, _) = twin::shortest(&twin::edges(&world), |_| 0.0);
        let list = ordered(&world, &mut Level::default());
        prop_assert_eq!(list, expected(&world, |node| levels[node]));
    }

    #[test]
    fn densities(worlds in [world(), world()]) {
        let (mut exact, mut fifo) = (Density::default(), DensityFifo::default());
        for world in worlds {
            let edges = twin::edges(&world);
            let is_hidden = |node: usize| !edges[node].contains(&Seen::Camera);
            let density = |node: usize| brick(&world, node).density;
            let sums = twin::dijkstra(&edges, density);
            let list = ordered(&world, &mut exact);
            prop_assert_eq!(list, expected(&world, |node| (is_hidden(node), sums[node])));
            let (_, sums) = twin::shortest(&edges, density);
            let list = ordered(&world, &mut fifo);
            prop_assert_eq!(list, expected(&world, |node| (is_hidden(node), sums[node])));
        }
    }

    #[test]
    fn expected_pixels(world in world()) {
        let width = f64::from(world.grid.cells().width());
        let edges = twin::edges(&world);
        let own = |node: usize| thickness(brick(&world, node), width);
        let before = twin::dijkstra(&edges, |node| own(node) as f32);
        let pixels = |brick: &VisibleBrick| {
            let node = world.visible.bricks.iter().position(|b| b == brick).unwrap();
            let away = (f64::from(brick.near()) + f64::from(brick.far())) / 2.0;
            let spread = if world.view.is_perspective() { away.max(width / 2.0) } else { 1.0 };
            let side = width / spread / world.view.pixel_size();
            let seen = (-f64::from(before[node])).exp() * -(-own(node)).exp_m1() * side * side;
            seen / brick_records(&world, node)
        };
        let list = ordered(&world, &mut Transmittance::default());
        prop_assert_eq!(list.len(), world.visible.bricks.len());
        // Both round, so that what is nearly equal may be in any order.
        for pair in list.windows(2) {
            let (first, second) = (pixels(&pair[0]), pixels(&pair[1]));
            prop_assert!(first >= second * (1.0 - 1e-4) - 1e-30, "{first} before {second}");
        }
    }
}

fn brick_records(world: &World, node: usize) -> f64 {
    brick(world, node).records.len() as f64
}

/// The queue sees `last` behind the dense brick, and so draws it after what is behind a middling
/// one.
#[test]
fn the_queue_takes_the_dense_path() {
    let (world, [_, last, also]) = twin::way_around();
    let is_before = |list: Vec<VisibleBrick>| {
        let place = |node: usize| list.iter().position(|b| b.index() as usize == node).unwrap();
        place(last) < place(also)
    };
    assert!(is_before(ordered(&world, &mut Density::default())));
    assert!(!is_before(ordered(&world, &mut DensityFifo::default())));
}

#[test]
fn threads_change_nothing() {
    let mut dice = Dice(5);
    let grid = twin::grid([40, 40, 40], 50, &mut dice);
    let world = twin::seen_from(grid, [-20.0, 70.0, 31.0]);
    assert!(world.visible.bricks.len() > 1 << 14);
    let lists = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            [
                ordered(&world, &mut Level::default()),
                ordered(&world, &mut Density::default()),
                ordered(&world, &mut DensityFifo::default()),
                ordered(&world, &mut Transmittance::default()),
            ]
        })
    });
    assert!(lists[1] == lists[0] && lists[2] == lists[0]);
    assert!((1..4).all(|order| lists[0][order] != lists[0][order - 1]));
}
