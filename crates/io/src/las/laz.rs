/*!
LAZ: point records, compressed with an arithmetic coder.

A variable length record says how the points are compressed. They come in chunks, each of which
starts with a raw record. In formats 0 to 5 the coded bytes of the other points follow; in formats 6
to 10 there follow the sizes of layers, then the layers, one for each group of fields. A table
behind the chunks, whose place stands in front of them, has the bytes of each chunk, and its points
if the chunks vary in size.

# Hazards

The decoder trusts what it reads. So checked here are: the kind of compression and its items against
the point format; the sizes of the layers, which the decoder allocates, against the file; the table
of chunks against the file and the number of points; and after each chunk that the decoder stands
where the table says that the chunk ends, which tells most damage. The decoder's own way through the
chunks is not taken, since it guesses where the points start if the table is damaged.

The number of points cannot be confirmed before they are decoded: equal points take almost no bytes.
Room is made for them only if there are no more than bytes, and more than `POINTS_FREE` and
`POINTS_PER_BYTE` for each byte are refused. (Scans take two bytes or more for a point.)

Damaged bytes can still make the decoder panic. As a last net the panic is caught and made an error;
a message of the panic hook may go to the error output.
*/

use super::{
    chunks::{Chunks, OFFSET_BYTES},
    header::{Header, field},
};
use crate::{
    ReadOptions,
    error::{ErrorKind, Fault, Place},
};
use laz::{
    DecompressionSelection, LazItemRecordBuilder, LazItemType, LazVlr,
    record::{
        LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
    },
};
use std::{
    fmt,
    io::{Read, Seek, SeekFrom},
    panic::{AssertUnwindSafe, catch_unwind},
};

/// How many points a file may have whatever its size, and how many more for each of its bytes.
const POINTS_FREE: u64 = 1 << 20;
const POINTS_PER_BYTE: u64 = 64;

/// The largest number of extra bytes in a record: the decoder takes some 10 KB for each.
const EXTRA_BYTES_MAX: u64 = 4096;

/// The bytes of a variable length record before its data.
const RECORD_HEADER: usize = 54;

/// How the points are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Compression {
    /// All in one chunk, without a table.
    Whole,
    /// In chunks of points.
    Chunks,
    /// In chunks of layers.
    Layers,
}

/// What decodes the points of a file, one after another.
pub(super) struct Decoder<'a, R> {
    records: Box<dyn RecordDecompressor<R> + 'a>,
    vlr: LazVlr,
    compression: Compression,
    /// The fields to decode, where they are layers.
    selection: DecompressionSelection,
    length: u64,
    record_bytes: usize,
    count: u64,
    chunks: Chunks,
    /// The number of the chunk to come.
    next: usize,
    /// The present chunk: where it starts and, if that is known, ends, and its points to come.
    start: u64,
    end: Option<u64>,
    left: u64,
}

