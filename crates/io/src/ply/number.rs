//! The types of numbers, and their bytes.

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    Char,
    Uchar,
    Short,
    Ushort,
    Int,
    Uint,
    Float,
    Double,
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

impl Number {
    /// The type of this name; there are two names for each.
    pub(super) fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::Char,
            b"uchar" | b"uint8" => Self::Uchar,
            b"short" | b"int16" => Self::Short,
            b"ushort" | b"uint16" => Self::Ushort,
            b"int" | b"int32" => Self::Int,
            b"uint" | b"uint32" => Self::Uint,
            b"float" | b"float32" => Self::Float,
            b"double" | b"float64" => Self::Double,
            _ => return None,
        })
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Char => "char",
            Self::Uchar => "uchar",
            Self::Short => "short",
            Self::Ushort => "ushort",
            Self::Int => "int",
            Self::Uint => "uint",
            Self::Float => "float",
            Self::Double => "double",
        }
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Char | Self::Uchar => 1,
            Self::Short | Self::Ushort => 2,
            Self::Int | Self::Uint | Self::Float => 4,
            Self::Double => 8,
        }
    }

    /// Whether it has no fractions.
    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::Float | Self::Double)
    }

    /// The number that starts with these bytes. Callers give as many as it has.
    pub(super) fn read(self, bytes: &[u8], order: Order) -> f64 {
        match self {
            Self::Char => f64::from(i8::from_le_bytes(ordered(bytes, order))),
            Self::Uchar => f64::from(u8::from_le_bytes(ordered(bytes, order))),
            Self::Short => f64::from(i16::from_le_bytes(ordered(bytes, order))),
            Self::Ushort => f64::from(u16::from_le_bytes(ordered(bytes, order))),
            Self::Int => f64::from(i32::from_le_bytes(ordered(bytes, order))),
            Self::Uint => f64::from(u32::from_le_bytes(ordered(bytes, order))),
            Self::Float => f64::from(f32::from_le_bytes(ordered(bytes, order))),
            Self::Double => f64::from_le_bytes(ordered(bytes, order)),
        }
    }
}

/// The first bytes, the lowest first.
fn ordered<const N: usize>(bytes: &[u8], order: Order) -> [u8; N] {
    let mut ordered = [0; N];
    ordered.copy_from_slice(&bytes[..N]);
    if order == Order::Big {
        ordered.reverse();
    }
    ordered
}
