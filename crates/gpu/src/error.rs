//! What can go wrong on a GPU, with the values that are at fault.

/// Why something could not be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene, its bricks or the view cannot be used.
    #[error(transparent)]
    Core(#[from] puncta_core::Error),
    /// There is no adapter of that name, or none at all.
    #[error("no GPU adapter {wanted}; there are: {known}. {reason}")]
    NoAdapter {
        /// What was asked for.
        wanted: String,
        /// The names of those that there are.
        known: String,
        /// What the drivers say.
        reason: String,
    },
    /// An adapter gave no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// The name of the adapter.
        adapter: String,
        /// What it says.
        reason: String,
    },
    /// An adapter cannot do what was asked for.
    #[error("{adapter} cannot {what}")]
    Unsupported {
        /// The name of the adapter.
        adapter: String,
        /// What was asked for.
        what: String,
    },
    /// The device was lost: it can draw nothing any more.
    #[error("the GPU was lost: {reason}")]
    Lost {
        /// What the driver says.
        reason: String,
    },
    /// There is not enough memory on the device.
    #[error("not enough GPU memory for {what}")]
    OutOfMemory {
        /// What it was for.
        what: String,
    },
    /// A picture that needs more memory in one piece than the device can address.
    #[error(
        "a picture of {width} x {height} pixels needs {bytes} bytes in one piece; {adapter} takes {limit}"
    )]
    PictureTooLarge {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
        /// What it needs.
        bytes: u64,
        /// What the device takes.
        limit: u64,
        /// The name of the adapter.
        adapter: String,
    },
    /// A picture with more columns or rows than the device has pixels in a line.
    #[error("a picture of {width} x {height} pixels; {adapter} takes {limit} along a side")]
    PictureTooWide {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
        /// The most of either that the device takes.
        limit: u32,
        /// The name of the adapter.
        adapter: String,
    },
    /// More bricks than one table can hold.
    #[error("{bricks} bricks in play need {bytes} bytes in one piece; the GPU takes {limit}")]
    TooManyBricks {
        /// The number of bricks.
        bricks: usize,
        /// What they need.
        bytes: u64,
        /// What the device takes.
        limit: u64,
    },
    /// Ids of which one set does not fit on the device.
    #[error("shading ids up to {id} needs {bytes} bytes in one piece; the GPU takes {limit}")]
    TooManyIds {
        /// The largest id.
        id: u32,
        /// What the set needs.
        bytes: u64,
        /// What the device takes.
        limit: u64,
    },
    /// What all glyphs share does not fit on the device.
    #[error("what glyphs share needs {bytes} bytes in one piece; the GPU takes {limit}")]
    TableTooLarge {
        /// What it needs.
        bytes: u64,
        /// What the device takes.
        limit: u64,
    },
    /// A picture whose pixels do not make whole pixels of an image.
    #[error("a picture of {width} x {height} pixels cannot be averaged over {factor} x {factor}")]
    Supersample {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
        /// How many pixels of the picture make one of the image, along each side.
        factor: u32,
    },
    /// A least radius that is no size.
    #[error("a least radius of {pixels} pixels: it must be finite and not negative")]
    RadiusMin {
        /// The radius.
        pixels: f32,
    },
    /// A budget in which nothing can be drawn.
    #[error("a budget of {bytes} bytes of GPU memory; it takes at least {least}")]
    Budget {
        /// The budget.
        bytes: u64,
        /// The smallest one.
        least: u64,
    },
    /// A picture shows one scene: its ids would not tell two apart.
    #[error("a picture shows one scene and its bricks; begin another one")]
    OtherContent,
    /// The graphics library refuses what it was told to do: this is a fault of puncta.
    #[error("the graphics library refuses a call: {what}")]
    Refused {
        /// What it says.
        what: String,
    },
}
