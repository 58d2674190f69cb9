//! Brick files against the sort in memory, for any budget, and against everything that can happen to
//! a file.

#![cfg(all(target_endian = "little", any(unix, windows)))]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

use glam::DVec3;
use proptest::prelude::*;
use puncta_core::{Scalar, Scene, Source, Sphere};
use puncta_grid::{
    BrickFile, ConvertConfig, ConvertError, Error, Fit, Grid, GridConfig, Invalid, OpenError,
    Resolution, Verify, convert,
};
use std::{collections::BTreeMap, convert::Infallible, fs, path::Path};

/// A scene as a source, in chunks that vary.
struct Chunks {
    scene: Scene,
    next: usize,
}

impl Source for Chunks {
    type Record = Sphere;
    type Error = Infallible;

    fn remaining(&self) -> Option<u64> {
        None
    }

    fn append(&mut self, to: &mut Scene, limit: usize) -> Result<usize, Infallible> {
        let end = (self.next + limit).min(self.scene.records.len());
        let rows = self.next..end;
        to.origin = self.scene.origin;
        to.records.extend(self.scene.records[rows.clone()].iter().copied());
        let (to, from) = (&mut to.attributes, &self.scene.attributes);
        if let Some(ids) = &from.ids {
            to.ids.get_or_insert_default().extend(ids[rows.clone()].iter().copied());
        }
        if let Some(colors) = &from.colors {
            to.colors.get_or_insert_default().extend(colors[rows.clone()].iter().copied());
        }
        if let Some(elements) = &from.elements {
            to.elements.get_or_insert_default().extend(elements[rows.clone()].iter().copied());
        }
        for (index, scalar) in from.scalars.iter().enumerate() {
            if to.scalars.len() == index {
                to.scalars.push(Scalar { name: scalar.name.clone(), values: vec![].into() });
            }
            to.scalars[index].values.extend(scalar.values[rows.clone()].iter().copied());
        }
        self.next = end;
        Ok(rows.len())
    }
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -1.0_f32..1.0,
        3 => (-2_i8..2).prop_map(f32::from),
        1 => 1e3_f32..1.001e3,
        1 => prop_oneof![Just(f32::MAX), Just(f32::MIN), Just(1e-30), Just(-0.0)],
    ]
}

/// Which columns there are: bits of a number.
fn scene_of(records: Vec<Sphere>, columns: u8) -> Scene {
    let count = records.len();
    let mut scene = Scene::new(records);
    scene.origin = DVec3::new(1e7, -3.25, 0.1);
    let attributes = &mut scene.attributes;
    if columns & 1 != 0 {
        attributes.colors = Some((0..count).map(|i| (i as u32 * 77).to_le_bytes()).collect());
    }
    if columns & 2 != 0 {
        attributes.elements = Some((0..count).map(|i| (i % 251) as u8).collect());
    }
    for name in ["speed", "\u{3c1} of it"].iter().take(usize::from(columns >> 2 & 3)) {
        let values = (0..count).map(|i| if i % 5 == 3 { f32::NAN } else { i as f32 }).collect();
        attributes.scalars.push(Scalar { name: (*name).into(), values });
    }
    if columns & 16 != 0 {
        let id = |i: usize| 4_000_000_000 - (i as u32).wrapping_mul(2_654_435_769) % 3_999_999_999;
        attributes.ids = Some((0..count).map(id).collect());
    }
    scene
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
        ConvertConfig { grid: GridConfig { resolution, fit }, memory, invalid }
    })
}

/// Everything about the rows of a range, by their ids: bits, so that NaN is what it is.
fn rows(scene: &Scene, range: std::ops::Range<u32>) -> BTreeMap<u32, Vec<u32>> {
    let a = &scene.attributes;
    range
        .map(|index| {
            let i = index as usize;
            let record = scene.records[i];
            let mut row: Vec<u32> = record.center.map(f32::to_bits).into();
            row.push(record.radius.to_bits());
            row.extend(a.colors.as_ref().map(|colors| u32::from_le_bytes(colors[i])));
            row.extend(a.elements.as_ref().map(|elements| u32::from(elements[i])));
            row.extend(a.scalars.iter().map(|scalar| scalar.values[i].to_bits()));
            (scene.id(index), row)
        })
        .collect()
}

fn threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

