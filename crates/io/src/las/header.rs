/*!
The header of a LAS file, checked against the length of the file.

| byte | type | field |
| --- | --- | --- |
| 0 | 4 bytes | `LASF` |
| 24, 25 | u8 | version, major and minor |
| 94 | u16 | header size |
| 96 | u32 | offset to the points |
| 100 | u32 | number of variable length records, which follow the header |
| 104 | u8 | point format; bit 7 is set if the points are compressed |
| 105 | u16 | bytes in a point record |
| 107 | u32 | number of points |
| 131 | 3 f64 | scale of x, y, z |
| 155 | 3 f64 | offset of x, y, z |
| 179 | 6 f64 | max x, min x, max y, min y, max z, min z |
| 247 | u64 | number of points, from version 1.4 on |

Source: LAS Specification 1.4 R15, ASPRS 2019, and those of versions 1.0 to 1.3.
*/

use crate::error::{ErrorKind, Fault, Place, quote};
use std::io::{ErrorKind as IoError, Read};

/// The length of the header up to version 1.2, and the longest one.
const BYTES_MIN: usize = 227;
const BYTES_MAX: usize = 375;

/// The size of a record of each point format, and where its colors lie.
pub(super) const FORMATS: [(u64, Option<usize>); 11] = [
    (20, None),
    (28, None),
    (26, Some(20)),
    (34, Some(28)),
    (57, None),
    (63, Some(28)),
    (30, None),
    (36, Some(30)),
    (38, Some(30)),
    (59, None),
    (67, Some(30)),
];

/// What the header says about the points.
#[derive(Debug)]
pub(super) struct Header {
    /// The number of the point format, without the bit of compression.
    pub(super) format: u8,
    pub(super) compressed: bool,
    /// The byte at which the variable length records start.
    pub(super) header_bytes: u64,
    pub(super) variable_records: u32,
    /// The byte at which the points start.
    pub(super) points_start: u64,
    /// The bytes of an (uncompressed) record, and how many of them the format does not explain.
    pub(super) record_bytes: u64,
    pub(super) extra_bytes: u64,
    /// Where in a record its colors lie.
    pub(super) color_at: Option<usize>,
    pub(super) count: u64,
    /// The number of points in the field of the older versions, if it tells another one.
    pub(super) other_count: Option<u64>,
    pub(super) scale: [f64; 3],
    pub(super) offset: [f64; 3],
    /// The box that the points are said to lie in.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
}

impl Header {
    /// Reads the header from the start of a file of `length` bytes.
    pub(super) fn read(stream: &mut impl Read, length: u64) -> Result<Self, Fault> {
        let bytes = Bytes::read(stream)?;
        let minor = bytes.version()?;
        let (header_bytes, points_start) = bytes.extents(minor, length)?;
        let (format, compressed) = bytes.format()?;
        let (format_bytes, color_at) =
            FORMATS.get(usize::from(format)).copied().unwrap_or_default();
        let record_bytes = u64::from(u16::from_le_bytes(bytes.at(105)));
        if record_bytes < format_bytes {
            let what = format!("a record of point format {format} must have {format_bytes} bytes");
            return Err(Fault::invalid(Place::Byte(105), what, record_bytes));
        }
        let old_count = u64::from(u32::from_le_bytes(bytes.at(107)));
        let new_count = if minor == 4 { u64::from_le_bytes(bytes.at(247)) } else { 0 };
        let (count, other_count) = match (new_count, old_count) {
            (0, old) => (old, None),
            (new, old) => (new, Some(old).filter(|&old| old != 0 && old != new)),
        };
        Ok(Self {
            format,
            compressed,
            header_bytes,
            variable_records: u32::from_le_bytes(bytes.at(100)),
            points_start,
            record_bytes,
            extra_bytes: record_bytes - format_bytes,
            color_at,
            count,
            other_count,
            scale: bytes.scale()?,
            offset: bytes.offset()?,
            min: [187, 203, 219].map(|at| f64::from_le_bytes(bytes.at(at))),
            max: [179, 195, 211].map(|at| f64::from_le_bytes(bytes.at(at))),
        })
    }

