//! Real files, if the folder that `PUNCTA_DATA` names has them: they are read whole and drawn.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may panic, and says so if it has nothing to test"
)]

use glam::DVec3;
use puncta::{
    CpuRenderer, Depth, FrustumCull, Grid, GridConfig, Loaded, Pipeline, ReadOptions, View,
};
use std::path::{Path, PathBuf};

fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("PUNCTA_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: PUNCTA_DATA is not set");
    }
    folder
}

/// Reads a file, of which nothing may be skipped, and draws it; returns what was read and the share
/// of the pixels that show a record.
fn draw(path: &Path) -> (Loaded, f64) {
    let mut loaded = ReadOptions::default().strict(true).read(path).unwrap();
    let grid = Grid::sort_scene(&mut loaded.scene, &GridConfig::default()).unwrap();
    let view = View::look_at(DVec3::new(1.0, -2.0, 1.5), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(256, 256).unwrap().fitted(&loaded.scene.bounds());
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let picture = pipeline.render(&loaded.scene, &grid, &view).unwrap();
    (loaded, picture.covered_pixels() as f64 / (256.0 * 256.0))
}

#[test]
fn real_files_are_read_and_drawn() {
    let Some(folder) = folder() else { return };
    for (name, records, least_share) in [
        ("bace_membrane.pdb", 52_661, 0.3),
        ("ges2.xyz", 258, 0.3),
        ("sph_hilbert_18856.vtk", 18_856, 0.3),
        ("bun_zipper.ply", 35_947, 0.2),
        ("autzen_town.laz", 2_800_109, 0.1),
    ] {
        let (loaded, share) = draw(&folder.join(name));
        assert_eq!(loaded.scene.records.len(), records, "{name}");
        assert!(share > least_share, "{name} covers {share}");
    }
}

#[test]
fn every_kind_of_mmpld_is_read_to_its_last_byte() {
    let Some(folder) = folder() else { return };
    let mut count = 0;
    for entry in folder.join("mmpld").read_dir().unwrap() {
        let path = entry.unwrap().path();
        let (loaded, share) = draw(&path);
        assert!(loaded.report.warnings.is_empty(), "{}: {:?}", path.display(), loaded.report);
        assert!(share > 0.0, "{}", path.display());
        count += 1;
    }
    assert_eq!(count, 17);
}
