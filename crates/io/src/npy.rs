//! The array format of `NumPy`, for pictures as numbers.

use crate::error::{Error, ErrorKind, Fault};
use std::{
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};

/// Writes view depths, or anything else of `f32`, as an array of `height` rows.
///
/// # Errors
///
/// When the file cannot be written, or `values` are not `width * height`.
pub fn write_f32(path: impl AsRef<Path>, size: (u32, u32), values: &[f32]) -> Result<(), Error> {
    write(path.as_ref(), "<f4", size, values.iter().map(|value| value.to_le_bytes()))
}

/// Writes ids, or anything else of `u32`, as an array of `height` rows.
///
/// # Errors
///
/// When the file cannot be written, or `values` are not `width * height`.
pub fn write_u32(path: impl AsRef<Path>, size: (u32, u32), values: &[u32]) -> Result<(), Error> {
    write(path.as_ref(), "<u4", size, values.iter().map(|value| value.to_le_bytes()))
}

/// Writes a file of version 1.0 in row order.
fn write(
    path: &Path,
    kind: &str,
    (width, height): (u32, u32),
    values: impl ExactSizeIterator<Item = [u8; 4]>,
) -> Result<(), Error> {
    let write = || {
        if values.len() as u64 != u64::from(width) * u64::from(height) {
            let what = format!("{width} x {height} pixels must be as many values");
            return Err(ErrorKind::Invalid { what, value: values.len().to_string() }.into());
        }
        let mut file = BufWriter::new(File::create(path)?);
        file.write_all(&header(kind, (width, height)))?;
        for value in values {
            file.write_all(&value)?;
        }
        Ok(file.flush()?)
    };
    write().map_err(|fault: Fault| fault.in_file(path))
}

/// Magic, version, and a dictionary that ends on a multiple of 64 bytes.
fn header(kind: &str, (width, height): (u32, u32)) -> Vec<u8> {
    let dictionary =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    let padded = (10 + dictionary.len() + 1).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend(u16::try_from(padded).unwrap_or(u16::MAX).to_le_bytes());
    header.extend(format!("{dictionary:<width$}\n", width = padded - 1).into_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_that_of_the_format() {
        let header = header("<u4", (640, 480));
        assert_eq!(header.len() % 64, 0);
        assert_eq!(&header[..8], b"\x93NUMPY\x01\x00");
        assert_eq!(usize::from(u16::from_le_bytes([header[8], header[9]])), header.len() - 10);
        let text = String::from_utf8_lossy(&header[10..]).into_owned();
        assert!(text.contains("'shape': (480, 640)") && text.ends_with('\n'));
    }

    #[test]
    fn a_wrong_number_of_values_is_refused() {
        assert!(write_f32("never-written.npy", (2, 2), &[1.0]).is_err());
        assert!(!Path::new("never-written.npy").exists());
    }
}
