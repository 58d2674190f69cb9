//! What the properties of a vertex mean.

use super::{
    header::{Element, Kind, Property},
    number::Number,
};
use crate::{
    builder::{Builder, Columns, Row, to_f32},
    color::{Colors, WHITE},
    error::{Fault, quote},
};

/// The names of colors, the usual ones first.
const COLOR_NAMES: [[&str; 4]; 3] = [
    ["red", "green", "blue", "alpha"],
    ["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"],
    ["r", "g", "b", "a"],
];

/// A number of a vertex; lists have none.
#[derive(Clone, Debug)]
struct Field {
    name: String,
    number: Number,
}

/// Where to find a part of a color, and its largest value.
#[derive(Clone, Copy, Debug)]
struct Part {
    field: usize,
    largest: f64,
}

/// Red, green and blue, and alpha if there is one.
type Color = ([Part; 3], Option<Part>);

/// Makes rows of the numbers of a vertex.
#[derive(Debug)]
pub(super) struct Vertex {
    fields: Vec<Field>,
    position: [usize; 3],
    radius: Option<usize>,
    color: Option<Color>,
    element: Option<usize>,
    /// The fields that are scalars, and their values in the present row.
    scalars: Vec<usize>,
    scalar_values: Vec<f32>,
    /// The number type of properties that have the names of colors only.
    not_colors: Option<Number>,
    colors: Colors,
    /// How many atomic numbers are none, which only text can have.
    not_elements: u64,
}

impl Vertex {
    /// Finds the fields; x, y and z must be there.
    pub(super) fn new(element: &Element) -> Result<Self, Fault> {
        let field = |property: &Property| match property.kind {
            Kind::Scalar(number) => Some(Field { name: property.name.clone(), number }),
            Kind::List(..) => None,
        };
        let fields: Vec<Field> = element.properties.iter().filter_map(field).collect();
        let find = |name: &str| fields.iter().position(|field| field.name == name);
        let axis = |name: &str| {
            find(name).ok_or_else(|| {
                let names: Vec<_> = fields.iter().map(|field| &*field.name).collect();
                let names = quote(names.join(" ").as_bytes());
                Fault::invalid(element.place, format!("vertex must have a number {name}"), names)
            })
        };
        let position = [axis("x")?, axis("y")?, axis("z")?];
        let radius = find("radius");
        let is_byte = |&index: &usize| fields[index].number == Number::Uchar;
        let atom = find("element").filter(is_byte);
        let (color, not_colors) = find_color(&fields);
        let mut taken = vec![position[0], position[1], position[2]];
        taken.extend([radius, atom].into_iter().flatten());
        if let Some((parts, alpha)) = &color {
            taken.extend(parts.iter().chain(alpha).map(|part| part.field));
        }
        let scalars = (0..fields.len()).filter(|index| !taken.contains(index)).collect();
        let (scalar_values, colors) = (Vec::new(), Colors::default());
        let element = atom;
        Ok(Self {
            fields,
            position,
            radius,
            color,
            element,
            scalars,
            scalar_values,
            not_colors,
            colors,
            not_elements: 0,
        })
    }

    /// The types of x, y and z.
    pub(super) fn axes(&self) -> [Number; 3] {
        self.position.map(|index| self.fields[index].number)
    }

    /// The types of all numbers, in the order of the file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = Number> {
        self.fields.iter().map(|field| field.number)
    }

    /// What there is besides positions and radii.
    pub(super) fn columns(&self) -> Columns {
        Columns {
            color: self.color.is_some(),
            element: self.element.is_some(),
            scalars: self.scalars.iter().map(|&index| self.fields[index].name.clone()).collect(),
        }
    }

    /// The row of a vertex with these numbers, one for each field.
    pub(super) fn row(&mut self, values: &[f64]) -> Row<'_> {
        let color = self.color.map_or(WHITE, |(parts, alpha)| {
            let part = |part: Part| values[part.field] / part.largest;
            let [red, green, blue] = parts.map(part);
            self.colors.color([red, green, blue, alpha.map_or(1.0, part)])
        });
        self.scalar_values.clear();
        self.scalar_values.extend(self.scalars.iter().map(|&index| to_f32(values[index])));
        let element = self.element.map_or(0, |index| {
            let element = to_byte(values[index]);
            self.not_elements += u64::from(element.is_none());
            element.unwrap_or(0)
        });
        Row {
            position: self.position.map(|index| values[index]),
            radius: self.radius.map(|index| values[index]),
            color,
            element,
            scalars: &self.scalar_values,
            ..Row::default()
        }
    }

    /// Tells what the properties are not.
    pub(super) fn warn(&self, builder: &mut Builder<'_>) {
        if let Some(number) = self.not_colors {
            let number = number.name();
            builder.warn(format!(
                "colors of type {number} have no known largest value; they were kept as scalars"
            ));
        }
    }

    /// Tells what happened to colors and elements.
    pub(super) fn warn_of_rows(&self, builder: &mut Builder<'_>) {
        self.colors.warn(builder);
        if self.not_elements > 0 {
            let count = self.not_elements;
            builder.warn(format!("{count} atomic numbers are not 0 to 255; they were taken for 0"));
        }
    }
}

fn to_byte(value: f64) -> Option<u8> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "what does not fit is not equal any more"
    )]
    let byte = value as u8;
    (f64::from(byte) == value).then_some(byte)
}

/// The parts of the color, or the type because of which there are none.
fn find_color(fields: &[Field]) -> (Option<Color>, Option<Number>) {
    let find = |name: &str| fields.iter().position(|field| field.name == name);
    let mut not_colors = None;
    for [red, green, blue, alpha] in COLOR_NAMES {
        let (Some(red), Some(green), Some(blue)) = (find(red), find(green), find(blue)) else {
            continue;
        };
        let part = |field: usize| {
            let largest = match fields[field].number {
                Number::Uchar => 255.0,
                Number::Ushort => 65535.0,
                Number::Float | Number::Double => 1.0,
                other => return Err(other),
            };
            Ok(Part { field, largest })
        };
        match (part(red), part(green), part(blue), find(alpha).map(part).transpose()) {
            (Ok(red), Ok(green), Ok(blue), Ok(alpha)) => {
                return (Some(([red, green, blue], alpha)), not_colors);
            }
            (Err(number), ..)
            | (_, Err(number), ..)
            | (_, _, Err(number), _)
            | (.., Err(number)) => {
                not_colors = Some(number);
            }
        }
    }
    (None, not_colors)
}
