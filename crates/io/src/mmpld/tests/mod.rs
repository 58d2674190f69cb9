//! Files made by hand, byte by byte, and the faults they can have.

#![expect(clippy::cast_possible_truncation, reason = "the numbers of tests are small")]

mod faults;
mod files;
mod hazards;
mod writing;

use crate::{Error, Loaded, ReadOptions};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;

/// A file of these frames, whose global box goes from -1 to 3.
fn file(version: u16, frames: &[Vec<u8>]) -> Vec<u8> {
    let mut file = b"MMPLD\0".to_vec();
    file.extend(version.to_le_bytes());
    file.extend((frames.len() as u32).to_le_bytes());
    for x in [-1.0_f32, -1.0, -1.0, 3.0, 3.0, 3.0, -2.0, -2.0, -2.0, 4.0, 4.0, 4.0] {
        file.extend(x.to_le_bytes());
    }
    let mut offset = 60 + 8 * (frames.len() as u64 + 1);
    file.extend(offset.to_le_bytes());
    for frame in frames {
        offset += frame.len() as u64;
        file.extend(offset.to_le_bytes());
    }
    frames.iter().for_each(|frame| file.extend(frame));
    file
}

/// A frame of these lists, with a time stamp if the version has one.
fn frame(version: u16, lists: &[Vec<u8>]) -> Vec<u8> {
    let mut frame = Vec::new();
    if version >= 102 {
        frame.extend(1.5_f32.to_le_bytes());
    }
    frame.extend((lists.len() as u32).to_le_bytes());
    lists.iter().for_each(|list| frame.extend(list));
    frame
}

/// A list of particles, given as bytes.
/// Its radius is 0.5, its color (10, 20, 30), its box [0, 2]³.
fn list(version: u16, types: (u8, u8), particles: &[Vec<u8>]) -> Vec<u8> {
    let mut list = header(version, types, particles.len() as u64);
    particles.iter().for_each(|particle| list.extend(particle));
    if version == 101 {
        list.extend(3_u32.to_le_bytes());
        list.extend(5_u64.to_le_bytes());
        list.extend(b"bytes");
    }
    list
}

fn header(version: u16, (vertex, color): (u8, u8), count: u64) -> Vec<u8> {
    let mut header = vec![vertex, color];
    if matches!(vertex, 1 | 3 | 4) {
        header.extend(0.5_f32.to_le_bytes());
    }
    match color {
        0 => header.extend([10, 20, 30, 0]),
        3 | 7 => header.extend(singles(&[0.0, 9.0])),
        _ => {}
    }
    header.extend(count.to_le_bytes());
    if version >= 103 {
        header.extend(singles(&[0.0, 0.0, 0.0, 2.0, 2.0, 2.0]));
    }
    header
}

fn singles(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn words(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// The bytes of `a` and `b`.
fn join(a: &[u8], b: &[u8]) -> Vec<u8> {
    [a, b].concat()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Reads a file as it is and compressed, which must give the same.
fn read_with(options: &ReadOptions, bytes: &[u8]) -> Result<Loaded, Error> {
    let plain = options.read_bytes("a.mmpld", bytes);
    let unzipped = options.read_bytes("a.mmpld", &gzip(bytes));
    if let Ok(plain) = &plain {
        let unzipped = unzipped.unwrap();
        // As text, since NaN is not equal to itself.
        assert!(format!("{:?}", plain.scene) == format!("{:?}", unzipped.scene));
        assert_eq!(plain.report, unzipped.report);
    } else {
        assert!(unzipped.is_err());
    }
    plain
}

fn read(bytes: &[u8]) -> Loaded {
    read_with(&ReadOptions::default(), bytes).unwrap()
}

fn fault(bytes: &[u8]) -> String {
    read_with(&ReadOptions::default(), bytes).unwrap_err().to_string()
}