impl<'a, R: Read + Seek + 'a> Decoder<'a, R> {
    pub(super) fn new(
        mut stream: R,
        length: u64,
        header: &Header,
        options: &ReadOptions,
    ) -> Result<Self, Fault> {
        let points_start = header.points_start;
        let (vlr, compression) = read_record(&mut stream, header)?;
        let bytes = length.saturating_sub(points_start);
        let most = POINTS_FREE.saturating_add(bytes.saturating_mul(POINTS_PER_BYTE));
        if header.count > most {
            let what = format!("the points in {bytes} compressed bytes must be at most {most}");
            return Err(Fault::invalid(Place::Byte(points_start), what, header.count));
        }
        let (chunks, start) = match compression {
            Compression::Whole => (Chunks::whole(header.count), points_start),
            _ => (Chunks::read(&mut stream, length, header, &vlr)?, points_start + OFFSET_BYTES),
        };
        stream.seek(SeekFrom::Start(start))?;
        let records: Box<dyn RecordDecompressor<R> + 'a> = match compression {
            Compression::Layers => Box::new(LayeredPointRecordDecompressor::new(stream)),
            _ => Box::new(SequentialPointRecordDecompressor::new(stream)),
        };
        Ok(Self {
            records,
            vlr,
            compression,
            selection: select(options),
            length,
            record_bytes: usize::try_from(header.record_bytes).unwrap_or(usize::MAX),
            count: header.count,
            chunks,
            next: 0,
            start,
            end: None,
            left: 0,
        })
    }

    /// For how many points room may be made before they are decoded.
    pub(super) fn count_to_reserve(&self) -> u64 {
        self.count.min(self.length)
    }

    /// What is odd about the file.
    pub(super) fn warning(&self) -> Option<String> {
        self.chunks.warning()
    }

    /// Decodes as many points as `block` holds; returns the byte at which the last chunk of them
    /// starts.
    pub(super) fn fill(&mut self, block: &mut [u8]) -> Result<u64, Fault> {
        guard(self.start, || self.decode(block))?;
        Ok(self.start)
    }

    fn decode(&mut self, block: &mut [u8]) -> Result<(), Fault> {
        let mut block = block;
        while !block.is_empty() {
            if self.left == 0 {
                self.enter_chunk()?;
            }
            let records = usize::try_from(self.left).unwrap_or(usize::MAX);
            let bytes = records.saturating_mul(self.record_bytes).min(block.len());
            let (now, later) = block.split_at_mut(bytes);
            for record in now.chunks_exact_mut(self.record_bytes) {
                self.records.decompress_next(record).map_err(|error| failure(self.start, error))?;
                self.left -= 1;
            }
            block = later;
            if self.left == 0 {
                self.leave_chunk()?;
            }
        }
        Ok(())
    }

    /// Gets ready for the next chunk that is not empty.
    fn enter_chunk(&mut self) -> Result<(), Fault> {
        let mut chunk = self.chunks.get(self.next);
        while chunk.is_some_and(|chunk| chunk.points == 0) {
            self.next += 1;
            chunk = self.chunks.get(self.next);
        }
        let chunk = chunk.ok_or_else(|| failure(self.start, "there are too few chunks"))?;
        self.next += 1;
        (self.left, self.end) = (chunk.points, chunk.end);
        self.start = self.records.get_mut().stream_position()?;
        if self.compression == Compression::Layers {
            self.check_layers()?;
        }
        self.records.reset();
        self.records
            .set_fields_from(self.vlr.items())
            .map_err(|error| failure(self.start, error))?;
        self.records.set_selection(self.selection);
        Ok(())
    }

    /// Checks that the decoder stands at the end of the present chunk.
    fn leave_chunk(&mut self) -> Result<(), Fault> {
        let here = self.records.get_mut().stream_position()?;
        match self.end {
            Some(end) if end != here => {
                let what = format!("the points of a chunk must end at byte {end}");
                Err(Fault::invalid(Place::Byte(self.start), what, here))
            }
            _ => Ok(()),
        }
    }

    /// Checks that the layers of the chunk to come lie in the file: the decoder allocates them.
    fn check_layers(&mut self) -> Result<(), Fault> {
        let sizes_start = self.start + self.record_bytes as u64 + 4;
        let layers: u64 = self.vlr.items().iter().map(|item| layers(item.item_type())).sum();
        let stream = self.records.get_mut();
        stream.seek(SeekFrom::Start(sizes_start))?;
        let mut needed = 0;
        for _ in 0..layers {
            let mut size = [0; 4];
            stream.read_exact(&mut size).map_err(|error| failure(sizes_start, error))?;
            needed += u64::from(u32::from_le_bytes(size));
        }
        stream.seek(SeekFrom::Start(self.start))?;
        let left = self.length.saturating_sub(sizes_start + 4 * layers);
        if needed <= left {
            return Ok(());
        }
        let kind = ErrorKind::Truncated { what: "the layers of a chunk".into(), needed, left };
        Err(Fault { place: Some(Place::Byte(sizes_start)), kind })
    }
}

/// The fields that are kept. (The return number comes with x and y.)
fn select(options: &ReadOptions) -> DecompressionSelection {
    type Select = fn(DecompressionSelection) -> DecompressionSelection;
    let fields: [(&str, Select); 4] = [
        ("intensity", DecompressionSelection::decompress_intensity),
        ("classification", DecompressionSelection::decompress_classification),
        ("scan_angle", DecompressionSelection::decompress_scan_angle),
        ("point_source", DecompressionSelection::decompress_point_source_id),
    ];
    let wanted = fields.into_iter().filter(|(name, _)| options.wants(name));
    let always = DecompressionSelection::base().decompress_z().decompress_rgb();
    wanted.fold(always, |selection, (_, select)| select(selection))
}

