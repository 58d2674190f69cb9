//! The occlusion graph equals its plain twin, wherever the camera is.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

mod twin;

use glam::DVec3;
use proptest::prelude::*;
use puncta_core::Visible;
use puncta_occlusion::{Edge, OcclusionGraph};
use twin::{Dice, Seen, World, world};

fn seen(edges: [Edge; 3]) -> [Seen; 3] {
    edges.map(|edge| match edge {
        Edge::Away => Seen::Away,
        Edge::Camera => Seen::Camera,
        Edge::Brick(node) => Seen::Node(node as usize),
    })
}

fn all(graph: &OcclusionGraph) -> Vec<[Seen; 3]> {
    (0..graph.len()).map(|node| seen(graph.edges(node))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn edges_are_those_of_the_twin(worlds in [world(), world()]) {
        let mut graph = OcclusionGraph::default();
        for world in worlds {
            // In memory that was used before.
            graph.rebuild(&world.frame(), &world.visible.bricks);
            prop_assert_eq!(all(&graph), twin::edges(&world));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn what_hides_a_brick_is_before_it(world in world()) {
        let graph = OcclusionGraph::new(&world.frame(), &world.visible.bricks);
        let mut places = vec![usize::MAX; graph.len()];
        for (place, &node) in graph.front_to_back().iter().enumerate() {
            places[node as usize] = place;
        }
        for (node, edges) in all(&graph).into_iter().enumerate() {
            prop_assert!(places[node] < graph.len());
            prop_assert!(edges != [Seen::Away; 3]);
            for edge in edges {
                if let Seen::Node(hider) = edge {
                    prop_assert!(places[hider] < places[node]);
                }
            }
        }
    }

    #[test]
    fn levels_and_sums_are_those_of_the_twins(
        world in world(),
        weights in prop::collection::vec(prop_oneof![1 => Just(0.0), 4 => 0.0_f32..1.0], 20),
    ) {
        let edges = twin::edges(&world);
        let mut graph = OcclusionGraph::new(&world.frame(), &world.visible.bricks);
        let weights: Vec<f32> =
            (0..edges.len()).map(|node| weights[node * 7 % weights.len()]).collect();
        let weight = |node: usize| weights[node];
        let (levels, sums) = twin::shortest(&edges, weight);
        prop_assert_eq!(graph.levels(), levels);
        prop_assert_eq!(graph.shortest_sums(&weights), sums);
        prop_assert_eq!(graph.least_sums(&weights), twin::dijkstra(&edges, weight));
    }
}

/// A world that is large enough to be cut for threads.
fn large() -> World {
    twin::seen_from(twin::grid([31, 30, 29], 60, &mut Dice(1)), [-3.3, 14.2, 77.7])
}

#[test]
fn threads_change_nothing() {
    let world = large();
    assert!(world.visible.bricks.len() > 3 * 4096);
    let graphs = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| all(&OcclusionGraph::new(&world.frame(), &world.visible.bricks)))
    });
    assert!(graphs[0] == twin::edges(&world));
    assert!(graphs[1] == graphs[0] && graphs[2] == graphs[0]);
}

/// A list that no stage of ours makes: some bricks twice, and one that the grid does not have.
#[test]
fn lists_may_hold_anything() {
    let world = large();
    let of_more = twin::grid([40, 40, 40], 90, &mut Dice(2));
    let more = Visible::all(of_more.bricks(), DVec3::ZERO, &world.view);
    let unknown = *more.bricks.last().unwrap();
    assert!(world.grid.cell_of(unknown.index()).is_none());
    let mut list = vec![unknown; 3];
    list.extend(&world.visible.bricks[..50]);
    list.extend(&world.visible.bricks[..9]);
    let mut graph = OcclusionGraph::new(&world.frame(), &list);
    assert_eq!(graph.len(), 62);
    assert_eq!(all(&graph)[..3], [[Seen::Away; 3]; 3]);
    assert_eq!(all(&graph)[3..12], all(&graph)[53..]);
    assert_eq!(graph.levels()[..3], [u32::MAX; 3]);
    let levels = graph.levels();
    assert_eq!(levels[3..12], levels[53..]);
    assert_eq!(graph.least_sums(&[1.0; 62])[..3], [f32::INFINITY; 3]);
    assert!(graph.levels()[3..].iter().all(|&level| level < 100));
    for list in [&[][..], &[unknown]] {
        graph.rebuild(&world.frame(), list);
        assert_eq!((graph.len(), graph.is_empty()), (list.len(), list.is_empty()));
        assert_eq!(graph.levels().len() + graph.front_to_back().len(), 2 * list.len());
    }
}

/// A thin way around a dense brick: the fewest edges lead through the dense one.
#[test]
fn the_shortest_path_is_not_always_the_least() {
    let (world, [dense, last, _]) = twin::way_around();
    let mut graph = OcclusionGraph::new(&world.frame(), &world.visible.bricks);
    let levels = graph.levels();
    assert_eq!((levels[dense], levels[last]), (1, 2));
    let mut weights = [1.0; 8];
    weights[dense] = 10.0;
    assert_eq!(graph.shortest_sums(&weights)[last], 10.0);
    assert_eq!(graph.least_sums(&weights)[last], 2.0);
}
