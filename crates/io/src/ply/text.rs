//! The payload in text: a line for each row.

use super::{
    header::{Element, Kind},
    vertex::Vertex,
};
use crate::{
    builder::Builder,
    error::{Fault, Problem, quote},
    input::Input,
};

/// Passes over all of an element.
pub(super) fn skip(input: &mut Input<'_>, element: &Element) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(());
    }
    let mut line = Vec::new();
    for index in 0..element.count {
        next_line(input, &mut line, (element, index))?;
    }
    Ok(())
}

/// Reads all vertices.
pub(super) fn read(
    input: &mut Input<'_>,
    element: &Element,
    vertex: &mut Vertex,
    builder: &mut Builder<'_>,
) -> Result<(), Fault> {
    if input.remaining().is_some() {
        // A digit and a separator for each property; the last line may end without one.
        let least_bytes = 2 * element.properties.len() as u64;
        let bytes = element.count.saturating_mul(least_bytes).saturating_sub(1);
        input.require(bytes, "the vertices")?;
        builder.reserve(element.count)?;
    }
    let kinds: Vec<Kind> = element.properties.iter().map(|property| property.kind).collect();
    let (mut line, mut values) = (Vec::new(), Vec::new());
    for index in 0..element.count {
        next_line(input, &mut line, (element, index))?;
        match parse(&line, &kinds, &mut values) {
            Ok(()) => builder.push(&vertex.row(&values), input.at_line())?,
            Err((problem, text)) => builder.skip(problem, input.at_line(), || quote(text))?,
        }
    }
    Ok(())
}

/// Tells of lines after the last element.
pub(super) fn warn_of_rest(input: &mut Input<'_>, builder: &mut Builder<'_>) -> Result<(), Fault> {
    let mut line = Vec::new();
    while input.line(&mut line)? {
        if !line.trim_ascii().is_empty() {
            let place = input.at_line();
            builder.warn(format!("from {place} on, text after the last element is ignored"));
            break;
        }
    }
    Ok(())
}

/// Reads the line of a row; blank ones are passed over.
fn next_line(
    input: &mut Input<'_>,
    line: &mut Vec<u8>,
    (element, index): (&Element, u64),
) -> Result<(), Fault> {
    while input.line(line)? {
        if !line.trim_ascii().is_empty() {
            return Ok(());
        }
    }
    let Element { name, count, .. } = element;
    let what = format!("row {} of the {count} of element {name}", index.saturating_add(1));
    Err(Fault::missing(input.at_line(), what))
}

/// Parses the numbers of a row, or tells what is wrong with which text.
fn parse<'l>(
    line: &'l [u8],
    kinds: &[Kind],
    values: &mut Vec<f64>,
) -> Result<(), (Problem, &'l [u8])> {
    values.clear();
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let mut next = || {
        let word = words.next().ok_or((Problem::Columns, line))?;
        let number: f64 = fast_float2::parse(word).map_err(|_| (Problem::Number, word))?;
        Ok((number, word))
    };
    for kind in kinds {
        let (number, word) = next()?;
        if let Kind::Scalar(_) = kind {
            values.push(number);
            continue;
        }
        if number < 0.0 || number.fract() != 0.0 {
            return Err((Problem::Number, word));
        }
        let mut items_left = number;
        while items_left > 0.0 {
            next()?;
            items_left -= 1.0;
        }
    }
    if words.next().is_some() { Err((Problem::Columns, line)) } else { Ok(()) }
}
