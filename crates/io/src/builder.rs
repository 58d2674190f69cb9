/*!
The builder: readers push rows into it and it makes a scene of them.

It does what all readers have in common: it chooses the origin, skips and counts rows that cannot be
used, keeps the wanted columns, and gives rows without a radius an estimated one.
*/

mod late;
mod origin;

use crate::{
    ReadOptions,
    error::{ErrorKind, Fault, Place, Problem},
    radius,
};
use glam::DVec3;
use puncta_core::{Attributes, Column, MAX_RECORDS, Scalar, Scene, Sphere};

/// How many rows of double precision wait for the origin to be chosen.
const HEAD: usize = 32_768;

/// How many warnings are kept; what a file can bring about without end is not worth more.
const WARNINGS_MAX: usize = 100;

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
}

impl Default for Row<'_> {
    fn default() -> Self {
        Self { position: [0.0; 3], radius: None, color: [255; 4], element: 0, scalars: &[] }
    }
}

/// What was found while reading.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Records that could not be used, by reason.
    pub skipped: Vec<Skipped>,
    /// What else a user should know.
    pub warnings: Vec<String>,
}

/// Records that could not be used for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The reason.
    pub problem: Problem,
    /// How many there are.
    pub count: u64,
    /// Where the first one is.
    pub first: Place,
    /// The value at fault in the first one.
    pub value: String,
}

impl Report {
    /// How many records could not be used.
    #[must_use]
    pub fn skipped_count(&self) -> u64 {
        self.skipped.iter().map(|skipped| skipped.count).sum()
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
}

impl<'a> Builder<'a> {
    pub(crate) fn new(options: &'a ReadOptions, precision: Precision, columns: &Columns) -> Self {
        let wanted = columns.scalars.iter().enumerate().filter(|(_, name)| options.wants(name));
        let scalar = |name: &String| Scalar { name: name.clone(), values: Column::new() };
        Self {
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
        }
    }

