/*!
An order of nodes from front to back; levels and sums of weights, in one look at each node.

Each step of a ray leads to a cell that is nearer to the camera along one axis and not farther along
the others. So nodes can be ordered such that each finds the values of all that hides it, and a
value is an exact minimum, as Dijkstra's algorithm would find it: adding in `f32` keeps the order of
numbers, rounded or not.

The order goes block by block, so that what is looked at next to each other is so in memory: blocks
by the sum of their distances from that of the camera, and the cells of a block plane by plane, row
by row and one by one, each of them first upwards from the camera and then downwards.
*/

use crate::graph::{AWAY, CAMERA, occupancy::Occupancy};

/// An order of nodes, and the values found in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    /// Blocks by their distance.
    blocks: Vec<(u32, usize)>,
    order: Vec<u32>,
    levels: Vec<u32>,
    sums: Vec<f32>,
    /// The sum of a node and its own weight.
    handed: Vec<f32>,
}

impl Sweep {
    /// Orders the nodes of a grid for a camera that is nearest to this cell.
    pub(crate) fn sort(&mut self, occupancy: &Occupancy, nearest: [u32; 3], nodes: usize) {
        self.blocks.clear();
        self.blocks.extend(occupancy.blocks().map(|(block, first)| {
            let [x, y, z] = [0, 1, 2].map(|axis| (first[axis] >> 3).abs_diff(nearest[axis] >> 3));
            (x + y + z, block)
        }));
        self.blocks.sort_unstable();
        self.order.clear();
        for &(_, block) in &self.blocks {
            occupancy.each_brick(block, nearest, |node| self.order.push(node));
        }
        if self.order.len() < nodes {
            // They hide nothing: what the grid does not have, and what is in the list twice.
            let mut is_known = vec![false; nodes];
            self.order.iter().for_each(|&node| is_known[node as usize] = true);
            let others = (0_u32..).zip(is_known).filter(|(_, is_known)| !is_known);
            self.order.extend(others.map(|(node, _)| node));
        }
    }

    /// The order of the nodes.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// One more than the least level of what hides a node.
    pub(crate) fn levels(&mut self, edges: &[[u32; 3]]) -> &[u32] {
        self.levels.clear();
        self.levels.resize(edges.len(), u32::MAX);
        for &node in &self.order {
            let mut least = u32::MAX;
            for edge in edges[node as usize] {
                least = least.min(match edge {
                    CAMERA => 0,
                    AWAY => u32::MAX,
                    brick => self.levels[brick as usize],
                });
            }
            self.levels[node as usize] = least.saturating_add(1);
        }
        &self.levels
    }

    /// The least of the sums that what hides a node hands on.
    pub(crate) fn least_sums(&mut self, edges: &[[u32; 3]], weights: &[f32]) -> &[f32] {
        self.sums(edges, weights, |_, _, _| true)
    }

    /// The least of the sums that what hides a node and has a lower level hands on.
    pub(crate) fn shortest_sums(&mut self, edges: &[[u32; 3]], weights: &[f32]) -> &[f32] {
        self.levels(edges);
        self.sums(edges, weights, |levels, brick, node| levels[brick] < levels[node])
    }

    /// The least of the sums that is handed on to a node by what hides it, where `counts` is true
    /// of the levels, what hides it, and the node.
    #[inline(always)]
    fn sums(
        &mut self,
        edges: &[[u32; 3]],
        weights: &[f32],
        counts: impl Fn(&[u32], usize, usize) -> bool,
    ) -> &[f32] {
        self.sums.clear();
        self.sums.resize(edges.len(), f32::INFINITY);
        // The own weights at first.
        self.handed.clear();
        self.handed.extend(weights.iter().take(edges.len()).map(|&weight| weight.max(0.0)));
        self.handed.resize(edges.len(), 0.0);
        for &node in &self.order {
            let (node, mut least) = (node as usize, f32::INFINITY);
            for edge in edges[node] {
                let sum = match edge {
                    CAMERA => 0.0,
                    AWAY => f32::INFINITY,
                    brick if counts(&self.levels, brick as usize, node) => {
                        self.handed[brick as usize]
                    }
                    _ => f32::INFINITY,
                };
                least = if sum < least { sum } else { least };
            }
            self.sums[node] = least;
            self.handed[node] += least;
        }
        &self.sums
    }
}
