//! How far the worker is: the bars of the example `render`, for a window to show.
//!
//! One thread reads at a time, so there is one bar at a time.

use crate::theme::rough;
use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicU64, Ordering},
};

static WHAT: Mutex<Option<&'static str>> = Mutex::new(None);
static POSITION: AtomicU64 = AtomicU64::new(0);
static TOTAL: AtomicU64 = AtomicU64::new(0);

/// Work that is under way; it is over when the last copy is dropped.
#[derive(Debug)]
pub(crate) struct Bar;

impl Bar {
    pub(crate) fn bytes(what: &'static str) -> Self {
        Self::counting(what, 0)
    }

    pub(crate) fn counting(what: &'static str, total: u64) -> Self {
        POSITION.store(0, Ordering::Relaxed);
        TOTAL.store(total, Ordering::Relaxed);
        set(Some(what));
        Self
    }

    /// For work that cannot tell how far it is.
    pub(crate) fn spinner(what: &'static str) -> Self {
        Self::counting(what, 0)
    }

    #[expect(clippy::unused_self, reason = "only who has a bar may move it")]
    pub(crate) fn set(&self, position: u64) {
        POSITION.store(position, Ordering::Relaxed);
    }

    pub(crate) fn set_of(&self, position: u64, total: u64) {
        TOTAL.store(total, Ordering::Relaxed);
        self.set(position);
    }

    #[expect(clippy::unused_self, reason = "only who has a bar may end it")]
    pub(crate) fn finish(&self) {
        set(None);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.finish();
    }
}

fn set(what: Option<&'static str>) {
    *WHAT.lock().unwrap_or_else(PoisonError::into_inner) = what;
}

/// What is being done, and which share of it is done if that is known.
pub(crate) fn now() -> Option<(&'static str, Option<f32>)> {
    let what = (*WHAT.lock().unwrap_or_else(PoisonError::into_inner))?;
    let (position, total) = (POSITION.load(Ordering::Relaxed), TOTAL.load(Ordering::Relaxed));
    let share = (total > 0).then(|| rough((position as f64 / total as f64).min(1.0)));
    Some((what, share))
}