    /// Makes room for exactly `count` more rows. Only for counts that the file's size confirms.
    pub(crate) fn reserve(&mut self, count: u64) -> Result<(), Fault> {
        let total = count.saturating_add(self.records.len() as u64);
        if total > MAX_RECORDS as u64 {
            return Err(ErrorKind::TooManyRecords(total).into());
        }
        let count = usize::try_from(count).map_err(|_| ErrorKind::TooManyRecords(count))?;
        self.records.reserve_exact(count);
        if let Some(colors) = &mut self.colors {
            colors.reserve_exact(count);
        }
        if let Some(elements) = &mut self.elements {
            elements.reserve_exact(count);
        }
        for (_, scalar) in &mut self.scalars {
            scalar.values.to_mut().reserve_exact(count);
        }
        Ok(())
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
        let radius = radius.map_or(f32::NAN, |radius| to_f32(radius * self.options.radius_scale));
        let center = self.place(row.position);
        self.records.push(Sphere::new(center, radius));
        if let Some(ids) = &mut self.ids {
            ids.push(to_id(self.rows));
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
        Ok(())
    }

    /// Counts a row that cannot be used; an error if reading is strict.
    pub(crate) fn skip(
        &mut self,
        problem: Problem,
        place: Place,
        value: impl FnOnce() -> String,
    ) -> Result<(), Fault> {
        self.report_skip(problem, place, value)?;
        self.check_count()?;
        if self.ids.is_none() {
            let mut ids = Vec::with_capacity(self.records.capacity());
            ids.extend((0..self.records.len() as u64).map(to_id));
            self.ids = Some(ids);
        }
        self.rows += 1;
        Ok(())
    }

    /// Checks that the next row still has an id.
    fn check_count(&self) -> Result<(), Fault> {
        if self.rows < MAX_RECORDS as u64 {
            return Ok(());
        }
        Err(ErrorKind::TooManyRecords(self.rows + 1).into())
    }

    /// Reports a row that cannot be used; an error if reading is strict.
    fn report_skip(
        &mut self,
        problem: Problem,
        place: Place,
        value: impl FnOnce() -> String,
    ) -> Result<(), Fault> {
        if self.options.strict {
            let kind = ErrorKind::Record { problem, value: value() };
            return Err(Fault { place: Some(place), kind });
        }
        match self.report.skipped.iter_mut().find(|skipped| skipped.problem == problem) {
            Some(skipped) => skipped.count += 1,
            None => {
                let value = value();
                self.report.skipped.push(Skipped { problem, count: 1, first: place, value });
            }
        }
        Ok(())
    }

    /// Notes something that a user should know.
    pub(crate) fn warn(&mut self, warning: impl Into<String>) {
        let warning = warning.into();
        let warnings = &mut self.report.warnings;
        if warnings.len() < WARNINGS_MAX && !warnings.contains(&warning) {
            warnings.push(warning);
            if warnings.len() == WARNINGS_MAX {
                warnings.push("there are more warnings than these".to_owned());
            }
        }
    }

    /// Gives a radius to the rows that came without one; whether there are any.
    pub(crate) fn fill_radius(&mut self, radius: f64) -> bool {
        let smallest = f64::from(f32::MIN_POSITIVE);
        let radius = (radius * self.options.radius_scale).clamp(smallest, f64::from(f32::MAX));
        let radius = to_f32(radius);
        let missing = self.records.iter_mut().filter(|sphere| sphere.radius.is_nan());
        missing.for_each(|sphere| sphere.radius = radius);
        std::mem::take(&mut self.radius_missing)
    }

    /// Counts `count` rows that cannot be used, the first of which is at this place; an error if
    /// reading is strict.
    pub(crate) fn skip_many(
        &mut self,
        problem: Problem,
        (place, count): (Place, u64),
        value: impl FnOnce() -> String,
    ) -> Result<(), Fault> {
        let Some(more) = count.checked_sub(1) else { return Ok(()) };
        self.skip(problem, place, value)?;
        self.rows = self.rows.saturating_add(more);
        if self.rows > MAX_RECORDS as u64 {
            return Err(ErrorKind::TooManyRecords(self.rows).into());
        }
        let skipped = self.report.skipped.iter_mut().find(|skipped| skipped.problem == problem);
        skipped.into_iter().for_each(|skipped| skipped.count += more);
        Ok(())
    }

    /// The colors so far, for readers that learn of their meaning only as they go.
    pub(crate) fn colors_mut(&mut self) -> &mut Option<Vec<[u8; 4]>> {
        &mut self.colors
    }

    /// The scene of all rows, and what was found on the way.
    pub(crate) fn finish(mut self) -> Result<(Scene, Report), Fault> {
        if self.records.is_empty() {
            return Err(ErrorKind::NoRecords { skipped: self.report.skipped_count() }.into());
        }
        match self.precision {
            Precision::Single => self.rebase(),
            Precision::Double => self.settle(),
        }
        self.shrink();
        if self.radius_missing {
            let scale = self.options.radius_scale;
            let estimate = to_f32(f64::from(radius::estimate(&self.records)) * scale);
            self.warn(format!("the file gives no radius; {estimate} was taken from the spacing"));
            let missing = self.records.iter_mut().filter(|sphere| sphere.radius.is_nan());
            missing.for_each(|sphere| sphere.radius = estimate);
        }
        let attributes = Attributes {
            ids: self.ids.map(Column::from),
            colors: self.colors.map(Column::from),
            elements: self.elements.map(Column::from),
            scalars: self.scalars.into_iter().map(|(_, scalar)| scalar).collect(),
        };
        let origin = self.origin.unwrap_or(DVec3::ZERO);
        Ok((Scene { origin, records: self.records.into(), attributes }, self.report))
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
            return position.map(to_f32);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(positions: &[[f64; 3]], precision: Precision) -> Scene {
        let options = ReadOptions::default().radius(1.0);
        let mut builder = Builder::new(&options, precision, &Columns::default());
        for &position in positions {
            builder.push(&Row { position, ..Row::default() }, Place::Line(1)).unwrap();
        }
        builder.finish().unwrap().0
    }

    #[test]
    fn positions_around_zero_are_stored_as_they_are() {
        let scene = scene(&[[0.1, 0.2, 0.3], [0.9, 1.0, -0.25]], Precision::Double);
        assert_eq!(scene.origin, DVec3::ZERO);
        assert_eq!(scene.records[0].center, [0.1, 0.2, 0.3]);
    }

    #[test]
    fn far_positions_keep_their_digits() {
        let positions = [[637_000.01, 851_000.02, 450.03], [637_001.04, 851_002.05, 451.06]];
        let scene = scene(&positions, Precision::Double);
        for (index, position) in positions.iter().enumerate() {
            assert!((scene.position(index) - DVec3::from(*position)).abs().max_element() < 1e-7);
        }
    }

    #[test]
    fn a_box_without_measurable_extent_has_an_origin() {
        let scene = scene(&[[2.0, 0.0, 0.0], [2.0, 1e-320, 0.0]], Precision::Double);
        assert_eq!(scene.origin, DVec3::new(2.0, 0.0, 0.0));
    }

    #[test]
    fn strays_do_not_take_the_digits_of_the_rest() {
        let near = |i: u32| [637_000.0 + f64::from(i) * 0.01, 851_000.02, 400.0];
        let positions: Vec<[f64; 3]> =
            std::iter::once([0.0; 3]).chain((0..5000).map(near)).collect();
        let scene = scene(&positions, Precision::Double);
        assert_eq!(scene.position(0), DVec3::ZERO);
        for (index, position) in positions.iter().enumerate() {
            let error = (scene.position(index) - DVec3::from(*position)).abs().max_element();
            assert!(error < 2e-5, "{index}: {error}");
        }
    }

    #[test]
    fn warnings_have_an_end() {
        let options = ReadOptions::default();
        let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
        (0..1000).for_each(|i| builder.warn(format!("warning {i}")));
        assert_eq!(builder.report.warnings.len(), WARNINGS_MAX + 1);
    }

    #[test]
    fn moving_single_precision_is_exact() {
        let positions: Vec<[f64; 3]> = (0..100_u16)
            .map(|i| [1e7_f32 + f32::from(i), -3e5 + 0.1 * f32::from(i), 77.7].map(f64::from))
            .collect();
        let scene = scene(&positions, Precision::Single);
        assert!(scene.origin.x != 0.0 && scene.origin.y != 0.0);
        for (index, position) in positions.iter().enumerate() {
            assert_eq!(scene.position(index), DVec3::from(*position));
        }
    }

    #[test]
    fn many_rows_of_double_precision_share_one_origin() {
        let positions: Vec<[f64; 3]> =
            (0..100_000_u32).map(|i| [1e7 + f64::from(i) * 0.5, 0.0, 0.0]).collect();
        let scene = scene(&positions, Precision::Double);
        for index in [0, 1, HEAD - 2, HEAD - 1, HEAD, HEAD + 1, 99_999] {
            assert_eq!(scene.position(index), DVec3::from(positions[index]), "{index}");
        }
    }

    #[test]
    fn rows_that_cannot_be_used_are_counted_and_keep_ids_right() {
        let options = ReadOptions::default();
        let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
        let row =
            |x, radius| Row { position: [x, 0.0, 0.0], radius: Some(radius), ..Row::default() };
        for (x, radius) in [(0.0, 1.0), (f64::NAN, 1.0), (2.0, -1.0), (3.0, 0.0), (4.0, 1.0)] {
            builder.push(&row(x, radius), Place::Line(7)).unwrap();
        }
        let (scene, report) = builder.finish().unwrap();
        assert_eq!(scene.attributes.ids, Some([0, 4].into()));
        assert_eq!(report.skipped_count(), 3);
        assert_eq!(report.skipped[1].value, "-1");
    }

    #[test]
    fn strict_reading_names_the_value() {
        let options = ReadOptions::default().strict(true);
        let mut builder = Builder::new(&options, Precision::Double, &Columns::default());
        let row = Row { position: [0.0, f64::INFINITY, 0.0], ..Row::default() };
        let error = builder.push(&row, Place::Line(3)).unwrap_err().in_file("a.xyz");
        let text = "a.xyz, line 3: a position that cannot be stored: (0, inf, 0)";
        assert_eq!(error.to_string(), text);
    }
}
