/*!
The chunks of a LAZ file: how many points each has, and where it ends.

In front of the chunks stands the place of a table of them; a writer that cannot go back puts that
place at the end of the file. The table is needed where chunks vary in size. Where all have the same
number of points it only serves to check them, so a damaged table is a warning there.
*/

use super::{
    header::{Header, field},
    laz::{failure, guard},
};
use crate::error::{Fault, Place};
use laz::{LazVlr, laszip::ChunkTable};
use std::io::{Read, Seek, SeekFrom};

/// The bytes of the place of the table.
pub(super) const OFFSET_BYTES: u64 = ChunkTable::OFFSET_SIZE as u64;

/// A chunk of points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk {
    pub(super) points: u64,
    /// The byte behind it, if that is known.
    pub(super) end: Option<u64>,
}

/// The chunks of a file.
pub(super) enum Chunks {
    /// Chunks of `size` points, but for the last one.
    Fixed {
        size: u64,
        count: u64,
        /// The ends of the chunks, or why they are not known.
        ends: Result<Vec<u64>, Option<String>>,
    },
    /// Chunks of any size: their points and ends.
    Variable(Vec<(u64, u64)>),
}

impl Chunks {
    /// One chunk of all points.
    pub(super) fn whole(count: u64) -> Self {
        Self::Fixed { size: count, count, ends: Err(None) }
    }

    /// Reads the table of chunks and checks it.
    pub(super) fn read(
        stream: &mut (impl Read + Seek),
        length: u64,
        header: &Header,
        vlr: &LazVlr,
    ) -> Result<Self, Fault> {
        let is_variable = vlr.uses_variable_size_chunks();
        let table = find_table(stream, length, header).and_then(|start| {
            stream.seek(SeekFrom::Start(start))?;
            let mut read = || ChunkTable::read(stream, is_variable);
            let table = guard(start, || read().map_err(|error| failure(start, error)))?;
            check_table(&table, start, header).map(|ends| (start, table, ends))
        });
        if is_variable {
            let (start, table, ends) = table?;
            let points = table.as_ref().iter().map(|entry| low_bits(entry.point_count));
            let total: u64 = points.clone().sum();
            if total == header.count {
                return Ok(Self::Variable(points.zip(ends).collect()));
            }
            let what = format!("the chunks must have all {} points", header.count);
            return Err(Fault::invalid(Place::Byte(start), what, total));
        }
        let (size, count) = (u64::from(vlr.chunk_size()), header.count);
        let ends = match table {
            Ok((_, _, ends)) if ends.len() as u64 == count.div_ceil(size) => Ok(ends),
            Ok((_, _, ends)) => Err(Some(format!("it has {} chunks", ends.len()))),
            Err(fault) => Err(Some(fault.kind.to_string())),
        };
        Ok(Self::Fixed { size, count, ends })
    }

    /// The chunk of this number.
    pub(super) fn get(&self, index: usize) -> Option<Chunk> {
        match self {
            Self::Variable(chunks) => {
                let &(points, end) = chunks.get(index)?;
                Some(Chunk { points, end: Some(end) })
            }
            Self::Fixed { size, count, ends } => {
                let left = count.checked_sub(size.checked_mul(index as u64)?)?;
                let end = ends.as_ref().ok().and_then(|ends| ends.get(index).copied());
                (left > 0).then_some(Chunk { points: left.min(*size), end })
            }
        }
    }

    /// What is odd about the table.
    pub(super) fn warning(&self) -> Option<String> {
        match self {
            Self::Fixed { ends: Err(Some(reason)), .. } => {
                Some(format!("the table of chunks is damaged and not used: {reason}"))
            }
            _ => None,
        }
    }
}

/// The byte at which the table starts, once its number of chunks is known to be sound.
fn find_table(stream: &mut (impl Read + Seek), length: u64, header: &Header) -> Result<u64, Fault> {
    let (offset, last) = (header.points_start, length.saturating_sub(OFFSET_BYTES));
    let chunks_start = offset + OFFSET_BYTES;
    let mut found = 0;
    for at in [offset, last] {
        let mut bytes = [0; 8];
        stream.seek(SeekFrom::Start(at))?;
        stream.read_exact(&mut bytes).map_err(|error| failure(at, error))?;
        found = u64::from_le_bytes(bytes);
        if (chunks_start..=last).contains(&found) {
            break;
        }
    }
    if !(chunks_start..=last).contains(&found) {
        let what = format!("the table of chunks must start at byte {chunks_start} to {last}");
        return Err(Fault::invalid(Place::Byte(offset), what, found));
    }
    let mut head = [0; 8];
    stream.seek(SeekFrom::Start(found))?;
    stream.read_exact(&mut head).map_err(|error| failure(found, error))?;
    let chunks = u64::from(u32::from_le_bytes(field(&head, 4)));
    // Each chunk starts with a raw record.
    let most = (found - chunks_start) / header.record_bytes;
    if chunks > most {
        let what = format!("the table must have at most {most} chunks");
        return Err(Fault::invalid(Place::Byte(found + 4), what, chunks));
    }
    Ok(found)
}

/// The ends of the chunks, the last of which must be the start of the table.
fn check_table(table: &ChunkTable, start: u64, header: &Header) -> Result<Vec<u64>, Fault> {
    let mut end = header.points_start + OFFSET_BYTES;
    let ends = table.as_ref().iter().map(|entry| {
        end += low_bits(entry.byte_count);
        end
    });
    let ends: Vec<u64> = ends.collect();
    if end == start {
        return Ok(ends);
    }
    let what = format!("the chunks must end at byte {start}, where their table starts");
    Err(Fault::invalid(Place::Byte(start), what, end))
}

/// The number in a table, which has 32 bits, without the extension of its sign.
const fn low_bits(number: u64) -> u64 {
    number & 0xffff_ffff
}
