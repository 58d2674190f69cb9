//! Brick files against the sort in memory, for any budget.

#![cfg(all(target_endian = "little", any(unix, windows)))]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

mod sources;

use proptest::prelude::*;
use puncta_core::{Scene, Source, Sphere};
use puncta_grid::{
    BrickFile, ConvertConfig, ConvertError, Error, Fit, Grid, GridConfig, Invalid, Resolution,
    convert,
};
use sources::{Chunks, convert_to, names, rows, scene_of};
use std::{convert::Infallible, fs};

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -1.0_f32..1.0,
        3 => (-2_i8..2).prop_map(f32::from),
        1 => 1e3_f32..1.001e3,
        1 => prop_oneof![Just(f32::MAX), Just(f32::MIN), Just(1e-30), Just(-0.0)],
    ]
}

fn scenes() -> impl Strategy<Value = Scene> {
    let sphere = || {
        let sphere = ([coordinate(), coordinate(), coordinate()], 0.0_f32..0.1);
        sphere.prop_map(|(center, radius)| Sphere { center, radius })
    };
    // Many records at one place are a cell that is larger than any memory.
    let pile = (sphere(), 0_usize..200);
    let records = (prop::collection::vec(sphere(), 0..400), pile);
    let records = records.prop_map(|(mut records, (sphere, count))| {
        records.extend(vec![sphere; count]);
        records
    });
    (records, 0_u8..32).prop_map(|(records, columns)| scene_of(records, columns))
}

fn config() -> impl Strategy<Value = ConvertConfig> {
    let resolution = prop_oneof![
        (1_u32..60).prop_map(Resolution::LongestSide),
        (0_u32..60).prop_map(Resolution::RecordsPerBrick),
    ];
    let fit = prop_oneof![Just(Fit::Robust), Just(Fit::Whole)];
    let memory = prop_oneof![4 => 0_u64..20_000, 1 => Just(1 << 24)];
    let invalid = prop_oneof![Just(Invalid::Refuse), Just(Invalid::Skip)];
    (resolution, fit, memory, invalid).prop_map(|(resolution, fit, memory, invalid)| {
        ConvertConfig {
            grid: GridConfig { resolution, fit, ..GridConfig::default() },
            memory,
            invalid,
        }
    })
}

fn threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_file_holds_what_the_sort_in_memory_gives(scene in scenes(), config in config()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bricks");
        let mut sorted = scene.clone();
        let grid = match Grid::sort_scene(&mut sorted, &config.grid) {
            Ok(grid) => grid,
            Err(error) => {
                prop_assert_eq!(convert_to(&path, &scene, &config).unwrap_err(), error);
                prop_assert!(names(folder.path()).is_empty());
                return Ok(());
            }
        };
        convert_to(&path, &scene, &config).unwrap();
        let file = BrickFile::open(&path).unwrap();
        prop_assert_eq!(file.grid.cells(), grid.cells());
        prop_assert_eq!(file.grid.bricks().len(), grid.bricks().len());
        prop_assert_eq!(file.scene.origin, scene.origin);
        prop_assert_eq!(file.scene.records.len(), scene.records.len());
        for (index, (a, b)) in (0..).zip(file.grid.bricks().iter().zip(grid.bricks())) {
            prop_assert_eq!(file.grid.cell_of(index), grid.cell_of(index));
            prop_assert_eq!((&a.records, &a.bounds), (&b.records, &b.bounds));
            prop_assert_eq!(a.radius_max, b.radius_max);
            // Sums depend on the order, by a hair.
            prop_assert!((a.density - b.density).abs() <= 1e-5 * b.density, "{:?} {:?}", a, b);
            prop_assert_eq!(rows(&file.scene, a.records.clone()), rows(&sorted, b.records.clone()));
            let ids: Vec<u32> = a.records.clone().map(|at| file.scene.id(at)).collect();
            prop_assert!(ids.is_sorted());
        }
        if !scene.records.is_empty() {
            prop_assert_eq!(file.bounds(), scene.bounds());
        }
        let inner = scene.inner_bounds(0.001);
        prop_assert_eq!(file.inner_bounds(), inner);
        for axis in 0..3 {
            let heights = || (0..scene.records.len()).map(|i| scene.position(i)[axis]);
            prop_assert_eq!(file.axis_range(axis), puncta_core::inner_range(heights, 0.002));
        }
        for scalar in &scene.attributes.scalars {
            let values = || scalar.values.iter().map(|&value| f64::from(value));
            let range = puncta_core::inner_range(values, 0.002);
            prop_assert_eq!(file.scalar_range(&scalar.name), Some(range));
        }
        let bytes = fs::read(&path).unwrap();
        let generous = ConvertConfig { memory: 1 << 30, ..config };
        threads(3, || convert_to(&path, &scene, &generous)).unwrap();
        prop_assert!(fs::read(&path).unwrap() == bytes, "the budget shows");
        prop_assert_eq!(names(folder.path()), ["a.bricks"]);
    }
}

