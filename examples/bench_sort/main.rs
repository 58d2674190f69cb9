//! Measures the grid sort against copying the same bytes and against other sorts, in one run.
//!
//! ```text
//! cargo run --release --example bench_sort -- --n 1e7,5e7 --grid 100 --json out.json
//! cargo run --release --example bench_sort -- --help
//! ```
//!
//! All contenders take turns, so that a machine that is slower for a while is so for all of them.
//! Times are medians; the ratio is that to the time in which two threads copy the records.

mod contenders;
mod report;

use anyhow::{Context, Result, ensure};
use clap::{Parser, ValueEnum};
use contenders::Contender;
use puncta::{Grid, GridConfig, Source, Sphere, io::synthetic::Generator};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use report::Case;
use std::{io::Write, path::PathBuf, time::Instant};

/// Measures the sort of records into the bricks of a grid.
#[derive(Debug, Parser)]
struct Options {
    /// Numbers of records, such as 1e6,5e7
    #[arg(long, value_delimiter = ',', default_values = ["1e6", "1e7"], value_parser = count)]
    n: Vec<usize>,
    /// Numbers of cells along the longest side
    #[arg(long, value_delimiter = ',', default_values_t = [100])]
    grid: Vec<u32>,
    /// What to sort
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Data::Uniform])]
    data: Vec<Data>,
    /// How often to measure each contender
    #[arg(long, default_value_t = 7)]
    repetitions: usize,
    /// How often to measure those that take long
    #[arg(long, default_value_t = 3)]
    slow_repetitions: usize,
    /// Who takes part; all by default
    #[arg(long, value_enum, value_delimiter = ',')]
    only: Vec<Contender>,
    /// Number of threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Write all times here
    #[arg(long)]
    json: Option<PathBuf>,
    /// Write a table here
    #[arg(long)]
    table: Option<PathBuf>,
    /// Write a plot here, as SVG
    #[arg(long)]
    plot: Option<PathBuf>,
}

/// What is sorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Data {
    /// Evenly spread over a cube
    Uniform,
    /// Clusters of clusters
    Halo,
    /// A cube that is sorted already, but for one record in a hundred
    Sorted,
}

fn main() -> Result<()> {
    let options = Options::parse();
    ensure!(options.repetitions > 0 && options.slow_repetitions > 0, "nothing is to be measured");
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global()
        .context("cannot start the threads")?;
    let mut cases = Vec::new();
    for &data in &options.data {
        for &n in &options.n {
            let mut records = make(data, n)?;
            for &grid in &options.grid {
                if data == Data::Sorted {
                    nearly_sort(&mut records, grid)?;
                }
                cases.push(measure(&options, data, &records, grid)?);
                let case = cases.last().context("a case was just measured")?;
                writeln!(std::io::stdout(), "{}", report::text(case)).ok();
            }
        }
    }
    if let Some(path) = &options.json {
        std::fs::write(path, report::json(&cases)?)?;
    }
    if let Some(path) = &options.table {
        std::fs::write(path, report::table(&cases))?;
    }
    if let Some(path) = &options.plot {
        report::plot(&cases, path)?;
    }
    Ok(())
}

/// A number such as 5e7.
fn count(text: &str) -> Result<usize, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    let is_count = (1.0..=4e9).contains(&number) && number.fract() == 0.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    let count = number as usize;
    is_count.then_some(count).ok_or_else(|| "must be a whole number up to 4e9".into())
}

/// The records to sort.
fn make(data: Data, n: usize) -> Result<Vec<Sphere>> {
    let kind = if data == Data::Halo { "halo" } else { "cube" };
    let generator: Generator = format!("{kind}:n={n}").parse()?;
    let scene = generator.into_scene()?;
    Ok(scene.records.into_vec())
}

/// Sorts records, and exchanges one in a hundred with any other.
fn nearly_sort(records: &mut [Sphere], grid: u32) -> Result<()> {
    Grid::sort(records, &GridConfig::longest_side(grid))?;
    let mut random = Pcg64Mcg::seed_from_u64(1);
    for _ in 0..records.len() / 200 {
        let (a, b) = (random.random_range(0..records.len()), random.random_range(0..records.len()));
        records.swap(a, b);
    }
    Ok(())
}

/// Measures all contenders in turn.
fn measure(options: &Options, data: Data, records: &[Sphere], grid: u32) -> Result<Case> {
    let mut work = records.to_vec();
    let found = Grid::sort(&mut work, &GridConfig::longest_side(grid))?;
    let all = Contender::value_variants();
    let chosen = if options.only.is_empty() { all } else { &options.only[..] };
    let mut times: Vec<(Contender, Vec<f64>)> = vec![];
    for contender in all {
        if chosen.contains(contender) || contender.is_copy() {
            times.push((*contender, vec![]));
        }
    }
    for repetition in 0..options.repetitions {
        for (contender, seconds) in &mut times {
            if contender.is_slow() && repetition >= options.slow_repetitions {
                continue;
            }
            if !contender.is_copy() {
                work.copy_from_slice(records);
            }
            let start = Instant::now();
            let result = contender.run(records, &mut work, grid, found.cells())?;
            seconds.push(start.elapsed().as_secs_f64());
            drop(result);
            if repetition == 0 {
                ensure!(contender.is_right(&work, found.cells()), "{contender:?} does not sort");
            }
        }
    }
    Ok(Case {
        data: data.to_possible_value().map_or_else(String::new, |value| value.get_name().into()),
        n: records.len(),
        grid,
        bricks: found.bricks().len(),
        grid_bytes: found.bytes(),
        times,
    })
}
