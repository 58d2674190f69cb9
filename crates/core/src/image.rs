//! Images: what a person looks at.

/// Colors by pixel, rows from the top: sRGB with straight alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// A color for each pixel.
    pub pixels: Vec<[u8; 4]>,
}
