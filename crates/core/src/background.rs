//! Backgrounds: what images show where there is no record.

/// What is seen where there is no record. All colors are sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// One color.
    Solid([u8; 3]),
    /// A color at the top row that turns into another at the bottom row.
    Gradient([u8; 3], [u8; 3]),
    /// Nothing: the image has alpha 0 there.
    Transparent,
}

impl Default for Background {
    fn default() -> Self {
        Self::Gradient([24, 28, 36], [66, 75, 88])
    }
}
