//! What can be wrong with a scene or a view, or end its drawing.

use glam::DVec3;

/// A scene or a view that cannot be used, with the value that is at fault; or drawing that has
/// ended.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A direction cannot be made from these points.
    #[error("no view from {eye} to {target} with {up} up: {reason}")]
    DegenerateView {
        /// The place of the camera.
        eye: DVec3,
        /// The point it looks at.
        target: DVec3,
        /// The direction that points up in the picture.
        up: DVec3,
        /// What is wrong.
        reason: &'static str,
    },
    /// A setting of a view lies outside of its range.
    #[error("{name} of a view must be {range}, not {value}")]
    ViewSetting {
        /// The name of the setting.
        name: &'static str,
        /// The values it can take.
        range: &'static str,
        /// The value it was given.
        value: f64,
    },
    /// A picture of no or of too many pixels.
    #[error("a picture of {width} x {height} pixels: each side must be 1 to {max}", max = crate::MAX_SIDE)]
    PictureSize {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// An attribute that does not have one value for each record.
    #[error("attribute {name} has {values} values for {records} records")]
    AttributeLength {
        /// The name of the attribute.
        name: String,
        /// How many values it has.
        values: usize,
        /// How many records the scene has.
        records: usize,
    },
    /// More records than ids.
    #[error("{records} records: a scene holds at most {max}", max = crate::MAX_RECORDS)]
    TooManyRecords {
        /// How many records there are.
        records: usize,
    },
    /// An origin that is not finite.
    #[error("the origin of a scene must be finite, not {origin}")]
    Origin {
        /// The origin.
        origin: DVec3,
    },
    /// A brick that is not made of records of the scene.
    #[error("brick {brick} holds records {start}..{end} of a scene with {records}")]
    BrickRange {
        /// The index of the brick.
        brick: usize,
        /// Its first record.
        start: u32,
        /// The record after its last one.
        end: u32,
        /// How many records the scene has.
        records: usize,
    },
    /// A brick to draw that is not among the bricks.
    #[error("brick {index} is to be drawn, but there are {bricks}")]
    UnknownBrick {
        /// Its index.
        index: u32,
        /// How many bricks there are.
        bricks: usize,
    },
    /// A renderer was asked for a picture before one was begun.
    #[error("no picture was begun")]
    NotBegun,
    /// A renderer, a stage or what is called after each step has panicked on the thread of a
    /// [`Live`](crate::Live), which has ended.
    #[error("the drawing thread has panicked: {message}")]
    DrawingPanicked {
        /// What the panic says.
        message: String,
    },
}
