/*!
The renderer of puncta on wgpu: the same picture as on the CPU, streamed progressively.
*/

mod config;
mod error;
mod exact;
mod finish;
mod frame;
mod gpu;
mod kernel;
mod kernels;
mod raster;
mod renderer;
mod residency;
mod round;
mod runs;
#[cfg(test)]
mod shaders;
mod store;
mod survey;
mod table;
mod target;

pub use crate::{
    config::{Fragment, GpuConfig, Setup, Skipping},
    error::Error,
    gpu::{Extent, Gpu},
    renderer::GpuRenderer,
};
pub use wgpu;
