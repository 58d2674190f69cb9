//! What can go wrong while drawing and shading.

/// A picture or image that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene or the view is not valid.
    #[error(transparent)]
    Core(#[from] puncta_core::Error),
    /// There is no color map of this name.
    #[error("there is no color map {name:?}; there are {known}")]
    UnknownColorMap {
        /// The name.
        name: String,
        /// All names.
        known: String,
    },
    /// The scene lacks what the coloring needs.
    #[error("the scene has no {what} to color by")]
    NoColumn {
        /// The missing column.
        what: String,
    },
    /// A picture whose size does not go with the view.
    #[error(
        "a picture of {}x{} pixels for a view of {}x{}: each side must be {supersample} times as long",
        .picture.0, .picture.1, .view.0, .view.1
    )]
    Size {
        /// Columns and rows of the picture.
        picture: (u32, u32),
        /// Columns and rows of the view.
        view: (u32, u32),
        /// How many pixels of the picture make one of the image, along each side.
        supersample: u32,
    },
    /// A picture that shows a record which the scene does not have.
    #[error("the picture shows record {id} of a scene with {records}")]
    UnknownRecord {
        /// The index of the record.
        id: u32,
        /// How many there are.
        records: usize,
    },
}
