//! Draws a landscape of blocks with caves and ores.
//!
//! ```text
//! cargo run --release --example blocks -- --cells 256 [--all-blocks]
//! ```

#[path = "../glyphs/mod.rs"]
mod glyphs;
mod kind;
mod noise;
mod terrain;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use glam::DVec3;
use glyphs::{Built, DrawingOptions, Outlook, Paint, progress::Bar};
use kind::Kind;
use puncta::{
    Background, Bounds, Glyphs, Grid, GridConfig, Scene,
    avc::{Block, BlockWorld, Filling},
    core::MAX_RECORDS,
};
use std::{
    process::ExitCode,
    sync::atomic::{AtomicU64, Ordering},
    time::Instant,
};
use terrain::Terrain;

/// Draws a landscape of blocks: meadows, deserts and mountains, and below them caves and ores, which
/// are seen at the sides.
#[derive(Clone, Debug, Parser)]
#[command(name = "blocks", version)]
struct Options {
    /// How many cells there are along each side, or along x, y and z
    #[arg(long, value_name = "N|XxYxZ", default_value = "256", value_parser = cells)]
    cells: [u16; 3],

    /// Another number gives another landscape
    #[arg(long, value_name = "N", default_value_t = 7)]
    seed: u32,

    /// Draw all blocks with all their faces, also those that others hide: to compare with
    #[arg(long)]
    all_blocks: bool,

    #[command(flatten)]
    drawing: DrawingOptions,
}

fn main() -> ExitCode {
    let options = Options::parse();
    glyphs::run("blocks", &options.drawing, || build(&options))
}

fn cells(text: &str) -> Result<[u16; 3], String> {
    let side = |side: &str| match side.trim().parse() {
        Ok(side) if u32::from(side) <= BlockWorld::SIDE_MAX && side > 0 => Ok(side),
        _ => Err(format!("{side:?} is no number of cells from 1 to {}", BlockWorld::SIDE_MAX)),
    };
    match text.split(['x', 'X']).collect::<Vec<_>>()[..] {
        [all] => side(all).map(|all| [all; 3]),
        [x, y, z] => Ok([side(x)?, side(y)?, side(z)?]),
        _ => Err("write it as 256 or 256x256x128".into()),
    }
}

fn build(options: &Options) -> Result<Built<Block, Grid>> {
    let dims = options.cells;
    let start = Instant::now();
    let (terrain, world) = fill(options)?;
    let filled = start.elapsed();
    let spinner = Bar::spinner("looking");
    let kind = |[x, y, z]: [u16; 3]| terrain.column([x, y]).kind(z) as u8;
    let count = world.count();
    ensure!(
        !options.all_blocks || count <= MAX_RECORDS as u64,
        "--all-blocks: {count} blocks are more than {MAX_RECORDS}"
    );
    let blocks = if options.all_blocks { world.all(kind) } else { world.surface(kind) };
    spinner.finish();
    let found = start.elapsed() - filled;
    let faces: u64 = blocks.iter().map(|block| u64::from(block.faces.count_ones())).sum();
    let (drawn, bytes) = (blocks.len(), size_of_val(blocks.as_slice()));
    let mut scene = Scene::new(blocks);
    let spinner = Bar::spinner("sorting");
    let bricks = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    spinner.finish();
    let [x, y, z] = dims;
    let all: u64 = dims.map(u64::from).iter().product();
    let facts = vec![
        format!("{x} x {y} x {z} = {all} cells, {count} of them filled"),
        format!("{drawn} blocks with {faces} faces are kept: {bytes} bytes"),
        format!(
            "filled in {:.2} s, surface found in {:.2} s, sorted in {:.2} s",
            filled.as_secs_f64(),
            found.as_secs_f64(),
            (start.elapsed() - filled - found).as_secs_f64()
        ),
    ];
    let top = f64::from(z).min(f64::from(x.max(y)));
    let outlook = Outlook {
        points: Bounds {
            min: DVec3::ZERO,
            max: DVec3::new(f64::from(x), f64::from(y), top * 0.52),
        }
        .corners()
        .to_vec(),
        toward: DVec3::new(-0.66, -1.0, 0.72),
        fov: 30.0,
        zoom: 1.0,
        sun: DVec3::new(0.62, -1.0, 0.95),
        background: Background::Gradient([150, 186, 224], [226, 234, 238]),
    };
    let paint = Paint::Record(|block: &Block| Kind::color(block.kind, block.cell));
    Ok(Built { scene, bricks, glyphs: Glyphs::new([]), paint, outlook, notes: vec![], facts })
}

/// Makes the landscape and fills the cells.
fn fill(options: &Options) -> Result<(Terrain, BlockWorld)> {
    let dims = options.cells;
    let [x, y, _] = dims.map(u64::from);
    let terrain = Terrain::new(dims, options.seed);
    let mut world = BlockWorld::new(dims.map(u32::from)).context("--cells")?;
    let (bar, done) = (Bar::counting("filling", x * y), AtomicU64::new(0));
    world.fill_columns(|[x, y], cells| {
        let column = terrain.column([x, y]);
        for (z, cell) in (0..).zip(cells) {
            *cell = if column.is_filled(z) { Filling::Opaque } else { Filling::Air };
        }
        bar.set(done.fetch_add(1, Ordering::Relaxed));
    });
    bar.finish();
    Ok((terrain, world))
}
