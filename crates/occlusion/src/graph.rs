/*!
The occlusion graph: which brick hides which, as far as one ray for each side can tell.

This is section 3.2 of *Visibility-Driven Progressive Rendering of Large Particle Data*, the thesis
whose methods puncta is built on. A ray goes from the center of each side of a brick's cell that
faces the camera, one to three of them, towards the camera. The first cell on its way that holds
another brick in play is an edge of the graph; a ray that meets none sees the camera. So the graph
needs 12 bytes for each brick.

Decisions:

* A ray is walked exactly, in whole numbers; where it passes through an edge between cells, the axes
  go in their order. Camera and cells are told in `camera.rs`, the walk in `walk.rs`.
* Each step of a walk leads to a cell that is nearer to the camera's along one axis and not farther
  along the others. So the graph has no cycles, and one look at each brick from front to back is
  enough for levels and for exact minima: `sweep.rs`. The thesis does it with a queue, which is
  exact for levels, but not for other weights.
* Bricks that are not in play hide nothing: what a stage dropped is not drawn.
*/

mod address;
mod camera;
mod occupancy;
mod sweep;
mod walk;

use crate::graph::{
    address::{Axes, NOWHERE},
    camera::Camera,
    occupancy::Occupancy,
    sweep::Sweep,
    walk::Rays,
};
use puncta_core::{Frame, VisibleBrick};
use puncta_grid::Grid;
use rayon::prelude::*;

/// The edge of a side whose ray sees the camera.
const CAMERA: u32 = u32::MAX;

/// The edge of a side that does not face the camera.
const AWAY: u32 = u32::MAX - 1;

/// How many bricks one thread takes at a time.
const CHUNK: usize = 1 << 12;

/// What the ray from a side of a brick meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Nothing: the sides along this axis do not face the camera.
    Away,
    /// The camera: this side is directly visible.
    Camera,
    /// A brick, as an index into the list that the graph was built for.
    Brick(u32),
}

/// Which of the bricks in play hides which.
///
/// A node is a brick of the list that the graph was built for, by its index in this list.
///
/// # Examples
///
/// Ten bricks in a row, seen from one end. Each hides the next.
///
/// ```
/// use glam::DVec3;
/// use puncta_core::{Frame, Scene, Sphere, View, Visible};
/// use puncta_grid::{Grid, GridConfig};
/// use puncta_occlusion::{Edge, OcclusionGraph};
///
/// let spheres = (0..100_u8).map(|i| Sphere::new([f32::from(i), 0.0, 0.0], 0.5));
/// let mut scene = Scene::new(spheres.collect::<Vec<_>>());
/// let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(10))?;
/// let view = View::look_at(DVec3::new(-50.0, 0.0, 0.0), DVec3::ZERO, DVec3::Z)?;
///
/// let visible = Visible::all(grid.bricks(), scene.origin, &view);
/// let frame = Frame { view: &view, origin: scene.origin, bricks: &grid };
/// let mut graph = OcclusionGraph::new(&frame, &visible.bricks);
/// assert_eq!(graph.edges(0)[0], Edge::Camera);
/// assert_eq!(graph.edges(7)[0], Edge::Brick(6));
/// assert_eq!(graph.levels(), [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
///
/// // How many records are to be drawn before a brick, at least, on the way to it?
/// let records: Vec<f32> = grid.bricks().iter().map(|brick| brick.records.len() as f32).collect();
/// assert_eq!(graph.least_sums(&records)[..3], [0.0, 10.0, 20.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct OcclusionGraph {
    places: Vec<u64>,
    occupancy: Occupancy,
    edges: Vec<[u32; 3]>,
    sweep: Sweep,
}

impl OcclusionGraph {
    /// The graph of some bricks of a grid.
    #[must_use]
    pub fn new(frame: &Frame<'_, Grid>, bricks: &[VisibleBrick]) -> Self {
        let mut graph = Self::default();
        graph.rebuild(frame, bricks);
        graph
    }

    /// Makes this the graph of some bricks of a grid, in the memory that it has.
    ///
    /// Bricks that the grid does not have are nodes that hide nothing and are never seen. Of nodes
    /// that are the same brick, one hides others.
    pub fn rebuild(&mut self, frame: &Frame<'_, Grid>, bricks: &[VisibleBrick]) {
        let (grid, dims) = (frame.bricks, frame.bricks.dims());
        let camera = Camera::new(grid.cells(), frame.view, frame.origin);
        let axes = Axes::new(dims);
        let place = |brick: &VisibleBrick| {
            grid.cell_of(brick.index()).map_or(NOWHERE, |cell| axes.address(cell))
        };
        bricks.par_iter().with_min_len(CHUNK).map(place).collect_into_vec(&mut self.places);
        let camera_at = camera.cell().and_then(|cell| axes.find(cell));
        self.occupancy.rebuild(axes, &self.places, camera_at);
        let rays = Rays::new(&self.occupancy, &camera, dims);
        let edges = |&address: &u64| rays.edges(address);
        self.places.par_iter().with_min_len(CHUNK).map(edges).collect_into_vec(&mut self.edges);
        self.sweep.sort(&self.occupancy, camera.nearest(dims), bricks.len());
    }

    /// The number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Whether there are no nodes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// What is seen from the sides of a node, one for each axis.
    ///
    /// A brick whose cell holds the camera has no side that faces it, and sees the camera with all of
    /// them.
    ///
    /// # Panics
    ///
    /// When there is no such node.
    #[must_use]
    pub fn edges(&self, node: usize) -> [Edge; 3] {
        self.edges[node].map(|edge| match edge {
            AWAY => Edge::Away,
            CAMERA => Edge::Camera,
            brick => Edge::Brick(brick),
        })
    }

    /// Whether a node sees the camera with some side.
    ///
    /// # Panics
    ///
    /// When there is no such node.
    #[must_use]
    #[inline]
    pub fn is_visible(&self, node: usize) -> bool {
        self.edges[node].contains(&CAMERA)
    }

    /// All nodes, each one after those that hide it.
    #[must_use]
    pub fn front_to_back(&self) -> &[u32] {
        self.sweep.order()
    }

    /// For each node, the least number of edges that lead to the camera: 1 if it is directly
    /// visible.
    pub fn levels(&mut self) -> &[u32] {
        self.sweep.levels(&self.edges)
    }

    /// For each node, the least sum of the weights of the nodes on a path to the camera, without
    /// its own weight: 0 if it is directly visible, infinity if it is never seen.
    ///
    /// The sums are those of `f32`, added from the camera on. They are least if no weight is
    /// negative or NaN; such count as 0, and so does a weight that is missing.
    pub fn least_sums(&mut self, weights: &[f32]) -> &[f32] {
        self.sweep.least_sums(&self.edges, weights)
    }

    /// As [`Self::least_sums`], but only over the paths to the camera that have the fewest edges.
    pub fn shortest_sums(&mut self, weights: &[f32]) -> &[f32] {
        self.sweep.shortest_sums(&self.edges, weights)
    }
}
