//! Which ranges of a column were changed last, so that copies need not be made anew.

use std::{collections::VecDeque, ops::Range};

/// The ranges that were changed last.
#[derive(Clone, Debug, Default)]
pub(super) struct Edits {
    /// The version before the first of them.
    since: u64,
    /// The version after each, and which values it changed.
    ranges: VecDeque<(u64, Range<usize>)>,
}

/// How many ranges are remembered.
pub(super) const EDITS_MAX: usize = 256;

impl Edits {
    /// None, from this version on.
    pub(super) const fn since(version: u64) -> Self {
        Self { since: version, ranges: VecDeque::new() }
    }

    /// Notes that a range was changed, which made this version.
    pub(super) fn add(&mut self, version: u64, range: Range<usize>) {
        self.ranges.push_back((version, range));
        if self.ranges.len() > EDITS_MAX
            && let Some((version, _)) = self.ranges.pop_front()
        {
            self.since = version;
        }
    }

    /// The ranges that were changed after a version; `None` if it is not known.
    pub(super) fn after(&self, version: u64) -> Option<Vec<Range<usize>>> {
        let first = if version == self.since {
            0
        } else {
            1 + self.ranges.iter().position(|(after, _)| *after == version)?
        };
        Some(self.ranges.range(first..).map(|(_, range)| range.clone()).collect())
    }
}
