/*!
The builder: readers push rows into it and it makes a scene of them, or chunks of one.

It does what all readers have in common: it chooses the origin, skips and counts rows that cannot be
used, keeps the wanted columns, and gives rows without a radius an estimated one.

Where the rows go is told by a [`Sink`]. A file that is larger than memory is read twice: by
[`survey`], which keeps no rows, and in [`chunks`], which know from the survey what comes at the end.
*/

mod chunks;
mod first;
mod late;
mod origin;
mod report;
mod survey;
#[cfg(test)]
mod tests;

pub use self::report::{Report, Skipped};
pub(crate) use self::{
    chunks::{Chunks, Outlet, Sink},
    survey::{Ranks, Survey},
};

use self::{chunks::Chunking, first::First};
use crate::{
    ReadOptions,
    error::{ErrorKind, Fault, Place, Problem},
    radius,
};
use glam::DVec3;
use puncta_core::{Attributes, Column, MAX_RECORDS, Scalar, Scene, Sphere};

/// How many rows of double precision wait for the origin to be chosen.
const HEAD: usize = 32_768;

/// The largest coordinate: the difference of any two of them is one that `f32` can hold.
const COORDINATE_MAX: f64 = f32::MAX as f64 * 0.25;

/// What the coordinates of a file were before they became `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    /// `f32`.
    Single,
    /// `f64`, or text.
    Double,
}

/// The columns a file has besides positions and radii.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    pub(crate) color: bool,
    pub(crate) element: bool,
    pub(crate) scalars: Vec<String>,
}

/// A record of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) position: [f64; 3],
    /// `None` if the file has none; it is estimated then.
    pub(crate) radius: Option<f64>,
    pub(crate) color: [u8; 4],
    pub(crate) element: u8,
    /// One value for each name in [`Columns::scalars`].
    pub(crate) scalars: &'a [f32],
    /// What it is known by in a chunk; its number in the file if there is none.
    pub(crate) id: Option<u32>,
}

impl Default for Row<'_> {
    fn default() -> Self {
        let (position, color) = ([0.0; 3], [255; 4]);
        Self { position, radius: None, color, element: 0, scalars: &[], id: None }
    }
}

/// A scene in the making.
pub(crate) struct Builder<'a> {
    options: &'a ReadOptions,
    precision: Precision,
    origin: Option<DVec3>,
    /// Positions that wait for the origin.
    head: Vec<[f64; 3]>,
    records: Vec<Sphere>,
    /// The index in the file of each record, once a row was skipped.
    ids: Option<Vec<u32>>,
    colors: Option<Vec<[u8; 4]>>,
    elements: Option<Vec<u8>>,
    /// The wanted scalars and where a row has them.
    scalars: Vec<(usize, Scalar)>,
    /// How many rows were pushed or skipped.
    rows: u64,
    report: Report,
    radius_missing: bool,
    /// What was found so far, if no rows are kept.
    survey: Option<Box<Survey>>,
    /// Where full chunks go, if rows are kept in these only.
    chunking: Option<Chunking<'a>>,
    /// What is known of a first row that comes last.
    first: First,
}

impl<'a> Builder<'a> {
    pub(crate) fn new(options: &'a ReadOptions, precision: Precision, columns: &Columns) -> Self {
        let wanted = columns.scalars.iter().enumerate().filter(|(_, name)| options.wants(name));
        let scalar = |name: &String| Scalar { name: name.clone(), values: Column::new() };
        let mut builder = Self {
            options,
            precision,
            origin: None,
            head: Vec::new(),
            records: Vec::new(),
            ids: None,
            colors: columns.color.then(Vec::new),
            elements: columns.element.then(Vec::new),
            scalars: wanted.map(|(column, name)| (column, scalar(name))).collect(),
            rows: 0,
            report: Report::default(),
            radius_missing: false,
            survey: None,
            chunking: None,
            first: First::default(),
        };
        match &options.sink {
            Sink::Scene => {}
            Sink::Survey(_) => builder.survey = Some(Box::default()),
            Sink::Chunks(chunks) => builder.start_chunks(chunks),
        }
        builder
    }

