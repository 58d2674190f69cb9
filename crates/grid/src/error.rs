//! What a grid cannot be laid over.

use glam::Vec3;

/// Records or a resolution that no grid can be made of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A position that is not finite.
    #[error("record {index} lies at {position}, which is not finite")]
    Position {
        /// The index of the record.
        index: usize,
        /// Its position.
        position: Vec3,
    },
    /// A radius that is not finite, or negative.
    #[error("record {index} has radius {radius}; it must be finite and not negative")]
    Radius {
        /// The index of the record.
        index: usize,
        /// Its radius.
        radius: f32,
    },
    /// A resolution of no or of too many cells.
    #[error("a grid of {} x {} x {} cells; it must have 1 to {max}", .dims[0], .dims[1], .dims[2], max = crate::cells::CELLS_MAX)]
    Resolution {
        /// The number of cells along each axis.
        dims: [u64; 3],
    },
    /// A width that no cell can have.
    #[error("cells of width {width}; it must be a positive number")]
    Width {
        /// The width.
        width: f32,
    },
    /// A scene that is not valid.
    #[error(transparent)]
    Scene(#[from] puncta_core::Error),
}

impl Error {
    /// The same of records that start at an index.
    pub(crate) fn after(self, start: usize) -> Self {
        match self {
            Self::Position { index, position } => Self::Position { index: start + index, position },
            Self::Radius { index, radius } => Self::Radius { index: start + index, radius },
            other => other,
        }
    }
}
