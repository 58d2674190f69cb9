//! A plot: the time of a frame for each strategy, with and without pixels.

use crate::{strategies::Row, table::wall};
use anyhow::{Context, Result, ensure};
use plotters::prelude::*;
use puncta::gpu::{Fragment, Setup};
use std::path::Path;

/// One place on the horizontal axis for each set-up of each scene.
pub(crate) fn write(adapter: &str, scenes: &[(String, Vec<Row>)], path: &Path) -> Result<()> {
    let points = points(scenes);
    ensure!(!points.is_empty(), "there is nothing to plot: no strategies were measured");
    let labels = labels(scenes);
    let times = || points.iter().flat_map(|point| [point.frame, point.geometry]);
    let low = times().fold(f64::INFINITY, f64::min) * 0.6;
    let high = times().fold(0.0, f64::max) * 1.6;
    let area = SVGBackend::new(path, (860, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let across = -0.6..labels.len() as f64 + 1.4;
    let mut chart = ChartBuilder::on(&area)
        .caption(adapter, ("sans-serif", 16))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(across, (low..high).log_scale())?;
    let label = |place: &f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (place.fract() == 0.0 && *place >= 0.0).then_some(*place as usize);
        index.and_then(|index| labels.get(index).cloned()).unwrap_or_default()
    };
    chart
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(labels.len() + 3)
        .x_label_formatter(&label)
        .y_label_formatter(&|y| format!("{y}"))
        .x_desc(legend(scenes))
        .y_desc("milliseconds a frame; open: geometry only")
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    for (index, fragment) in (0..).zip(Fragment::ALL) {
        let color = Palette99::pick(index).to_rgba();
        let aside = (f64::from(u32::try_from(index)?) - 1.5) * 0.14;
        let of = || points.iter().filter(move |point| point.fragment == fragment);
        let frames =
            of().map(|point| Circle::new((point.place + aside, point.frame), 5, color.filled()));
        chart
            .draw_series(frames)?
            .label(fragment.to_string())
            .legend(move |(x, y)| Circle::new((x + 8, y), 5, color.filled()));
        let geometry =
            of().map(|point| Circle::new((point.place + aside, point.geometry), 4, color));
        chart.draw_series(geometry)?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 12))
        .draw()?;
    area.present().context("cannot write the plot")
}

struct Point {
    place: f64,
    fragment: Fragment,
    frame: f64,
    geometry: f64,
}

fn points(scenes: &[(String, Vec<Row>)]) -> Vec<Point> {
    let mut points = Vec::new();
    let mut first = 0.0;
    for (_, rows) in scenes {
        let setups = setups(rows);
        for row in rows {
            let Row::Measured(row) = row else { continue };
            let place = setups.iter().position(|setup| *setup == row.setup);
            let times = wall(&row.frames).zip(wall(&row.away));
            if let (Some(place), Some((frame, geometry))) = (place, times) {
                let place = first + place as f64;
                points.push(Point { place, fragment: row.fragment, frame, geometry });
            }
        }
        first += setups.len() as f64;
    }
    points
}

/// The set-ups that were measured.
fn setups(rows: &[Row]) -> Vec<Setup> {
    let has = |setup: &Setup| {
        rows.iter().any(|row| matches!(row, Row::Measured(row) if row.setup == *setup))
    };
    Setup::ALL.into_iter().filter(has).collect()
}

/// Which scene is which.
fn legend(scenes: &[(String, Vec<Row>)]) -> String {
    let names: Vec<String> = match scenes {
        [(name, _)] => vec![name.clone()],
        _ => (1..).zip(scenes).map(|(number, (name, _))| format!("{number}: {name}")).collect(),
    };
    names.join(", ")
}

/// The names along the horizontal axis.
fn labels(scenes: &[(String, Vec<Row>)]) -> Vec<String> {
    let several = scenes.len() > 1;
    let label = |(number, (_, rows)): (usize, &(String, Vec<Row>))| {
        let name = move |setup: Setup| {
            if several { format!("{setup} {}", number + 1) } else { setup.to_string() }
        };
        setups(rows).into_iter().map(name).collect::<Vec<_>>()
    };
    scenes.iter().enumerate().flat_map(label).collect()
}
