#![doc = include_str!("../../README.md")]

pub use puncta_avc as avc;
pub use puncta_core as core;
pub use puncta_cpu as cpu;
#[cfg(feature = "gpu")]
pub use puncta_gpu as gpu;
pub use puncta_grid as grid;
pub use puncta_io as io;
pub use puncta_occlusion as occlusion;

pub use puncta_avc::{Cuboid, Glyph, Glyphs};
pub use puncta_core::{
    Amount, Bounds, Brick, Bricks, Budget, Content, Frame, Image, Live, NO_RECORD, Picture,
    Pipeline, Progress, Projection, Record, Renderer, Scene, Source, Sphere, Stage, Step, View,
    Visible,
};
pub use puncta_cpu::{
    Background, ColorMap, Coloring, Colors, CpuRenderer, Each, Shading, Spheres, shade,
    shade_glyphs,
};
#[cfg(feature = "gpu")]
pub use puncta_gpu::{Compositor, Gpu, GpuConfig, GpuRenderer, Paint, ShadeConfig};
#[cfg(all(target_endian = "little", any(unix, windows)))]
pub use puncta_grid::{BrickFile, ConvertConfig, convert};
pub use puncta_grid::{Cells, Error as GridError, Fit, Grid, GridConfig, Order, Resolution};
pub use puncta_io::{Format, Loaded, ReadOptions};
pub use puncta_occlusion::{
    Density, DensityFifo, Depth, FrustumCull, Level, OcclusionGraph, Transmittance,
};
