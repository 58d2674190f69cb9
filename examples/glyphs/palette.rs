//! Colors.

/// A color between two others.
#[allow(dead_code, reason = "not every tool mixes colors")]
pub(crate) fn mix(from: [u8; 3], to: [u8; 3], share: f64) -> [u8; 3] {
    let share = share.clamp(0.0, 1.0);
    let channel = |i: usize| {
        let mixed = f64::from(from[i]) + (f64::from(to[i]) - f64::from(from[i])) * share;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let byte = mixed.round() as u8;
        byte
    };
    [channel(0), channel(1), channel(2)]
}
