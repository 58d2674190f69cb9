/*!
The renderer of puncta on wgpu: the same picture as on the CPU, streamed progressively.
*/

mod compositor;
mod config;
mod error;
mod exact;
mod finish;
mod frame;
mod gpu;
mod kernel;
mod kernels;
mod paint;
mod raster;
mod renderer;
mod residency;
mod round;
mod runs;
mod shade;
mod shade_list;
mod shade_pass;
mod shaded;
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
};
pub use wgpu;