#[test]
fn records_that_no_grid_can_hold_are_refused_or_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bricks");
    let mut records: Vec<Sphere> = (0..70_000_u32)
        .map(|i| Sphere::new([(i % 211) as f32, (i % 13) as f32, 0.0], 1.0))
        .collect();
    records[66_000].center[1] = f32::NAN;
    records[66_001].radius = -1.0;
    records[66_002].radius = f32::INFINITY;
    let scene = scene_of(records, 7);
    let refuse = ConvertConfig::default();
    let error = convert_to(&path, &scene, &refuse).unwrap_err();
    assert!(matches!(error, Error::Position { index: 66_000, .. }), "{error}");
    assert!(names(folder.path()).is_empty());

    let skip = ConvertConfig { invalid: Invalid::Skip, ..refuse };
    let summary = convert(Chunks { scene: scene.clone(), next: 0 }, &path, &skip).unwrap();
    assert_eq!((summary.records, summary.skipped), (69_997, 3));
    assert_eq!(summary.bytes, fs::metadata(&path).unwrap().len());
    let file = BrickFile::open(&path).unwrap();
    let all = rows(&file.scene, 0..69_997);
    assert_eq!(all.len(), 69_997);
    let before = rows(&scene, 0..70_000);
    for (id, row) in &all {
        assert_eq!(before.get(id), Some(row));
    }
    assert!((66_000..66_003).all(|id| !all.contains_key(&id)));
}

#[test]
fn a_source_that_changes_its_columns_is_refused() {
    struct Fickle(u32);
    impl Source for Fickle {
        type Record = Sphere;
        type Error = Infallible;
        fn remaining(&self) -> Option<u64> {
            None
        }
        fn append(&mut self, scene: &mut Scene, limit: usize) -> Result<usize, Infallible> {
            scene.records.extend(vec![Sphere::default(); limit]);
            self.0 += 1;
            if self.0 == 2 {
                scene.attributes.elements = Some(vec![1; limit].into());
            }
            Ok(if self.0 < 3 { limit } else { 0 })
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let error = convert(Fickle(0), folder.path().join("a.bricks"), &ConvertConfig::default());
    assert!(matches!(error, Err(ConvertError::Columns { index: 65_536, .. })), "{error:?}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn what_a_source_says_is_handed_on() {
    struct Broken;
    impl Source for Broken {
        type Record = Sphere;
        type Error = &'static str;
        fn remaining(&self) -> Option<u64> {
            Some(7)
        }
        fn append(&mut self, _: &mut Scene, _: usize) -> Result<usize, &'static str> {
            Err("no more paper")
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bricks");
    fs::write(&path, "old").unwrap();
    let error = convert(Broken, &path, &ConvertConfig::default()).unwrap_err();
    assert!(matches!(error, ConvertError::Source("no more paper")));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["a.bricks"]);
}
