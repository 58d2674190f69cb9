/*!
LAS and LAZ: the points of laser scans.

A LAS file is a header, variable length records (of projections and the like, which are passed
over), and point records of equal length in one of eleven formats. Read are versions 1.0 to 1.4 with
all formats, and LAZ, in which a decoder restores the very same point records.

Kept are positions, colors where the format has them, and the scalars `intensity`, `classification`,
`return_number`, `scan_angle` (in degrees) and `point_source`. The time of the points is left out:
it needs the digits of an `f64`. Points that are marked as withheld are kept as well. There is one
frame, and no radius.

Hazards: colors of 8 bits in fields of 16 (see `points`), counts and offsets that are wrong, and
LAZ, where nothing but the decoder can tell whether bytes are sound (see `laz`). A box in the header
that does not hold the points is a warning.

The header and the point records are decoded here, and compressed chunks by the crate `laz`, the
decoder beneath the crate `las`. That crate itself does not fit: its reader needs a stream that lives
forever, it makes a struct of all attributes for each point, and it trusts the counts of the header.
It writes the files of the tests.

Source: LAS Specification 1.4 R15, ASPRS 2019.
*/

mod chunks;
mod header;
mod laz;
mod points;
#[cfg(test)]
mod tests;

use self::{header::Header, points::Points};
use crate::{
    ReadOptions,
    builder::Report,
    error::{ErrorKind, Fault, Place},
};
use puncta_core::Scene;
use std::io::{Read, Seek, SeekFrom};

/// How many bytes of point records are read or decoded at a time.
const BLOCK_BYTES: u64 = 1 << 16;

/// Reads the points of a stream of `length` bytes.
pub(crate) fn read(
    mut stream: impl Read + Seek + Send + Sync,
    length: u64,
    options: &ReadOptions,
) -> Result<(Scene, Report), Fault> {
    if options.frame > 0 {
        return Err(ErrorKind::NoSuchFrame { frame: options.frame, frames: 1 }.into());
    }
    let header = Header::read(&mut stream, length)?;
    let mut points;
    if header.compressed {
        let mut decoder = laz::Decoder::new(stream, length, &header, options)?;
        points = Points::new(options, &header, decoder.count_to_reserve())?;
        decoder.warning().into_iter().for_each(|warning| points.warn(warning));
        read_blocks(&header, &mut points, |block| Ok((decoder.fill(block)?, 0)))?;
    } else {
        require(&header, length)?;
        points = Points::new(options, &header, header.count)?;
        let mut start = header.points_start;
        stream.seek(SeekFrom::Start(start))?;
        read_blocks(&header, &mut points, |block| {
            let place = start;
            stream
                .read_exact(block)
                .map_err(|error| Fault { place: Some(Place::Byte(place)), kind: error.into() })?;
            start += block.len() as u64;
            Ok((place, header.record_bytes))
        })?;
    }
    if let Some(other) = header.other_count {
        let count = header.count;
        points.warn(format!("the older field for the number of points says {other}, not {count}"));
    }
    points.finish()
}

/// Checks that the file has as many bytes as its points need.
fn require(header: &Header, length: u64) -> Result<(), Fault> {
    let Header { count, record_bytes, points_start, .. } = *header;
    let (needed, left) = (count.saturating_mul(record_bytes), length.saturating_sub(points_start));
    if needed <= left {
        return Ok(());
    }
    let what = format!("its {count} points of {record_bytes} bytes");
    let kind = ErrorKind::Truncated { what, needed, left };
    Err(Fault { place: Some(Place::Byte(points_start)), kind })
}

/// Adds all points of the file block by block. `fill` fills a block with records; it returns the
/// place of the first one and the distance of the places.
fn read_blocks(
    header: &Header,
    points: &mut Points<'_>,
    mut fill: impl FnMut(&mut [u8]) -> Result<(u64, u64), Fault>,
) -> Result<(), Fault> {
    let record_bytes = usize::from(u16::try_from(header.record_bytes).unwrap_or(u16::MAX));
    let per_block = (BLOCK_BYTES / header.record_bytes).clamp(1, header.count.max(1));
    let mut block = vec![0; usize::try_from(per_block).unwrap_or(1) * record_bytes];
    let mut left = header.count;
    while left > 0 {
        let records = usize::try_from(left.min(per_block)).unwrap_or(1);
        let block = &mut block[..records * record_bytes];
        let places = fill(block)?;
        points.push(block, record_bytes, places)?;
        left -= records as u64;
    }
    Ok(())
}