/// Finds the variable length record of LAZ and checks it against the point format.
fn read_record(
    stream: &mut (impl Read + Seek),
    header: &Header,
) -> Result<(LazVlr, Compression), Fault> {
    let mut at = header.header_bytes;
    for _ in 0..header.variable_records {
        if at + RECORD_HEADER as u64 > header.points_start {
            break;
        }
        let mut head = [0; RECORD_HEADER];
        stream.seek(SeekFrom::Start(at))?;
        stream.read_exact(&mut head)?;
        let bytes = u16::from_le_bytes(field(&head, 20));
        let is_laz = head[2..18].starts_with(LazVlr::USER_ID.as_bytes())
            && u16::from_le_bytes(field(&head, 18)) == LazVlr::RECORD_ID;
        at += RECORD_HEADER as u64;
        if is_laz && at + u64::from(bytes) > header.points_start {
            let what = format!("the record of LAZ must end before byte {}", header.points_start);
            return Err(Fault::invalid(Place::Byte(at), what, at + u64::from(bytes)));
        }
        if is_laz {
            let mut data = vec![0; usize::from(bytes)];
            stream.read_exact(&mut data)?;
            return check_record(&data, at, header);
        }
        at += u64::from(bytes);
    }
    let what = "a file of compressed points must have a record \"laszip encoded\"";
    Err(Fault::invalid(Place::Byte(header.header_bytes), what, "none"))
}

/// Checks the record of LAZ at byte `at`.
fn check_record(data: &[u8], at: u64, header: &Header) -> Result<(LazVlr, Compression), Fault> {
    let vlr = LazVlr::from_buffer(data).map_err(|error| failure(at, error))?;
    let compression = match (u16::from_le_bytes(field(data, 0)), header.is_extended()) {
        (1, false) => Compression::Whole,
        (2, false) => Compression::Chunks,
        (3, true) => Compression::Layers,
        (other, _) => {
            let what = format!("the compression must fit point format {}", header.format);
            return Err(Fault::invalid(Place::Byte(at), what, other));
        }
    };
    let coder = u16::from_le_bytes(field(data, 2));
    if coder != 0 {
        return Err(Fault::invalid(Place::Byte(at + 2), "the coder must be 0", coder));
    }
    if header.extra_bytes > EXTRA_BYTES_MAX {
        let what = format!("extra bytes of compressed points must be at most {EXTRA_BYTES_MAX}");
        return Err(Fault::invalid(Place::Byte(105), what, header.extra_bytes));
    }
    let extra_bytes = u16::try_from(header.extra_bytes).unwrap_or(u16::MAX);
    let expected = LazItemRecordBuilder::default_for_point_format_id(header.format, extra_bytes)
        .map_err(|error| failure(at, error))?;
    let versions = if header.is_extended() { 3..=4 } else { 1..=2 };
    let fits = expected.len() == vlr.items().len()
        && expected.iter().zip(vlr.items()).all(|(expected, item)| {
            expected.item_type() == item.item_type()
                && expected.size() == item.size()
                && versions.contains(&item.version())
        });
    if !fits {
        let items = vlr.items().iter().map(|item| (item.item_type(), item.version()));
        let what = format!("the compressed items must be those of point format {}", header.format);
        return Err(Fault::invalid(Place::Byte(at + 32), what, Items(items.collect())));
    }
    Ok((vlr, compression))
}

/// The types and versions of items, for messages.
struct Items(Vec<(LazItemType, u16)>);

impl fmt::Display for Items {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, f)
    }
}

/// How many layers an item has.
fn layers(item: LazItemType) -> u64 {
    match item {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(bytes) => u64::from(bytes),
        _ => 1,
    }
}

/// Calls what may panic on damaged bytes, and makes the panic an error.
///
/// What `decode` holds must not be used any more after an error.
pub(super) fn guard<T>(at: u64, decode: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().copied();
        let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
        Err(failure(at, text.unwrap_or("unknown panic")))
    })
}

/// What went wrong in the decoder.
pub(super) fn failure(at: u64, error: impl fmt::Display) -> Fault {
    let kind = ErrorKind::Decoder(format!("the LAZ decoder failed: {error}"));
    Fault { place: Some(Place::Byte(at)), kind }
}
