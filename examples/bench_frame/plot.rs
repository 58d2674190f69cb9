//! A plot: the time of each part over the number of bricks in view, and what the thesis reports.

use crate::{case::Case, part::Part, thesis};
use anyhow::{Context, Result, ensure};
use plotters::prelude::*;
use std::path::Path;

pub(crate) fn write(cases: &[Case], path: &Path) -> Result<()> {
    let (parts, graph) = (Part::all(), (760, 520));
    let lines: Vec<(Part, Vec<Line>)> =
        parts.iter().map(|&part| (part, lines(cases, part))).collect();
    let reported: Vec<(f64, f64)> =
        thesis::LINES.iter().map(|line| (f64::from(line.bricks), f64::from(line.sum))).collect();
    let all = || lines.iter().flat_map(|(_, lines)| lines).flatten().chain(&reported);
    ensure!(!cases.is_empty(), "there is nothing to plot");
    let range = |of: fn(&(f64, f64)) -> f64, room: f64| {
        let low = all().map(of).fold(f64::INFINITY, f64::min);
        let high = all().map(of).fold(0.0, f64::max);
        (low * 0.7..high * room).log_scale()
    };
    let area = SVGBackend::new(path, graph).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption("Time of a frame before drawing", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(range(|point| point.0, 9.0), range(|point| point.1, 1.5))?;
    chart
        .configure_mesh()
        .x_desc("bricks in view")
        .y_desc("milliseconds")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    for (index, (part, lines)) in lines.into_iter().enumerate() {
        let width = if part == Part::Graph { 3 } else { 1 };
        let style = Palette99::pick(index).stroke_width(width);
        for (place, line) in lines.into_iter().enumerate() {
            let series = chart.draw_series(LineSeries::new(line, style).point_size(3))?;
            if place == 0 {
                series
                    .label(part.name())
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
            }
        }
    }
    chart
        .draw_series(reported.into_iter().map(|point| Cross::new(point, 4, BLACK.mix(0.7))))?
        .label("thesis, sum")
        .legend(|(x, y)| Cross::new((x + 8, y), 4, BLACK.mix(0.7)));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 11))
        .draw()?;
    area.present().context("cannot write the plot")
}

/// Milliseconds over bricks.
type Line = Vec<(f64, f64)>;

/// A line for all blocks and one for each scene.
fn lines(cases: &[Case], part: Part) -> Vec<Line> {
    let kind = |case: &Case| if case.frames.is_empty() { "block" } else { &case.name }.to_owned();
    let point = |case: &Case| {
        let wall = case.median(part)?.wall;
        Some((case.in_view.bricks as f64, wall * 1e3))
    };
    let runs = cases.chunk_by(|a, b| kind(a) == kind(b));
    let line = |run: &[Case]| {
        let mut line: Line = run.iter().filter_map(point).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        line
    };
    runs.map(line).collect()
}
