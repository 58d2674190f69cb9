//! Progress bars that show only for work of more than half a second, and only on a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    sync::{
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError, Sender},
    },
    thread,
    time::{Duration, Instant},
};

/// Work that takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// A bar on the error stream.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
    start: Instant,
    is_shown: AtomicBool,
    /// Lives as long as work that cannot tell how far it is.
    _working: Option<Sender<()>>,
}

impl Bar {
    /// A bar that counts bytes.
    pub(crate) fn bytes(what: &'static str) -> Self {
        Self::new(what, "{msg:>8} [{bar:32}] {bytes} of {total_bytes}, {eta} left", 0)
    }

    /// A bar that counts particles.
    pub(crate) fn counting(what: &'static str, total: u64) -> Self {
        Self::new(what, "{msg:>8} [{bar:32}] {human_pos} of {human_len}, {eta} left", total)
    }

    /// A sign of life for work that cannot tell how far it is.
    pub(crate) fn spinner(what: &'static str) -> Self {
        let (working, done) = mpsc::channel::<()>();
        let bar = Self::new(what, "{msg:>8} {spinner} {elapsed}", 0);
        let shown = bar.bar.clone();
        // Nothing is ever sent: the other end goes when the work is done.
        thread::spawn(move || {
            if done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(PATIENCE / 4);
            }
        });
        Self { _working: Some(working), ..bar }
    }

    fn new(what: &'static str, template: &str, total: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template(template);
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        bar.set_message(what);
        Self { bar, start: Instant::now(), is_shown: AtomicBool::new(false), _working: None }
    }

    pub(crate) fn set(&self, position: u64) {
        if !self.is_shown.load(Ordering::Relaxed) && self.start.elapsed() > PATIENCE {
            self.is_shown.store(true, Ordering::Relaxed);
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(position);
    }

    pub(crate) fn set_of(&self, position: u64, total: u64) {
        self.bar.set_length(total);
        self.set(position);
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
