//! The reader: finds the frame, and whether its second line is a comment.

use super::properties;
use crate::{
    ReadOptions,
    atoms::Atoms,
    builder::Report,
    error::{ErrorKind, Fault, Place, Problem, quote},
    input::Input,
    table::{Role, Table, Values, is_kind},
    text::{self, Lines, columns, number, whole},
};
use puncta_core::Scene;

/// What a file starts with.
const FIRST: &str = "the first line must be the number of atoms, or a row of coordinates";

/// Reads a frame.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let mut lines = Lines::new(input);
    if !advance_to_data(&mut lines)? {
        return Err(ErrorKind::NoSuchFrame { frame: options.frame, frames: 0 }.into());
    }
    if columns(lines.text()).count() == 1 {
        lines.hold();
        let count = seek(&mut lines, options.frame)?;
        return read_frame(&mut lines, options, count);
    }
    if options.frame > 0 {
        return Err(ErrorKind::NoSuchFrame { frame: options.frame, frames: 1 }.into());
    }
    read_points(&mut lines, options)
}

/// Where the coordinates of a row are, without a header that tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Behind a name.
    Named,
    /// At the start.
    Bare,
}

impl Shape {
    /// The shape of a row of a frame, if there was no other row.
    fn in_frame(line: &[u8]) -> Option<Self> {
        [Self::Named, Self::Bare].into_iter().find(|shape| shape.may_be(line))
    }

    /// Whether a row of a frame may have this shape.
    fn may_be(self, line: &[u8]) -> bool {
        let is_name = columns(line).next().is_some_and(is_kind);
        (self == Self::Bare || is_name) && self.fits(line)
    }

    /// The shape of the row that was read last and of the `more` that may follow.
    ///
    /// A whole number at the start may be x or a name: the rows after it tell, as far as they are
    /// looked at.
    fn of_rows(lines: &mut Lines<'_, '_>, more: u64) -> Result<Option<Self>, Fault> {
        let row = lines.text();
        let Some(shape) = Self::in_frame(row) else { return Ok(None) };
        if shape == Self::Bare || !Self::Bare.may_be(row) {
            return Ok(Some(shape));
        }
        let count = columns(row).count();
        let is_bare = lines
            .look_ahead(more)?
            .any(|row| columns(row).count() == count && Self::in_frame(row) == Some(Self::Bare));
        Ok(Some(if is_bare { Self::Bare } else { shape }))
    }

    /// The shape of a row of a file without frames.
    fn of_point(line: &[u8]) -> Option<Self> {
        [Self::Bare, Self::Named].into_iter().find(|shape| shape.fits(line))
    }

    /// Whether there are numbers where the coordinates should be.
    fn fits(self, line: &[u8]) -> bool {
        columns(line).skip(self.start()).map(number).take(3).flatten().count() == 3
    }

    /// The index of the first coordinate.
    fn start(self) -> usize {
        usize::from(self == Self::Named)
    }

    /// The table of rows like this one.
    fn table(self, row: &[u8], place: Place, options: &ReadOptions) -> Result<Table, Fault> {
        Table::check(columns(row).count() as u64, place)?;
        let mut table = Table::default();
        for (column, text) in columns(row).enumerate() {
            match column.checked_sub(self.start()) {
                None if number(text).is_some() => table.push(Role::Kind),
                None => table.push(Role::Element),
                Some(axis @ 0..3) => table.push(Role::Axis(axis)),
                Some(_) if number(text).is_some() => {
                    table.push_scalar(format!("column_{}", column + 1), options, Role::Scalar);
                }
                Some(_) => table.push(Role::Ignored),
            }
        }
        Ok(table)
    }
}

/// Goes to the first line that is neither blank nor a comment.
fn advance_to_data(lines: &mut Lines<'_, '_>) -> Result<bool, Fault> {
    while lines.advance_to_text()? {
        if !is_comment(lines.text()) {
            return Ok(true);
        }
    }
    Ok(false)
}

fn is_comment(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    line.starts_with(b"#") || line.starts_with(b"//")
}

/// Whether a line can only follow after a frame: it is blank, or a number of atoms.
fn ends_frame(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line.is_empty() || whole(line).is_some()
}

/// Goes to the frame of this index, and over its number of atoms, which is returned.
fn seek(lines: &mut Lines<'_, '_>, frame: u64) -> Result<u64, Fault> {
    for frames in 0.. {
        if !lines.advance_to_text()? {
            return Err(ErrorKind::NoSuchFrame { frame, frames }.into());
        }
        let line = lines.text().trim_ascii();
        // Commas between numbers, say: it may be another kind of file altogether.
        if frames == 0 && number(line).is_none() {
            return Err(Fault::invalid(lines.place(), FIRST, quote(line)));
        }
        let count = text::count(line, lines.place(), "the number of atoms")?;
        if frames == frame {
            return Ok(count);
        }
        pass(lines, count)?;
    }
    Ok(0)
}

/// Passes over the rest of a frame of `count` atoms.
fn pass(lines: &mut Lines<'_, '_>, count: u64) -> Result<(), Fault> {
    let second = second_line(lines, count)?;
    for found in u64::from(second.shape.is_some())..count {
        if !lines.advance()? {
            return Err(text::too_few(lines.place(), count, found));
        }
    }
    if second.shape.is_some() && lines.advance()? && ends_frame(lines.text()) {
        lines.hold();
    }
    Ok(())
}

/// The second line of a frame.
struct Second {
    line: Vec<u8>,
    place: Place,
    /// What its shape and that of all rows is if it is the first atom; `None` if it is not.
    shape: Option<Shape>,
}

