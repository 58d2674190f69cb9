//! Footprints: polygons with holes, and from where to where they rise.

/// What a footprint is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    Ground,
    Pavement,
    Park,
    Tree,
    Water,
    House,
    Tower,
}

/// Something that rises straight from a polygon.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Footprint {
    /// The outline and the holes in it, east and north of a middle, in metres. No point is there twice
    /// at the ends.
    pub(crate) rings: Vec<Vec<[f64; 2]>>,
    /// From where to where it rises.
    pub(crate) heights: [f64; 2],
    pub(crate) sort: Sort,
}
