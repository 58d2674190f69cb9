//! The payload in binary.

use super::{
    header::{Element, Kind},
    number::{Number, Order},
    vertex::Vertex,
};
use crate::{builder::Builder, error::Fault, input::Input};

/// How many bytes are read at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// Numbers that follow each other, up to the next list.
struct Run {
    bytes: usize,
    /// The types of the length and the items of a list behind them.
    list: Option<(Number, Number)>,
}

/// Passes over all of an element.
pub(super) fn skip(input: &mut Input<'_>, element: &Element, order: Order) -> Result<(), Fault> {
    let what = format!("element {}", element.name);
    let runs = runs(element);
    if let [Run { bytes, list: None }] = &runs[..] {
        return input.skip(element.count.saturating_mul(*bytes as u64), &what);
    }
    for _ in 0..element.count {
        for run in &runs {
            input.skip(run.bytes as u64, &what)?;
            skip_list(input, run, order)?;
        }
    }
    Ok(())
}

/// Reads all vertices.
pub(super) fn read(
    input: &mut Input<'_>,
    (element, order): (&Element, Order),
    vertex: &mut Vertex,
    builder: &mut Builder<'_>,
) -> Result<(), Fault> {
    const WHAT: &str = "the vertices";
    let runs = runs(element);
    let least = |run: &Run| run.bytes + run.list.map_or(0, |(length, _)| length.bytes());
    let least_bytes: usize = runs.iter().map(least).sum();
    if input.remaining().is_some() {
        input.require(element.count.saturating_mul(least_bytes as u64), WHAT)?;
        builder.reserve(element.count)?;
    }
    let mut rows = Rows::new(vertex, order);
    let stride: usize = runs.iter().map(|run| run.bytes).sum();
    let has_lists = runs.iter().any(|run| run.list.is_some());
    let chunk_records = if has_lists { 1 } else { (CHUNK_BYTES / stride).max(1) };
    let mut buffer = Vec::new();
    let mut records_left = element.count;
    while records_left > 0 {
        let records = records_left.min(chunk_records as u64);
        let start = input.byte();
        #[expect(clippy::cast_possible_truncation, reason = "at most chunk_records")]
        buffer.resize(records as usize * stride, 0);
        if has_lists {
            let mut rest = &mut buffer[..];
            for run in &runs {
                let (numbers, others) = rest.split_at_mut(run.bytes);
                input.bytes(numbers, WHAT)?;
                skip_list(input, run, order)?;
                rest = others;
            }
        } else {
            input.bytes(&mut buffer, WHAT)?;
        }
        rows.push((&buffer, stride), start, vertex, builder)?;
        records_left -= records;
    }
    Ok(())
}

/// Tells of bytes after the last element.
pub(super) fn warn_of_rest(input: &Input<'_>, builder: &mut Builder<'_>) {
    if let Some(left) = input.remaining().filter(|left| *left > 0) {
        builder.warn(format!("{left} bytes after the last element are ignored"));
    }
}

/// Decodes vertices.
struct Rows {
    order: Order,
    numbers: Vec<Number>,
    values: Vec<f64>,
}

impl Rows {
    fn new(vertex: &Vertex, order: Order) -> Self {
        let numbers: Vec<Number> = vertex.numbers().collect();
        Self { order, values: vec![0.0; numbers.len()], numbers }
    }

    /// Adds vertices of `stride` bytes each, which start at the byte `start` of the file.
    fn push(
        &mut self,
        (bytes, stride): (&[u8], usize),
        start: u64,
        vertex: &mut Vertex,
        builder: &mut Builder<'_>,
    ) -> Result<(), Fault> {
        for (index, mut record) in bytes.chunks_exact(stride).enumerate() {
            for (value, number) in self.values.iter_mut().zip(&self.numbers) {
                *value = number.read(record, self.order);
                record = &record[number.bytes()..];
            }
            let byte = start + (index * stride) as u64;
            builder.push(&vertex.row(&self.values), crate::Place::Byte(byte))?;
        }
        Ok(())
    }
}

/// Passes over the list after a run.
fn skip_list(input: &mut Input<'_>, run: &Run, order: Order) -> Result<(), Fault> {
    let Some((length, item)) = run.list else { return Ok(()) };
    let place = input.at_byte();
    let mut bytes = [0; 8];
    let bytes = &mut bytes[..length.bytes()];
    input.bytes(bytes, "the length of a list")?;
    let items = length.read(bytes, order);
    if items < 0.0 {
        return Err(Fault::invalid(place, "the length of a list must not be negative", items));
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of at most 32 bits that is not negative"
    )]
    input.skip(items as u64 * item.bytes() as u64, "a list")
}

fn runs(element: &Element) -> Vec<Run> {
    let mut runs = vec![Run { bytes: 0, list: None }];
    for property in &element.properties {
        match (property.kind, runs.last_mut()) {
            (Kind::Scalar(number), Some(Run { bytes, list: None })) => *bytes += number.bytes(),
            (Kind::Scalar(number), _) => runs.push(Run { bytes: number.bytes(), list: None }),
            (Kind::List(length, item), Some(Run { list: list @ None, .. })) => {
                *list = Some((length, item));
            }
            (Kind::List(length, item), _) => {
                runs.push(Run { bytes: 0, list: Some((length, item)) });
            }
        }
    }
    runs
}
