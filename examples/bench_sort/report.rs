//! What was measured, as text, as JSON, as a table and as a plot.

use crate::contenders::Contender;
use anyhow::{Context, Result};
use clap::ValueEnum;
use plotters::prelude::*;
use std::{fmt::Write, path::Path};

/// The times of all contenders for one input.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) data: String,
    pub(crate) n: usize,
    pub(crate) grid: u32,
    pub(crate) bricks: usize,
    pub(crate) grid_bytes: usize,
    pub(crate) times: Vec<(Contender, Vec<f64>)>,
}

impl Case {
    /// The median of the seconds of a contender.
    pub(crate) fn median(&self, contender: Contender) -> Option<f64> {
        let (_, seconds) = self.times.iter().find(|(who, _)| *who == contender)?;
        let mut seconds = seconds.clone();
        seconds.sort_by(f64::total_cmp);
        seconds.get(seconds.len() / 2).copied()
    }

    /// The median as a multiple of that of a copy by two threads.
    pub(crate) fn ratio(&self, contender: Contender) -> Option<f64> {
        Some(self.median(contender)? / self.median(Contender::Copy2)?)
    }
}

fn name(contender: Contender) -> String {
    contender.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// A few lines for people.
pub(crate) fn text(case: &Case) -> String {
    let mut text = format!(
        "{} n={} grid={}: {} bricks, {:.1} bytes each",
        case.data,
        case.n,
        case.grid,
        case.bricks,
        case.grid_bytes as f64 / case.bricks as f64
    );
    for &(contender, _) in &case.times {
        if let (Some(median), Some(ratio)) = (case.median(contender), case.ratio(contender)) {
            let nanoseconds = median / case.n as f64 * 1e9;
            write!(
                text,
                "\n  {:8} {median:9.4} s {nanoseconds:8.2} ns a record {ratio:8.2} x copy",
                name(contender)
            )
            .ok();
        }
    }
    if let (Some(thesis), Some(ours)) =
        (case.median(Contender::Thesis), case.median(Contender::Puncta))
    {
        write!(text, "\n  {:.1} times as fast as the thesis", thesis / ours).ok();
    }
    text
}

/// All times.
pub(crate) fn json(cases: &[Case]) -> Result<String> {
    let cases: Vec<_> = cases
        .iter()
        .map(|case| {
            let contenders: serde_json::Map<_, _> = case
                .times
                .iter()
                .map(|(contender, seconds)| {
                    let (median, ratio) = (case.median(*contender), case.ratio(*contender));
                    let value =
                        serde_json::json!({ "seconds": seconds, "median": median, "ratio": ratio });
                    (name(*contender), value)
                })
                .collect();
            serde_json::json!({
                "data": case.data, "n": case.n, "grid": case.grid, "bricks": case.bricks,
                "grid_bytes": case.grid_bytes, "contenders": contenders,
            })
        })
        .collect();
    Ok(serde_json::to_string_pretty(&serde_json::json!({
        "threads": rayon::current_num_threads(), "record_bytes": 16, "cases": cases,
    }))?)
}

/// A table in Markdown: seconds, and in brackets the multiple of a copy by two threads.
pub(crate) fn table(cases: &[Case]) -> String {
    let contenders = Contender::value_variants();
    let mut table = "| data | n | grid | bricks |".to_owned();
    contenders.iter().for_each(|&contender| table += &format!(" {} |", name(contender)));
    table += "\n|---|---|---|---|";
    contenders.iter().for_each(|_| table += "---|");
    for case in cases {
        let Case { data, n, grid, bricks, .. } = case;
        write!(table, "\n| {data} | {:.0e} | {grid} | {bricks} |", *n as f64).ok();
        for &contender in contenders {
            match (case.median(contender), case.ratio(contender)) {
                (Some(median), Some(ratio)) => {
                    write!(table, " {median:.4} ({ratio:.1}) |").ok();
                }
                _ => table += " |",
            }
        }
    }
    table + "\n"
}

/// How the time for a record grows with their number, for each contender and grid of even data.
pub(crate) fn plot(cases: &[Case], path: &Path) -> Result<()> {
    let area = SVGBackend::new(path, (760, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let cases: Vec<&Case> = cases.iter().filter(|case| case.data == "uniform").collect();
    let point = |case: &Case, contender| {
        Some((case.n as f64, case.median(contender)? / case.n as f64 * 1e9))
    };
    let shown = || Contender::value_variants().iter().copied().filter(|c| *c != Contender::Copy1);
    let all: Vec<(f64, f64)> =
        cases.iter().flat_map(|case| shown().filter_map(|c| point(case, c))).collect();
    let range = |values: &dyn Fn(&(f64, f64)) -> f64, room: f64| {
        let low = all.iter().map(values).fold(f64::INFINITY, f64::min);
        let high = all.iter().map(values).fold(0.0, f64::max);
        (low * 0.7..high * room).log_scale()
    };
    anyhow::ensure!(!all.is_empty(), "there is nothing to plot");
    let mut chart = ChartBuilder::on(&area)
        .caption("Time of a sort into bricks, for each record", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(range(&|point| point.0, 12.0), range(&|point| point.1, 1.5))?;
    chart
        .configure_mesh()
        .x_desc("records")
        .y_desc("nanoseconds a record")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    let mut grids: Vec<u32> = cases.iter().map(|case| case.grid).collect();
    grids.sort_unstable();
    grids.dedup();
    for (index, contender) in shown().enumerate() {
        for (shade, &grid) in grids.iter().enumerate() {
            let color =
                Palette99::pick(index).mix(0.4 + 0.6 * (shade + 1) as f64 / grids.len() as f64);
            let points: Vec<_> = cases
                .iter()
                .filter(|case| case.grid == grid)
                .filter_map(|case| point(case, contender))
                .collect();
            let width = if contender == Contender::Puncta { 3 } else { 1 };
            let style = color.stroke_width(width);
            let label = format!("{}, grid {grid}", name(contender));
            chart
                .draw_series(LineSeries::new(points, style).point_size(3))?
                .label(label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 11))
        .draw()?;
    area.present().context("cannot write the plot")
}
