//! The command line.

use crate::{
    order::Order,
    world::{Origin, Place},
};
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// Measures how fast a picture that is drawn bit by bit comes to look like the finished one.
#[derive(Debug, Parser)]
#[command(name = "convergence", version, after_help = VIEWS)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) origin: Origin,

    /// What to look at
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Place::Overview, Place::Detail])]
    pub(crate) views: Vec<Place>,

    /// In which orders to draw bricks
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = Order::usual())]
    pub(crate) orders: Vec<Order>,

    /// The number of records of a step; a thousandth of those in view by default
    #[arg(long, value_name = "N", value_parser = count)]
    pub(crate) budget: Option<u64>,

    /// Compare pictures once this share more has been drawn than when they were compared before
    #[arg(long, value_name = "SHARE", default_value_t = 0.005)]
    pub(crate) every: f64,

    /// After each view, turn the camera and the scene by these angles, and see what the records that
    /// were seen before show at once
    #[arg(long, value_name = "DEG", value_delimiter = ',')]
    pub(crate) turn: Vec<f64>,

    /// Draw what is hidden as well, as far as its order goes: count all records that come before the
    /// end. Times are still those of skipping
    #[arg(long)]
    pub(crate) no_skip: bool,

    /// Write all points of all curves here
    #[arg(long, value_name = "FILE.json")]
    pub(crate) json: Option<PathBuf>,

    /// Write a plot here, as SVG
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,

    /// Write pictures here: the final one of each view, and of each order the first one that shows
    /// no more than half of the first error
    #[arg(long, value_name = "FOLDER")]
    pub(crate) pictures: Option<PathBuf>,
}

const VIEWS: &str = "\
Views:
  overview  the view that the tool `render` chooses: all of the scene
  detail    the eye moves 70 % of the way to the point that the overview shows in its middle, or to
            the one that is nearest to the middle of the picture
  inside    the eye is within the box of nearly all records, a quarter along its longest horizontal
            side and halfway along the others, and looks along that side, 60 degrees wide";

/// A number such as 1e5.
fn count(text: &str) -> Result<u64, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    let is_count = (1.0..=1e15).contains(&number) && number.fract() == 0.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    let count = number as u64;
    is_count.then_some(count).ok_or_else(|| "must be a whole number from 1 on".into())
}

/// What a value is called on the command line.
pub(crate) fn name(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}
