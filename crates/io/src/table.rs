//! Tables: text in columns, whose roles a header, or the first row, tells.

use crate::{
    ReadOptions,
    builder::{Columns, Row},
    color::Colors,
    elements,
    error::{Fault, Place, Problem},
    text::{columns, number, number_f32, whole},
};

/// The largest number of columns: a header must not make a reader keep names without end.
const COLUMNS_MAX: u64 = 4096;

/// What a column of a table is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Nothing that is kept.
    Ignored,
    /// A coordinate.
    Axis(usize),
    Radius,
    Diameter,
    /// A channel of the color, from 0 to 1.
    Color(usize),
    /// A channel of the color, from 0 to 255.
    ColorByte(usize),
    /// A symbol, a label or an atomic number.
    Element,
    /// An atomic number or another whole one, or a label: the first column of rows whose first one
    /// starts with a whole number. With a fraction or a sign it would be a coordinate.
    Kind,
    /// A whole number by which an atom is known.
    Id,
    /// A measurement of this index.
    Scalar(usize),
    /// A measurement of this index, and the id too.
    IdScalar(usize),
    /// A truth value of this index.
    Logical(usize),
}

/// The roles of the columns of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Table {
    pub(crate) roles: Vec<Role>,
    /// The names of the scalars.
    pub(crate) names: Vec<String>,
    /// The names of scalars that were there already.
    pub(crate) repeated: Vec<String>,
}

/// What a row holds; used again for each row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    pub(crate) axes: [f64; 3],
    pub(crate) radius: Option<f64>,
    pub(crate) color: [u8; 4],
    pub(crate) element: u8,
    pub(crate) id: i64,
    pub(crate) scalars: Vec<f32>,
    /// What happened to colors.
    pub(crate) colors: Colors,
    /// The color of a row whose color is to be made, with parts from 0 to 1.
    parts: [f64; 4],
    has_color: bool,
}

/// Why a row cannot be used, and the text at fault.
type Bad<'a> = (Problem, &'a [u8]);

impl Table {
    /// Checks the number of columns.
    pub(crate) fn check(columns: u64, place: Place) -> Result<(), Fault> {
        if columns > COLUMNS_MAX {
            let what = format!("there must be at most {COLUMNS_MAX} columns");
            return Err(Fault::invalid(place, what, columns));
        }
        Ok(())
    }

    /// Adds a column.
    pub(crate) fn push(&mut self, role: Role) {
        self.roles.push(role);
    }

    /// Adds a column of measurements if they are wanted and there are none of this name.
    pub(crate) fn push_scalar(
        &mut self,
        name: String,
        options: &ReadOptions,
        role: fn(usize) -> Role,
    ) {
        if self.names.contains(&name) {
            self.repeated.push(name);
            self.roles.push(Role::Ignored);
        } else if options.wants(&name) {
            self.roles.push(role(self.names.len()));
            self.names.push(name);
        } else {
            self.roles.push(Role::Ignored);
        }
    }

    /// Whether there is such a column.
    pub(crate) fn has(&self, role: Role) -> bool {
        self.roles.contains(&role)
    }

    fn has_color(&self) -> bool {
        self.has(Role::Color(0)) || self.has(Role::ColorByte(0))
    }

    /// The columns that a builder must know.
    pub(crate) fn columns(&self) -> Columns {
        Columns {
            color: self.has_color(),
            element: self.has(Role::Element) || self.has(Role::Kind),
            scalars: self.names.clone(),
        }
    }

    /// Room for the values of a row.
    pub(crate) fn values(&self) -> Values {
        Values {
            axes: [0.0; 3],
            radius: None,
            color: [255; 4],
            element: 0,
            id: i64::MAX,
            scalars: vec![f32::NAN; self.names.len()],
            colors: Colors::default(),
            parts: [1.0; 4],
            has_color: self.has_color(),
        }
    }

    /// Reads a row. It must have as many columns as the table.
    pub(crate) fn parse<'l>(&self, line: &'l [u8], values: &mut Values) -> Result<(), Bad<'l>> {
        values.id = i64::MAX;
        let mut texts = columns(line);
        let mut wrong = None;
        for role in &self.roles {
            let text = texts.next().ok_or((Problem::Columns, line))?;
            if values.set(*role, text).is_none() && wrong.is_none() {
                wrong = Some(text);
            }
        }
        match (texts.next(), wrong) {
            (Some(_), _) => Err((Problem::Columns, line)),
            (None, Some(text)) => Err((Problem::Number, text)),
            (None, None) => {
                if values.has_color {
                    values.color = values.colors.color(values.parts);
                }
                Ok(())
            }
        }
    }
}

impl Values {
    /// What was read, as a row for a builder.
    pub(crate) fn row(&self) -> Row<'_> {
        let Self { axes: position, radius, color, element, .. } = *self;
        Row { position, radius, color, element, scalars: &self.scalars, ..Row::default() }
    }

    /// Takes the text of a column; `None` if it is not what it must be.
    fn set(&mut self, role: Role, text: &[u8]) -> Option<()> {
        match role {
            Role::Ignored => {}
            Role::Axis(axis) => *self.axes.get_mut(axis)? = number(text)?,
            Role::Radius => self.radius = Some(number(text)?),
            Role::Diameter => self.radius = Some(number(text)? / 2.0),
            Role::Color(channel) => *self.parts.get_mut(channel)? = number(text)?,
            Role::ColorByte(channel) => *self.parts.get_mut(channel)? = number(text)? / 255.0,
            Role::Element => self.element = elements::from_label(text),
            Role::Kind if !is_kind(text) => return None,
            Role::Kind => self.element = elements::from_label(text),
            Role::Id => self.id = id(text)?,
            Role::Scalar(index) => *self.scalars.get_mut(index)? = number_f32(text)?,
            Role::IdScalar(index) => {
                self.id = id(text)?;
                *self.scalars.get_mut(index)? = number_f32(text)?;
            }
            Role::Logical(index) => {
                *self.scalars.get_mut(index)? = match text {
                    b"T" | b"t" | b"True" | b"TRUE" | b"true" | b"1" => 1.0,
                    b"F" | b"f" | b"False" | b"FALSE" | b"false" | b"0" => 0.0,
                    _ => return None,
                }
            }
        }
        Some(())
    }
}

/// Whether a text may tell the kind of an atom: it is a label, or a number of digits alone.
pub(crate) fn is_kind(text: &[u8]) -> bool {
    number(text).is_none() || (whole(text).is_some() && !text.starts_with(b"+"))
}

/// A whole number; some programs write it with a decimal point.
fn id(text: &[u8]) -> Option<i64> {
    /// Up to here, `f64` holds every whole number.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    if let Some(id) = std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()) {
        return Some(id);
    }
    #[expect(clippy::cast_possible_truncation, reason = "the number is whole and small enough")]
    number(text).filter(|id| id.fract() == 0.0 && id.abs() <= EXACT).map(|id| id as i64)
}
