/*!
The header of a brick file and its tables, as bytes and back; `docs/bricks.md` has the layout.

All numbers are little-endian. Nothing is taken from a header before its checksum was found to be
right, and no memory is asked for that the length of the file does not account for.
*/

use super::{
    shape::Shape,
    sums::{self, RUN},
};
use glam::{DVec3, Vec3};
use puncta_core::{Aabb, Bounds, Brick};

/// What a file starts with: no text, and altered by whatever changes the ends of lines.
pub(crate) const MAGIC: [u8; 8] = *b"\x89BRICKS\n";

/// The version that is written and read.
const VERSION: u32 = 1;

/// Sections start at multiples of this; the header is as long.
pub(crate) const PAGE: u64 = PAGE_BYTES as u64;

/// The same number.
pub(crate) const PAGE_BYTES: usize = 4096;

/// The bytes of the header.
pub(crate) type HeaderBytes = [u8; PAGE_BYTES];

/// The bytes of a brick in the table and of its code.
const BRICK_BYTES: u64 = 40;

/// The least bytes of a scalar in the tables: its range and the length of its name.
const SCALAR_BYTES: u64 = 18;

/// What is wrong at a place of a file.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) byte: u64,
    pub(crate) what: String,
    pub(crate) value: String,
}

pub(crate) fn fault(byte: u64, what: impl Into<String>, value: impl ToString) -> Fault {
    Fault { byte, what: what.into(), value: value.to_string() }
}

/// The first page of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Header {
    pub(crate) file_bytes: u64,
    pub(crate) records: u64,
    pub(crate) bricks: u64,
    pub(crate) scalars: u32,
    pub(crate) colors: bool,
    pub(crate) elements: bool,
    pub(crate) origin: DVec3,
    pub(crate) dims: [u32; 3],
    pub(crate) corner: Vec3,
    pub(crate) scale: f32,
    pub(crate) bounds: Aabb,
    pub(crate) block_bits: u32,
    pub(crate) inner: Bounds,
    pub(crate) outer: Bounds,
    pub(crate) tables_start: u64,
    pub(crate) tables_bytes: u64,
    pub(crate) tables_sum: u32,
}

/// What stands behind the records and their columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tables {
    /// The ranges of the coordinates and of the scalars.
    pub(crate) ranges: Vec<[f64; 2]>,
    pub(crate) names: Vec<String>,
    pub(crate) bricks: Vec<Brick>,
    pub(crate) codes: Vec<u32>,
    /// The sums of each section.
    pub(crate) sums: Vec<Vec<u32>>,
}

/// A column in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Section {
    pub(crate) start: u64,
    pub(crate) bytes: u64,
    /// The bytes to the next section.
    pub(crate) padded: u64,
}

impl Section {
    pub(crate) fn end(&self) -> u64 {
        self.start + self.padded
    }

    /// How many sums it has.
    pub(crate) fn sums(&self) -> u64 {
        self.padded.div_ceil(RUN)
    }
}

/// Where the columns of this many records lie. The numbers are far from the end of what `u64`
/// holds.
pub(crate) fn sections(records: u64, shape: &Shape) -> Vec<Section> {
    let mut start = PAGE;
    let section = |width| {
        let bytes = records * width as u64;
        let section = Section { start, bytes, padded: bytes.next_multiple_of(PAGE) };
        start = section.end();
        section
    };
    shape.widths().into_iter().map(section).collect()
}

impl Header {
    pub(crate) fn encode(&self) -> HeaderBytes {
        let mut all = Vec::from(MAGIC);
        put(&mut all, [VERSION, u32::try_from(PAGE).unwrap_or(0)].map(u32::to_le_bytes));
        put(&mut all, [self.file_bytes, self.records, self.bricks].map(u64::to_le_bytes));
        let columns = u32::from(self.colors) | u32::from(self.elements) << 1;
        put(&mut all, [self.scalars, columns].map(u32::to_le_bytes));
        put(&mut all, self.origin.to_array().map(f64::to_le_bytes));
        put(&mut all, self.dims.map(u32::to_le_bytes));
        put(&mut all, self.corner.to_array().map(f32::to_le_bytes));
        put(&mut all, [self.scale.to_le_bytes()]);
        put(&mut all, [self.bounds.min, self.bounds.max].floats());
        put(&mut all, [self.block_bits.to_le_bytes()]);
        for corner in [self.inner.min, self.inner.max, self.outer.min, self.outer.max] {
            put(&mut all, corner.to_array().map(f64::to_le_bytes));
        }
        put(&mut all, [self.tables_start, self.tables_bytes].map(u64::to_le_bytes));
        put(&mut all, [self.tables_sum.to_le_bytes()]);
        let mut page = [0; PAGE_BYTES];
        page[..all.len()].copy_from_slice(&all);
        let end = page.len() - 4;
        let sum = sums::sum(&page[..end]);
        page[end..].copy_from_slice(&sum.to_le_bytes());
        page
    }

