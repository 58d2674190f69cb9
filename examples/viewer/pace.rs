//! How often images are made of a picture that is being drawn.
//!
//! Making an image takes time in which nothing is drawn. So of a picture that is not settled only as
//! many images are made as leave most of the time to drawing.

use std::time::{Duration, Instant};

/// How long a step may take: a screen shows a new image about as often.
pub(crate) const BUDGET: Duration = Duration::from_millis(16);

/// How much longer drawing takes than making images, at least.
const PATIENCE: u32 = 2;

/// When the last image was done, and how long it took.
#[derive(Debug, Default)]
pub(crate) struct Pace(Option<(Instant, Duration)>);

/// What is known of a step of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct About {
    pub(crate) is_first: bool,
    pub(crate) is_settled: bool,
    /// Whether it is a finer picture of what is shown already.
    pub(crate) is_fine: bool,
}

impl Pace {
    /// Whether an image of a step is to be made.
    pub(crate) fn is_due(&self, about: About) -> bool {
        match self.0 {
            // What is shown already is better than a fine picture that is half done.
            _ if about.is_fine => about.is_settled,
            Some((at, took)) => {
                about.is_settled || about.is_first || at.elapsed() > took * PATIENCE
            }
            None => true,
        }
    }

    /// Notes an image that was begun at `start` and is done now.
    pub(crate) fn note(&mut self, start: Instant) {
        self.0 = Some((Instant::now(), start.elapsed()));
    }
}
