/*!
Atoms: a builder for readers whose rows may have an element instead of a radius.

An atom of a known element takes the radius of that element. An atom of an unknown one takes the
radius of an unknown element, with a warning, if any atom of the frame is of a known element; else
the names are no elements at all (the beads of a coarse model, say), so the elements are dropped and
the radius is estimated from the spacing.
*/

use crate::{
    ReadOptions,
    builder::{Builder, Columns, Precision, Report, Row},
    error::{Fault, Place, Problem, quote},
    table::{Table, Values},
};
use puncta_core::Scene;

/// A scene of atoms in the making.
pub(crate) struct Atoms<'a> {
    builder: Builder<'a>,
    options: &'a ReadOptions,
    has_elements: bool,
    /// Whether any row is of a known element.
    known: bool,
    /// How many rows are of an unknown element, and where the first one is.
    unknown: Option<(u64, Place)>,
}

impl<'a> Atoms<'a> {
    pub(crate) fn new(options: &'a ReadOptions, columns: &Columns) -> Self {
        Self {
            builder: Builder::new(options, Precision::Double, columns),
            options,
            has_elements: columns.element,
            known: false,
            unknown: None,
        }
    }

    /// For the rows of a table.
    pub(crate) fn of_table(options: &'a ReadOptions, table: &Table) -> Self {
        let mut atoms = Self::new(options, &table.columns());
        for name in &table.repeated {
            atoms.warn(format!("a second scalar {name} is left out"));
        }
        atoms
    }

    pub(crate) fn reserve(&mut self, count: u64) -> Result<(), Fault> {
        self.builder.reserve(count)
    }

    /// Adds a row; if it has no radius, then that of its element.
    pub(crate) fn push(&mut self, mut row: Row<'_>, place: Place) -> Result<(), Fault> {
        if self.has_elements {
            self.known |= row.element > 0;
            if row.radius.is_none() && row.element > 0 {
                row.radius = Some(self.options.radii.of(row.element));
            } else if row.element == 0 {
                self.unknown.get_or_insert((0, place)).0 += 1;
            }
        }
        self.builder.push(&row, place)
    }

    /// Adds a row of a table, or skips it if it cannot be used.
    pub(crate) fn push_text(
        &mut self,
        line: &[u8],
        place: Place,
        table: &Table,
        values: &mut Values,
    ) -> Result<(), Fault> {
        match table.parse(line, values) {
            Ok(()) => self.push(values.row(), place),
            Err((problem, text)) => self.skip(problem, place, || quote(text)),
        }
    }

    pub(crate) fn skip(
        &mut self,
        problem: Problem,
        place: Place,
        value: impl FnOnce() -> String,
    ) -> Result<(), Fault> {
        self.builder.skip(problem, place, value)
    }

    /// Tells what happened to the colors of rows.
    pub(crate) fn warn_of_colors(&mut self, values: &Values) {
        values.colors.warn(&mut self.builder);
    }

    /// Says that the row to be added next, the last one, stands before all others in the file.
    pub(crate) fn first_comes(&mut self) {
        self.builder.first_comes();
    }

    /// The builder, for what is not about atoms.
    pub(crate) fn builder(&mut self) -> &mut Builder<'a> {
        &mut self.builder
    }

    pub(crate) fn warn(&mut self, warning: impl Into<String>) {
        self.builder.warn(warning);
    }

    pub(crate) fn finish(mut self) -> Result<(Scene, Report), Fault> {
        if let (true, Some((count, first))) = (self.known, self.unknown) {
            let radius = self.options.radii.of(0);
            let rest = if self.builder.fill_radius(radius) {
                format!(" and was given the radius {radius}")
            } else {
                String::new()
            };
            self.warn(format!(
                "the element of {count} atoms is not known{rest}; the first: {first}"
            ));
        }
        if !self.known {
            self.builder.drop_elements();
        }
        self.builder.finish()
    }
}