    /// Whether the fields lie as in the formats of version 1.4.
    pub(super) fn is_extended(&self) -> bool {
        self.format >= 6
    }
}

/// The bytes of the header; zeros after its end.
struct Bytes([u8; BYTES_MAX]);

impl Bytes {
    fn read(stream: &mut impl Read) -> Result<Self, Fault> {
        let (mut bytes, mut filled) = ([0; BYTES_MAX], 0);
        while filled < BYTES_MAX {
            match stream.read(&mut bytes[filled..]) {
                Ok(0) => break,
                Ok(read) => filled += read,
                Err(error) if error.kind() == IoError::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        if !bytes.starts_with(b"LASF") {
            let what = "the file must start with \"LASF\"";
            return Err(Fault::invalid(Place::Byte(0), what, quote(&bytes[..filled.min(4)])));
        }
        if filled < BYTES_MIN {
            let (what, needed) = ("the header".to_owned(), BYTES_MIN as u64);
            let kind = ErrorKind::Truncated { what, needed, left: filled as u64 };
            return Err(Fault { place: Some(Place::Byte(0)), kind });
        }
        Ok(Self(bytes))
    }

    /// `N` bytes of a field.
    fn at<const N: usize>(&self, at: usize) -> [u8; N] {
        field(&self.0, at)
    }

    /// The minor version.
    fn version(&self) -> Result<u8, Fault> {
        let [major, minor] = self.at(24);
        if major == 1 && minor <= 4 {
            return Ok(minor);
        }
        let what = "the version must be 1.0 to 1.4";
        Err(Fault::invalid(Place::Byte(24), what, format!("{major}.{minor}")))
    }

    /// Where the header ends and where the points start.
    fn extents(&self, minor: u8, length: u64) -> Result<(u64, u64), Fault> {
        let header_bytes = u64::from(u16::from_le_bytes(self.at(94)));
        let needed = if minor == 4 { BYTES_MAX } else { BYTES_MIN } as u64;
        if header_bytes < needed {
            let what = format!("the header of version 1.{minor} must have {needed} bytes");
            return Err(Fault::invalid(Place::Byte(94), what, header_bytes));
        }
        let points_start = u64::from(u32::from_le_bytes(self.at(96)));
        if points_start < header_bytes || points_start > length {
            let what = format!(
                "the points must start after the header of {header_bytes} bytes \
                 and within the file of {length} bytes"
            );
            return Err(Fault::invalid(Place::Byte(96), what, format!("at byte {points_start}")));
        }
        Ok((header_bytes, points_start))
    }

    /// The point format, and whether the points are compressed.
    fn format(&self) -> Result<(u8, bool), Fault> {
        let [byte] = self.at(104);
        let format = byte & 0x7f;
        if usize::from(format) < FORMATS.len() {
            return Ok((format, byte & 0x80 != 0));
        }
        Err(Fault::invalid(Place::Byte(104), "the point format must be 0 to 10", format))
    }

    fn scale(&self) -> Result<[f64; 3], Fault> {
        let scale = [131, 139, 147].map(|at| (at, f64::from_le_bytes(self.at(at))));
        match scale.iter().find(|(_, value)| !value.is_finite() || *value == 0.0) {
            None => Ok(scale.map(|(_, value)| value)),
            Some(&(at, value)) => {
                let what = "the scale of a coordinate must be a finite number other than 0";
                Err(Fault::invalid(Place::Byte(at as u64), what, value))
            }
        }
    }

    fn offset(&self) -> Result<[f64; 3], Fault> {
        let offset = [155, 163, 171].map(|at| (at, f64::from_le_bytes(self.at(at))));
        match offset.iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(offset.map(|(_, value)| value)),
            Some(&(at, value)) => {
                let what = "the offset of a coordinate must be a finite number";
                Err(Fault::invalid(Place::Byte(at as u64), what, value))
            }
        }
    }
}

/// `N` bytes of a record or header; zeros where it has none.
#[inline]
pub(super) fn field<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    bytes.get(at..).and_then(|bytes| bytes.first_chunk()).copied().unwrap_or([0; N])
}
