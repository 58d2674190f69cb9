//! The command line.

#[path = "parse.rs"]
mod parse;

use clap::{Parser, ValueEnum};
use glam::DVec3;
use parse::{background, point, range, size};
use puncta::{Background, ColorMap, io::synthetic::Generator};
use std::{num::NonZero, path::PathBuf};

/// Draws a particle or point file, or a synthetic scene, exactly, on the CPU or a GPU.
#[derive(Clone, Debug, Parser)]
#[command(name = "render", version, after_help = after_help())]
pub(crate) struct Options {
    /// A file (XYZ, extended XYZ, LAMMPS dump, PDB, MMPLD, PLY, LAS, LAZ, legacy VTK; gzip is fine),
    /// a brick file, or a generator such as cube:n=10000000,r=0.01,seed=7; a built-in scene by default
    pub(crate) input: Option<String>,

    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = size)]
    pub(crate) size: (u32, u32),

    /// The place of the camera, in the coordinates of the file; fits the scene by default
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,

    /// The point to look at; the middle of the scene by default
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,

    /// The direction that is up in the picture; z or y by default, as is usual for the format
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) up: Option<DVec3>,

    /// The vertical angle of view, 45 by default
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) fov: Option<f64>,

    /// Parallel rays, and the height of the picture in the units of the file
    #[arg(long, value_name = "HEIGHT", conflicts_with = "fov", allow_negative_numbers = true)]
    pub(crate) ortho: Option<f64>,

    /// The view depth before which nothing is seen; a billionth of the distance by default
    #[arg(long, value_name = "DEPTH", allow_negative_numbers = true)]
    pub(crate) near: Option<f64>,

    /// One radius for all particles, whatever the file says
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    pub(crate) radius: Option<f64>,

    /// A factor for all radii
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) radius_scale: f64,

    /// Which radii to take for atoms
    #[arg(long, value_enum, default_value_t = Radii::Vdw)]
    pub(crate) radii: Radii,

    /// Where colors come from: auto, element, rgb, height, uniform or scalar:NAME
    #[arg(long, value_name = "WHAT", default_value = "auto", value_parser = color_by)]
    pub(crate) color_by: ColorBy,

    /// The color map for heights and scalars, viridis by default; _r after a name reverses it
    #[arg(long, value_name = "NAME")]
    pub(crate) colormap: Option<String>,

    /// The values at the ends of the color map; nearly the range of the data by default
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true)]
    pub(crate) range: Option<[f64; 2]>,

    /// Draw a bar that explains the color map
    #[arg(long)]
    pub(crate) legend: bool,

    /// A color (#rrggbb), two from top to bottom (#rrggbb,#rrggbb), black, white or transparent
    #[arg(long, value_name = "COLOR", value_parser = background)]
    pub(crate) background: Option<Background>,

    /// How many samples to average along each side of a pixel; 2 by default, if that many fit
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=8))]
    pub(crate) supersample: Option<u32>,

    /// Which frame of the file, counted from 0
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) frame: u64,

    /// Records that cannot be used are errors instead of being skipped
    #[arg(long)]
    pub(crate) strict: bool,

    /// Check only the tables of a brick file, and not every byte: it opens at once, but what was
    /// altered in it may go unnoticed
    #[arg(long)]
    pub(crate) unverified: bool,

    /// Grid cells along the longest side; by default those of a brick file, else some 512
    /// records share a cell
    #[arg(long, value_name = "N")]
    pub(crate) grid: Option<NonZero<u32>>,

    /// What draws
    #[arg(long, value_enum, default_value_t = BackendKind::Cpu)]
    pub(crate) backend: BackendKind,

    /// A part of the name of the GPU to draw with; the fastest by default
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,

    /// How spheres become fragments: instanced, pulled, triangle, mesh or compute; by default what
    /// suits the GPU
    #[arg(long, value_name = "SETUP")]
    pub(crate) setup: Option<String>,

    /// What fragments do: sphere or sphere-early; point and proxy are not exact
    #[arg(long, value_name = "FRAGMENT")]
    pub(crate) fragment: Option<String>,

    /// Threads to draw with, at most 1024; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    /// The image to write
    #[arg(long, value_name = "FILE.png", default_value = "puncta.png")]
    pub(crate) out: PathBuf,

    /// Write view depths as an array: f32, H x W, +inf where nothing is seen
    #[arg(long, value_name = "FILE.npy")]
    pub(crate) depth: Option<PathBuf>,

    /// Write the index in the file of the record at each pixel: u32, H x W, 4294967295 for none
    #[arg(long, value_name = "FILE.npy")]
    pub(crate) ids: Option<PathBuf>,

    /// Write counts, bytes and seconds
    #[arg(long, value_name = "FILE.json")]
    pub(crate) json: Option<PathBuf>,

    /// Which scalars to read besides the one to color by: not for the command line.
    #[arg(skip)]
    pub(crate) columns: Columns,
}

/// Which scalars to read of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Columns {
    /// That to color by.
    #[default]
    Needed,
    /// All, to choose among them later.
    #[allow(dead_code, reason = "only the example `viewer` asks for it")]
    All,
}

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BackendKind {
    /// All cores; needs nothing
    Cpu,
    /// A GPU, through Vulkan, Metal, DirectX or OpenGL
    Gpu,
}

/// Which radii to take for atoms.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Radii {
    /// Half the distance of atoms that do not bond: space filling
    Vdw,
    /// Half the distance of bonded atoms
    Covalent,
}

/// Where colors come from.
#[derive(Clone, Debug)]
pub(crate) enum ColorBy {
    /// The first of elements, colors, a generator's scalar and height that there is.
    Auto,
    Element,
    Rgb,
    Height,
    Uniform,
    Scalar(String),
}

/// The generators and color maps, for the end of the help.
fn after_help() -> String {
    let kinds = Generator::kinds().iter().map(|kind| {
        let keys: Vec<String> =
            kind.keys.iter().map(|key| format!("{}={}", key.name, key.default)).collect();
        format!("  {:<9} {}\n            {}\n", kind.name, kind.about, keys.join(", "))
    });
    let kinds: String = kinds.collect();
    let maps = ColorMap::names().collect::<Vec<_>>().join(", ");
    format!("Generators:\n{kinds}\nColor maps: {maps}.")
}

fn color_by(text: &str) -> Result<ColorBy, String> {
    Ok(match text {
        "auto" => ColorBy::Auto,
        "element" => ColorBy::Element,
        "rgb" => ColorBy::Rgb,
        "height" => ColorBy::Height,
        "uniform" => ColorBy::Uniform,
        _ => match text.strip_prefix("scalar:") {
            Some(name) if !name.is_empty() => ColorBy::Scalar(name.to_owned()),
            _ => return Err("auto, element, rgb, height, uniform or scalar:NAME".into()),
        },
    })
}
