//! What was found while reading: rows that cannot be used, and warnings.

use super::{Builder, to_id};
use crate::error::{ErrorKind, Fault, Place, Problem};
use puncta_core::MAX_RECORDS;

/// How many warnings are kept; what a file can bring about without end is not worth more.
pub(super) const WARNINGS_MAX: usize = 100;

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

impl Builder<'_> {
    /// Counts a row that cannot be used; an error if reading is strict.
    pub(crate) fn skip(
        &mut self,
        problem: Problem,
        place: Place,
        value: impl FnOnce() -> String,
    ) -> Result<(), Fault> {
        self.report_skip(problem, place, value)?;
        self.check_count()?;
        if let Some(survey) = &mut self.survey {
            survey.skip(&mut self.first);
        } else if let Some(chunking) = &self.chunking {
            // The row that the chunks began with is not to be counted twice.
            if chunking.skip(&mut self.first)? {
                return Ok(());
            }
        } else if self.ids.is_none() {
            let mut ids = Vec::with_capacity(self.records.capacity());
            ids.extend((0..self.records.len() as u64).map(to_id));
            self.ids = Some(ids);
        }
        self.rows += 1;
        Ok(())
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

    /// Checks that the next row still has an id.
    pub(super) fn check_count(&self) -> Result<(), Fault> {
        if self.rows < MAX_RECORDS as u64 {
            return Ok(());
        }
        Err(ErrorKind::TooManyRecords(self.rows + 1).into())
    }

    /// Reports a row that cannot be used; an error if reading is strict.
    pub(super) fn report_skip(
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
}
