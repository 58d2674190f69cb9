//! The parts of a frame before drawing: culling, the occlusion graph, and the orders.

use crate::{
    case::Often,
    clock::{self, Span},
    naive,
    order::Order,
    world::World,
};
use clap::ValueEnum;
use puncta::{Amount, Frame, FrustumCull, Stage, View, Visible, occlusion::OcclusionGraph};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Depth bounds of all bricks, and which of them are in view
    Cull,
    /// The occlusion graph
    Graph,
    /// Its plain twin
    Naive,
    /// An order, with its graph if it needs one
    Order(Order),
}

impl Part {
    pub(crate) fn all() -> Vec<Self> {
        let orders = Order::usual().into_iter().map(Self::Order);
        [Self::Cull, Self::Graph, Self::Naive].into_iter().chain(orders).collect()
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Cull => "cull".to_owned(),
            Self::Graph => "graph".to_owned(),
            Self::Naive => "plain graph".to_owned(),
            Self::Order(order) => {
                let value = order.to_possible_value();
                value.map_or_else(String::new, |value| value.get_name().to_owned())
            }
        }
    }
}

/// Measures all parts in turn, and what is in view. What a pipeline would keep from frame to frame is
/// kept.
pub(crate) fn measure(
    world: &World,
    view: &View,
    often: Often,
) -> (Amount, Vec<(Part, Vec<Span>)>) {
    let bricks = world.grid.bricks();
    let frame = Frame { view, origin: world.scene().origin, bricks: &world.grid };
    let (mut culled, mut visible) = (Visible::default(), Visible::default());
    let mut graph = OcclusionGraph::default();
    let mut parts: Vec<_> = Part::all().into_iter().map(|part| (part, vec![])).collect();
    let mut stages: Vec<_> =
        Order::usual().into_iter().filter_map(|order| Some((order, order.stage()?))).collect();
    // The first time is for getting memory.
    for repetition in 0..=often.parts {
        for (part, spans) in &mut parts {
            let span = match *part {
                Part::Cull => clock::time(|| {
                    culled.refill(bricks, frame.origin, view);
                    FrustumCull.apply(&frame, &mut culled);
                }),
                Part::Graph => clock::time(|| graph.rebuild(&frame, &culled.bricks)),
                Part::Naive if repetition > often.slow => continue,
                Part::Naive => {
                    let (edges, span) = clock::time(|| naive::edges(&frame, &culled.bricks));
                    drop(edges);
                    ((), span)
                }
                Part::Order(order) => {
                    let stage = stages.iter_mut().find(|(which, _)| *which == order);
                    let Some((_, stage)) = stage else { continue };
                    visible.bricks.clone_from(&culled.bricks);
                    clock::time(|| stage.apply(&frame, &mut visible))
                }
            }
            .1;
            if repetition > 0 {
                spans.push(span);
            }
        }
    }
    (Amount::of(bricks, &culled.bricks), parts)
}

/// The share of all edges that are the same in the graph and in its twin.
pub(crate) fn agreement(world: &World, view: &View) -> Option<f64> {
    let frame = Frame { view, origin: world.scene().origin, bricks: &world.grid };
    let mut visible = Visible::all(world.grid.bricks(), frame.origin, view);
    FrustumCull.apply(&frame, &mut visible);
    let graph = OcclusionGraph::new(&frame, &visible.bricks);
    let twin = naive::edges(&frame, &visible.bricks);
    let count =
        |node: usize| graph.edges(node).iter().zip(&twin[node]).filter(|(a, b)| a == b).count();
    let same: usize = (0..graph.len()).map(count).sum();
    (!twin.is_empty()).then(|| same as f64 / (3 * twin.len()) as f64)
}
