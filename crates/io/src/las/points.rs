/*!
Point records, as they are in a LAS file or as they come out of the decoder of LAZ.

All formats start with x, y and z as `i32`, to be scaled and moved, and the intensity as `u16`:

| field | formats 0 to 5 | formats 6 to 10 |
| --- | --- | --- |
| return number | 3 low bits of byte 14 | 4 low bits of byte 14 |
| classification | 5 low bits of byte 15 | byte 16 |
| scan angle | byte 16, `i8`, degrees | byte 18, `i16`, 0.006 degrees |
| point source | byte 18, `u16` | byte 20, `u16` |
| color | three `u16` behind the fields that all points of the format have | the same |

# Colors

The format wants 16 bits, yet many files hold 8-bit values. Which it is, is decided over the whole
file: the values are 8 bits if none exceeds 255. No second copy is needed for that. The values are
taken as 8 bits until the first one exceeds 255. Then all colors stored so far are below 256, and so
they are black when read as 16 bits, of which the upper 8 are kept.
*/

use super::header::{Header, field};
use crate::{
    ReadOptions,
    builder::{Builder, Columns, Precision, Report, Row},
    error::{Fault, Place},
};
use puncta_core::Scene;

/// A scalar and how it is found in a record.
type Measurement = (&'static str, fn(&[u8]) -> f32);

/// The scalars of formats 0 to 5.
const MEASUREMENTS: [Measurement; 5] = [
    ("intensity", |record| f32::from(u16::from_le_bytes(field(record, 12)))),
    ("classification", |record| f32::from(byte(record, 15) & 0x1f)),
    ("return_number", |record| f32::from(byte(record, 14) & 0x07)),
    ("scan_angle", |record| f32::from(byte(record, 16).cast_signed())),
    ("point_source", |record| f32::from(u16::from_le_bytes(field(record, 18)))),
];

/// The scalars of formats 6 to 10.
const MEASUREMENTS_EXTENDED: [Measurement; 5] = [
    ("intensity", |record| f32::from(u16::from_le_bytes(field(record, 12)))),
    ("classification", |record| f32::from(byte(record, 16))),
    ("return_number", |record| f32::from(byte(record, 14) & 0x0f)),
    ("scan_angle", |record| 0.006 * f32::from(i16::from_le_bytes(field(record, 18)))),
    ("point_source", |record| f32::from(u16::from_le_bytes(field(record, 20)))),
];

/// What the values of the colors seen so far tell of their depth.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    /// All are 0.
    Unknown,
    /// All are below 256.
    Eight,
    Sixteen,
}

/// The points of a file in the making.
pub(super) struct Points<'a> {
    header: &'a Header,
    builder: Builder<'a>,
    wanted: Vec<Measurement>,
    /// The scalars of one point.
    scalars: Vec<f32>,
    depth: Depth,
    /// The box around the points before they are scaled and moved.
    min: [i32; 3],
    max: [i32; 3],
}

impl<'a> Points<'a> {
    /// Makes room for all points: call it with a count that the file's length confirms.
    pub(super) fn new(
        options: &'a ReadOptions,
        header: &'a Header,
        reserve: u64,
    ) -> Result<Self, Fault> {
        let all = if header.is_extended() { MEASUREMENTS_EXTENDED } else { MEASUREMENTS };
        let wanted: Vec<Measurement> =
            all.into_iter().filter(|(name, _)| options.wants(name)).collect();
        let columns = Columns {
            color: header.color_at.is_some(),
            element: false,
            scalars: wanted.iter().map(|(name, _)| (*name).to_owned()).collect(),
        };
        let mut builder = Builder::new(options, Precision::Double, &columns);
        builder.reserve(reserve)?;
        let scalars = vec![0.0; wanted.len()];
        let (depth, min, max) = (Depth::Unknown, [i32::MAX; 3], [i32::MIN; 3]);
        Ok(Self { header, builder, wanted, scalars, depth, min, max })
    }

    pub(super) fn warn(&mut self, warning: String) {
        self.builder.warn(warning);
    }

    /// Adds records; the first one is at byte `place`, the others `stride` bytes further each.
    pub(super) fn push(
        &mut self,
        records: &[u8],
        record_bytes: usize,
        (mut place, stride): (u64, u64),
    ) -> Result<(), Fault> {
        for record in records.chunks_exact(record_bytes) {
            let steps = [0, 4, 8].map(|at| i32::from_le_bytes(field(record, at)));
            let mut position = [0.0; 3];
            for axis in 0..3 {
                self.min[axis] = self.min[axis].min(steps[axis]);
                self.max[axis] = self.max[axis].max(steps[axis]);
                position[axis] = self.to_world(steps[axis], axis);
            }
            for (scalar, (_, measure)) in self.scalars.iter_mut().zip(&self.wanted) {
                *scalar = measure(record);
            }
            let color = match self.header.color_at {
                Some(at) => {
                    self.color([0, 2, 4].map(|i| u16::from_le_bytes(field(record, at + i))))
                }
                None => [255; 4],
            };
            let row = Row { position, color, scalars: &self.scalars, ..Row::default() };
            self.builder.push(&row, Place::Byte(place))?;
            place += stride;
        }
        Ok(())
    }

    /// The scene of all points.
    pub(super) fn finish(mut self) -> Result<(Scene, Report), Fault> {
        if self.header.color_at.is_some() && self.depth == Depth::Unknown {
            self.builder.drop_colors();
            self.builder.warn("the colors are left out: all of them are 0");
        }
        self.check_box();
        self.builder.finish()
    }

    /// A coordinate on an axis.
    fn to_world(&self, steps: i32, axis: usize) -> f64 {
        f64::from(steps) * self.header.scale[axis] + self.header.offset[axis]
    }

    /// The color to store: see the text of the module.
    fn color(&mut self, channels: [u16; 3]) -> [u8; 4] {
        let largest = channels.into_iter().fold(0, u16::max);
        if largest > 255 && self.depth != Depth::Sixteen {
            self.depth = Depth::Sixteen;
            self.builder.blacken();
        } else if largest > 0 && self.depth == Depth::Unknown {
            self.depth = Depth::Eight;
        }
        let [r, g, b] = channels.map(|channel| {
            let [low, high] = channel.to_le_bytes();
            if self.depth == Depth::Sixteen { high } else { low }
        });
        [r, g, b, 255]
    }

    /// Warns if points lie outside of the box in the header, as far as it has one: there is no
    /// other sum in the file that would tell of damaged coordinates.
    fn check_box(&mut self) {
        let Header { scale, min, max, .. } = self.header;
        if self.header.count == 0 || (*min, *max) == ([0.0; 3], [0.0; 3]) {
            return;
        }
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let ends = [self.min[axis], self.max[axis]].map(|steps| self.to_world(steps, axis));
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let step = scale[axis].abs();
            if low < min[axis] - step || high > max[axis] + step {
                let (min, max) = (min[axis], max[axis]);
                self.warn(format!(
                    "{name} is {low:?} to {high:?}, but the header says {min:?} to {max:?}"
                ));
            }
        }
    }
}

fn byte(record: &[u8], at: usize) -> u8 {
    let [byte] = field(record, at);
    byte
}