    /// Reads a header; that the lengths agree is found out here, too.
    pub(crate) fn decode(page: &HeaderBytes, length: u64) -> Result<Self, Fault> {
        let mut cursor = Cursor { bytes: page, at: 0, start: 0 };
        let magic: [u8; 8] = cursor.take()?;
        if magic != MAGIC {
            let what = format!("a brick file must start with \"{}\"", MAGIC.escape_ascii());
            return Err(fault(0, what, format!("\"{}\"", magic.escape_ascii())));
        }
        let [body @ .., a, b, c, d] = page;
        let (stored, found) = (u32::from_le_bytes([*a, *b, *c, *d]), sums::sum(body));
        let version = cursor.u32()?;
        // Another version may have its sum elsewhere.
        if version != VERSION {
            return Err(fault(8, format!("the version must be {VERSION}"), version));
        }
        if stored != found {
            let what = format!("the checksum of the header must be {found:#010x}");
            return Err(fault(PAGE - 4, what, format!("{stored:#010x}")));
        }
        let page_bytes = cursor.u32()?;
        if u64::from(page_bytes) != PAGE {
            return Err(fault(12, format!("a page must have {PAGE} bytes"), page_bytes));
        }
        let (file_bytes, records, bricks) = (cursor.u64()?, cursor.u64()?, cursor.u64()?);
        let (scalars, columns) = (cursor.u32()?, cursor.u32()?);
        if columns > 3 {
            return Err(fault(44, "the columns must be 0 to 3", columns));
        }
        let header = Self {
            file_bytes,
            records,
            bricks,
            scalars,
            colors: columns & 1 != 0,
            elements: columns & 2 != 0,
            origin: DVec3::from_array(cursor.f64s()?),
            dims: [cursor.u32()?, cursor.u32()?, cursor.u32()?],
            corner: Vec3::from_array(cursor.f32s()?),
            scale: cursor.f32s::<1>()?[0],
            bounds: cursor.aabb()?,
            block_bits: cursor.u32()?,
            inner: cursor.bounds()?,
            outer: cursor.bounds()?,
            tables_start: cursor.u64()?,
            tables_bytes: cursor.u64()?,
            tables_sum: cursor.u32()?,
        };
        header.check_lengths(length)?;
        Ok(header)
    }

    /// Checks that the numbers of things agree with the length of the file.
    fn check_lengths(&self, length: u64) -> Result<(), Fault> {
        if self.file_bytes != length {
            let what = format!("the header says that the file has {} bytes", self.file_bytes);
            return Err(fault(16, what, length));
        }
        let records = u64::try_from(puncta_core::MAX_RECORDS).unwrap_or(u64::MAX);
        if self.records > records {
            let what = format!("the number of records must be at most {records}");
            return Err(fault(24, what, self.records));
        }
        if self.tables_start.checked_add(self.tables_bytes) != Some(length) {
            let what = format!("the tables at {} must reach to the end", self.tables_start);
            return Err(fault(232, what, format!("{} bytes", self.tables_bytes)));
        }
        if self.bricks > self.records || self.bricks > self.tables_bytes / BRICK_BYTES {
            let what = "there must be no more bricks than records and room in the tables";
            return Err(fault(32, what, self.bricks));
        }
        if u64::from(self.scalars) > self.tables_bytes / SCALAR_BYTES {
            return Err(fault(40, "there must be room for the scalars' names", self.scalars));
        }
        Ok(())
    }
}

impl Tables {
    pub(crate) fn encode(&self) -> Vec<u8> {
        let mut all = Vec::with_capacity(self.bricks.len() * 40 + 4096);
        put(&mut all, self.ranges.as_flattened().iter().map(|x| x.to_le_bytes()));
        for name in &self.names {
            put(&mut all, [u16::try_from(name.len()).unwrap_or(u16::MAX).to_le_bytes()]);
            all.extend_from_slice(name.as_bytes());
        }
        for brick in &self.bricks {
            put(&mut all, [(brick.records.end - brick.records.start).to_le_bytes()]);
            put(&mut all, [brick.bounds.min, brick.bounds.max].floats());
            put(&mut all, [brick.radius_max, brick.density].map(f32::to_le_bytes));
        }
        put(&mut all, self.codes.iter().map(|code| code.to_le_bytes()));
        put(&mut all, self.sums.iter().flatten().map(|sum| sum.to_le_bytes()));
        all
    }

