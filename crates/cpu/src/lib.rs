/*!
The renderer that is always there: exact spheres and glyphs on the CPU, and
shading.

```
use glam::DVec3;
use puncta_core::{Pipeline, Scene, Sphere, View};
use puncta_cpu::{CpuRenderer, Shading, shade};
use puncta_grid::{Grid, GridConfig};
use puncta_occlusion::{Depth, FrustumCull};

let mut scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0), Sphere::new([1.5, 0.0, 0.0], 0.5)]);
let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
let view = View::look_at(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Y)?
    .with_size(11, 5)?
    .with_orthographic(2.5)?;
let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
let picture = pipeline.render(&scene, &grid, &view)?;

let rows: Vec<String> = picture
    .original_ids(&scene)
    .chunks(11)
    .map(|row| row.iter().map(|id| ["o", "x"].get(*id as usize).unwrap_or(&".")).copied().collect())
    .collect();
assert_eq!(rows, [
    ".....o.....",
    "....ooo.x..",
    "...oooooxx.",
    "....ooo.x..",
    ".....o.....",
]);
let image = shade(&scene, &view, &picture, &Shading::default())?;
assert_eq!(image.pixels.len(), 11 * 5);
# Ok::<(), Box<dyn std::error::Error>>(())
```

[`CpuRenderer`] draws spheres, or glyphs, front to back into bands of rows, on all cores of the present
rayon pool. What a pixel shows does not depend on the order of the records nor on the number of threads.
[`shade`] and [`shade_glyphs`] make an image of the picture afterwards, from nothing but ids.
*/

mod band;
mod cache;
mod coloring;
mod colormap;
mod disc;
mod drawing;
mod error;
mod image;
mod knowledge;
mod legend;
mod renderer;
mod renders;
mod shade;
mod shade_glyphs;
mod shape;
mod solid;
mod survey;
mod tiles;

pub use crate::{
    coloring::{Coloring, Colors, Each},
    colormap::ColorMap,
    error::Error,
    legend::draw_legend,
    renderer::CpuRenderer,
    shade::{Shading, shade},
    shade_glyphs::shade_glyphs,
    shape::Spheres,
};
pub use puncta_core::Background;
