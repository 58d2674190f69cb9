//! Draws a folder as rings: an arc for each file and folder, a ring for each depth.
//!
//! ```text
//! cargo run --release --example sunburst -- FOLDER [--height depth|age|lines] [--color folder|kind]
//! ```

#[path = "../glyphs/mod.rs"]
mod glyphs;
#[path = "../glyphs/kinds.rs"]
mod kinds;
mod layout;
mod rings;
#[path = "../glyphs/tree.rs"]
mod tree;

use anyhow::Result;
use clap::Parser;
use glam::DVec3;
use glyphs::{Built, DrawingOptions, Outlook, Paint};
use kinds::Kinds;
use layout::{ColorBy, Height, Sector};
use puncta::{Background, Glyphs, Grid, GridConfig, Scene, avc::Arc};
use rings::RADIUS;
use std::{f64::consts::TAU, process::ExitCode};
use tree::{Tree, Where};

/// Draws a folder as rings: the turn that an arc takes says how large a file or folder is, and the
/// ring how deep it lies.
#[derive(Clone, Debug, Parser)]
#[command(name = "sunburst", version)]
struct Options {
    #[command(flatten)]
    place: Where,

    /// What makes arcs high
    #[arg(long, value_enum, default_value_t = Height::Depth)]
    height: Height,

    /// What gives arcs their color
    #[arg(long, value_enum, default_value_t = ColorBy::Folder)]
    color: ColorBy,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("sunburst", &options.drawing, || build(&options))
}

/// The table that it stands on.
const TABLE: f64 = 8.0;

fn build(options: &Options) -> Result<Built<Arc, Grid>> {
    let Tree { root, mut notes } = tree::read(&options.place, options.height == Height::Lines)?;
    let kinds = Kinds::of(&root);
    let sectors = layout::build(&root, &kinds, options.height, options.color);
    let (files, folders) = (root.all_files().len(), root.folder_count());
    let mut facts =
        vec![format!("{}: {files} files in {folders} folders, {} bytes", root.name, root.bytes)];
    if options.color == ColorBy::Kind {
        facts.extend(kinds.key);
    }
    let table = arc(
        -TABLE,
        &Sector { turns: [0.0, 1.0], radii: [0.0, RADIUS * 2.2], height: TABLE, color: [0; 3] },
    );
    let (mut records, mut colors) = (vec![table], vec![[228, 230, 234, 255]]);
    let all = sectors.len();
    // What is narrower than numbers can tell is nothing.
    let is_there = |arc: &Arc| arc.turns[0] < arc.turns[1] && arc.radii[0] < arc.radii[1];
    for sector in &sectors {
        let (arc, [r, g, b]) = (arc(0.0, sector), sector.color);
        if is_there(&arc) {
            records.push(arc);
            colors.push([r, g, b, 255]);
        }
    }
    if records.len() <= all {
        notes.push(format!("{} are too small to be drawn", all + 1 - records.len()));
    }
    let mut scene = Scene::new(records);
    scene.attributes.colors = Some(colors.into());
    let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    let outlook = Outlook {
        points: sectors.iter().flat_map(rim).collect(),
        toward: DVec3::new(0.0, -1.0, 1.25),
        fov: 28.0,
        zoom: 1.0,
        sun: DVec3::new(-1.0, 0.25, 1.2),
        background: Background::Gradient([206, 211, 219], [236, 238, 240]),
    };
    let (glyphs, paint) = (Glyphs::new([]), Paint::Scene);
    Ok(Built { scene, bricks, glyphs, paint, outlook, notes, facts })
}

/// Points along the outer rim of an arc, below and above.
fn rim(sector: &Sector) -> impl Iterator<Item = DVec3> {
    let ([start, end], radius, height) = (sector.turns, sector.radii[1], sector.height);
    (0..=RIM).map(move |k| start + (end - start) * f64::from(k) / f64::from(RIM)).flat_map(
        move |turns| {
            let (y, x) = (turns * TAU).sin_cos();
            [0.0, height].map(|z| DVec3::new(radius * x, radius * y, z))
        },
    )
}

/// How many chords such a rim has.
const RIM: u32 = 32;

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn arc(bottom: f64, sector: &Sector) -> Arc {
    Arc {
        center: [0.0, 0.0, bottom as f32],
        radii: sector.radii.map(|x| x as f32),
        turns: sector.turns.map(|x| x as f32),
        height: sector.height as f32,
    }
}
