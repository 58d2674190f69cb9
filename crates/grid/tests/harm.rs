//! Brick files against everything that can happen to a file.

#![cfg(all(target_endian = "little", any(unix, windows)))]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

mod sources;

use glam::DVec3;
use proptest::{prelude::*, test_runner::TestRunner};
use puncta_core::{Sphere, View};
use puncta_grid::{BrickFile, ConvertConfig, GridConfig, OpenError, Resolution, Verify};
use sources::{convert_to, scene_of};
use std::{fs, path::Path};

/// A file of some records with all columns.
fn small(folder: &Path) -> (std::path::PathBuf, Vec<u8>) {
    let sphere = |i: u16| Sphere::new([i % 31, i % 29, i % 23].map(f32::from), 0.5);
    let scene = scene_of((0..900).map(sphere).collect(), 15);
    let path = folder.join("small.bricks");
    let grid = GridConfig { resolution: Resolution::RecordsPerBrick(40), ..GridConfig::default() };
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

/// Harm to a file of this length.
fn harm(length: usize) -> impl Strategy<Value = Harm> {
    // Most harm is done to the header and the tables, where it might be believed.
    let at = move || prop_oneof![0_usize..260, length - 1500..length, 0..length];
    prop_oneof![
        (at(), 0_u8..8).prop_map(|(at, bit)| Harm::Flip(at, 1 << bit)),
        (at(), any::<u8>()).prop_map(|(at, byte)| Harm::Byte(at, byte)),
        (0..length).prop_map(Harm::Truncate),
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
    let harms = prop::collection::vec(harm(whole.len()), 1..3);
    let mut runner = TestRunner::new(ProptestConfig::default());
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
                for index in 0..file.grid.bricks().len() as u32 {
                    let place = file.grid.cell_of(index).unwrap();
                    prop_assert_eq!(file.grid.brick_at(place), Some(index));
                    prop_assert!(file.grid.cells().contains(place));
                }
                let view = View::look_at(DVec3::ONE, DVec3::ZERO, DVec3::Z).unwrap();
                let bricks = file.grid.bricks();
                prop_assert!(view.framing_bricks(&file.scene, bricks, &file.bounds()).near() > 0.0);
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
fn tables_that_are_no_grid_are_refused_even_if_their_sums_are_right() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = small(folder.path());
    let bricks = BrickFile::open(&path).unwrap().grid.bricks().len();
    let word = |at: usize| u64::from_le_bytes(whole[at..at + 8].try_into().unwrap()) as usize;
    // Behind the ranges of five columns and the names of two.
    let table = word(224) + 5 * 16 + (2 + "speed".len()) + (2 + "\u{3c1} of it".len());
    let codes = table + 36 * bricks;
    for (at, bytes, named) in [
        (table, 0_u32.to_le_bytes(), "a brick must have 1 to 900 records, not 0"),
        (table, 901_u32.to_le_bytes(), "a brick must have 1 to 900 records, not 901"),
        (table, 1_u32.to_le_bytes(), "the bricks must have 900 records"),
        (table + 4, 1e9_f32.to_le_bytes(), "the box of brick 0 must lie in its cell"),
        (table + 4, f32::NAN.to_le_bytes(), "the box of brick 0 must lie in its cell"),
        (table + 28, f32::NAN.to_le_bytes(), "the largest radius of brick 0"),
        (table + 32, (-1_f32).to_le_bytes(), "the density of brick 0"),
        (codes + 4, 0_u32.to_le_bytes(), "the code of brick 1 must be above"),
        (codes + 4, u32::MAX.to_le_bytes(), "the code of brick 1 must be that of a cell"),
        (72, u32::MAX.to_le_bytes(), "the numbers of cells along the axes"),
        (84, f32::INFINITY.to_le_bytes(), "the corner of the cells"),
        (96, 0_f32.to_le_bytes(), "the scale of the cells"),
        (124, 77_u32.to_le_bytes(), "bits of a code can tell the block, not 77"),
        (40, 3_u32.to_le_bytes(), "small.bricks: byte "),
        (40, u32::MAX.to_le_bytes(), "there must be room for the scalars' names"),
        (32, u32::MAX.to_le_bytes(), "no more bricks than records"),
        (24, 5000_u32.to_le_bytes(), "the bricks must have 5000 records, not 900"),
    ] {
        let mut harmed = whole.clone();
        harmed[at..at + 4].copy_from_slice(&bytes);
        mend(&mut harmed);
        fs::write(&path, &harmed).unwrap();
        let error = BrickFile::open_with(&path, Verify::Tables).unwrap_err().to_string();
        assert!(error.contains(named), "{error}, but not {named}");
    }
}
