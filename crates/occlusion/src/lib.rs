/*!
Culling and visibility orders: the stages between a grid and a renderer.

* [`FrustumCull`] drops bricks that lie outside of the view.
* [`Depth`] orders the rest by view depth, nearest first.
* [`Level`], [`Density`] and [`Transmittance`] order them by what lies before them in a grid, as the
  [`OcclusionGraph`] tells: how many bricks, how dense they are, and how many pixels are likely to
  show through them. [`DensityFifo`] is the thesis' way to the order of density.

```
use glam::DVec3;
use puncta_core::{Frame, Scene, Sphere, Stage, View, Visible};
use puncta_grid::{Grid, GridConfig};
use puncta_occlusion::{Depth, FrustumCull};

let spheres = (0..100_u8).map(|i| Sphere::new([f32::from(i), 0.0, 0.0], 0.5));
let mut scene = Scene::new(spheres.collect::<Vec<_>>());
let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(10))?;
let view = View::look_at(DVec3::new(55.0, 0.0, 0.0), DVec3::new(99.0, 0.0, 0.0), DVec3::Z)?;

let mut visible = Visible::all(grid.bricks(), scene.origin, &view);
let frame = Frame { view: &view, origin: scene.origin, bricks: &grid };
(FrustumCull, Depth::default()).apply(&frame, &mut visible);
let seen: Vec<u32> = visible.bricks.iter().map(|brick| brick.index()).collect();
assert_eq!(seen, [5, 6, 7, 8, 9]);
# Ok::<(), Box<dyn std::error::Error>>(())
```
*/

mod density;
mod depth;
mod frustum;
mod graph;
mod level;
mod radix;
mod transmittance;

pub use crate::{
    density::{Density, DensityFifo},
    depth::Depth,
    frustum::FrustumCull,
    graph::{Edge, OcclusionGraph},
    level::Level,
    transmittance::Transmittance,
};
