//! Colors of files, as the sRGB bytes of a scene.

use crate::builder::Builder;

/// What is drawn where a file has no color that can be used.
pub(crate) const WHITE: [u8; 4] = [255; 4];

/// Makes colors, and counts those that had to be changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Colors {
    not_numbers: u64,
    outside: u64,
}

impl Colors {
    /// The color with these parts, which should be from 0 to 1: parts outside are taken for the
    /// nearest end, and a color with a NaN in it becomes white.
    pub(crate) fn color(&mut self, parts: [f64; 4]) -> [u8; 4] {
        if parts.iter().any(|part| part.is_nan()) {
            self.not_numbers += 1;
            return WHITE;
        }
        self.outside += u64::from(parts.iter().any(|part| !(0.0..=1.0).contains(part)));
        parts.map(to_byte)
    }

    /// Tells of the colors that had to be changed.
    pub(crate) fn warn(&self, builder: &mut Builder<'_>) {
        if self.not_numbers > 0 {
            builder.warn(format!("{} colors are not a number; they are white", self.not_numbers));
        }
        if self.outside > 0 {
            builder.warn(format!("{} colors lie outside of 0..1 and were clamped", self.outside));
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounding to a byte is what is meant"
)]
fn to_byte(part: f64) -> u8 {
    (part.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_and_words_come_back() {
        let mut colors = Colors::default();
        for byte in 0..=255_u8 {
            let part = f64::from(byte) / 255.0;
            let word = f64::from(u16::from(byte) * 257) / 65535.0;
            let single = f64::from(f32::from(byte) / 255.0);
            assert_eq!(colors.color([part, word, single, 1.0]), [byte, byte, byte, 255]);
        }
        assert_eq!((colors.outside, colors.not_numbers), (0, 0));
    }

    #[test]
    fn what_is_no_color_is_counted() {
        let mut colors = Colors::default();
        assert_eq!(colors.color([-1.0, 255.0, f64::INFINITY, 0.0]), [0, 255, 255, 0]);
        assert_eq!(colors.color([0.0, f64::NAN, 0.0, 0.0]), WHITE);
        assert_eq!((colors.outside, colors.not_numbers), (1, 1));
    }
}
