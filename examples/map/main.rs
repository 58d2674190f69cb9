//! Draws the polygons of a `GeoJSON` file as blocks, or a town of its own.
//!
//! ```text
//! cargo run --release --example map -- FILE.geojson [--height NAME]
//! ```

mod footprint;
mod geo;
#[path = "../glyphs/mod.rs"]
mod glyphs;
mod lot;
mod town;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use footprint::{Footprint, Sort};
use glam::{DVec2, DVec3};
use glyphs::{Built, DrawingOptions, Outlook, Paint, palette::mix};
use puncta::{
    Background, Bounds, ColorMap, Glyphs, Grid, GridConfig, Scene,
    avc::{Polygon, PolygonSet},
};
use std::{path::PathBuf, process::ExitCode};

/// Draws the polygons of a `GeoJSON` file, each as high as one of its properties says. Without a file
/// it draws a small town that it makes up.
#[derive(Clone, Debug, Parser)]
#[command(name = "map", version)]
struct Options {
    /// A `GeoJSON` file with longitudes and latitudes
    file: Option<PathBuf>,

    /// The property that heights come from; by default height, building:height, or three times
    /// building:levels and the like, in metres
    #[arg(long, value_name = "NAME")]
    height: Option<String>,

    /// A factor for heights; by default 1, or if that is too flat to be seen so much that the highest
    /// reaches an eighth of the width
    #[arg(long, value_name = "F")]
    stretch: Option<f64>,

    /// The color map for heights
    #[arg(long, value_name = "NAME", default_value = "viridis")]
    colormap: String,

    /// Another number gives another town
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("map", &options.drawing, || build(&options))
}

/// What is drawn, before it becomes polygons.
struct Plan {
    footprints: Vec<Footprint>,
    colors: Vec<[u8; 3]>,
    outlook: Outlook,
    notes: Vec<String>,
    facts: Vec<String>,
}

fn build(options: &Options) -> Result<Built<Polygon, Grid>> {
    let plan = match &options.file {
        Some(file) => file_plan(options, file)?,
        None => town_plan(options),
    };
    let Plan { footprints, colors, outlook, mut notes, mut facts } = plan;
    let (mut set, mut kept) = (PolygonSet::default(), Vec::new());
    for (footprint, [r, g, b]) in footprints.iter().zip(colors) {
        let [bottom, top] = footprint.heights;
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
        let height = (top - bottom) as f32;
        if set.push(&footprint.rings, bottom, height).is_ok() {
            kept.push([r, g, b, 255]);
        }
    }
    if let Some(failure) = set.failures.first() {
        notes.push(format!("{} polygons left out; {failure}", set.failures.len()));
    }
    ensure!(!kept.is_empty(), "there is no polygon that can be drawn; {}", notes.join("; "));
    let corners: u64 = set.records.iter().map(|polygon| u64::from(polygon.corners)).sum();
    facts.push(format!(
        "{} polygons with {corners} corners, {} bytes in the table",
        set.records.len(),
        size_of_val(set.table.as_slice())
    ));
    let mut scene = Scene::new(set.records);
    scene.attributes.colors = Some(kept.into());
    let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    let glyphs = Glyphs::new([]).with_table(set.table);
    Ok(Built { scene, bricks, glyphs, paint: Paint::Scene, outlook, notes, facts })
}

fn town_plan(options: &Options) -> Plan {
    let footprints = town::build(options.seed);
    let colors = footprints.iter().enumerate().map(|(index, footprint)| {
        let high = footprint.heights[1];
        match footprint.sort {
            Sort::Ground => [196, 194, 186],
            Sort::Pavement => [222, 219, 211],
            Sort::Park => [134, 170, 104],
            Sort::Tree => mix([88, 132, 74], [124, 160, 84], (index % 7) as f64 / 6.0),
            Sort::Water => [104, 152, 188],
            Sort::House => {
                let roofs = [[214, 146, 112], [226, 178, 134], [205, 128, 104], [232, 204, 168]];
                mix(roofs[index % roofs.len()], [240, 232, 220], high / 70.0)
            }
            Sort::Tower => mix([150, 172, 196], [234, 240, 246], high / 190.0),
        }
    });
    let colors = colors.collect();
    let count = |sort: Sort| footprints.iter().filter(|footprint| footprint.sort == sort).count();
    let facts = vec![format!(
        "a town: {} houses, {} towers, {} trees",
        count(Sort::House),
        count(Sort::Tower),
        count(Sort::Tree)
    )];
    let outlook = Outlook {
        points: Bounds {
            min: DVec3::new(-700.0, -620.0, 0.0),
            max: DVec3::new(760.0, 840.0, 60.0),
        }
        .corners()
        .to_vec(),
        toward: DVec3::new(0.42, -1.0, 0.55),
        fov: 32.0,
        zoom: 1.1,
        sun: DVec3::new(-0.9, -0.45, 0.85),
        background: Background::Gradient([188, 206, 224], [232, 232, 226]),
    };
    Plan { footprints, colors, outlook, notes: vec![], facts }
}

fn file_plan(options: &Options, file: &std::path::Path) -> Result<Plan> {
    let map = ColorMap::named(&options.colormap).context("--colormap")?;
    let geo::Map { mut footprints, middle, notes } = geo::read(file, options.height.as_deref())?;
    let points = || footprints.iter().flat_map(|footprint| &footprint.rings).flatten();
    let low = points().fold(DVec2::INFINITY, |low, &point| low.min(point.into()));
    let high = points().fold(DVec2::NEG_INFINITY, |high, &point| high.max(point.into()));
    let width = (high - low).max_element();
    ensure!(width > 0.0, "{}: all of it lies in one place", file.display());
    let top = footprints.iter().map(|footprint| footprint.heights[1]).fold(0.0, f64::max);
    let stretch =
        options.stretch.unwrap_or(if top < 0.02 * width { width / 8.0 / top } else { 1.0 });
    ensure!(stretch > 0.0 && stretch.is_finite(), "--stretch {stretch}: it must be positive");
    let colors: Vec<[u8; 3]> =
        footprints.iter().map(|footprint| map.color((footprint.heights[1] / top).sqrt())).collect();
    for footprint in &mut footprints {
        footprint.heights = footprint.heights.map(|height| height * stretch);
    }
    // The ground below everything.
    let (margin, thick) = (0.06 * width, 0.012 * width);
    let (a, b) = (low - margin, high + margin);
    let rings = vec![vec![[a.x, a.y], [b.x, a.y], [b.x, b.y], [a.x, b.y]]];
    footprints.push(Footprint { rings, heights: [-thick, 0.0], sort: Sort::Ground });
    let colors = colors.into_iter().chain([[214, 216, 220]]).collect();
    let facts = vec![
        format!(
            "{}: the middle is at longitude {:.6}, latitude {:.6}",
            file.display(),
            middle[0],
            middle[1]
        ),
        format!(
            "{width:.1} m wide, the highest is {top:.1} m; heights are drawn {stretch:.3} times"
        ),
    ];
    let outlook = Outlook {
        points: Bounds { min: low.extend(0.0), max: high.extend(top * stretch * 0.5) }
            .corners()
            .to_vec(),
        toward: DVec3::new(0.3, -1.0, 0.85),
        fov: 32.0,
        zoom: 1.0,
        sun: DVec3::new(-0.9, -0.45, 1.0),
        background: Background::Gradient([206, 214, 224], [238, 238, 236]),
    };
    Ok(Plan { footprints, colors, outlook, notes, facts })
}
