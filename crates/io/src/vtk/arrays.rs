/*!
Arrays of a VTK file: columns of its points, or something to pass over.

| keyword | behind it |
| --- | --- |
| `SCALARS` | name, type, sometimes the width, then `LOOKUP_TABLE` and its name |
| `COLOR_SCALARS` | name, width; bytes, or as text numbers from 0 to 1 |
| `VECTORS`, `NORMALS`, `TENSORS`, `GLOBAL_IDS`, ... | name, type |
| `TEXTURE_COORDINATES` | name, width, type |
| `LOOKUP_TABLE` | name, number of colors of four bytes, or as text four numbers |
| `FIELD` | name, number of arrays, of each its name, width, length and type |
*/

use super::{
    File, Section,
    source::{Kind, Source},
};
use crate::{
    builder::{Builder, to_f32},
    color::Colors,
    error::Fault,
    table::Table,
};
use puncta_core::Scalar;

/// The largest number of values for each point that become scalars.
const WIDTH_MAX: u64 = 9;

/// What an array is for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// Numbers, or colors if their type is that of colors.
    Any,
    /// Directions, whose length tells nothing.
    Normals,
    /// Colors, of numbers from 0 to 1 if they are text.
    Colors,
    /// Nothing that is kept.
    None,
}

/// An array whose values follow.
struct Array {
    name: String,
    kind: Kind,
    /// How many values belong to a point or cell.
    width: u64,
    purpose: Purpose,
}

/// The values of a scalar.
#[derive(Clone, Copy)]
enum Part {
    Component(usize),
    Length,
}

impl File<'_, '_, '_> {
    /// Reads or passes over the array that a keyword announces.
    pub(super) fn read_array(&mut self, keyword: &str) -> Result<(), Fault> {
        let count = match self.section {
            Section::Geometry => None,
            Section::Cells(count) => Some(count),
            Section::Points => Some(self.rows),
        };
        let header = header(keyword).zip(count);
        let Some((header, count)) = header else {
            return Err(self.source.invalid("there must be a keyword of this part of the format"));
        };
        let source = &mut self.source;
        let name = source.name()?;
        let array = match header {
            Header::Table => {
                let colors = source.count("the number of colors")?;
                return source.skip(Kind::U8, colors.saturating_mul(4), keyword);
            }
            Header::Scalars => {
                let kind = source.kind()?;
                Array { name, kind, width: read_width(source)?, purpose: Purpose::Any }
            }
            Header::Colors => {
                let width = source.count("the number of values of a color")?;
                Array { name, kind: Kind::U8, width, purpose: Purpose::Colors }
            }
            Header::Texture => {
                let width = source.count("the number of texture coordinates")?;
                Array { name, kind: source.kind()?, width, purpose: Purpose::Any }
            }
            Header::Fixed(width, purpose) => Array { name, kind: source.kind()?, width, purpose },
        };
        self.take(&array, count)
    }

    /// Reads or passes over a list of arrays.
    pub(super) fn read_field(&mut self) -> Result<(), Fault> {
        self.source.name()?;
        let mut left = self.source.count("the number of arrays")?;
        while left > 0 {
            // What describes an array may follow it.
            match self.source.keyword()?.as_deref() {
                Some("METADATA") => {
                    self.source.skip_paragraph()?;
                    continue;
                }
                Some("NULL_ARRAY") => {
                    left -= 1;
                    continue;
                }
                _ => self.source.hold(),
            }
            let name = self.source.name()?;
            let width = self.source.count("the number of values in a tuple")?;
            let count = self.source.count("the number of tuples")?;
            let array = Array { name, kind: self.source.kind()?, width, purpose: Purpose::Any };
            self.take(&array, count)?;
            left -= 1;
        }
        Ok(())
    }

    /// Makes columns of an array, or passes over it.
    fn take(&mut self, array: &Array, count: u64) -> Result<(), Fault> {
        let Array { name, kind, width, purpose } = array;
        let total = count.saturating_mul(*width);
        let builder = match &mut self.builder {
            Some(builder) if self.section == Section::Points => builder,
            _ => return self.source.skip(*kind, total, name),
        };
        if *purpose == Purpose::None {
            return self.source.skip(*kind, total, name);
        }
        if count != self.rows || !(1..=WIDTH_MAX).contains(width) || *kind == Kind::Text {
            builder.warn(format!("the array {name} of {width} x {count} values is left out"));
            return self.source.skip(*kind, total, name);
        }
        let is_radius = *width == 1 && name.eq_ignore_ascii_case("radius");
        let is_color = *kind == Kind::U8 && matches!(width, 3 | 4) || *purpose == Purpose::Colors;
        let is_color = is_color && *width <= 4 && !builder.has_colors();
        let mut wanted = parts(array);
        wanted.retain(|(name, _)| self.options.wants(name));
        if wanted.is_empty() && !is_radius && !is_color {
            return self.source.skip(*kind, total, name);
        }
        if !is_radius && !is_color {
            self.columns += wanted.len() as u64;
            Table::check(self.columns, self.source.place())?;
        }
        self.source.start(*kind, total, name)?;
        if is_radius {
            read_radii(&mut self.source, builder, array, count)
        } else if is_color {
            read_colors(&mut self.source, builder, array, count)
        } else {
            read_scalars(&mut self.source, builder, (array, count), wanted)
        }
    }
}

/// What stands between the name of an array and its values.
enum Header {
    Scalars,
    Colors,
    Texture,
    Table,
    /// Only the type; this width is known.
    Fixed(u64, Purpose),
}