    /// Reads the tables; `bytes` are as many as the header says.
    pub(crate) fn decode(header: &Header, bytes: &[u8]) -> Result<Self, Fault> {
        let mut cursor = Cursor { bytes, at: 0, start: header.tables_start };
        let mut tables = Self::default();
        for _ in 0..3 + u64::from(header.scalars) {
            tables.ranges.push(cursor.f64s()?);
        }
        for _ in 0..header.scalars {
            tables.names.push(cursor.name()?);
        }
        let mut next = 0_u32;
        for _ in 0..header.bricks {
            let byte = cursor.byte();
            let count = cursor.u32()?;
            let end = next.checked_add(count).filter(|&end| end > next);
            let end = end.filter(|&end| u64::from(end) <= header.records).ok_or_else(|| {
                let what =
                    format!("a brick must have 1 to {} records", header.records - u64::from(next));
                fault(byte, what, count)
            })?;
            let bounds = cursor.aabb()?;
            let [radius_max, density] = cursor.f32s()?;
            tables.bricks.push(Brick { records: next..end, bounds, radius_max, density });
            next = end;
        }
        if u64::from(next) != header.records {
            let what = format!("the bricks must have {} records", header.records);
            return Err(fault(cursor.byte(), what, next));
        }
        for _ in 0..header.bricks {
            tables.codes.push(cursor.u32()?);
        }
        let names = tables.names.clone();
        let shape = Shape { colors: header.colors, elements: header.elements, scalars: names };
        let sections = sections(header.records, &shape);
        let end = sections.last().map_or(PAGE, Section::end);
        if end != header.tables_start {
            let what = format!("the tables must start at {end}");
            return Err(fault(224, what, header.tables_start));
        }
        for section in sections {
            let sums = (0..section.sums()).map(|_| cursor.u32());
            tables.sums.push(sums.collect::<Result<_, _>>()?);
        }
        if cursor.at < bytes.len() {
            let left = bytes.len() - cursor.at;
            return Err(fault(cursor.byte(), "the tables must end", format!("{left} bytes more")));
        }
        Ok(tables)
    }
}

/// Appends some numbers.
fn put<const N: usize>(all: &mut Vec<u8>, numbers: impl IntoIterator<Item = [u8; N]>) {
    numbers.into_iter().for_each(|number| all.extend_from_slice(&number));
}

/// The numbers of two corners.
trait Corners {
    fn floats(self) -> impl Iterator<Item = [u8; 4]>;
}

impl Corners for [Vec3; 2] {
    fn floats(self) -> impl Iterator<Item = [u8; 4]> {
        self.into_iter().flat_map(|corner| corner.to_array().map(f32::to_le_bytes))
    }
}

/// Bytes that are read from the first to the last.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the bytes lie in the file.
    start: u64,
}

impl Cursor<'_> {
    /// The place in the file.
    fn byte(&self) -> u64 {
        self.start + self.at as u64
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let left = &self.bytes[self.at..];
        let Some(found) = left.first_chunk() else {
            let what = format!("there must be {N} bytes more");
            return Err(fault(self.byte(), what, left.len()));
        };
        self.at += N;
        Ok(*found)
    }

    fn u32(&mut self) -> Result<u32, Fault> {
        self.take().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Result<u64, Fault> {
        self.take().map(u64::from_le_bytes)
    }

    fn f32s<const N: usize>(&mut self) -> Result<[f32; N], Fault> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f32::from_le_bytes(self.take()?);
        }
        Ok(numbers)
    }

    fn f64s<const N: usize>(&mut self) -> Result<[f64; N], Fault> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f64::from_le_bytes(self.take()?);
        }
        Ok(numbers)
    }

    fn aabb(&mut self) -> Result<Aabb, Fault> {
        let [min, max] = [self.f32s()?, self.f32s()?].map(Vec3::from_array);
        Ok(Aabb { min, max })
    }

    fn bounds(&mut self) -> Result<Bounds, Fault> {
        let [min, max] = [self.f64s()?, self.f64s()?].map(DVec3::from_array);
        Ok(Bounds { min, max })
    }

    fn name(&mut self) -> Result<String, Fault> {
        let length = usize::from(u16::from_le_bytes(self.take()?));
        let (byte, left) = (self.byte(), &self.bytes[self.at..]);
        let Some(name) = left.get(..length) else {
            let what = format!("there must be a name of {length} bytes");
            return Err(fault(byte, what, left.len()));
        };
        self.at += length;
        let name = str::from_utf8(name);
        let name = name.map_err(|error| fault(byte, "a name must be UTF-8", error))?;
        Ok(name.to_owned())
    }
}
