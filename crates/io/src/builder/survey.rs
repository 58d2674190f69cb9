/*!
A survey: what only the whole file tells, found without keeping its rows.

Some of a scene is known only when all of it was read: the origin of single precision, the radius of
rows without one, whether elements are any, how deep colors are. A reader whose rows go into a
survey reads all the same, and meets all errors. What it finds is what a scene would be made with,
by the same code or on the same numbers: so chunks that are made with it later have the same
records, bit by bit.

The radius that is estimated needs a third look, since the sample of records, to which the nearest
ones are to be found, is known only at the end of the survey.
*/

use super::{Builder, Precision, Row, Sink, estimate_text, first, first::First, offset, to_f32};
use crate::{
    builder::{Report, origin},
    error::{ErrorKind, Fault},
    hash::mix,
    radius::Sample,
};
use glam::{DVec3, Vec3};
use puncta_core::Scene;

/// Where the ids of rows come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Ranks {
    /// They are the numbers of rows.
    #[default]
    Rows,
    /// They count the rows that have an id in the file.
    Counted,
    /// They are the ids of the file, less this one.
    From(i64),
}

/// What a whole file tells.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// How many rows can be used.
    pub(crate) count: u64,
    pub(crate) origin: DVec3,
    /// The radius of rows without one, once it is known.
    pub(crate) radius: Option<f32>,
    pub(crate) ranks: Ranks,
    /// What the rows were, so that it is noticed if they are others the next time.
    pub(super) digest: Digest,
    /// Whether ids are not simply the numbers of records.
    pub(super) has_ids: bool,
    /// Whether the columns of colors and elements tell anything.
    pub(super) has_colors: bool,
    pub(super) has_elements: bool,
    /// How many records at the start are black.
    pub(super) black: u64,
    pub(super) first: First,
    /// The index of the warning that names the estimated radius.
    estimate_at: Option<usize>,
    sample: Sample<[f64; 3]>,
    min: [f64; 3],
    max: [f64; 3],
}

impl Default for Survey {
    fn default() -> Self {
        Self {
            count: 0,
            origin: DVec3::ZERO,
            radius: None,
            ranks: Ranks::default(),
            digest: Digest::default(),
            has_ids: false,
            has_colors: true,
            has_elements: true,
            black: 0,
            first: First::None,
            estimate_at: None,
            sample: Sample::default(),
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Survey {
    /// The centers, relative to the origin, between which the radius is to be estimated; `None` if
    /// all rows have a radius.
    pub(crate) fn sample(&self) -> Option<Vec<Vec3>> {
        self.estimate_at?;
        let center = |position: [f64; 3]| Vec3::from(offset(position, self.origin));
        Some(self.sample.clone().into_items(self.count).into_iter().map(center).collect())
    }

    /// Takes the radius that was estimated, and puts it into the warning that tells of it.
    pub(crate) fn set_estimate(&mut self, radius: f32, report: &mut Report) {
        self.radius = Some(radius);
        let warning = self.estimate_at.and_then(|at| report.warnings.get_mut(at));
        warning.into_iter().for_each(|warning| *warning = estimate_text(radius));
    }

    /// The ends of the box around all centers, as they are stored.
    pub(crate) fn centers(&self) -> [DVec3; 2] {
        // Rounding keeps the order, so the ends of the box are stored like the rows they are of.
        [self.min, self.max]
            .map(|end| self.origin + Vec3::from(offset(end, self.origin)).as_dvec3())
    }

    /// Sets where the ids of rows come from.
    pub(crate) fn set_ranks(&mut self, ranks: Ranks) {
        self.ranks = ranks;
        self.has_ids |= matches!(ranks, Ranks::From(_));
    }

    /// Notes that a row cannot be used.
    pub(super) fn skip(&mut self, first: &mut First) {
        self.has_ids = true;
        if matches!(first, First::Next) {
            *first = First::Skipped;
        }
    }

    fn add(&mut self, position: [f64; 3]) {
        self.count += 1;
        self.sample.add(position);
        for (axis, x) in position.into_iter().enumerate() {
            // The same comparisons as for the range of a scene, down to the sign of zero.
            self.min[axis] = if x < self.min[axis] { x } else { self.min[axis] };
            self.max[axis] = if x > self.max[axis] { x } else { self.max[axis] };
        }
    }
}

impl Builder<'_> {
    /// The survey, if rows go into one.
    pub(crate) fn survey_mut(&mut self) -> Option<&mut Survey> {
        self.survey.as_deref_mut()
    }

    /// Adds a row to the survey.
    pub(super) fn survey_row(&mut self, row: &Row<'_>, radius: Option<f32>) {
        let mut position = row.position;
        if self.precision == Precision::Single {
            position = position.map(to_f32).map(f64::from);
        } else {
            self.place(position);
        }
        if matches!(self.first, First::Next) {
            self.first = First::Row(first::Values::of(row, radius));
        }
        if let Some(survey) = &mut self.survey {
            survey.add(position);
            survey.digest.add(row.position, radius);
        }
        self.rows += 1;
    }

    /// Hands over what was found.
    pub(super) fn finish_survey(mut self, mut survey: Survey) -> Result<(Scene, Report), Fault> {
        if survey.count == 0 {
            return Err(ErrorKind::NoRecords { skipped: self.report.skipped_count() }.into());
        }
        survey.origin = match self.precision {
            Precision::Single => origin::of_box(survey.min.into(), survey.max.into()),
            Precision::Double => {
                self.settle();
                self.origin.unwrap_or(DVec3::ZERO)
            }
        };
        if self.radius_missing {
            let at = self.report.warnings.len();
            self.warn(estimate_text(f32::NAN));
            survey.estimate_at = Some(at);
        }
        survey.first = self.first;
        if let Sink::Survey(found) = &self.options.sink {
            // There is one builder for each reading, so nothing is there yet.
            found.set(survey).ok();
        }
        Ok((Scene::new(Vec::new()), self.report))
    }
}

/// A sum of rows that tells whether they are the same ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Digest(u64);

impl Digest {
    pub(super) fn add(&mut self, position: [f64; 3], radius: Option<f32>) {
        let [x, y, z] = position.map(f64::to_bits);
        let radius = radius.map_or(0, |radius| u64::from(radius.to_bits()));
        let row = x ^ y.rotate_left(21) ^ z.rotate_left(42) ^ radius;
        self.0 = mix(self.0 ^ row);
    }
}
