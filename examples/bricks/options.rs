//! The command line.

use clap::{Parser, ValueEnum};
use puncta::{
    GridConfig, Resolution,
    grid::{self, Invalid},
};
use std::{num::NonZero, path::PathBuf};

/// Sorts a particle or point file of any size into a brick file, which is drawn without being
/// loaded.
#[derive(Debug, Parser)]
#[command(name = "bricks", version)]
pub(crate) struct Options {
    /// A file (XYZ, extended XYZ, LAMMPS dump, PDB, MMPLD, PLY, LAS, LAZ, legacy VTK; gzip is fine)
    /// or a generator such as cube:n=1e8,r=0.003
    pub(crate) input: String,

    /// The file to write
    #[arg(long, value_name = "FILE.bricks")]
    pub(crate) out: PathBuf,

    /// Memory to use, such as 256MiB, 2GiB or 500MB
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = size)]
    pub(crate) memory: u64,

    /// Cells along the longest side
    #[arg(long, value_name = "N", conflicts_with_all = ["per_brick", "width"])]
    grid: Option<NonZero<u32>>,

    /// About how many records a brick has; 512 by default
    #[arg(long, value_name = "N", conflicts_with = "width")]
    per_brick: Option<NonZero<u32>>,

    /// The side of a cell
    #[arg(long, value_name = "W", allow_negative_numbers = true)]
    width: Option<f32>,

    /// Which box the cells fill
    #[arg(long, value_enum, default_value_t = Fit::Robust)]
    fit: Fit,

    /// One radius for all particles, whatever the file says
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    pub(crate) radius: Option<f64>,

    /// Which frame of the file, counted from 0
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) frame: u64,

    /// Records that cannot be used are errors instead of being skipped
    #[arg(long)]
    pub(crate) strict: bool,

    /// Threads to sort with, at most 1024; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

/// Which box the cells fill.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Fit {
    /// A box around nearly all records: strays go into bricks of their own
    Robust,
    /// The box around all records
    Whole,
}

impl Options {
    /// The grid that was asked for.
    pub(crate) fn grid(&self) -> GridConfig {
        let resolution = match (self.grid, self.per_brick, self.width) {
            (Some(cells), ..) => Resolution::LongestSide(cells.get()),
            (_, Some(records), _) => Resolution::RecordsPerBrick(records.get()),
            (.., Some(width)) => Resolution::Width(width),
            _ => Resolution::default(),
        };
        let fit = match self.fit {
            Fit::Robust => grid::Fit::Robust,
            Fit::Whole => grid::Fit::Whole,
        };
        GridConfig { resolution, fit, ..GridConfig::default() }
    }

    /// What to do with records that no grid can hold.
    pub(crate) fn invalid(&self) -> Invalid {
        if self.strict { Invalid::Refuse } else { Invalid::Skip }
    }
}

/// A number of bytes.
fn size(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 8] = [
        ("KiB", 1024.0),
        ("MiB", 1048576.0),
        ("GiB", 1073741824.0),
        ("TiB", 1099511627776.0),
        ("kB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("B", 1.0),
    ];
    let text = text.trim();
    let found = UNITS.iter().find_map(|(unit, bytes)| {
        let number = text.strip_suffix(unit)?.trim_end().parse::<f64>().ok()?;
        Some(number * bytes)
    });
    let bytes = found.or_else(|| text.parse().ok());
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in range")]
    match bytes {
        Some(bytes) if (1.0..1e18).contains(&bytes) => Ok(bytes as u64),
        _ => Err(format!("{text:?} is no size: write it as 256MiB or 2GiB")),
    }
}
