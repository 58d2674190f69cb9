//! How much memory the process uses, and used at most.

use std::fs;

/// Now and at most, in bytes; `None` where the system does not tell.
fn resident() -> Option<[u64; 2]> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let find = |key: &str| {
        let line = status.lines().find(|line| line.starts_with(key))?;
        let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kibibytes * 1024)
    };
    Some([find("VmRSS:")?, find("VmHWM:")?])
}

/// Forgets how much was used at most; whether that is possible.
fn forget_peak() -> bool {
    fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// Does something, and tells how far memory grew beyond what was in use, at most.
pub(crate) fn growth<T>(work: impl FnOnce() -> T) -> (T, Option<u64>) {
    let before = if forget_peak() { resident() } else { None };
    let result = work();
    let growth = resident().zip(before).map(|([_, peak], [now, _])| peak.saturating_sub(now));
    (result, growth)
}
