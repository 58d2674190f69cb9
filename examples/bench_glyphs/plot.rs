//! A plot: the time of a frame over the number of glyphs, a line for each representation.

use crate::{measure::Row, table::wall};
use anyhow::{Context, Result, ensure};
use plotters::prelude::*;
use std::path::Path;

/// A representation of a kind of scene: its name, and a time for each number of glyphs.
type Line = (&'static str, Vec<(f64, f64)>);

/// What is drawn of a scene: its name, the number of glyphs, the rows.
pub(crate) type Drawn = (String, usize, Vec<Row>);

/// A panel for each kind of scene.
pub(crate) fn write(adapter: &str, drawn: &[Drawn], path: &Path) -> Result<()> {
    let kind = |name: &str| name.split(':').next().unwrap_or_default().to_owned();
    let mut kinds: Vec<String> = Vec::new();
    for (name, ..) in drawn {
        if !kinds.contains(&kind(name)) {
            kinds.push(kind(name));
        }
    }
    ensure!(!kinds.is_empty(), "there is nothing to plot");
    let rows = kinds.len().div_ceil(2);
    let columns = kinds.len().min(2);
    let size = (u32::try_from(columns)? * 560, u32::try_from(rows)? * 420 + 24);
    let area = SVGBackend::new(path, size).into_drawing_area();
    area.fill(&WHITE)?;
    let area = area.titled(adapter, ("sans-serif", 15))?;
    for (panel, kind_here) in area.split_evenly((rows, columns)).iter().zip(&kinds) {
        let of_kind: Vec<&Drawn> = drawn.iter().filter(|one| kind(&one.0) == *kind_here).collect();
        draw(panel, kind_here, &lines(&of_kind)).with_context(|| kind_here.clone())?;
    }
    area.present().context("cannot write the plot")
}

fn lines(drawn: &[&Drawn]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for (_, count, rows) in drawn {
        for row in rows {
            let time = row.outcome.as_ref().ok().and_then(|measured| wall(&measured.frames));
            let Some(time) = time else { continue };
            let point = (*count as f64, time);
            match lines.iter_mut().find(|(name, _)| *name == row.name) {
                Some((_, points)) => points.push(point),
                None => lines.push((row.name, vec![point])),
            }
        }
    }
    lines
}

fn draw(
    panel: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    kind: &str,
    lines: &[Line],
) -> Result<()> {
    let range = |of: fn(&(f64, f64)) -> f64| {
        let all = || lines.iter().flat_map(|(_, points)| points).map(of);
        (all().fold(f64::INFINITY, f64::min) * 0.7, all().fold(0.0, f64::max) * 1.4)
    };
    let (counts, milliseconds) = (range(|point| point.0), range(|point| point.1));
    ensure!(counts.0 < counts.1 && milliseconds.0 < milliseconds.1, "nothing was measured");
    let mut chart = ChartBuilder::on(panel)
        .caption(kind, ("sans-serif", 15))
        .margin(10)
        .x_label_area_size(38)
        .y_label_area_size(60)
        .build_cartesian_2d(
            (counts.0..counts.1).log_scale(),
            (milliseconds.0..milliseconds.1).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("glyphs")
        .y_desc("milliseconds a frame")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    for (index, (name, points)) in lines.iter().enumerate() {
        let color = Palette99::pick(index).to_rgba();
        chart
            .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 14, y)], color.stroke_width(2)));
        chart.draw_series(points.iter().map(|point| Circle::new(*point, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 11))
        .draw()?;
    Ok(())
}