    /// Makes room for exactly `count` more rows. Only for counts that the file's size confirms.
    pub(crate) fn reserve(&mut self, count: u64) -> Result<(), Fault> {
        let total = count.saturating_add(self.records.len() as u64);
        if total > MAX_RECORDS as u64 {
            return Err(ErrorKind::TooManyRecords(total).into());
        }
        let count = usize::try_from(count).map_err(|_| ErrorKind::TooManyRecords(count))?;
        if matches!(self.options.sink, Sink::Scene) {
            self.make_room(count);
        }
        Ok(())
    }

    /// Makes room in all columns.
    fn make_room(&mut self, count: usize) {
        self.records.reserve_exact(count);
        if let Some(ids) = &mut self.ids {
            ids.reserve_exact(count);
        }
        if let Some(colors) = &mut self.colors {
            colors.reserve_exact(count);
        }
        if let Some(elements) = &mut self.elements {
            elements.reserve_exact(count);
        }
        for (_, scalar) in &mut self.scalars {
            scalar.values.to_mut().reserve_exact(count);
        }
    }

    /// Adds a row, or skips it if it cannot be used.
    pub(crate) fn push(&mut self, row: &Row<'_>, place: Place) -> Result<(), Fault> {
        if !row.position.iter().all(|x| x.is_finite() && x.abs() <= COORDINATE_MAX) {
            let [x, y, z] = row.position;
            return self.skip(Problem::Position, place, || format!("({x}, {y}, {z})"));
        }
        let radius = self.options.radius.or(row.radius);
        if let Some(radius) = radius
            && !is_radius(radius * self.options.radius_scale)
        {
            return self.skip(Problem::Radius, place, || radius.to_string());
        }
        self.check_count()?;
        self.radius_missing |= radius.is_none();
        let radius = radius.map(|radius| to_f32(radius * self.options.radius_scale));
        if self.survey.is_some() {
            self.survey_row(row, radius);
        } else if self.chunking.is_some() {
            self.chunk_row(row, radius)?;
        } else {
            self.store(row, radius.unwrap_or(f32::NAN));
        }
        Ok(())
    }

    /// Adds a row to the columns.
    fn store(&mut self, row: &Row<'_>, radius: f32) {
        let center = self.place(row.position);
        self.records.push(Sphere::new(center, radius));
        if let Some(ids) = &mut self.ids {
            ids.push(row.id.unwrap_or(to_id(self.rows)));
        }
        if let Some(colors) = &mut self.colors {
            colors.push(row.color);
        }
        if let Some(elements) = &mut self.elements {
            elements.push(row.element);
        }
        for (column, scalar) in &mut self.scalars {
            scalar.values.to_mut().push(row.scalars.get(*column).copied().unwrap_or(f32::NAN));
        }
        self.rows += 1;
    }

    /// Gives a radius to the rows that came without one; whether there are any.
    pub(crate) fn fill_radius(&mut self, radius: f64) -> bool {
        let smallest = f64::from(f32::MIN_POSITIVE);
        let radius = (radius * self.options.radius_scale).clamp(smallest, f64::from(f32::MAX));
        let radius = to_f32(radius);
        if let Some(survey) = &mut self.survey {
            survey.radius = Some(radius);
        }
        let missing = self.records.iter_mut().filter(|sphere| sphere.radius.is_nan());
        missing.for_each(|sphere| sphere.radius = radius);
        std::mem::take(&mut self.radius_missing)
    }

    /// The scene of all rows, and what was found on the way; an empty one if the rows went
    /// elsewhere.
    pub(crate) fn finish(mut self) -> Result<(Scene, Report), Fault> {
        if let Some(survey) = self.survey.take() {
            return self.finish_survey(*survey);
        }
        if self.chunking.is_some() {
            return self.finish_chunks();
        }
        if self.records.is_empty() {
            return Err(ErrorKind::NoRecords { skipped: self.report.skipped_count() }.into());
        }
        match self.precision {
            Precision::Single => self.rebase(),
            Precision::Double => self.settle(),
        }
        self.shrink();
        if self.radius_missing {
            let estimate = radius::estimate(&self.records);
            let estimate = estimated(estimate, self.options);
            self.warn(estimate_text(estimate));
            let missing = self.records.iter_mut().filter(|sphere| sphere.radius.is_nan());
            missing.for_each(|sphere| sphere.radius = estimate);
        }
        self.put_first();
        Ok((self.take(), self.report))
    }

