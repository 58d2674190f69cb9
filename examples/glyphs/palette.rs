//! Colors.

/// Colors that are easily told apart.
#[allow(dead_code, reason = "not every tool needs so many")]
pub(crate) const PALETTE: [[u8; 3]; 11] = [
    [57, 105, 172],
    [242, 183, 1],
    [231, 63, 116],
    [17, 165, 121],
    [230, 131, 16],
    [127, 60, 141],
    [128, 186, 90],
    [0, 134, 149],
    [249, 123, 114],
    [75, 75, 143],
    [207, 28, 144],
];

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
