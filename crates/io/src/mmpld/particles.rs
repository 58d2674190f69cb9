//! The particles of a list: positions, radii and colors of all types.

use super::list::{Color, ListHeader, Vertex};
use crate::{
    builder::{Builder, Row, to_f32},
    color::{Colors, WHITE},
    error::{Fault, Place},
    input::Input,
};

/// How many bytes are read at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// A reader of particles.
pub(super) struct Particles {
    /// The box of the file.
    bounds: [f32; 6],
    colors: Colors,
    buffer: Vec<u8>,
}

impl Particles {
    pub(super) fn new(bounds: [f32; 6]) -> Self {
        Self { bounds, colors: Colors::default(), buffer: Vec::new() }
    }

    /// Reads the particles of a list.
    pub(super) fn read(
        &mut self,
        input: &mut Input<'_>,
        list: &ListHeader,
        builder: &mut Builder<'_>,
    ) -> Result<(), Fault> {
        let stride = list.types.stride();
        if list.records() == 0 {
            return Ok(());
        }
        let quantum = self.quantum(list, builder)?;
        let mut records_left = list.records();
        while records_left > 0 {
            let chunk_records = (CHUNK_BYTES / stride) as u64;
            let records = records_left.min(chunk_records);
            #[expect(clippy::cast_possible_truncation, reason = "at most CHUNK_BYTES")]
            self.buffer.resize(records as usize * stride, 0);
            let mut byte = input.byte();
            input.bytes(&mut self.buffer, "the particles")?;
            for bytes in self.buffer.chunks_exact(stride) {
                let (vertex, color) = bytes.split_at(list.types.vertex.bytes());
                let (color, intensity) = read_color(color, list, &mut self.colors);
                let row = Row {
                    position: read_position(vertex, list.types.vertex, &quantum),
                    radius: Some(match list.types.vertex {
                        Vertex::FloatXyzr => single(vertex, 12),
                        _ => f64::from(list.radius),
                    }),
                    color,
                    scalars: &[intensity],
                    ..Row::default()
                };
                builder.push(&row, Place::Byte(byte))?;
                byte += stride as u64;
            }
            records_left -= records;
        }
        Ok(())
    }

    /// Tells what happened to colors.
    pub(super) fn warn(&self, builder: &mut Builder<'_>) {
        self.colors.warn(builder);
    }

    /// Where quantized positions lie.
    fn quantum(&self, list: &ListHeader, builder: &mut Builder<'_>) -> Result<Quantum, Fault> {
        if list.types.vertex != Vertex::ShortXyz {
            return Ok(Quantum::default());
        }
        let (bounds, owner) = match list.bounds {
            Some(bounds) if has_extent(&bounds) => (bounds, "their list"),
            _ => (self.bounds, "the file"),
        };
        if !has_extent(&bounds) {
            let what = "quantized positions must have a box with an extent";
            return Err(Fault::invalid(list.place, what, format!("{bounds:?}")));
        }
        builder.warn(format!(
            "positions are quantized in a way the format does not define; the box of {owner} was \
             taken for theirs"
        ));
        let [x, y, z, right, top, front] = bounds.map(f64::from);
        Ok(Quantum { least: [x, y, z], extent: [right - x, top - y, front - z] })
    }
}

/// The box of quantized positions.
#[derive(Clone, Copy, Debug, Default)]
struct Quantum {
    least: [f64; 3],
    extent: [f64; 3],
}

/// Whether a box is one, with an extent along one axis at least.
fn has_extent(bounds: &[f32; 6]) -> bool {
    let (least, largest) = bounds.split_at(3);
    let is_box =
        bounds.iter().all(|x| x.is_finite()) && least.iter().zip(largest).all(|(a, b)| a <= b);
    is_box && least != largest
}

fn read_position(bytes: &[u8], vertex: Vertex, quantum: &Quantum) -> [f64; 3] {
    match vertex {
        Vertex::None => [f64::NAN; 3],
        Vertex::FloatXyz | Vertex::FloatXyzr => [0, 4, 8].map(|at| single(bytes, at)),
        Vertex::DoubleXyz => [0, 8, 16].map(|at| double(bytes, at)),
        Vertex::ShortXyz => {
            let mut position = [0.0; 3];
            for (axis, x) in position.iter_mut().enumerate() {
                *x = quantum.least[axis] + part(bytes, 2 * axis) * quantum.extent[axis];
            }
            position
        }
    }
}

/// The color and the intensity of a particle.
fn read_color(bytes: &[u8], list: &ListHeader, colors: &mut Colors) -> ([u8; 4], f32) {
    let color = match list.types.color {
        Color::None => list.rgba,
        Color::ByteRgb | Color::ByteRgba => {
            let alpha = bytes.get(3).copied().unwrap_or(255);
            [bytes[0], bytes[1], bytes[2], alpha]
        }
        Color::FloatRgb => {
            colors.color([single(bytes, 0), single(bytes, 4), single(bytes, 8), 1.0])
        }
        Color::FloatRgba => colors.color([0, 4, 8, 12].map(|at| single(bytes, at))),
        Color::ShortRgba => colors.color([0, 2, 4, 6].map(|at| part(bytes, at))),
        Color::FloatI => return (WHITE, f32::from_le_bytes(number(bytes, 0))),
        Color::DoubleI => return (WHITE, to_f32(double(bytes, 0))),
    };
    (color, f32::NAN)
}

/// The bytes of a number. Callers give whole particles, which have them.
fn number<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    let mut number = [0; N];
    number.copy_from_slice(&bytes[at..at + N]);
    number
}

fn single(bytes: &[u8], at: usize) -> f64 {
    f64::from(f32::from_le_bytes(number(bytes, at)))
}

fn double(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(number(bytes, at))
}

/// A number of 16 bits as a part of the largest one.
fn part(bytes: &[u8], at: usize) -> f64 {
    f64::from(u16::from_le_bytes(number(bytes, at))) / f64::from(u16::MAX)
}