/// Reads the second line of a frame of `count` atoms.
fn second_line(lines: &mut Lines<'_, '_>, count: u64) -> Result<Second, Fault> {
    if !lines.advance()? && count > 0 {
        return Err(text::too_few(lines.place(), count, 0));
    }
    let (line, place) = (lines.text().to_vec(), lines.place());
    let mut shape = Shape::in_frame(&line).filter(|_| count > 0);
    if shape.is_some() {
        if lines.advance()? {
            let is_single = count == 1 && ends_frame(lines.text());
            if !is_single {
                // It must be like the other rows, and does not tell what these are.
                let is_as_long = columns(&line).count() == columns(lines.text()).count();
                let rows = if is_as_long { Shape::of_rows(lines, count - 1)? } else { None };
                shape = rows.filter(|rows| rows.may_be(&line));
            }
            lines.hold();
        } else if count > 1 {
            return Err(text::too_few(lines.place(), count, 1));
        }
    }
    Ok(Second { line, place, shape })
}

/// Reads the rest of a frame of `count` atoms.
fn read_frame(
    lines: &mut Lines<'_, '_>,
    options: &ReadOptions,
    count: u64,
) -> Result<(Scene, Report), Fault> {
    let mut second = second_line(lines, count)?;
    let mut rows = count;
    let mut first_bad = None;
    let told = properties::told(&second.line, second.place, options)?;
    let table = match told.table {
        Some(table) => {
            second.shape = None;
            table
        }
        None => match second.shape {
            Some(shape) => shape.table(&second.line, second.place, options)?,
            None => first_table(lines, options, count, &mut first_bad)?,
        },
    };
    let mut rest = Rows::new(table, options);
    if lines.can_hold(count, rest.table.roles.len()) {
        rest.atoms.reserve(count)?;
    }
    told.warning.into_iter().for_each(|warning| rest.atoms.warn(warning));
    if let Some(bad) = first_bad {
        rows -= bad.count;
        for _ in 0..bad.count {
            rest.atoms.skip(Problem::Columns, bad.place, || bad.text.clone())?;
        }
    }
    rows -= u64::from(second.shape.is_some());
    for found in count - rows..count {
        if !lines.advance()? {
            return Err(text::too_few(lines.place(), count, found));
        }
        rest.push(lines)?;
    }
    if second.shape.is_none() {
        warn_of_more(lines, &mut rest.atoms)?;
        return rest.finish();
    }
    if lines.advance()? && !ends_frame(lines.text()) {
        rest.push(lines)?;
        warn_of_more(lines, &mut rest.atoms)?;
        return rest.finish();
    }
    rest.atoms.warn("the frame has no comment: its second line was taken for an atom");
    rest.atoms.first_comes();
    rest.atoms.push_text(&second.line, second.place, &rest.table, &mut rest.values)?;
    rest.finish()
}

/// Lines at the start of a frame that do not tell what its columns are.
struct FirstBad {
    count: u64,
    place: Place,
    text: String,
}

/// The table that the first usable row tells of; that row comes next.
fn first_table(
    lines: &mut Lines<'_, '_>,
    options: &ReadOptions,
    count: u64,
    first_bad: &mut Option<FirstBad>,
) -> Result<Table, Fault> {
    for found in 0..count {
        if !lines.advance()? {
            return Err(text::too_few(lines.place(), count, found));
        }
        if let Some(shape) = Shape::of_rows(lines, count - found - 1)? {
            lines.hold();
            return shape.table(lines.text(), lines.place(), options);
        }
        let (place, text) = (lines.place(), lines.text());
        let bad = || FirstBad { count: 0, place, text: quote(text) };
        first_bad.get_or_insert_with(bad).count += 1;
    }
    Ok(Table::default())
}

/// Warns if what follows a frame is no other frame.
fn warn_of_more(lines: &mut Lines<'_, '_>, atoms: &mut Atoms<'_>) -> Result<(), Fault> {
    if lines.advance()? && !ends_frame(lines.text()) {
        let (place, text) = (lines.place(), quote(lines.text()));
        atoms.warn(format!("{place}, after the frame, was not read: it starts no frame, {text}"));
    }
    Ok(())
}

/// Reads a file without frames, whose first row is the line that was read last.
fn read_points(lines: &mut Lines<'_, '_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let (line, place) = (lines.text(), lines.place());
    let Some(shape) = Shape::of_point(line) else {
        return Err(Fault::invalid(place, FIRST, quote(line)));
    };
    let mut rows = Rows::new(shape.table(line, place, options)?, options);
    rows.push(lines)?;
    while advance_to_data(lines)? {
        rows.push(lines)?;
    }
    rows.finish()
}

/// The rows of a frame, on their way into a scene.
struct Rows<'o> {
    table: Table,
    values: Values,
    atoms: Atoms<'o>,
}

impl<'o> Rows<'o> {
    fn new(table: Table, options: &'o ReadOptions) -> Self {
        let (values, atoms) = (table.values(), Atoms::of_table(options, &table));
        Self { table, values, atoms }
    }

    /// Adds the line that was read last.
    fn push(&mut self, lines: &Lines<'_, '_>) -> Result<(), Fault> {
        self.atoms.push_text(lines.text(), lines.place(), &self.table, &mut self.values)
    }

    fn finish(mut self) -> Result<(Scene, Report), Fault> {
        self.atoms.warn_of_colors(&self.values);
        self.atoms.finish()
    }
}
