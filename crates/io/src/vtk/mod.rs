/*!
The legacy format of VTK, as text and binary, of versions 1.0 to 5.1.

A file starts with `# vtk DataFile Version 4.1`, a title, `ASCII` or `BINARY`, and `DATASET` with
its type. Read are the points of `POLYDATA`, `UNSTRUCTURED_GRID` and `STRUCTURED_GRID`, of any type
of values; cells in the forms before and since version 5.0, and all else, are passed over. The
section `POINT_DATA` gives columns:

* an array of one value for each point becomes a scalar of its name, and one of three the scalars
  `name_x`, `name_y`, `name_z` and, but for normals, its length as `name`; other arrays of up to
  nine values become `name_0`, `name_1` and so on. Tensors are passed over;
* an array `radius` of one value gives the radii;
* `COLOR_SCALARS`, or else the first array of 3 or 4 bytes for each point, gives the colors.

# Hazards

Points come before their data, so columns are added when the positions are there already, and leave
out what was skipped. Binary values are big-endian and start behind the line that announces them;
what follows them may stand on the same line, and lines may end in `\r\n`. `long` is taken as 8
bytes, as on all systems but one. Numbers of text may be parted by any white space. Integers of a scalar
that `f32` does not hold exactly are a warning.

Source: VTK File Formats (Kitware, for versions up to 4.2), and the reader of the library,
`IO/Legacy/vtkDataReader.cxx`, for all else.
*/

mod arrays;
mod source;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_errors;

use self::source::{Kind, Source};
use crate::{
    ReadOptions,
    builder::{Builder, Columns, Precision, Report, Row},
    error::{ErrorKind, Fault, quote},
    input::Input,
};
use puncta_core::Scene;

/// The datasets that have points.
const DATASETS: [&str; 3] = ["POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID"];

/// Reads the points and their data.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    if options.frame > 0 {
        return Err(ErrorKind::NoSuchFrame { frame: options.frame, frames: 1 }.into());
    }
    let version = read_version(input)?;
    input.expect_line(&mut Vec::new(), "the title")?;
    let mut source = Source::new(input);
    match source.keyword()?.as_deref() {
        Some("ASCII") => {}
        Some("BINARY") => source.set_binary(),
        _ => return Err(source.invalid("the third line must be ASCII or BINARY")),
    }
    let (rows, section, builder) = (0, Section::Geometry, None);
    let mut file = File { source, options, version, rows, section, builder, columns: 0 };
    while let Some(keyword) = file.source.keyword()? {
        file.read_part(&keyword)?;
    }
    match file.builder {
        Some(builder) => builder.finish(),
        None => {
            let what = "the file must have a dataset with POINTS";
            Err(Fault::invalid(file.source.place(), what, "one without"))
        }
    }
}

/// The major version, from the first line.
fn read_version(input: &mut Input<'_>) -> Result<u8, Fault> {
    let mut line = Vec::new();
    input.expect_line(&mut line, "the version")?;
    let text = String::from_utf8_lossy(&line);
    let version = text.trim().rsplit(' ').next().and_then(|version| version.split_once('.'));
    let version = version.and_then(|(major, minor)| {
        let numbers = major.parse::<u8>().ok().zip(minor.parse::<u8>().ok())?;
        text.contains("vtk DataFile Version").then_some(numbers)
    });
    match version {
        Some((major, minor)) if ((1, 0)..=(5, 1)).contains(&(major, minor)) => Ok(major),
        _ => {
            let what = "the first line must be # vtk DataFile Version 1.0 to 5.1";
            Err(Fault::invalid(input.at_line(), what, quote(&line)))
        }
    }
}

/// The part of a file that arrays belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Geometry,
    /// As many cells.
    Cells(u64),
    Points,
}

/// A file that is being read.
struct File<'s, 'i, 'a> {
    source: Source<'i, 'a>,
    options: &'s ReadOptions,
    /// The major version.
    version: u8,
    /// How many points the file has.
    rows: u64,
    section: Section,
    /// Once the points are there.
    builder: Option<Builder<'s>>,
    /// How many columns became scalars.
    columns: u64,
}

