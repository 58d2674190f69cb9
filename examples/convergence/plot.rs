//! A plot: the error over the records that were drawn, one panel for each view.

use crate::{cli, curve::Curve, order::Order, report::Chapter};
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use plotters::{coord::Shift, prelude::*};
use std::path::Path;

/// What is shown of an error that is less than this share of the first one.
const FLOOR: f64 = 1e-3;

const PANEL: (u32, u32) = (640, 420);

pub(crate) fn write(chapters: &[Chapter], path: &Path) -> Result<()> {
    ensure!(!chapters.is_empty(), "there is nothing to plot");
    let count = u32::try_from(chapters.len())?;
    let area = SVGBackend::new(path, (PANEL.0, PANEL.1 * count)).into_drawing_area();
    area.fill(&WHITE)?;
    for (area, chapter) in area.split_evenly((chapters.len(), 1)).iter().zip(chapters) {
        panel(area, chapter)?;
    }
    area.present().context("cannot write the plot")
}

fn panel(area: &DrawingArea<SVGBackend<'_>, Shift>, chapter: &Chapter) -> Result<()> {
    let points: Vec<_> = chapter.curves.iter().map(shares).collect();
    let end = |is_shown: fn(Order) -> bool| {
        let shown = chapter.curves.iter().zip(&points).filter(|(curve, _)| is_shown(curve.order));
        shown.flat_map(|(_, points)| points).map(|point| point.0).fold(0.0, f64::max)
    };
    // Without an order, the end is far away.
    let ordered = end(|order| order != Order::Memory);
    let most = 1.1 * if ordered > 0.0 { ordered } else { end(|_| true) };
    ensure!(most > 0.0, "{}: nothing was drawn", chapter.name);
    let title = format!("{}: error against records drawn", chapter.name);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(12)
        .margin_right(24)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..most, (FLOOR..1.3).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("records drawn")
        .y_desc("share of the first error")
        .x_label_formatter(&|x| format!("{x:.1e}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(BLACK.mix(0.05))
        .draw()?;
    for (curve, points) in chapter.curves.iter().zip(&points) {
        let place = Order::value_variants().iter().position(|&order| order == curve.order);
        let style = Palette99::pick(place.unwrap_or(0)).stroke_width(2);
        let inside = points.iter().filter(|(x, _)| *x <= most);
        let shown = inside.map(|&(x, y)| (x, y.max(FLOOR)));
        chart
            .draw_series(LineSeries::new(shown, style))?
            .label(cli::name(curve.order))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 12))
        .draw()?;
    Ok(())
}

/// Records drawn, and the share of the first error, up to the first point without any.
fn shares(curve: &Curve) -> Vec<(f64, f64)> {
    let first = curve.first_error();
    let share = |error: f64| if first > 0.0 { error / first } else { 0.0 };
    let end = curve.points.iter().rposition(|point| point.error > 0.0).map_or(0, |last| last + 1);
    let shown = curve.points.iter().take(end + 1);
    shown.map(|point| (point.progress.drawn.records as f64, share(point.error))).collect()
}
