//! The conversion: what it is told, what it tells, and its steps in order.

use super::{
    arrange::Arranger,
    distribute::distribute,
    error::{ConvertError, Trouble},
    field::{Field, length, read_rows, write_at, write_rows},
    header::{Header, PAGE, Section, Tables, sections},
    keys::Keys,
    lattice::Lattice,
    parts::{Parts, Room},
    publish::Unborn,
    shape::{self, Shape},
    spill::Spill,
    sums::{self, Sums},
    survey::{Findings, Survey},
};
use crate::{
    GridConfig,
    leaf::{Bricks, How},
};
use glam::DVec3;
use puncta_core::{Scene, Source, Sphere};
use std::{
    ops::Range,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

/// How to make a brick file.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvertConfig {
    /// How to lay the grid.
    pub grid: GridConfig,
    /// The memory to use, in bytes; 2 GiB by default.
    ///
    /// Buffers keep to it, down to some 64 rows for each thread. The table of bricks, which is in
    /// memory to the end, comes on top: 45 bytes for each brick. So do a sample of up to a million
    /// records, and rows that share cell *and* id, if they are that many.
    pub memory: u64,
    /// What to do with records that no grid can hold.
    pub invalid: Invalid,
}

impl Default for ConvertConfig {
    fn default() -> Self {
        Self { grid: GridConfig::default(), memory: 2 << 30, invalid: Invalid::default() }
    }
}

/// What to do with a record whose position or radius is not finite, or whose radius is negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Invalid {
    /// To end with an error that names it.
    #[default]
    Refuse,
    /// To leave it out and to count it. The ids of the others stay what they are.
    Skip,
}

/// What a conversion does at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConvertStage {
    /// Records are taken from the source.
    Reading,
    /// Records are counted.
    Counting,
    /// Records are brought to their parts of the file.
    Distributing,
    /// The parts are sorted.
    Sorting,
    /// The file is brought to the disk.
    Finishing,
}

/// How far a conversion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConvertStep {
    /// What it does.
    pub stage: ConvertStage,
    /// The number of records it has done that with.
    pub done: u64,
    /// How many there are, if that is known.
    pub total: Option<u64>,
}

/// Called with each step, from any thread.
pub(crate) type Watch<'a> = dyn Fn(ConvertStep) + Sync + 'a;

/// What a brick file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConvertSummary {
    /// The number of records.
    pub records: u64,
    /// How many records were left out.
    pub skipped: u64,
    /// The number of bricks.
    pub bricks: u64,
    /// The length of the file in bytes.
    pub bytes: u64,
}

/// Sorts the records of a source into bricks, and writes them to a brick file.
///
/// The file appears when it is complete, and replaces an older one then. Until it does, there is
/// need for the room of two such files on the disk. The bytes of the file depend on the records and
/// the grid alone, not on the memory or on the number of threads.
///
/// # Errors
///
/// When the source fails, records or the resolution are such that no grid can be made, or the disk
/// is full.
///
/// # Examples
///
/// ```
/// use puncta_core::{SliceSource, Sphere};
/// use puncta_grid::{BrickFile, ConvertConfig, convert};
///
/// let records: Vec<Sphere> =
///     (0..9000_u16).map(|i| Sphere::new([f32::from(i % 97), f32::from(i % 89), 0.0],
///     0.5)).collect();
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("scene.bricks");
/// let summary = convert(SliceSource::new(&records), &path, &ConvertConfig::default())?;
/// assert_eq!(summary.records, 9000);
///
/// let BrickFile { scene, grid, .. } = BrickFile::open(&path)?;
/// let brick = &grid.bricks()[1];
/// let id = scene.id(brick.records.start);
/// assert_eq!(scene.records[brick.records.start as usize], records[id as usize]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn convert<S: Source<Record = Sphere>>(
    source: S,
    path: impl AsRef<Path>,
    config: &ConvertConfig,
) -> Result<ConvertSummary, ConvertError<S::Error>> {
    convert_watched(source, path, config, &|_| ())
}

/// As [`convert`], and tells how far it is.
///
/// # Errors
///
/// As [`convert`].
pub fn convert_watched<S: Source<Record = Sphere>>(
    source: S,
    path: impl AsRef<Path>,
    config: &ConvertConfig,
    watch: &(dyn Fn(ConvertStep) + Sync),
) -> Result<ConvertSummary, ConvertError<S::Error>> {
    let path = path.as_ref();
    // A place where no file can be is to be found out before anything is read.
    let file = Unborn::create(path).map_err(|error| Trouble::writing(error).at(path))?;
    let spill = Spill::of(source, path, config, watch)?;
    finish(spill, file, config, watch).map_err(|trouble| trouble.at(path))
}

