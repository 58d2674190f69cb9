//! The plain twin of the occlusion graph: a map from cells to bricks, and each ray walked by itself
//! in `f64`, on one thread.

use glam::DVec3;
use puncta::{Frame, Grid, core::VisibleBrick, occlusion::Edge};
use std::collections::HashMap;

/// The edges of all bricks in play.
pub(crate) fn edges(frame: &Frame<'_, Grid>, bricks: &[VisibleBrick]) -> Vec<[Edge; 3]> {
    let cell_of = |brick: &VisibleBrick| {
        frame.bricks.cell_of(brick.index()).unwrap_or_default().map(i64::from)
    };
    let nodes = (0_u32..).zip(bricks).map(|(node, brick)| (cell_of(brick), node)).collect();
    let cells = frame.bricks.cells();
    let eye = frame.view.eye() - frame.origin - cells.corner().as_dvec3();
    let walk = Walk {
        nodes,
        dims: cells.dims().map(i64::from),
        eye: eye * f64::from(cells.scale()),
        along: (!frame.view.is_perspective()).then(|| -frame.view.forward()),
    };
    bricks.iter().map(|brick| walk.edges(cell_of(brick))).collect()
}

/// The cells with bricks, and the camera in units of cells.
struct Walk {
    nodes: HashMap<[i64; 3], u32>,
    dims: [i64; 3],
    eye: DVec3,
    /// The direction of all rays, if they are parallel.
    along: Option<DVec3>,
}

impl Walk {
    #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
    fn camera(&self) -> [i64; 3] {
        self.eye.floor().to_array().map(|coordinate| coordinate as i64)
    }

    fn edges(&self, cell: [i64; 3]) -> [Edge; 3] {
        let camera = self.camera();
        let steps: [i64; 3] = std::array::from_fn(|axis| match self.along {
            Some(along) => sign(along[axis]),
            None => (camera[axis] - cell[axis]).signum(),
        });
        if steps == [0; 3] {
            return [Edge::Camera; 3];
        }
        std::array::from_fn(|axis| match steps[axis] {
            0 => Edge::Away,
            step => self.follow(cell, axis, step),
        })
    }

    /// What the ray from the center of a side meets.
    fn follow(&self, mut cell: [i64; 3], axis: usize, step: i64) -> Edge {
        let mut from = DVec3::from(cell.map(|index| index as f64 + 0.5));
        from[axis] += 0.5 * step as f64;
        let way = self.along.unwrap_or(self.eye - from);
        let camera = self.along.is_none().then(|| self.camera());
        cell[axis] += step;
        loop {
            if let Some(&node) = self.nodes.get(&cell) {
                return Edge::Brick(node);
            }
            let is_outside = (0..3).any(|axis| !(0..self.dims[axis]).contains(&cell[axis]));
            if is_outside || camera == Some(cell) {
                return Edge::Camera;
            }
            let share = |axis: usize| match sign(way[axis]) {
                0 => f64::INFINITY,
                sign => (cell[axis] as f64 + f64::from(sign > 0) - from[axis]) / way[axis],
            };
            let shares = [0, 1, 2].map(share);
            let first = (1..3).fold(0, |a, b| if shares[b] < shares[a] { b } else { a });
            cell[first] += sign(way[first]);
        }
    }
}

fn sign(number: f64) -> i64 {
    i64::from(number > 0.0) - i64::from(number < 0.0)
}
