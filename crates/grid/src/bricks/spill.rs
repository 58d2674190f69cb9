/*!
The spill: what a source gives, as it comes, in unnamed files beside the one to be made.

A source gives its records once, but they are needed more often: to sample them, to count them, to
distribute them. On the way their box is taken, and those that no grid can hold are refused or left
out.
*/

use super::{
    convert::{ConvertConfig, ConvertStage, ConvertStep, Invalid, Watch},
    error::{ConvertError, Trouble},
    field::{Field, read_columns},
    publish::folder,
    shape::{self, Shape},
};
use crate::Error;
use glam::{DVec3, Vec3};
use puncta_core::{Aabb, MAX_RECORDS, Record, Scene, Source, Sphere};
use std::{ops::Range, path::Path, sync::Arc};

/// How many rows a source is asked for at once.
const CHUNK: usize = 1 << 16;

/// The rows of a source.
#[derive(Debug)]
pub(crate) struct Spill {
    pub(crate) shape: Shape,
    pub(crate) origin: DVec3,
    fields: Vec<Field>,
    /// Whether ids are stored; else each is the index of its row.
    has_ids: bool,
    pub(crate) rows: u64,
    pub(crate) skipped: u64,
    /// The box around all positions.
    pub(crate) bounds: Aabb,
    /// The least and the largest finite value of each scalar.
    pub(crate) ranges: Vec<[f32; 2]>,
}

impl Spill {
    /// Takes all that a source gives.
    pub(crate) fn of<S: Source<Record = Sphere>>(
        mut source: S,
        path: &Path,
        config: &ConvertConfig,
        watch: &Watch<'_>,
    ) -> Result<Self, ConvertError<S::Error>> {
        let (mut chunk, mut spill, mut given) = (Scene::new(Vec::new()), None, 0_u64);
        let total = source.remaining();
        loop {
            chunk.clear();
            let count = source.append(&mut chunk, CHUNK).map_err(ConvertError::Source)?;
            if spill.is_none() {
                spill =
                    Some(Self::start(&chunk, path, config).map_err(|trouble| trouble.at(path))?);
            }
            let taken = chunk.records.len() as u64;
            if let Some(spill) = &mut spill {
                spill.take(&mut chunk, given, config).map_err(|trouble| trouble.at(path))?;
            }
            given += taken;
            watch(ConvertStep { stage: ConvertStage::Reading, done: given, total });
            if count < CHUNK {
                break;
            }
        }
        match spill {
            Some(spill) => Ok(spill),
            None => Self::start(&chunk, path, config).map_err(|trouble| trouble.at(path)),
        }
    }

    /// A spill without rows, for chunks like this one.
    fn start(chunk: &Scene, path: &Path, config: &ConvertConfig) -> Result<Self, Trouble> {
        let shape = Shape::of(chunk);
        // Rows from which some are left out have ids that must be stored.
        let has_ids = chunk.attributes.ids.is_some() || config.invalid == Invalid::Skip;
        let long = shape.scalars.iter().map(String::len).find(|&bytes| bytes > u16::MAX.into());
        if let Some(bytes) = long {
            return Err(Trouble::Name { bytes });
        }
        let file = |width| {
            let file = tempfile::tempfile_in(folder(path)).map_err(Trouble::writing)?;
            Ok(Field { file: Arc::new(file), start: 0, width })
        };
        Ok(Self {
            origin: chunk.origin,
            fields: stored(shape.widths(), has_ids)
                .into_iter()
                .map(file)
                .collect::<Result<_, Trouble>>()?,
            has_ids,
            rows: 0,
            skipped: 0,
            bounds: Aabb::EMPTY,
            ranges: vec![[f32::INFINITY, f32::NEG_INFINITY]; shape.scalars.len()],
            shape,
        })
    }