    /// The scene of the rows so far; their columns stay, but have no rows any more.
    fn take(&mut self) -> Scene {
        let scalar = |scalar: &mut Scalar| Scalar {
            name: scalar.name.clone(),
            values: std::mem::take(&mut scalar.values),
        };
        let attributes = Attributes {
            ids: self.ids.as_mut().map(|ids| std::mem::take(ids).into()),
            colors: self.colors.as_mut().map(|colors| std::mem::take(colors).into()),
            elements: self.elements.as_mut().map(|elements| std::mem::take(elements).into()),
            scalars: self.scalars.iter_mut().map(|(_, column)| scalar(column)).collect(),
        };
        let origin = self.origin.unwrap_or(DVec3::ZERO);
        Scene { origin, records: std::mem::take(&mut self.records).into(), attributes }
    }

    /// Gives back the room that no row took.
    fn shrink(&mut self) {
        self.records.shrink_to_fit();
        self.ids.iter_mut().for_each(Vec::shrink_to_fit);
        self.colors.iter_mut().for_each(Vec::shrink_to_fit);
        self.elements.iter_mut().for_each(Vec::shrink_to_fit);
        self.scalars.iter_mut().for_each(|(_, scalar)| scalar.values.to_mut().shrink_to_fit());
    }

    /// The offset to store for a position; it may be put right later.
    fn place(&mut self, position: [f64; 3]) -> [f32; 3] {
        if self.precision == Precision::Single {
            // The origin is known in advance or not at all.
            return match self.origin {
                Some(origin) if origin != DVec3::ZERO => offset(position, origin),
                _ => position.map(to_f32),
            };
        }
        if self.head.len() == HEAD {
            self.settle();
        }
        if let Some(origin) = self.origin {
            return offset(position, origin);
        }
        self.head.push(position);
        [0.0; 3]
    }

    /// Chooses the origin from the positions that wait, and stores their offsets.
    fn settle(&mut self) {
        if self.origin.is_none() {
            let origin = origin::choose(|| self.head.iter().copied(), origin::STRAYS);
            for (record, position) in self.records.iter_mut().zip(&self.head) {
                record.center = offset(*position, origin);
            }
            self.origin = Some(origin);
            self.head = Vec::new();
        }
    }

    /// Moves absolute positions to an origin near them.
    fn rebase(&mut self) {
        let absolute = |sphere: &Sphere| sphere.center.map(f64::from);
        let origin = origin::choose(|| self.records.iter().map(absolute), 0.0);
        if origin != DVec3::ZERO {
            for record in &mut self.records {
                record.center = offset(record.center.map(f64::from), origin);
            }
        }
        self.origin = Some(origin);
    }
}

fn offset(position: [f64; 3], origin: DVec3) -> [f32; 3] {
    (DVec3::from(position) - origin).to_array().map(to_f32)
}

/// The radius to give for an estimate, at the scale of the options.
pub(crate) fn estimated(estimate: f32, options: &ReadOptions) -> f32 {
    to_f32(f64::from(estimate) * options.radius_scale)
}

/// What to tell of an estimated radius.
pub(crate) fn estimate_text(radius: f32) -> String {
    format!("the file gives no radius; {radius} was taken from the spacing")
}

/// Whether a radius can be drawn and stored.
pub(crate) fn is_radius(radius: f64) -> bool {
    radius <= f64::from(f32::MAX) && radius >= f64::from(f32::MIN_POSITIVE)
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
pub(crate) fn to_f32(x: f64) -> f32 {
    x as f32
}

#[expect(clippy::cast_possible_truncation, reason = "rows are at most MAX_RECORDS")]
fn to_id(row: u64) -> u32 {
    row as u32
}
