//! The header of a list: how its particles are stored, and how many there are.

use super::header::{FileHeader, floats};
use crate::{
    color::WHITE,
    error::{Fault, Place},
    input::Input,
};

const HEADER: &str = "the header of a list";

/// How positions are stored; the value is that in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Vertex {
    None = 0,
    FloatXyz = 1,
    FloatXyzr = 2,
    ShortXyz = 3,
    DoubleXyz = 4,
}

impl Vertex {
    fn from_byte(byte: u8) -> Option<Self> {
        let all = [Self::None, Self::FloatXyz, Self::FloatXyzr, Self::ShortXyz, Self::DoubleXyz];
        all.get(usize::from(byte)).copied()
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::None => 0,
            Self::FloatXyz => 12,
            Self::FloatXyzr => 16,
            Self::ShortXyz => 6,
            Self::DoubleXyz => 24,
        }
    }

    fn has_global_radius(self) -> bool {
        matches!(self, Self::FloatXyz | Self::ShortXyz | Self::DoubleXyz)
    }
}

/// How colors are stored; the value is that in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Color {
    None = 0,
    ByteRgb = 1,
    ByteRgba = 2,
    FloatI = 3,
    FloatRgb = 4,
    FloatRgba = 5,
    ShortRgba = 6,
    DoubleI = 7,
}

impl Color {
    fn from_byte(byte: u8) -> Option<Self> {
        let all = [
            Self::None,
            Self::ByteRgb,
            Self::ByteRgba,
            Self::FloatI,
            Self::FloatRgb,
            Self::FloatRgba,
            Self::ShortRgba,
            Self::DoubleI,
        ];
        all.get(usize::from(byte)).copied()
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::None => 0,
            Self::ByteRgb => 3,
            Self::ByteRgba | Self::FloatI => 4,
            Self::ShortRgba | Self::DoubleI => 8,
            Self::FloatRgb => 12,
            Self::FloatRgba => 16,
        }
    }

    pub(super) fn is_intensity(self) -> bool {
        matches!(self, Self::FloatI | Self::DoubleI)
    }
}

/// Whether a list is written as it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// As it should be.
    Specified,
    /// As a known writer does it wrong.
    Deviating,
}

/// What the particles of a list are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Types {
    pub(super) vertex: Vertex,
    pub(super) color: Color,
}

impl Types {
    /// Reads the start of the header of a list.
    pub(super) fn read(input: &mut Input<'_>, file: &FileHeader) -> Result<Self, Fault> {
        let place = input.at_byte();
        fit(input, 2, file, HEADER)?;
        let [vertex, color] = input.array(HEADER)?;
        let wrong = |what, byte: u8| Fault::invalid(place, what, byte);
        Ok(Self {
            vertex: Vertex::from_byte(vertex)
                .ok_or_else(|| wrong("the vertex type must be 0 to 4", vertex))?,
            color: Color::from_byte(color)
                .ok_or_else(|| wrong("the color type must be 0 to 7", color))?,
        })
    }

    /// Whether real files hold lists of these types that deviate from the format.
    ///
    /// MegaMol's writer gives double positions without colors the color type `SHORT_RGBA`, and
    /// colors, but also the global color, which no reader expects. And it leaves out the cluster
    /// block of version 1.1 where there are no positions.
    pub(super) fn has_other_form(self, file: &FileHeader) -> bool {
        match self.vertex {
            Vertex::DoubleXyz => self.color == Color::ShortRgba,
            Vertex::None => file.version == 101,
            _ => false,
        }
    }

    /// The length of a particle; there are none without positions.
    pub(super) fn stride(self) -> usize {
        match self.vertex {
            Vertex::None => 0,
            vertex => vertex.bytes() + self.color.bytes(),
        }
    }

    /// The length of what the header says of all colors.
    fn color_bytes(self, form: Form) -> u64 {
        match self.color {
            Color::None => 4,
            Color::FloatI | Color::DoubleI => 8,
            Color::ShortRgba if self.vertex == Vertex::DoubleXyz && form == Form::Deviating => 4,
            _ => 0,
        }
    }
}

