//! The header of a file, and the place of a frame in its seek table.

use crate::{
    error::{ErrorKind, Fault, Place, quote},
    input::Input,
};

/// What a file starts with.
pub(super) const MAGIC: &[u8; 6] = b"MMPLD\0";

/// How many bytes stand before the seek table.
pub(super) const HEADER_BYTES: u64 = 60;

/// The header of a file and the place of one frame.
#[derive(Clone, Debug)]
pub(super) struct FileHeader {
    /// 100 times the major plus the minor version.
    pub(super) version: u16,
    /// The box of the data: the least coordinates, then the largest.
    pub(super) bounds: [f32; 6],
    /// The index of the frame.
    pub(super) frame: u64,
    /// Its first byte.
    pub(super) start: u64,
    /// The byte after its last one.
    pub(super) end: u64,
}

impl FileHeader {
    /// Reads the header and the seek table.
    pub(super) fn read(input: &mut Input<'_>, frame: u64) -> Result<Self, Fault> {
        const WHAT: &str = "the header";
        let magic: [u8; 6] = input.array(WHAT)?;
        if &magic != MAGIC {
            let what = "the file must start with \"MMPLD\\x00\"";
            return Err(Fault::invalid(Place::Byte(0), what, quote(&magic)));
        }
        let place = input.at_byte();
        let version = u16::from_le_bytes(input.array(WHAT)?);
        if version == 0 {
            let what = "the version must be 100 to 103 (0 marks a file not written to its end)";
            return Err(Fault::invalid(place, what, version));
        }
        if !(100..=103).contains(&version) {
            return Err(Fault::invalid(place, "the version must be 100 to 103", version));
        }
        let frames = u32::from_le_bytes(input.array(WHAT)?);
        let bounds = floats(&input.array(WHAT)?);
        input.skip(24, WHAT)?;
        let (start, end) = find_frame(input, frames, frame)?;
        Ok(Self { version, bounds, frame, start, end })
    }
}

/// Reads the seek table, checks it and returns where a frame starts and ends.
fn find_frame(input: &mut Input<'_>, frames: u32, frame: u64) -> Result<(u64, u64), Fault> {
    let table_bytes = 8 * (u64::from(frames) + 1);
    input.require(table_bytes, "the seek table")?;
    let file_bytes = input.remaining().map_or(u64::MAX, |left| HEADER_BYTES + left);
    let (mut found, mut least) = ((0, 0), HEADER_BYTES + table_bytes);
    for index in 0..=u64::from(frames) {
        let place = input.at_byte();
        let offset = u64::from_le_bytes(input.array("the seek table")?);
        let name = || match index < u64::from(frames) {
            true => format!("the offset of frame {index}"),
            false => "the end of the last frame".to_owned(),
        };
        if offset < least {
            return Err(Fault::invalid(
                place,
                format!("{} must be {least} or more", name()),
                offset,
            ));
        }
        if offset > file_bytes {
            let what = format!("{} must be at most the {file_bytes} bytes of the file", name());
            return Err(Fault::invalid(place, what, offset));
        }
        match index {
            _ if index == frame => found.0 = offset,
            _ if Some(index) == frame.checked_add(1) => found.1 = offset,
            _ => {}
        }
        // A frame has at least one byte.
        least = offset.saturating_add(1);
    }
    if frame >= u64::from(frames) {
        return Err(ErrorKind::NoSuchFrame { frame, frames: u64::from(frames) }.into());
    }
    Ok(found)
}

/// Six numbers: a box.
pub(super) fn floats(bytes: &[u8; 24]) -> [f32; 6] {
    let mut floats = [0.0; 6];
    for (float, bytes) in floats.iter_mut().zip(bytes.chunks_exact(4)) {
        let mut number = [0; 4];
        number.copy_from_slice(bytes);
        *float = f32::from_le_bytes(number);
    }
    floats
}