    /// Takes a chunk whose first record has this index.
    fn take(
        &mut self,
        chunk: &mut Scene,
        index: u64,
        config: &ConvertConfig,
    ) -> Result<(), Trouble> {
        chunk.validate().map_err(Error::Scene)?;
        let found = Shape::of(chunk);
        if found != self.shape && !chunk.records.is_empty() {
            let (found, before) = (format!("{found:?}"), format!("{:?}", self.shape));
            return Err(Trouble::Columns { index, found, before });
        }
        let records =
            usize::try_from(index).unwrap_or(usize::MAX).saturating_add(chunk.records.len());
        if records > MAX_RECORDS {
            return Err(Error::from(puncta_core::Error::TooManyRecords { records }).into());
        }
        if chunk.attributes.ids.is_some() {
            self.check(chunk, index, config)?;
            return self.write(chunk);
        }
        let ids = (index..).take(chunk.records.len());
        let ids = ids.map(|id| u32::try_from(id).unwrap_or(u32::MAX));
        chunk.attributes.ids = Some(ids.collect());
        self.check(chunk, index, config)?;
        self.write(chunk)?;
        // The next chunk must be one that its source knows.
        chunk.attributes.ids = None;
        Ok(())
    }

    /// Leaves out records that no grid can hold, or refuses them; takes the box of the others.
    fn check(
        &mut self,
        chunk: &mut Scene,
        index: u64,
        config: &ConvertConfig,
    ) -> Result<(), Trouble> {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut are_valid = true;
        for record in chunk.records.as_slice() {
            are_valid &= record.position().is_finite() && is_radius(record.radius);
            (min, max) = (min.min(record.position()), max.max(record.position()));
        }
        if are_valid {
            self.bounds = Aabb { min: self.bounds.min.min(min), max: self.bounds.max.max(max) };
            return Ok(());
        }
        let is_valid = |record: &Sphere| record.position().is_finite() && is_radius(record.radius);
        let keep: Vec<bool> = chunk.records.iter().map(is_valid).collect();
        let bad = keep.iter().position(|keep| !keep).unwrap_or(0);
        if config.invalid == Invalid::Refuse {
            let Sphere { radius, .. } = chunk.records[bad];
            let position = chunk.records[bad].position();
            let index = usize::try_from(index).unwrap_or(usize::MAX).saturating_add(bad);
            return Err(if position.is_finite() {
                Error::Radius { index, radius }.into()
            } else {
                Error::Position { index, position }.into()
            });
        }
        self.skipped += keep.iter().filter(|&&keep| !keep).count() as u64;
        shape::retain(chunk, &keep);
        chunk.records.iter().for_each(|record| self.bounds.add(record.position()));
        Ok(())
    }

    fn write(&mut self, chunk: &Scene) -> Result<(), Trouble> {
        for (field, bytes) in self.fields.iter().zip(stored(shape::bytes(chunk), self.has_ids)) {
            field.write(self.rows, bytes).map_err(Trouble::writing)?;
        }
        for ([low, high], scalar) in self.ranges.iter_mut().zip(&chunk.attributes.scalars) {
            for &value in scalar.values.iter().filter(|value| value.is_finite()) {
                (*low, *high) = (low.min(value), high.max(value));
            }
        }
        self.rows += chunk.records.len() as u64;
        Ok(())
    }

    /// The position of a record.
    pub(crate) fn position(&self, row: u64) -> Result<Vec3, Trouble> {
        let mut sphere = [Sphere::default()];
        let bytes = bytemuck::cast_slice_mut(&mut sphere);
        self.fields[0].read(row, bytes).map_err(Trouble::reading)?;
        Ok(sphere[0].position())
    }

    /// Reads rows to the start of a block.
    pub(crate) fn read(&self, rows: &Range<u64>, block: &mut Scene) -> Result<(), Trouble> {
        read_columns(&self.fields, rows, stored(shape::bytes_mut(block), self.has_ids))?;
        if let Some(ids) = block.attributes.ids.as_mut().filter(|_| !self.has_ids) {
            let rows = rows.clone().map(|row| u32::try_from(row).unwrap_or(u32::MAX));
            ids.to_mut().iter_mut().zip(rows).for_each(|(id, row)| *id = row);
        }
        Ok(())
    }

    /// Lets go of rows that are not needed any more.
    pub(crate) fn forget(&self, rows: &Range<u64>) {
        self.fields.iter().for_each(|field| field.forget(rows));
    }
}

/// The columns that are stored, of all: perhaps without ids, which come second.
fn stored<T>(mut columns: Vec<T>, has_ids: bool) -> Vec<T> {
    if !has_ids && columns.len() > 1 {
        columns.remove(1);
    }
    columns
}

fn is_radius(radius: f32) -> bool {
    (0.0..f32::INFINITY).contains(&radius)
}
