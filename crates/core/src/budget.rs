//! Budgets: how much is drawn before it is asked whether to go on.

use std::time::Duration;

/// How much is drawn in one step of a [`Progressive`](crate::Progressive) picture.
///
/// Numbers of records and durations turn into budgets by themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// Bricks that hold at least this many records, those that are skipped included.
    Records(u64),
    /// About as much as can be drawn in this time, at least one brick. What a step draws depends on
    /// the machine then; the complete picture does not.
    Time(Duration),
}

impl From<u64> for Budget {
    fn from(records: u64) -> Self {
        Self::Records(records)
    }
}

impl From<Duration> for Budget {
    fn from(time: Duration) -> Self {
        Self::Time(time)
    }
}
