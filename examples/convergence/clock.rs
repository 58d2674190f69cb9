//! Time, on the clock at the wall and on all processors.
//!
//! Where other programs share the machine, the time that the processors gave us is the figure to
//! trust; divided by the number of threads it is what an idle machine would have shown, at best.

use std::time::Instant;

/// A stretch of time in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Span {
    pub(crate) wall: f64,
    /// User and system time of all threads; 0 where the system does not tell.
    pub(crate) processors: f64,
}

impl std::ops::AddAssign for Span {
    fn add_assign(&mut self, other: Self) {
        self.wall += other.wall;
        self.processors += other.processors;
    }
}

/// Does something and tells how long it took.
pub(crate) fn time<T>(work: impl FnOnce() -> T) -> (T, Span) {
    let (wall, processors) = (Instant::now(), processors());
    let result = work();
    let spent = self::processors() - processors;
    (result, Span { wall: wall.elapsed().as_secs_f64(), processors: spent })
}

/// The medians of walls and of processors.
pub(crate) fn median(spans: &[Span]) -> Option<Span> {
    let middle = |of: fn(&Span) -> f64| {
        let mut seconds: Vec<f64> = spans.iter().map(of).collect();
        seconds.sort_by(f64::total_cmp);
        seconds.get(seconds.len() / 2).copied()
    };
    Some(Span { wall: middle(|span| span.wall)?, processors: middle(|span| span.processors)? })
}

#[cfg(unix)]
fn processors() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}

#[cfg(not(unix))]
fn processors() -> f64 {
    0.0
}
