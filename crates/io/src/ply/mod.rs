/*!
PLY: the points of scans and the vertices of meshes.

A header in text names elements and their properties; the payload has them in this order, as text or
in binary of either byte order. The element `vertex` becomes the scene: elements before it are
passed over and those after it are not read. Source: the description by Greg Turk (1994), and what
PLY files of common programs hold.

# Properties

* `x`, `y`, `z` of any number type.
* `radius`, if there is one; `r` is a color where `g` and `b` are there too, else a scalar.
* Colors: `red green blue`, else `diffuse_red ...`, else `r g b`, with `alpha` or `a` if there is
  one. They are bytes, words of 16 bits, or numbers from 0 to 1; a color with a NaN in it becomes
  white, and one outside is clamped, both with a warning. Colors of other types have no known
  largest value, so they are scalars, with a warning.
* `element` of type `uchar`: the atomic number.
* All other numbers are scalars, rounded to `f32`; lists are passed over.

# Hazards

* Names may have characters that no specification allows, as in `distance[<0.1]`, so a name is all
  that is left of a line. Two properties or elements of one name are an error: they would be mixed
  up. This, and errors that name value and line, is why the header is read here: the parser of
  `ply-rs-bw` refuses such names, keeps the last of two equal ones without a word, and reads lines
  of any length.
* Lines may end in a carriage return and a line feed; the payload starts after the line feed.
* Text rows with a wrong number of columns are skipped and counted; blank rows are passed over.
* Counts are numbers in a text that anybody can write: no memory is reserved for more vertices than
  the bytes of the file can hold.
*/

mod binary;
mod header;
mod number;
#[cfg(test)]
mod tests;
mod text;
mod vertex;
mod write;

pub(crate) use write::write;

use crate::{
    ReadOptions,
    builder::{Builder, Precision, Report},
    error::Fault,
    input::Input,
};
use header::{Encoding, Header};
use number::Number;
use puncta_core::Scene;
use vertex::Vertex;

/// Reads the vertices.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let header = Header::read(input)?;
    let (before, element) = header.split_at_vertex()?;
    let mut vertex = Vertex::new(element)?;
    let is_single = vertex.axes().iter().all(|number| *number == Number::Float);
    let precision = match header.encoding {
        Encoding::Text => Precision::Double,
        _ if is_single => Precision::Single,
        _ => Precision::Double,
    };
    let mut builder = Builder::new(options, precision, &vertex.columns());
    vertex.warn(&mut builder);
    for element in before {
        match header.encoding {
            Encoding::Text => text::skip(input, element)?,
            Encoding::Binary(order) => binary::skip(input, element, order)?,
        }
    }
    match header.encoding {
        Encoding::Text => text::read(input, element, &mut vertex, &mut builder)?,
        Encoding::Binary(order) => {
            binary::read(input, (element, order), &mut vertex, &mut builder)?;
        }
    }
    if before.len() + 1 == header.elements.len() {
        match header.encoding {
            Encoding::Text => text::warn_of_rest(input, &mut builder)?,
            Encoding::Binary(_) => binary::warn_of_rest(input, &mut builder),
        }
    }
    vertex.warn_of_rows(&mut builder);
    builder.finish()
}
