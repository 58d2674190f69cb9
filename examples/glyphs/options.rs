//! The options that all tools have.

use super::parse::{background, point, size};
use clap::{Args, ValueEnum};
use glam::DVec3;
use puncta::Background;
use puncta_viewer::glyphs::angles;
use std::path::PathBuf;

/// How to draw, and where to.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub(crate) struct Drawing {
    /// Columns and rows of the picture, or of the window
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = size)]
    pub(crate) size: (u32, u32),

    /// The place of the camera; sees all by default
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,

    /// The point to look at; the middle by default
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,

    /// The vertical angle of view; what suits by default
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) fov: Option<f64>,

    /// From how many directions light falls, which makes shadows: a picture is drawn from each; with
    /// 0 the only light is at the camera
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub(crate) sky: u16,

    /// A color (#rrggbb), two from top to bottom (#rrggbb,#rrggbb), black, white or transparent
    #[arg(long, value_name = "COLOR", value_parser = background)]
    pub(crate) background: Option<Background>,

    /// How many samples to average along each side of a pixel
    #[arg(long, value_name = "K", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=8))]
    pub(crate) supersample: u32,

    /// What draws
    #[arg(long, value_enum, default_value_t = BackendKind::Cpu)]
    pub(crate) backend: BackendKind,

    /// A part of the name of the GPU to draw with; the fastest by default
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,

    /// Threads to draw with, at most 1024; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    /// The image to write; by default the name of the tool with .png
    #[arg(long, value_name = "FILE.png")]
    pub(crate) out: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) window: Window,
}

/// Whether to show a window, and what it does by itself.
#[derive(Clone, Debug, Args)]
pub(crate) struct Window {
    /// Show it in a window instead of writing an image: drag to turn (left) and move (right), scroll to
    /// zoom, click to pick; there are no shadows
    #[arg(long, conflicts_with_all = ["out", "sky"])]
    pub(crate) window: bool,

    /// Write the picture of the window to this file once it is settled, and end
    #[arg(long, value_name = "FILE.png", requires = "window", hide_short_help = true)]
    pub(crate) screenshot: Option<PathBuf>,

    /// How many times the window is painted before --screenshot is written, at least
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        requires = "window",
        hide_short_help = true
    )]
    pub(crate) frames: u32,

    /// Turn the camera by this many degrees with each of the --frames, to the right and upwards
    #[arg(
        long,
        value_name = "YAW,PITCH",
        value_parser = angles,
        allow_hyphen_values = true,
        requires = "window",
        hide_short_help = true
    )]
    pub(crate) orbit: Option<[f64; 2]>,

    /// Print a line for each picture of the window that is settled, and for each record that is picked
    #[arg(long, requires = "window", hide_short_help = true)]
    pub(crate) log: bool,
}

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BackendKind {
    /// All cores; needs nothing
    Cpu,
    /// A GPU, through Vulkan, Metal, DirectX or OpenGL
    Gpu,
}
