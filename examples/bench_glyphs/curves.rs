/*!
Glyphs of any kind, sorted into bricks: those whose number of triangles depends on the view.

Each record is drawn as finely as the renderers of the library do: so all representations have the same
triangles.
*/

use crate::noise::Noise;
use anyhow::Result;
use glam::DVec3;
use puncta::{
    Bounds, Bricks, Glyph, Glyphs, Grid, GridConfig, Scene, View, avc,
    avc::{Arc, Lens, Mesh, Node, Runs, Trajectories},
    core::Camera,
};

/// Records in bricks, and how they are drawn.
#[derive(Debug)]
pub(crate) struct Curves<G: Glyph, B = Grid> {
    pub(crate) glyphs: Glyphs<G>,
    pub(crate) scene: Scene<G>,
    pub(crate) bricks: B,
}

/// What a view makes of glyphs.
#[derive(Debug)]
pub(crate) struct Levels {
    /// The view depth by which each record is drawn.
    pub(crate) nearest: Vec<f32>,
    /// The number of triangles of each record.
    pub(crate) triangles: Vec<u32>,
    /// The most vertices of a record.
    pub(crate) vertices_max: u32,
}

impl Levels {
    pub(crate) fn sum(&self) -> u64 {
        self.triangles.iter().map(|count| u64::from(*count)).sum()
    }

    pub(crate) fn most(&self) -> u32 {
        self.triangles.iter().copied().max().unwrap_or(0)
    }
}

impl<G: Glyph> Curves<G> {
    /// Sorts records into a grid.
    pub(crate) fn sort(glyphs: Glyphs<G>, records: Vec<G>) -> Result<Self> {
        let mut scene = Scene::new(records);
        let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
        Ok(Self { glyphs, scene, bricks })
    }
}

impl<G: Glyph> Curves<G, Runs> {
    /// Leaves records in their order.
    pub(crate) fn keep(glyphs: Glyphs<G>, records: Vec<G>) -> Self {
        let scene = Scene::new(records);
        let bricks = Runs::new(&glyphs.cloud(scene.records.as_slice()));
        Self { glyphs, scene, bricks }
    }
}

impl<G: Glyph, B: Bricks> Curves<G, B> {
    /// The box around all balls.
    pub(crate) fn bounds(&self) -> Bounds {
        let mut bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        for brick in self.bricks.bricks() {
            let radius = f64::from(brick.radius_max);
            bounds.min = bounds.min.min(brick.bounds.min.as_dvec3() - radius);
            bounds.max = bounds.max.max(brick.bounds.max.as_dvec3() + radius);
        }
        bounds
    }

    pub(crate) fn levels(&self, view: &View) -> Levels {
        let camera = Camera::new(view, DVec3::ZERO);
        let lens = Lens::new(&camera, self.glyphs.tolerance);
        let cloud = self.glyphs.cloud(self.scene.records.as_slice());
        let levels = avc::Levels::new(&camera, self.bricks.bricks());
        let nearest = |(index, number)| lens.nearest(levels.of(number), &cloud, index);
        let nearest: Vec<f32> = (0..cloud.records.len()).zip(0..).map(nearest).collect();
        let size = |(index, nearest): (usize, &f32)| {
            let sight = lens.sight(cloud.get(index).position(), *nearest);
            G::size(&G::form(&cloud, index, &sight))
        };
        let sizes: Vec<_> = nearest.iter().enumerate().map(size).collect();
        Levels {
            triangles: sizes.iter().map(|size| size.triangles).collect(),
            vertices_max: sizes.iter().map(|size| size.vertices).max().unwrap_or(0),
            nearest,
        }
    }

    /// The geometry of a record, in the coordinates of the scene.
    pub(crate) fn mesh(&self, lens: &Lens<'_>, levels: &Levels, index: usize) -> Mesh {
        let cloud = self.glyphs.cloud(self.scene.records.as_slice());
        let position = cloud.get(index).position();
        let sight = lens.sight(position, levels.nearest[index]);
        let mut mesh = Mesh::of::<G>(&G::form(&cloud, index, &sight));
        mesh.vertices.iter_mut().for_each(|vertex| *vertex += position);
        mesh
    }
}

/// Arcs of all sizes, one around each point of a regular grid.
#[expect(clippy::cast_possible_truncation, reason = "coordinates are small")]
pub(crate) fn arcs(count: u32) -> Vec<Arc> {
    let side = (1..).find(|side| side * side >= u64::from(count)).unwrap_or(1);
    let [start, turn, outer, inner, height] = [5, 6, 7, 8, 9].map(|seed| Noise::new(seed, 1.5));
    let arc = |index: u64| {
        let (x, y) = ((index % side) as f64 + 0.5, (index / side) as f64 + 0.5);
        let start = start.flat(x, y);
        let outer = 0.1 + 0.38 * outer.flat(x, y);
        let inner = outer * (0.2 + 0.7 * inner.flat(x, y));
        let end = start + 0.1 + 0.85 * turn.flat(x, y);
        Arc {
            center: [x as f32, y as f32, 0.0],
            radii: [inner as f32, outer as f32],
            turns: [start as f32, end as f32],
            height: (0.05 + 0.6 * height.flat(x, y)) as f32,
        }
    };
    (0..u64::from(count)).map(arc).collect()
}

/// Trajectories of up to 100 nodes that wind through a cube.
#[expect(clippy::cast_possible_truncation, reason = "coordinates are small")]
pub(crate) fn tubes(count: u32) -> Vec<Node> {
    const LENGTH: u32 = 100;
    let mut all = Trajectories::default();
    let ways = [10, 11, 12].map(|seed| Noise::new(seed, 1.0));
    for first in (0..count).step_by(LENGTH as usize) {
        let nodes = first..(first + LENGTH).min(count);
        let times: Vec<f32> = nodes.clone().map(|node| (node - first) as f32).collect();
        let position = |node: u32| {
            let (time, number) = (f64::from(node - first) * 0.06, f64::from(first / LENGTH));
            // Other trajectories lie elsewhere in the noise.
            ways.map(|way| (10.0 * way.at([time, number * 1.7, number * 0.3])) as f32)
        };
        let positions: Vec<_> = nodes.map(position).collect();
        all.push(&positions, &times);
    }
    all.nodes
}