fn header(keyword: &str) -> Option<Header> {
    Some(match keyword {
        "SCALARS" => Header::Scalars,
        "COLOR_SCALARS" => Header::Colors,
        "TEXTURE_COORDINATES" => Header::Texture,
        "LOOKUP_TABLE" => Header::Table,
        "VECTORS" | "HIGHERORDERDEGREES" => Header::Fixed(3, Purpose::Any),
        "NORMALS" => Header::Fixed(3, Purpose::Normals),
        "TENSORS" => Header::Fixed(9, Purpose::None),
        "TENSORS6" => Header::Fixed(6, Purpose::None),
        "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" | "RATIONALWEIGHTS" => {
            Header::Fixed(1, Purpose::Any)
        }
        _ => return None,
    })
}

/// The width of `SCALARS`, which is 1 if it is not there, and the name of their table of colors.
fn read_width(source: &mut Source<'_, '_>) -> Result<u64, Fault> {
    let width = match source.rest_of_line()? {
        b"" => 1,
        text => match std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()) {
            Some(width) => width,
            None => return Err(source.invalid("the width of scalars must be a whole number")),
        },
    };
    match source.keyword()?.as_deref() {
        Some("LOOKUP_TABLE") => source.expect("the name of a table").map(|_| ())?,
        // The keyword must be there, but numbers of a text cannot be mistaken for it.
        _ if source.is_text() => source.hold(),
        _ => return Err(source.invalid("behind SCALARS there must be LOOKUP_TABLE")),
    }
    Ok(width)
}

/// The names of the scalars that an array gives.
fn parts(array: &Array) -> Vec<(String, Part)> {
    let Array { name, width, purpose, .. } = array;
    match width {
        1 => vec![(name.clone(), Part::Component(0))],
        3 => {
            let axes = ["x", "y", "z"].into_iter().enumerate();
            let axes = axes.map(|(i, axis)| (format!("{name}_{axis}"), Part::Component(i)));
            let length = (*purpose != Purpose::Normals).then(|| (name.clone(), Part::Length));
            axes.chain(length).collect()
        }
        _ => {
            let width = usize::try_from(*width).unwrap_or(0);
            (0..width).map(|i| (format!("{name}_{i}"), Part::Component(i))).collect()
        }
    }
}

/// Makes scalars of an array.
fn read_scalars(
    source: &mut Source<'_, '_>,
    builder: &mut Builder<'_>,
    (array, count): (&Array, u64),
    wanted: Vec<(String, Part)>,
) -> Result<(), Fault> {
    let column = |(name, part)| (part, name, Vec::with_capacity(builder.kept()));
    let mut columns: Vec<(Part, String, Vec<f32>)> = wanted.into_iter().map(column).collect();
    let (mut row, mut is_exact) = (0, true);
    source.tuples((array.kind, width(array)), count, &array.name, |tuple, _| {
        if builder.keeps(row) {
            for (part, _, values) in &mut columns {
                let value = match *part {
                    Part::Component(index) => tuple.get(index).copied().unwrap_or(f64::NAN),
                    Part::Length => tuple.iter().map(|x| x * x).sum::<f64>().sqrt(),
                };
                let stored = to_f32(value);
                is_exact &= !matches!(part, Part::Component(_)) || f64::from(stored) == value;
                values.push(stored);
            }
        }
        row += 1;
        Ok(())
    })?;
    if array.kind.is_integer() && !is_exact {
        builder.warn(format!("the integers of {} are rounded to 24 bits", array.name));
    }
    for (_, name, values) in columns {
        builder.add_scalar(Scalar { name, values: values.into() });
    }
    Ok(())
}

/// Gives the points the radii of an array.
fn read_radii(
    source: &mut Source<'_, '_>,
    builder: &mut Builder<'_>,
    array: &Array,
    count: u64,
) -> Result<(), Fault> {
    let (mut row, mut index) = (0, 0);
    source.tuples((array.kind, 1), count, &array.name, |tuple, place| {
        if builder.keeps(row) {
            builder.set_radius(index, tuple.first().copied().unwrap_or(f64::NAN), place)?;
            index += 1;
        }
        row += 1;
        Ok(())
    })?;
    builder.end_radii();
    Ok(())
}

/// Makes colors of an array: gray, gray and alpha, red green and blue, or these and alpha.
fn read_colors(
    source: &mut Source<'_, '_>,
    builder: &mut Builder<'_>,
    array: &Array,
    count: u64,
) -> Result<(), Fault> {
    let is_fraction = array.purpose == Purpose::Colors && source.is_text();
    let one = if is_fraction { 1.0 } else { 255.0 };
    let (mut changed, mut colors) = (Colors::default(), Vec::with_capacity(builder.kept()));
    let mut row = 0;
    source.tuples((array.kind, width(array)), count, &array.name, |tuple, _| {
        if builder.keeps(row) {
            let color = match *tuple {
                [gray] => [gray, gray, gray, one],
                [gray, alpha] => [gray, gray, gray, alpha],
                [red, green, blue] => [red, green, blue, one],
                [red, green, blue, alpha, ..] => [red, green, blue, alpha],
                [] => [one; 4],
            };
            colors.push(changed.color(color.map(|part| part / one)));
        }
        row += 1;
        Ok(())
    })?;
    changed.warn(builder);
    builder.add_colors(colors);
    Ok(())
}

fn width(array: &Array) -> usize {
    usize::try_from(array.width).unwrap_or(1)
}