/// The header of a list.
#[derive(Clone, Debug)]
pub(super) struct ListHeader {
    pub(super) place: Place,
    pub(super) types: Types,
    /// The radius of all particles, if they have none of their own.
    pub(super) radius: f32,
    /// The color of all particles, if they have none of their own.
    pub(super) rgba: [u8; 4],
    pub(super) count: u64,
    /// The box of the list, from version 1.3 on.
    pub(super) bounds: Option<[f32; 6]>,
}

impl ListHeader {
    /// The length of the longest header.
    pub(super) const BYTES_MAX: u64 = 2 + 4 + 8 + 8 + 24;

    /// Reads a header that, with the particles after it, must fit into the frame.
    pub(super) fn read(
        input: &mut Input<'_>,
        file: &FileHeader,
        form: Form,
    ) -> Result<Self, Fault> {
        let types = Types::read(input, file)?;
        Self::read_rest(input, file, types, form)
    }

    /// Reads what follows the types.
    pub(super) fn read_rest(
        input: &mut Input<'_>,
        file: &FileHeader,
        types: Types,
        form: Form,
    ) -> Result<Self, Fault> {
        let place = Place::Byte(input.byte().saturating_sub(2));
        let (has_radius, has_bounds) = (types.vertex.has_global_radius(), file.version >= 103);
        let radius_bytes = if has_radius { 4 } else { 0 };
        let bounds_bytes = if has_bounds { 24 } else { 0 };
        let color_bytes = types.color_bytes(form);
        fit(input, radius_bytes + color_bytes + 8 + bounds_bytes, file, HEADER)?;

        let (mut radius, mut rgba) = (0.0, WHITE);
        if has_radius {
            radius = f32::from_le_bytes(input.array(HEADER)?);
        }
        if types.color == Color::None {
            let [red, green, blue, _] = input.array(HEADER)?;
            rgba = [red, green, blue, 255];
        } else {
            input.skip(color_bytes, HEADER)?;
        }
        let count_place = input.at_byte();
        let count = u64::from_le_bytes(input.array(HEADER)?);
        let bounds = if has_bounds { Some(floats(&input.array(HEADER)?)) } else { None };
        let list = Self { place, types, radius, rgba, count, bounds };
        let left = left(input, file);
        if list.bytes().is_none_or(|bytes| bytes > left) {
            let stride = types.stride();
            let what = format!(
                "the particles, {stride} bytes each, must fit into the {left} bytes left of \
                 the frame"
            );
            return Err(Fault::invalid(count_place, what, count));
        }
        Ok(list)
    }

    /// The length of all particles.
    pub(super) fn bytes(&self) -> Option<u64> {
        self.count.checked_mul(self.types.stride() as u64)
    }

    /// How many particles can be drawn.
    pub(super) fn records(&self) -> u64 {
        if self.types.vertex == Vertex::None { 0 } else { self.count }
    }

    /// The color of each particle, where it is one for all of them.
    pub(super) fn global_color(&self) -> Option<[u8; 4]> {
        (self.types.color == Color::None).then_some(self.rgba)
    }

    /// Reads the head of the cluster block after a list; returns how many bytes it is followed by.
    pub(super) fn cluster_bytes(
        &self,
        input: &mut Input<'_>,
        file: &FileHeader,
        form: Form,
    ) -> Result<u64, Fault> {
        const WHAT: &str = "a cluster block";
        if file.version != 101 || (self.types.vertex == Vertex::None && form == Form::Deviating) {
            return Ok(0);
        }
        fit(input, 12, file, WHAT)?;
        input.skip(4, WHAT)?;
        let place = input.at_byte();
        let bytes = u64::from_le_bytes(input.array(WHAT)?);
        let left = left(input, file);
        if bytes > left {
            let what = format!("a cluster block must fit into the {left} bytes left of the frame");
            return Err(Fault::invalid(place, what, bytes));
        }
        Ok(bytes)
    }
}

/// How many bytes are left of the frame.
fn left(input: &Input<'_>, file: &FileHeader) -> u64 {
    file.end.saturating_sub(input.byte())
}

/// Checks that the frame does not end before `needed` bytes.
pub(super) fn fit(
    input: &Input<'_>,
    needed: u64,
    file: &FileHeader,
    what: &str,
) -> Result<(), Fault> {
    let left = left(input, file);
    if needed <= left {
        return Ok(());
    }
    let what = format!("the frame must have {needed} more bytes for {what}");
    Err(Fault::invalid(input.at_byte(), what, left))
}