impl File<'_, '_, '_> {
    /// Reads what a keyword announces.
    fn read_part(&mut self, keyword: &str) -> Result<(), Fault> {
        match keyword {
            "DATASET" => self.read_dataset(),
            "POINTS" => self.read_points(),
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                self.skip_cells(keyword)
            }
            "CELL_TYPES" => {
                let count = self.source.count("the number of cells")?;
                self.source.skip(Kind::I32, count, keyword)
            }
            "DIMENSIONS" => self.skip_words(3, keyword),
            "EXTENT" => self.skip_words(6, keyword),
            "METADATA" => self.source.skip_paragraph(),
            "CELL_DATA" => {
                self.section = Section::Cells(self.source.count("the number of cells")?);
                Ok(())
            }
            "POINT_DATA" => self.start_point_data(),
            "FIELD" => self.read_field(),
            _ => self.read_array(keyword),
        }
    }

    fn skip_words(&mut self, count: usize, what: &str) -> Result<(), Fault> {
        (0..count).try_for_each(|_| self.source.value(what).map(|_| ()))
    }

    fn read_dataset(&mut self) -> Result<(), Fault> {
        let name = self.source.keyword()?.unwrap_or_default();
        if DATASETS.contains(&name.as_str()) {
            return Ok(());
        }
        let what = format!("the dataset must be one that has points to draw: {DATASETS:?}");
        Err(self.source.invalid(what.replace(['[', ']', '"'], "")))
    }

    fn read_points(&mut self) -> Result<(), Fault> {
        if self.builder.is_some() {
            return Err(self.source.invalid("a file must have its points once"));
        }
        self.rows = self.source.count("the number of points")?;
        let kind = self.source.kind()?;
        let is_single = kind == Kind::F32 && !self.source.is_text();
        let precision = if is_single { Precision::Single } else { Precision::Double };
        let builder = Builder::new(self.options, precision, &Columns::default());
        let builder = self.builder.insert(builder);
        self.source.start(kind, self.rows.saturating_mul(3), "POINTS")?;
        if self.source.has_length() {
            builder.reserve(self.rows)?;
        }
        self.source.tuples((kind, 3), self.rows, "POINTS", |values, place| {
            let position = values.first_chunk().copied().unwrap_or([f64::NAN; 3]);
            builder.push(&Row { position, ..Row::default() }, place)
        })
    }

    /// Passes over cells: before version 5.0 their points, each time behind their number, as `int`;
    /// since then where the points of each cell start, and the points.
    fn skip_cells(&mut self, keyword: &str) -> Result<(), Fault> {
        let first = self.source.count("the number of cells")?;
        let second = self.source.count("the number of values of cells")?;
        let is_text = self.source.is_text();
        if (first, second) == (0, 0) || !is_text && self.version < 5 {
            return self.source.skip(Kind::I32, second, keyword);
        }
        // A text shows by itself which form it has.
        match self.source.keyword()?.as_deref() {
            Some("OFFSETS") => {}
            _ if is_text => {
                self.source.hold();
                return self.source.skip(Kind::I32, second, keyword);
            }
            _ => return Err(self.source.invalid("cells of version 5 must start with OFFSETS")),
        }
        let kind = self.source.kind()?;
        self.source.skip(kind, first, "OFFSETS")?;
        if self.source.keyword()?.as_deref() != Some("CONNECTIVITY") {
            return Err(self.source.invalid("after OFFSETS there must be CONNECTIVITY"));
        }
        let kind = self.source.kind()?;
        self.source.skip(kind, second, "CONNECTIVITY")
    }

    fn start_point_data(&mut self) -> Result<(), Fault> {
        let count = self.source.count("the number of points with data")?;
        if self.builder.is_none() || count != self.rows {
            let what = format!("the points with data must be the {} points", self.rows);
            return Err(self.source.invalid(what));
        }
        self.section = Section::Points;
        Ok(())
    }
}
