/*!
Images: what all shading shares, once it is known how much light reaches what a pixel shows.

Colors are mixed as light, that is linearly: sRGB is decoded before and encoded after. A picture may
have more pixels than the image; then a block of them is averaged for each pixel of the image, which
smooths silhouettes.
*/

use crate::{Error, Shading};
use glam::Vec3;
use puncta_core::{Background, Image, NO_RECORD, Picture, Record, Scene, View};
use rayon::prelude::*;

/// Makes an image from the share of light at each pixel of a picture, given its column, row and id.
pub(crate) fn image<R: Record>(
    scene: &Scene<R>,
    (view, factor): (&View, usize),
    picture: &Picture,
    shading: &Shading<'_>,
    share: impl Fn(usize, usize, u32) -> f32 + Sync,
) -> Result<Image, Error> {
    let colors = shading.coloring.colors(scene)?;
    let decode: [f32; 256] = std::array::from_fn(|byte| decode(byte as f32 / 255.0));
    let light = |column: usize, row: usize| -> Option<Vec3> {
        let id = picture.id[row * picture.width as usize + column];
        let color = || Vec3::from(colors.of(id).map(|c| decode[usize::from(c)]));
        (id != NO_RECORD).then(|| color() * share(column, row, id))
    };
    let (width, height) = (view.width() as usize, view.height() as usize);
    let mut pixels = vec![[0; 4]; width * height];
    pixels.par_chunks_mut(width).enumerate().for_each(|(row, pixels)| {
        let background = background(shading.background, row, height);
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let (mut sum, mut covered) = (Vec3::ZERO, 0_u32);
            for i in 0..factor * factor {
                let (x, y) = (column * factor + i % factor, row * factor + i / factor);
                if let Some(light) = light(x, y) {
                    sum += light;
                    covered += 1;
                }
            }
            *pixel = mix(sum, covered, (factor * factor) as f32, background);
        }
    });
    Ok(Image { width: view.width(), height: view.height(), pixels })
}

/// Checks sizes and ids, and returns the supersampling factor.
pub(crate) fn check<R: Record>(
    scene: &Scene<R>,
    view: &View,
    picture: &Picture,
    shading: &Shading<'_>,
) -> Result<usize, Error> {
    scene.validate()?;
    let factor = shading.supersample.max(1);
    let (pictured, viewed) = ((picture.width, picture.height), (view.width(), view.height()));
    let fits = |fine: u32, coarse: u32| u64::from(fine) == u64::from(coarse) * u64::from(factor);
    let pixels = picture.width as usize * picture.height as usize;
    if !(fits(pictured.0, viewed.0) && fits(pictured.1, viewed.1) && picture.id.len() == pixels) {
        return Err(Error::Size { picture: pictured, view: viewed, supersample: factor });
    }
    let records = scene.records.len();
    let unknown = |id: &&u32| **id != NO_RECORD && **id as usize >= records;
    match picture.id.iter().find(unknown) {
        Some(&id) => Err(Error::UnknownRecord { id, records }),
        None => Ok(factor as usize),
    }
}

/// Linear color of the background at a row; `None` if there is none.
fn background(background: Background, row: usize, height: usize) -> Option<Vec3> {
    let linear = |color: [u8; 3]| Vec3::from(color.map(|c| decode(f32::from(c) / 255.0)));
    match background {
        Background::Solid(color) => Some(linear(color)),
        Background::Gradient(top, bottom) => {
            // Mixed in sRGB, which is more even to the eye than light.
            let share = row as f32 / (height.max(2) - 1) as f32;
            let ends = top.map(f32::from).into_iter().zip(bottom.map(f32::from));
            let mixed: Vec<f32> =
                ends.map(|(a, b)| decode((a + (b - a) * share) / 255.0)).collect();
            Some(Vec3::from_slice(&mixed))
        }
        Background::Transparent => None,
    }
}

/// A pixel from the sum of its covered samples.
fn mix(sum: Vec3, covered: u32, samples: f32, background: Option<Vec3>) -> [u8; 4] {
    let share = covered as f32 / samples;
    let (color, alpha) = match background {
        Some(background) => (sum / samples + background * (1.0 - share), 1.0),
        None if covered == 0 => (Vec3::ZERO, 0.0),
        None => (sum / covered as f32, share),
    };
    let [r, g, b] = color.to_array().map(|c| to_byte(encode(c)));
    [r, g, b, to_byte(alpha)]
}

fn decode(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
fn to_byte(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
pub(crate) fn to_f32(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_decoding_and_encoding() {
        for byte in 0..=255_u8 {
            assert_eq!(to_byte(encode(decode(f32::from(byte) / 255.0))), byte);
        }
    }

    #[test]
    fn transparent_pixels_keep_straight_colors() {
        assert_eq!(mix(Vec3::splat(2.0), 2, 4.0, None), [255, 255, 255, 128]);
        assert_eq!(mix(Vec3::ZERO, 0, 4.0, None), [0; 4]);
    }
}
