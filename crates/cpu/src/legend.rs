//! The legend of a color map: a bar with numbers, drawn onto an image.

use crate::ColorMap;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use puncta_core::Image;

/// The number of marks along the bar.
const MARKS: usize = 5;

/// Draws a bar of `map` with the values from `range[0]` (bottom) to `range[1]` (top) and a `title`
/// above it at the right edge of the image. On an image too small to hold it, or without a color for
/// each pixel, nothing is drawn.
pub fn draw_legend(image: &mut Image, map: &ColorMap, range: [f64; 2], title: &str) {
    let font = match image.height {
        0..720 => RasterHeight::Size16,
        720..1600 => RasterHeight::Size24,
        _ => RasterHeight::Size32,
    };
    let line = font.val();
    let letter = get_raster_width(FontWeight::Regular, font);
    let share = |mark: usize| mark as f64 / (MARKS - 1) as f64;
    let values = (0..MARKS).map(|mark| range[0] + (range[1] - range[0]) * share(mark));
    let labels = labels(&values.collect::<Vec<_>>());
    let label_width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0) * letter;
    let title_width = title.chars().count() * letter;
    let (width, height) = (image.width as usize, image.height as usize);
    if image.pixels.len() != width * height {
        return;
    }
    let (bar_width, bar_height) = (line, height * 2 / 5);
    let block = (bar_width + line / 2 + label_width).max(title_width);
    if width < block + 2 * line || bar_height < MARKS * line || height < bar_height + 5 * line {
        return;
    }
    let (left, top) = (width - line - block, height - line * 2 - bar_height);
    // Ink that stands out from what lies below the title.
    let below = image.pixels[(top - line) * width + left];
    let is_dark = below[3] > 127 && below[..3].iter().map(|&c| u32::from(c)).sum::<u32>() < 384;
    let ink = if is_dark { [235; 3] } else { [25; 3] };
    let mut sheet = Sheet { image, ink, font };
    for y in 0..bar_height {
        let color = map.color(1.0 - y as f64 / (bar_height - 1) as f64);
        for x in 0..bar_width {
            let edge = x == 0 || y == 0 || x + 1 == bar_width || y + 1 == bar_height;
            sheet.mix(left + x, top + y, if edge { ink } else { color }, 255);
        }
    }
    for (mark, label) in labels.iter().enumerate() {
        let y = top + (MARKS - 1 - mark) * (bar_height - 1) / (MARKS - 1);
        (0..line / 4).for_each(|x| sheet.mix(left + bar_width + x, y, ink, 255));
        sheet.write(left + bar_width + line / 2, y - line / 2, label);
    }
    sheet.write(left, top - line * 2, title);
}

/// An image to draw on.
struct Sheet<'a> {
    image: &'a mut Image,
    ink: [u8; 3],
    font: RasterHeight,
}

impl Sheet<'_> {
    /// Lays a color over a pixel; pixels outside of the image are left out.
    fn mix(&mut self, x: usize, y: usize, color: [u8; 3], cover: u8) {
        let width = self.image.width as usize;
        let Some(pixel) = self.image.pixels.get_mut(y * width + x).filter(|_| x < width) else {
            return;
        };
        let cover = u32::from(cover);
        let over = |new: u8, old: u8| {
            let mixed = (u32::from(new) * cover + u32::from(old) * (255 - cover)) / 255;
            u8::try_from(mixed).unwrap_or(u8::MAX)
        };
        let [r, g, b, a] = *pixel;
        *pixel = [over(color[0], r), over(color[1], g), over(color[2], b), over(255, a)];
    }

    /// Writes a text whose top left corner is at `(x, y)`.
    fn write(&mut self, x: usize, y: usize, text: &str) {
        let letter = get_raster_width(FontWeight::Regular, self.font);
        for (place, character) in text.chars().enumerate() {
            let raster = get_raster(character, FontWeight::Regular, self.font)
                .or_else(|| get_raster('?', FontWeight::Regular, self.font));
            let rows = raster.iter().flat_map(|raster| raster.rows().enumerate());
            for (row, covers) in rows {
                for (column, &cover) in covers.iter().enumerate() {
                    self.mix(x + place * letter + column, y + row, self.ink, cover);
                }
            }
        }
    }
}

/// The values with as many decimals as tell them apart.
fn labels(values: &[f64]) -> Vec<String> {
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let step = match values {
        [first, .., last] => (last - first).abs() / (values.len() - 1) as f64,
        _ => 0.0,
    };
    let plain = (1e-3..1e6).contains(&largest) && step > largest * 1e-6;
    if !plain {
        return values.iter().map(|value| format!("{value:.3e}")).collect();
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
    let decimals = (1.0 - step.log10().floor()).clamp(0.0, 9.0) as usize;
    values.iter().map(|value| format!("{value:.decimals$}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_tell_values_apart() {
        assert_eq!(labels(&[0.0, 0.25, 0.5]), ["0.00", "0.25", "0.50"]);
        assert_eq!(labels(&[0.0, 300.0, 600.0]), ["0", "300", "600"]);
        assert_eq!(labels(&[1e9, 2e9]), ["1.000e9", "2.000e9"]);
        assert_eq!(labels(&[7.0, 7.0]), ["7.000e0", "7.000e0"]);
    }

    #[test]
    fn a_legend_stays_on_the_image_and_small_images_stay_clean() {
        let map = ColorMap::default();
        for size in [1, 10, 100, 300, 500, 900, 2000] {
            let pixels = vec![[255; 4]; size as usize * size as usize];
            let mut image = Image { width: size, height: size, pixels: pixels.clone() };
            draw_legend(&mut image, &map, [0.0, 1.0], "height \u{1F980}");
            assert_eq!(image.pixels == pixels, size < 300, "{size}");
        }
    }
}
