//! The command line: the options of the example `render`, and those of a window.

use crate::{
    glyphs::angles,
    options::{Columns, Options},
};
use clap::{CommandFactory, FromArgMatches, Parser, ValueEnum, error::ErrorKind};
use puncta::gpu::{Fragment, Setup};
use std::path::PathBuf;

/// Options of `render` that write what a window does not.
const HIDDEN: [&str; 3] = ["depth", "ids", "json"];

#[derive(Debug, Parser)]
#[command(name = "viewer")]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) render: Options,

    /// What is named in `render`.
    #[arg(skip)]
    pub(crate) setup: Option<Setup>,
    #[arg(skip)]
    pub(crate) fragment: Option<Fragment>,

    /// Which bricks are drawn first
    #[arg(long, value_enum, default_value_t = Order::Depth)]
    pub(crate) order: Order,

    /// Write the picture to this file once it is settled, and end
    #[arg(long, value_name = "FILE.png")]
    pub(crate) screenshot: Option<PathBuf>,

    /// How many times the window is painted before --screenshot is written, at least
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) frames: u32,

    /// Turn the camera by this many degrees with each of the --frames, to the right and upwards
    #[arg(long, value_name = "YAW,PITCH", value_parser = angles, allow_hyphen_values = true)]
    pub(crate) orbit: Option<[f64; 2]>,

    /// Print a line for each picture that is settled
    #[arg(long)]
    pub(crate) log: bool,
}

/// Which bricks are drawn first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Order {
    /// The nearest
    Depth,
    /// Those with the fewest bricks before them
    Level,
    /// Those with the least matter before them
    Density,
    /// Those that are expected to show the most pixels
    Transmittance,
}

impl Order {
    pub(crate) const ALL: [Self; 4] =
        [Self::Depth, Self::Level, Self::Density, Self::Transmittance];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Level => "level",
            Self::Density => "density",
            Self::Transmittance => "transmittance",
        }
    }
}

/// What the user asks for; ends the program if that cannot be understood.
pub(crate) fn parse() -> Result<Cli, clap::Error> {
    let mut command = Cli::command()
        .about("Shows a particle or point file, or a synthetic scene, in a window")
        .long_about(None)
        .mut_arg("size", |size| {
            size.default_value("1280x800").help("Columns and rows of the window")
        })
        .mut_arg("backend", |backend| backend.default_value("gpu"))
        .mut_arg("out", |out| out.help("The image that the key P writes; numbered if it is there"));
    for name in HIDDEN {
        command = command.mut_arg(name, |option| option.hide(true));
    }
    let matches = command.clone().get_matches();
    let mut cli = Cli::from_arg_matches(&matches)?;
    let invalid = |what: String| command.error(ErrorKind::ValueValidation, what);
    cli.setup = cli.render.setup.as_deref().map(str::parse).transpose().map_err(invalid)?;
    let invalid = |what: String| command.error(ErrorKind::ValueValidation, what);
    cli.fragment = cli.render.fragment.as_deref().map(str::parse).transpose().map_err(invalid)?;
    cli.render.columns = Columns::All;
    Ok(cli)
}