/// Makes the file of what was spilled.
fn finish(
    spill: Spill,
    file: Unborn,
    config: &ConvertConfig,
    watch: &Watch<'_>,
) -> Result<ConvertSummary, Trouble> {
    let total = Some(spill.rows);
    let room = Room::new(config.memory, spill.shape.row_bytes(), spill.rows);
    let lattice = Lattice::lay(&spill, config)?;
    let keys = Keys::new(lattice.how.layout, lattice.how.coder);

    let survey = Survey::new(&spill);
    let counted = counter(watch, ConvertStage::Counting, total);
    let look = |found: &mut Option<Survey>, block: &Scene, rows: Range<u64>| {
        found.get_or_insert_with(|| survey.clone()).look(block, &rows);
        counted(rows.end - rows.start);
    };
    let (parts, surveys) = Parts::count(&spill, &keys, room, &look)?;
    let findings = surveys.into_iter().flatten().fold(survey.clone(), Survey::join).finish();

    let body = Body::new(&file, &spill)?;
    let distributed = counter(watch, ConvertStage::Distributing, total);
    distribute((&spill, &keys), &parts, &body.fields, room.step, &distributed)?;
    let columns = Columns {
        shape: spill.shape.clone(),
        origin: spill.origin,
        records: spill.rows,
        skipped: spill.skipped,
    };
    // The disk has no need of it any more.
    drop(spill);

    let sorted = |done| watch(ConvertStep { stage: ConvertStage::Sorting, done, total });
    let (bricks, sums) = body.sort(&parts, &columns.shape, lattice.how, &sorted)?;
    watch(ConvertStep { stage: ConvertStage::Finishing, done: 0, total });
    let summary = write_tables(&file, &body, columns, (lattice, bricks, sums, findings))?;
    file.publish().map_err(Trouble::writing)?;
    Ok(summary)
}

/// What is known of the rows without looking at them.
struct Columns {
    shape: Shape,
    origin: DVec3,
    records: u64,
    skipped: u64,
}

/// The columns in the file.
struct Body {
    sections: Vec<Section>,
    fields: Vec<Field>,
    /// Where the tables start.
    end: u64,
}

impl Body {
    /// Makes room for the rows of a spill.
    fn new(file: &Unborn, spill: &Spill) -> Result<Self, Trouble> {
        let sections = sections(spill.rows, &spill.shape);
        let end = sections.last().map_or(PAGE, Section::end);
        file.file.set_len(end).map_err(Trouble::writing)?;
        let columns = sections.iter().zip(spill.shape.widths());
        let field = |(section, width): (&Section, usize)| Field {
            file: Arc::clone(&file.file),
            start: section.start,
            width,
        };
        Ok(Self { fields: columns.map(field).collect(), sections, end })
    }

    /// Sorts part after part; returns the bricks and the sums of each section.
    fn sort(
        &self,
        parts: &Parts,
        shape: &Shape,
        how: How,
        done: &dyn Fn(u64),
    ) -> Result<(Bricks, Vec<Vec<u32>>), Trouble> {
        let mut arranger = Arranger::new(how);
        let mut sums = vec![Sums::default(); self.fields.len()];
        let mut block = shape.block(parts.rows.iter().map(length).max().unwrap_or(0));
        for rows in &parts.rows {
            read_rows(&self.fields, rows, &mut block)?;
            arranger.arrange(&mut block, length(rows));
            write_rows(&self.fields, rows, &block)?;
            for ((sums, bytes), field) in
                sums.iter_mut().zip(shape::bytes(&block)).zip(&self.fields)
            {
                sums.add(&bytes[..length(rows) * field.width]);
            }
            done(rows.end);
        }
        for (sums, section) in sums.iter_mut().zip(&self.sections) {
            let padding = usize::try_from(section.padded - section.bytes).unwrap_or(0);
            sums.add(&vec![0; padding]);
        }
        Ok((arranger.finish(), sums.into_iter().map(Sums::finish).collect()))
    }
}

/// Writes the tables behind the columns, and the header that makes a brick file of it all.
fn write_tables(
    file: &Unborn,
    body: &Body,
    columns: Columns,
    (lattice, bricks, sums, findings): (Lattice, Bricks, Vec<Vec<u32>>, Findings),
) -> Result<ConvertSummary, Trouble> {
    let Columns { shape, origin, records, skipped } = columns;
    let Findings { inner, outer, ranges } = findings;
    let (Bricks { bricks, codes, .. }, names) = (bricks, shape.scalars);
    let tables = Tables { ranges, names, bricks, codes, sums };
    let bytes = tables.encode();
    let (dims, corner, scale, bounds) = lattice.cells.parts();
    let header = Header {
        file_bytes: body.end + bytes.len() as u64,
        records,
        bricks: tables.bricks.len() as u64,
        scalars: u32::try_from(tables.names.len()).unwrap_or(u32::MAX),
        colors: shape.colors,
        elements: shape.elements,
        origin,
        dims,
        corner,
        scale,
        bounds,
        block_bits: lattice.how.layout.block_bits(),
        inner,
        outer,
        tables_start: body.end,
        tables_bytes: bytes.len() as u64,
        tables_sum: sums::sum(&bytes),
    };
    write_at(&file.file, &bytes, body.end).map_err(Trouble::writing)?;
    write_at(&file.file, &header.encode(), 0).map_err(Trouble::writing)?;
    Ok(ConvertSummary { records, skipped, bricks: header.bricks, bytes: header.file_bytes })
}

/// Adds up what threads have done, and tells it.
fn counter<'a>(
    watch: &'a Watch<'_>,
    stage: ConvertStage,
    total: Option<u64>,
) -> impl Fn(u64) + Sync + use<'a> {
    let done = AtomicU64::new(0);
    move |more| {
        let done = done.fetch_add(more, Ordering::Relaxed) + more;
        watch(ConvertStep { stage, done, total });
    }
}
