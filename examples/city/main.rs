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
use glam::DVec3;
use glyphs::{Built, DrawingOptions, Outlook, Paint};
use kinds::Kinds;
use layout::Height;
use puncta::{Background, Bounds, Cuboid, Glyphs, Grid, GridConfig, Scene};
use std::process::ExitCode;
use tree::{Tree, Where};

/// Draws a folder as a city: the ground that a file takes says how large it is, the color of a house what
/// kind it is of, and districts are folders.
#[derive(Clone, Debug, Parser)]
#[command(name = "city", version)]
struct Options {
    #[command(flatten)]
    place: Where,

    /// What makes houses high: heights grow with its square root
    #[arg(long, value_enum, default_value_t = Height::Lines)]
    height: Height,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("city", &options.drawing, || build(&options))
}

fn build(options: &Options) -> Result<Built<Cuboid, Grid>> {
    let Tree { root, mut notes } = tree::read(&options.place, options.height == Height::Lines)?;
    let kinds = Kinds::of(&root);
    let city = layout::build(&root, &kinds, options.height);
    if city.too_small > 0 {
        notes.push(format!("{} are too small to be drawn", city.too_small));
    }
    let (files, folders) = (root.all_files().len(), root.folder_count());
    let mut facts =
        vec![format!("{}: {files} files in {folders} folders, {} bytes", root.name, root.bytes)];
    facts.extend(kinds.key);
    let mut scene = Scene::new(city.cuboids);
    scene.attributes.colors = Some(city.colors.into());
    let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    let [width, length] = layout::SIDES;
    let outlook = Outlook {
        points: Bounds {
            min: DVec3::new(-width * 0.5, -length * 0.5, 0.0),
            max: DVec3::new(width * 0.5, length * 0.5, 60.0),
        }
        .corners()
        .to_vec(),
        toward: DVec3::new(-0.62, -1.0, 0.86),
        fov: 30.0,
        zoom: 1.0,
        sun: DVec3::new(0.7, -0.9, 1.15),
        background: Background::Gradient([214, 222, 232], [240, 240, 238]),
    };
    let (glyphs, paint) = (Glyphs::new([]), Paint::Scene);
    Ok(Built { scene, bricks, glyphs, paint, outlook, notes, facts })
}
