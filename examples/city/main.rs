//! Draws a folder as a city: a house for each file, a district for each folder.
//!
//! ```text
//! cargo run --release --example city -- FOLDER [--height age|size|lines]
//! ```

#[path = "../glyphs/mod.rs"]
mod glyphs;
#[path = "../glyphs/kinds.rs"]
mod kinds;
mod layout;
#[path = "../glyphs/tree.rs"]
mod tree;
mod treemap;

use anyhow::Result;
use clap::Parser;
use glam::{DVec3, Vec3};
use glyphs::{Built, DrawingOptions, Outlook, Paint};
use kinds::Kinds;
use layout::Height;
use puncta::{Background, Bounds, Cuboid, Glyphs, Grid, GridConfig, Scene};
use std::process::ExitCode;
use tree::{Folder, Tree, Where};

/// Draws a folder as a city: the ground that a file takes says how large it is, the color of a house what
/// kind it is of, and districts are folders.
#[derive(Clone, Debug, Parser)]
#[command(name = "city", version)]
struct Options {
    #[command(flatten)]
    place: Where,

    /// What makes houses high: heights grow with its square root. By default it is age, but lines if all
    /// files were changed within a day, such as those of a fresh copy
    #[arg(long, value_enum)]
    height: Option<Height>,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("city", &options.drawing, || build(&options))
}

fn build(options: &Options) -> Result<Built<Cuboid, Grid>> {
    let (Tree { root, mut notes }, height) = read(options)?;
    let kinds = Kinds::of(&root);
    let city = layout::build(&root, &kinds, height);
    if city.too_small > 0 {
        notes.push(format!("{} are too small to be drawn", city.too_small));
    }
    let (files, folders) = (root.all_files().len(), root.folder_count());
    let mut facts =
        vec![format!("{}: {files} files in {folders} folders, {} bytes", root.name, root.bytes)];
    facts.push(format!("heights show {}", height.name()));
    facts.extend(kinds.key);
    let mut scene = Scene::new(city.cuboids);
    scene.attributes.colors = Some(city.colors.into());
    let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    let outlook = Outlook {
        points: scene.records.iter().flat_map(corners).collect(),
        toward: DVec3::new(-0.62, -1.0, 0.86),
        fov: 30.0,
        zoom: 1.0,
        sun: DVec3::new(0.7, -0.9, 1.15),
        background: Background::Gradient([214, 222, 232], [240, 240, 238]),
    };
    let (glyphs, paint) = (Glyphs::new([]), Paint::Scene);
    Ok(Built { scene, bricks, glyphs, paint, outlook, notes, facts })
}

/// The folder, and what makes houses high.
fn read(options: &Options) -> Result<(Tree, Height)> {
    let tree = tree::read(&options.place, options.height == Some(Height::Lines))?;
    match options.height {
        Some(height) => Ok((tree, height)),
        None if age_span(&tree.root) > DAY => Ok((tree, Height::Age)),
        None => Ok((tree::read(&options.place, true)?, Height::Lines)),
    }
}

/// By how many seconds the ages of files differ.
fn age_span(root: &Folder) -> f64 {
    let ages = || root.all_files().into_iter().map(|file| file.age);
    ages().fold(0.0, f64::max) - ages().fold(f64::INFINITY, f64::min)
}

/// In seconds.
const DAY: f64 = 86_400.0;

/// The corners of a house.
fn corners(house: &Cuboid) -> [DVec3; 8] {
    let (center, half) = (Vec3::from(house.center), Vec3::from(house.extent) * 0.5);
    Bounds { min: (center - half).as_dvec3(), max: (center + half).as_dvec3() }.corners()
}
