//! The header: elements and their properties.

use super::number::{Number, Order};
use crate::{
    error::{Fault, Place, quote},
    input::Input,
};

/// How many elements and properties a header may have: a bound for files that were not made in
/// earnest.
const NAMES_MAX: usize = 4096;

/// How long their names may be.
const NAME_BYTES_MAX: usize = 1024;

/// How the payload is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary(Order),
}

/// What a property is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Number),
    /// How many items there are, and the items.
    List(Number, Number),
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Where it is declared.
    pub(super) place: Place,
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

impl Header {
    /// Reads all lines of the header.
    pub(super) fn read(input: &mut Input<'_>) -> Result<Self, Fault> {
        let (mut line, mut names) = (Vec::new(), 0);
        input.expect_line(&mut line, "the header")?;
        if line.trim_ascii_end() != b"ply" {
            let what = "the first line must be \"ply\"";
            return Err(Fault::invalid(input.at_line(), what, quote(&line)));
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        loop {
            input.expect_line(&mut line, "the line end_header")?;
            let place = input.at_line();
            let (word, rest) = split_word(&line);
            match word {
                b"" | b"comment" | b"obj_info" => {}
                b"end_header" => break,
                b"format" if encoding.is_none() => encoding = Some(read_encoding(rest, place)?),
                b"element" => {
                    let element = read_element(rest, place)?;
                    if elements.iter().any(|other| other.name == element.name) {
                        let what = "each element must have a name of its own";
                        return Err(Fault::invalid(place, what, quote(element.name.as_bytes())));
                    }
                    elements.push(element);
                    names += 1;
                }
                b"property" => {
                    let Some(element) = elements.last_mut() else {
                        let what = "a property must follow the element it belongs to";
                        return Err(Fault::invalid(place, what, quote(&line)));
                    };
                    element.add(read_property(rest, place)?, place)?;
                    names += 1;
                }
                _ => {
                    let what = "a line of the header must be one format, or an element, property, \
                                comment, obj_info or end_header";
                    return Err(Fault::invalid(place, what, quote(&line)));
                }
            }
            if names > NAMES_MAX {
                let what = format!("elements and properties must be at most {NAMES_MAX}");
                return Err(Fault::invalid(place, what, names));
            }
        }
        let missing = || Fault::invalid(input.at_line(), "the header must have a format", "none");
        Ok(Self { encoding: encoding.ok_or_else(missing)?, elements })
    }

    /// The elements before the vertices, and the vertices.
    pub(super) fn split_at_vertex(&self) -> Result<(&[Element], &Element), Fault> {
        let is_vertex = |element: &Element| element.name == "vertex";
        let found = self.elements.iter().position(is_vertex).and_then(|index| {
            let (before, from) = self.elements.split_at_checked(index)?;
            Some((before, from.first()?))
        });
        found.ok_or_else(|| {
            let names: Vec<_> = self.elements.iter().map(|element| &*element.name).collect();
            let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            let place = self.elements.first().map_or(Place::Line(1), |element| element.place);
            Fault::invalid(place, "there must be an element vertex", names)
        })
    }
}

impl Element {
    fn add(&mut self, property: Property, place: Place) -> Result<(), Fault> {
        if self.properties.iter().any(|other| other.name == property.name) {
            let what = "each property of an element must have a name of its own";
            return Err(Fault::invalid(place, what, quote(property.name.as_bytes())));
        }
        self.properties.push(property);
        Ok(())
    }
}

/// `binary_little_endian 1.0`
fn read_encoding(text: &[u8], place: Place) -> Result<Encoding, Fault> {
    let (name, version) = split_word(text);
    if version != b"1.0" {
        return Err(Fault::invalid(place, "the version must be 1.0", quote(version)));
    }
    match name {
        b"ascii" => Ok(Encoding::Text),
        b"binary_little_endian" => Ok(Encoding::Binary(Order::Little)),
        b"binary_big_endian" => Ok(Encoding::Binary(Order::Big)),
        _ => {
            let what = "the format must be ascii, binary_little_endian or binary_big_endian";
            Err(Fault::invalid(place, what, quote(name)))
        }
    }
}

/// `vertex 8`
fn read_element(text: &[u8], place: Place) -> Result<Element, Fault> {
    let (name, count) = split_word(text);
    let number = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
    let count = number.ok_or_else(|| {
        Fault::invalid(place, "the number of an element must be a whole number", quote(count))
    })?;
    Ok(Element { name: read_name(name, place)?, count, properties: Vec::new(), place })
}

/// `float x` or `list uchar int vertex_indices`
fn read_property(text: &[u8], place: Place) -> Result<Property, Fault> {
    let (word, rest) = split_word(text);
    if word != b"list" {
        let kind = Kind::Scalar(read_number(word, place)?);
        return Ok(Property { name: read_name(rest, place)?, kind });
    }
    let (count_word, rest) = split_word(rest);
    let (item, name) = split_word(rest);
    let count = read_number(count_word, place)?;
    if !count.is_integer() {
        let what = "the length of a list must be of a type without fractions";
        return Err(Fault::invalid(place, what, quote(count_word)));
    }
    let kind = Kind::List(count, read_number(item, place)?);
    Ok(Property { name: read_name(name, place)?, kind })
}

fn read_number(word: &[u8], place: Place) -> Result<Number, Fault> {
    let what = "the type must be char, uchar, short, ushort, int, uint, float, double, int8, \
                uint8, int16, uint16, int32, uint32, float32 or float64";
    Number::from_name(word).ok_or_else(|| Fault::invalid(place, what, quote(word)))
}

fn read_name(name: &[u8], place: Place) -> Result<String, Fault> {
    if name.is_empty() || name.len() > NAME_BYTES_MAX {
        let what = format!("a name must have 1 to {NAME_BYTES_MAX} bytes");
        return Err(Fault::invalid(place, what, quote(name)));
    }
    Ok(String::from_utf8_lossy(name).into_owned())
}

/// The first word and what follows it, without space around.
fn split_word(text: &[u8]) -> (&[u8], &[u8]) {
    let text = text.trim_ascii();
    let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    (word, rest.trim_ascii())
}