fn convert_to(path: &Path, scene: &Scene, config: &ConvertConfig) -> Result<(), Error> {
    let result = convert(Chunks { scene: scene.clone(), next: 0 }, path, config);
    match result {
        Ok(_) => Ok(()),
        Err(ConvertError::Grid(error)) => Err(error),
        Err(other) => panic!("{other}"),
    }
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
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
            prop_assert_eq!((&a.records, &a.bounds, a.radius_max), (&b.records, &b.bounds, b.radius_max));
            prop_assert!((a.density - b.density).abs() <= 1e-5 * b.density, "{} {}", a.density, b.density);
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

/// A file of some records with all columns.
fn small(folder: &Path) -> (std::path::PathBuf, Vec<u8>) {
    let sphere = |i: u16| Sphere::new([i % 31, i % 29, i % 23].map(f32::from), 0.5);
    let scene = scene_of((0..900).map(sphere).collect(), 15);
    let path = folder.join("small.bricks");
    let grid = GridConfig { resolution: Resolution::RecordsPerBrick(40), fit: Fit::Robust };
    convert_to(&path, &scene, &ConvertConfig { grid, ..ConvertConfig::default() }).unwrap();
    let bytes = fs::read(&path).unwrap();
    (path, bytes)
}

/// What can happen to a file.
#[derive(Clone, Debug)]
enum Harm {
    Flip(usize, u8),
    Byte(usize, u8),
    Truncate(usize),
    Extend(Vec<u8>),
    Swap(usize, usize),
    Word(usize, u32),
}

fn harm() -> impl Strategy<Value = Harm> {
    // Half of the harm is done to the header and the tables, where it might be believed.
    let at = || {
        prop_oneof![Just(0_usize), Just(1)].prop_flat_map(|part| match part {
            0 => 0_usize..260,
            _ => 0_usize..100_000,
        })
    };
    prop_oneof![
        (at(), 0_u8..8).prop_map(|(at, bit)| Harm::Flip(at, 1 << bit)),
        (at(), any::<u8>()).prop_map(|(at, byte)| Harm::Byte(at, byte)),
        (0_usize..100_000).prop_map(Harm::Truncate),
        prop::collection::vec(any::<u8>(), 1..5000).prop_map(Harm::Extend),
        (at(), at()).prop_map(|(a, b)| Harm::Swap(a, b)),
        (at(), prop_oneof![Just(u32::MAX), Just(0), Just(1 << 31), any::<u32>()])
            .prop_map(|(at, word)| Harm::Word(at, word)),
    ]
}

fn apply(harm: &Harm, bytes: &mut Vec<u8>) {
    let length = bytes.len();
    match *harm {
        Harm::Flip(at, mask) => bytes[at % length] ^= mask,
        Harm::Byte(at, byte) => bytes[at % length] = byte,
        Harm::Truncate(at) => bytes.truncate(at % length),
        Harm::Extend(ref more) => bytes.extend_from_slice(more),
        Harm::Swap(a, b) => {
            let (a, b) = (a % (length - 4) / 4 * 4, b % (length - 4) / 4 * 4);
            (0..4).for_each(|i| bytes.swap(a + i, b + i));
        }
        Harm::Word(at, word) => {
            let at = at % (length - 4) / 4 * 4;
            bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        }
    }
}

/// Sums that are right again, so that what they guard must be found wrong on its own.
fn mend(bytes: &mut [u8]) {
    let word = |bytes: &[u8], at: usize| {
        bytes.get(at..at + 8).map_or(0, |b| u64::from_le_bytes(b.try_into().unwrap()) as usize)
    };
    if bytes.len() < 4096 {
        return;
    }
    let (start, count) = (word(bytes, 224), word(bytes, 232));
    if let Some(tables) = start.checked_add(count).and_then(|end| bytes.get(start..end)) {
        let sum = crc32fast::hash(tables);
        bytes[240..244].copy_from_slice(&sum.to_le_bytes());
    }
    let sum = crc32fast::hash(&bytes[..4092]);
    bytes[4092..4096].copy_from_slice(&sum.to_le_bytes());
}

#[test]
fn no_harm_goes_unnoticed() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = small(folder.path());
    let file = BrickFile::open(&path).unwrap();
    let harms = prop::collection::vec(harm(), 1..3);
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::default());
    let path = folder.path().join("harmed.bricks");
    let result = runner.run(&(harms, any::<bool>()), |(harms, is_mended)| {
        let mut bytes = whole.clone();
        for harm in &harms {
            // What was cut off cannot be harmed.
            if bytes.len() > 8 {
                apply(harm, &mut bytes);
            }
        }
        let is_harmed = bytes != whole;
        if is_mended {
            mend(&mut bytes);
        }
        fs::write(&path, &bytes).unwrap();
        let opened = BrickFile::open(&path);
        let tables = BrickFile::open_with(&path, Verify::Tables);
        if is_mended {
            // Tables may say something else that is as good; what is opened can be used.
            for file in [opened, tables].into_iter().flatten() {
                file.scene.validate().unwrap();
                file.bounds();
            }
            return Ok(());
        }
        prop_assert_eq!(opened.is_err(), is_harmed);
        match opened {
            Err(error) => {
                let said = error.to_string();
                prop_assert!(said.contains("harmed.bricks: byte "), "{}", said);
            }
            Ok(again) => prop_assert_eq!(&again.grid, &file.grid),
        }
        Ok(())
    });
    result.unwrap();
}

#[test]
fn harm_to_records_is_found_unless_only_tables_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    let (path, mut bytes) = small(folder.path());
    bytes[4096 + 77] ^= 4;
    fs::write(&path, &bytes).unwrap();
    assert!(BrickFile::open_with(&path, Verify::Tables).is_ok());
    let error = BrickFile::open(&path).unwrap_err();
    assert!(matches!(error, OpenError::Invalid { byte: 4096, .. }), "{error}");
}

#[test]
fn files_of_other_kinds_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bricks");
    for (bytes, named) in [
        (&b""[..], "must start with"),
        (b"ply\nformat ascii 1.0\n", "ply"),
        (b"\x89BRICKS\n\x01\0\0\0", "the header must have 4096 bytes"),
    ] {
        fs::write(&path, bytes).unwrap();
        let error = BrickFile::open(&path).unwrap_err().to_string();
        assert!(error.contains(named) && error.contains("a.bricks"), "{error}");
    }
    assert!(matches!(BrickFile::open(folder.path()), Err(OpenError::Read { .. })));
    assert!(matches!(BrickFile::open(folder.path().join("none")), Err(OpenError::Read { .. })));
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
