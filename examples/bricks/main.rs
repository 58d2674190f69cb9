//! Sorts a particle or point file of any size into a brick file, which is drawn without being
//! loaded.
//!
//! ```text
//! cargo run --release --example bricks -- INPUT --out scene.bricks --memory 2GiB
//! cargo run --release --example bricks -- --help
//! ```

mod options;
#[path = "../render/progress.rs"]
mod progress;

use anyhow::{Context, Result, bail};
use clap::Parser;
use options::Options;
use progress::Bar;
use puncta::{
    Source, Sphere,
    grid::{ConvertConfig, ConvertStage, ConvertStep, ConvertSummary, Invalid, convert_watched},
    io::{ReadOptions, synthetic::Generator},
};
use std::{
    io::Write,
    path::Path,
    sync::{Arc, Mutex},
    time::Instant,
};

fn main() {
    if let Err(error) = run(&Options::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<()> {
    if let Some(threads) = options.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().context("cannot start the threads")?;
    }
    check_name(&options.out)?;
    let start = Instant::now();
    let summary = if Generator::is_spec(&options.input) && !Path::new(&options.input).exists() {
        if options.radius.is_some() {
            bail!("{}: a generator has its own radius: write it as r=0.01", options.input);
        }
        write(options.input.parse::<Generator>()?, options, Invalid::Refuse)?
    } else {
        write(open(options)?, options, options.invalid())?
    };
    let seconds = start.elapsed().as_secs_f64();
    let ConvertSummary { records, skipped, bricks, bytes } = summary;
    let rate = bytes as f64 / 1e6 / seconds;
    let left_out = if skipped > 0 { format!(", {skipped} skipped") } else { String::new() };
    let out = options.out.display();
    // Nobody may be listening any more; the file is written all the same.
    writeln!(
        std::io::stdout(),
        "{out}: {records} records{left_out}, {bricks} bricks, {bytes} bytes, \
         {seconds:.2} s, {rate:.0} MB/s"
    )
    .ok();
    Ok(())
}

/// The file to write must be a brick file: other formats cannot hold one.
fn check_name(out: &Path) -> Result<()> {
    let extension = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match extension.as_str() {
        "bricks" => Ok(()),
        "mmpgd" => bail!(
            "{}: an MMPGD file has no place for an origin, ids, columns or checksums, and stores \
             every empty cell; write a .bricks file",
            out.display()
        ),
        _ => bail!("{}: the name of a brick file must end in .bricks", out.display()),
    }
}

/// Opens a file, which is read once for that, and tells what was found.
fn open(options: &Options) -> Result<impl Source<Record = Sphere, Error = puncta::io::Error>> {
    let bar = Arc::new(Bar::bytes("looking"));
    let told = Arc::clone(&bar);
    let mut reader = ReadOptions::default()
        .frame(options.frame)
        .strict(options.strict)
        .on_progress(move |position, total| told.set_of(position, total));
    if let Some(radius) = options.radius {
        reader = reader.radius(radius);
    }
    let source = reader.stream(&options.input)?;
    bar.finish();
    let report = source.report();
    let skipped = report.skipped.iter().map(|skipped| {
        format!(
            "{} records skipped: {}, first at {}: {}",
            skipped.count, skipped.problem, skipped.first, skipped.value
        )
    });
    for notice in skipped.chain(report.warnings.iter().cloned()) {
        writeln!(std::io::stderr(), "note: {notice}").ok();
    }
    Ok(source)
}

/// Writes the records of a source, with a bar for each stage.
fn write<S>(source: S, options: &Options, invalid: Invalid) -> Result<ConvertSummary>
where
    S: Source<Record = Sphere>,
    S::Error: std::error::Error + Send + Sync + 'static,
{
    let config = ConvertConfig { grid: options.grid(), memory: options.memory, invalid };
    let shown: Mutex<Option<(ConvertStage, Bar)>> = Mutex::new(None);
    let watch = |step: ConvertStep| {
        let Ok(mut shown) = shown.lock() else { return };
        if shown.as_ref().is_none_or(|(stage, _)| *stage != step.stage) {
            if let Some((_, bar)) = shown.take() {
                bar.finish();
            }
            *shown = Some((step.stage, bar(step)));
        }
        if let Some((_, bar)) = &*shown {
            bar.set(step.done);
        }
    };
    let written = convert_watched(source, &options.out, &config, &watch);
    if let Ok(Some((_, bar))) = shown.into_inner() {
        bar.finish();
    }
    Ok(written?)
}

/// The bar of a stage.
fn bar(step: ConvertStep) -> Bar {
    let counting = |what| Bar::counting(what, step.total.unwrap_or(0));
    match step.stage {
        ConvertStage::Reading => counting("reading"),
        ConvertStage::Counting => counting("counting"),
        ConvertStage::Distributing => counting("moving"),
        ConvertStage::Sorting => counting("sorting"),
        ConvertStage::Finishing => Bar::spinner("writing"),
    }
}
