/*!
The renderer of puncta on wgpu: the same picture as on the CPU, streamed progressively.

```
use glam::DVec3;
use puncta_core::{Pipeline, Scene, Sphere, View};
use puncta_gpu::{Extent, Gpu, GpuConfig, GpuRenderer};
use puncta_grid::{Grid, GridConfig};
use puncta_occlusion::{Depth, FrustumCull};

# if std::env::var_os("PUNCTA_NO_GPU").is_some() {
#     return Ok(());
# }
let gpu = Gpu::new(None, Extent::Full)?; // or Gpu::from_device, beside what a program draws itself
let mut scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0), Sphere::new([1.5, 0.0, 0.0], 0.5)]);
let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
let view = View::look_at(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Y)?
    .with_size(11, 5)?
    .with_orthographic(2.5)?;
let renderer = GpuRenderer::new(&gpu, GpuConfig::default())?;
let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
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
# Ok::<(), Box<dyn std::error::Error>>(())
```

# The way of a record

1. The CPU places each brick in play before the camera, in `f64` (`runs.rs`), and brings records that
   are missing through a ring of buffers (`store.rs`). What was used least recently makes room, so
   scenes may be larger than [`GpuConfig::record_bytes`], and those that fit are brought once.
2. Bricks behind what is drawn are dropped by a look at tiles of the picture, records that are hidden or
   cover no pixel's centre by another; what is left becomes discs (`cull.wgsl`, `setup.wgsl`).
3. Discs become pixels in one of several ways ([`Setup`], [`Fragment`]), which all test the same ray
   against the same sphere. Glyphs become triangles: a lane draws those that are small, a group of lanes
   each block of those that are large (`glyph.wgsl`). Each way writes a word that is larger the nearer
   the surface is, and of equal depths the lower the id; the maximum stays. So the picture depends
   neither on the way nor on the order.
4. [`Renderer::survey`](puncta_core::Renderer::survey) finds what the bricks that are left can still
   change, as on the CPU: a picture that is settled is complete.

# What is exact

A silhouette is off by less than 1e-3 of a pixel, and two surfaces may change places where their
depths differ by some units in the last place of `f32`. Spheres that `f32` cannot draw as exactly as
that (larger than some hundred pixels, nearer than their diameter, or cut by the near plane) are drawn
by the CPU and merged. Depths of a [`Picture`](puncta_core::Picture) are computed in `f64`.

# What a device must have

Nothing beyond the defaults of WebGPU. Where words of 64 bits can be written, nothing is drawn twice
([`Gpu::useful_features`]). A picture needs 8 bytes a pixel in one piece: a device that binds
128 MiB at once draws 16 million pixels.

# Threads

`draw` comes back when the device is done, so that what it tells is true. It brings records on a thread
of its own. To keep a program going meanwhile, let [`Live`](puncta_core::Live) draw, in budgets: the
latest view takes over at the next one.
*/

#[cfg(test)]
mod branches;
mod compositor;
mod config;
mod draw;
mod error;
mod exact;
mod expand;
mod finish;
mod frame;
mod gpu;
mod kernel;
mod kernels;
mod pace;
mod paint;
mod picture;
mod raster;
mod renderer;
mod residency;
mod round;
mod runs;
mod shade;
mod shade_list;
mod shade_pass;
mod shaded;
#[cfg(test)]
mod shaders;
mod shape;
mod solid_depths;
mod solid_shaders;
mod solids;
mod spheres;
mod store;
mod survey;
mod table;
mod target;

pub use crate::{
    compositor::{Compositor, CompositorConfig, CompositorDepth},
    config::{Fragment, GpuConfig, Setup, Skipping},
    error::Error,
    gpu::{Extent, Gpu},
    paint::Paint,
    renderer::GpuRenderer,
    shade::ShadeConfig,
    shaded::Shaded,
    solids::Solids,
    spheres::Spheres,
};
pub use wgpu;
