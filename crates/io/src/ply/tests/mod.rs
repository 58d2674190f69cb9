//! Files made by hand, and the faults they can have.

#![expect(clippy::cast_possible_truncation, reason = "the numbers of tests are small")]

mod faults;
mod files;
mod writing;

use crate::{Error, Loaded, ReadOptions};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Reads a file as it is and compressed, which must give the same scene.
fn read_with(options: &ReadOptions, bytes: &[u8]) -> Result<Loaded, Error> {
    let plain = options.read_bytes("a.ply", bytes);
    let unzipped = options.read_bytes("a.ply", &gzip(bytes));
    if let Ok(plain) = &plain {
        let unzipped = unzipped.unwrap();
        // As text, since NaN is not equal to itself.
        assert!(format!("{:?}", plain.scene) == format!("{:?}", unzipped.scene));
        assert_eq!(plain.report.skipped, unzipped.report.skipped);
    } else {
        assert!(unzipped.is_err());
    }
    plain
}

fn read(bytes: &[u8]) -> Loaded {
    read_with(&ReadOptions::default(), bytes).unwrap()
}

fn fault(bytes: &[u8]) -> String {
    ReadOptions::default().read_bytes("a.ply", bytes).unwrap_err().to_string()
}

/// A header of these lines after the format.
fn header(format: &str, lines: &[&str]) -> Vec<u8> {
    format!("ply\nformat {format} 1.0\n{}\nend_header\n", lines.join("\n")).into_bytes()
}

/// The bytes of `a` and `b`.
fn join(a: &[u8], b: &[u8]) -> Vec<u8> {
    [a, b].concat()
}
