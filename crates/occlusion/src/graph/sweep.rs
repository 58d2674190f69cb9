/*!
Levels and sums of weights, in one look at each node.

What hides a node is nearer to the camera in the sum of the distances of cells along the axes, so that
nodes in this order find the values of all that hides them. A value is then an exact minimum, as
Dijkstra's algorithm would find it: adding in `f32` keeps the order of numbers, rounded or not.
*/

use crate::graph::{AWAY, CAMERA, occupancy::NOWHERE};

/// An order of nodes, and the values found in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    distances: Vec<u32>,
    /// For each distance the place in the order of its next node.
    next: Vec<u32>,
    order: Vec<u32>,
    levels: Vec<u32>,
    sums: Vec<f32>,
    /// The sum of a node and its own weight.
    handed: Vec<f32>,
}

impl Sweep {
    /// Sorts nodes by the distance of their cells from that nearest to the camera.
    ///
    /// Nodes without a place are last.
    pub(crate) fn sort(&mut self, places: &[[u32; 3]], nearest: [u32; 3]) {
        let mut farthest = 0;
        self.distances.clear();
        self.distances.extend(places.iter().map(|&place| {
            let along = |axis: usize| place[axis].abs_diff(nearest[axis]);
            let distance = if place == NOWHERE { 0 } else { along(0) + along(1) + along(2) + 1 };
            farthest = farthest.max(distance);
            distance
        }));
        let last = farthest + 1;
        self.next.clear();
        self.next.resize(last as usize + 1, 0);
        for distance in &mut self.distances {
            *distance = if *distance == 0 { last } else { *distance };
            self.next[*distance as usize] += 1;
        }
        let mut start = 0;
        for count in &mut self.next {
            start += std::mem::replace(count, start);
        }
        self.order.clear();
        self.order.resize(places.len(), 0);
        for (node, &distance) in (0_u32..).zip(&self.distances) {
            let next = &mut self.next[distance as usize];
            self.order[*next as usize] = node;
            *next += 1;
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
            let least = edges[node as usize].map(|edge| match edge {
                CAMERA => 0,
                AWAY => u32::MAX,
                brick => self.levels[brick as usize],
            });
            let least = least[0].min(least[1]).min(least[2]);
            self.levels[node as usize] = least.saturating_add(1);
        }
        &self.levels
    }

    /// The least of the sums that what hides a node hands on.
    pub(crate) fn least_sums(&mut self, edges: &[[u32; 3]], weights: &[f32]) -> &[f32] {
        self.clear_sums(edges.len());
        for &node in &self.order {
            let node = node as usize;
            let least = edges[node].map(|edge| match edge {
                CAMERA => 0.0,
                AWAY => f32::INFINITY,
                brick => self.handed[brick as usize],
            });
            let least = least[0].min(least[1]).min(least[2]);
            self.sums[node] = least;
            self.handed[node] = least + weights.get(node).map_or(0.0, |weight| weight.max(0.0));
        }
        &self.sums
    }

    /// The least of the sums that what hides a node and has a lower level hands on.
    pub(crate) fn shortest_sums(&mut self, edges: &[[u32; 3]], weights: &[f32]) -> &[f32] {
        self.levels(edges);
        self.clear_sums(edges.len());
        for &node in &self.order {
            let node = node as usize;
            let least = edges[node].map(|edge| match edge {
                CAMERA => 0.0,
                AWAY => f32::INFINITY,
                brick if self.levels[brick as usize] < self.levels[node] => {
                    self.handed[brick as usize]
                }
                _ => f32::INFINITY,
            });
            let least = least[0].min(least[1]).min(least[2]);
            self.sums[node] = least;
            self.handed[node] = least + weights.get(node).map_or(0.0, |weight| weight.max(0.0));
        }
        &self.sums
    }

    fn clear_sums(&mut self, nodes: usize) {
        self.sums.clear();
        self.sums.resize(nodes, f32::INFINITY);
        self.handed.clear();
        self.handed.resize(nodes, f32::INFINITY);
    }
}
