/*!
Light: which pixels the sun and the patches of the sky reach, and the image that comes of it.

From each beam of light the scene is drawn once. A pixel is lit by it if what it shows is also what is
seen from there. The point is moved off its surface by what a pixel of that picture measures: from
there the surface itself is never in the way.
*/

use super::{
    built::Built,
    drawing::Drawing,
    normals,
    progress::Bar,
    sky::{self, BOUNCE, Beam},
};
use anyhow::Result;
use glam::{DVec3, Vec3};
use puncta::{Background, Bounds, Bricks, Glyph, Image, NO_RECORD, Picture, View};
use rayon::prelude::*;

/// What a pixel shows, and the light on it.
#[derive(Clone, Copy, Debug, Default)]
struct Spot {
    normal: Vec3,
    light: Vec3,
}

/// Makes an image of a picture of `view`, with light from `count` directions.
pub(crate) fn image<G: Glyph + 'static, B: Bricks>(
    drawing: &mut Drawing<'_, G, B>,
    built: &Built<G, B>,
    (view, picture): (&View, &Picture),
    (count, supersample, background): (u16, u32, Background),
) -> Result<Image> {
    let mut spots = spots(view, picture);
    let bounds = bounds(built);
    let beams = sky::beams(count, built.outlook.sun);
    let bar = Bar::counting("lighting", beams.len() as u64);
    for (done, beam) in (0_u64..).zip(&beams) {
        bar.set(done);
        let from = sky::view(&bounds, beam)?;
        let seen = drawing.quietly(&from)?;
        fall(beam, (view, picture), (&from, &seen), &mut spots);
    }
    bar.finish();
    built.paint.with_coloring(&built.scene, |coloring| {
        let colors = coloring.colors(&built.scene)?;
        Ok(average(picture, &spots, (supersample, background), |id| colors.of(id)))
    })
}

/// The box around all bricks.
fn bounds<G: Glyph, B: Bricks>(built: &Built<G, B>) -> Bounds {
    let mut all = Bounds::EMPTY;
    for brick in built.bricks.bricks() {
        let Bounds { min, max } = brick.world_bounds(built.scene.origin);
        all.add(min);
        all.add(max);
    }
    all
}

/// Normals, and the light that comes from everywhere.
fn spots(view: &View, picture: &Picture) -> Vec<Spot> {
    let width = picture.width as usize;
    let mut spots = vec![Spot::default(); picture.id.len()];
    spots.par_chunks_mut(width).zip(0..picture.height).for_each(|(spots, row)| {
        for (spot, column) in spots.iter_mut().zip(0..picture.width) {
            *spot = Spot { normal: normals::normal(view, picture, column, row), light: BOUNCE };
        }
    });
    spots
}

/// Adds the light of a beam where it falls.
fn fall(
    beam: &Beam,
    (view, picture): (&View, &Picture),
    (from, seen): (&View, &Picture),
    spots: &mut [Spot],
) {
    let width = picture.width as usize;
    let toward = beam.toward.as_vec3();
    let texel = from.pixel_size();
    let half = [f64::from(seen.width) * 0.5, f64::from(seen.height) * 0.5];
    let is_lit = |column: usize, row: usize, normal: Vec3| -> bool {
        let depth = f64::from(picture.depth[row * width + column]);
        let place = normals::point(view, [column as f64, row as f64], depth);
        let offset = view.right() * place.x + view.up() * place.y + view.forward() * place.z;
        let moved = view.eye() + offset + normal.as_dvec3() * texel;
        let DVec3 { x, y, z } = from.to_camera(moved - from.eye());
        let at = [half[0] + x / texel, half[1] - y / texel].map(f64::floor);
        let is_inside = (0.0..f64::from(seen.width)).contains(&at[0])
            && (0.0..f64::from(seen.height)).contains(&at[1]);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is inside")]
        let index = || at[1] as usize * seen.width as usize + at[0] as usize;
        !is_inside || f64::from(seen.depth[index()]) >= z
    };
    spots.par_chunks_mut(width).enumerate().for_each(|(row, spots)| {
        for (column, spot) in spots.iter_mut().enumerate() {
            let slant = spot.normal.dot(toward);
            if slant > 0.0 && is_lit(column, row, spot.normal) {
                spot.light += beam.color * slant;
            }
        }
    });
}

/// Averages blocks of pixels, as light.
fn average(
    picture: &Picture,
    spots: &[Spot],
    (factor, background): (u32, Background),
    color: impl Fn(u32) -> [u8; 3] + Sync,
) -> Image {
    let decoded: [f32; 256] = std::array::from_fn(|byte| decode(byte as f32 / 255.0));
    let linear = |color: [u8; 3]| Vec3::from(color.map(|c| decoded[usize::from(c)]));
    let (width, height) = (picture.width / factor, picture.height / factor);
    let mut pixels = vec![[0; 4]; width as usize * height as usize];
    let samples = (factor * factor) as f32;
    pixels.par_chunks_mut(width as usize).zip(0..height).for_each(|(pixels, row)| {
        let share = row as f32 / height.saturating_sub(1).max(1) as f32;
        let behind = match background {
            Background::Solid(color) => Some(linear(color)),
            Background::Gradient(top, bottom) => {
                let [top, bottom] = [top, bottom].map(|color| Vec3::from(color.map(f32::from)));
                let mixed = top.lerp(bottom, share) / 255.0;
                Some(Vec3::from(mixed.to_array().map(decode)))
            }
            Background::Transparent => None,
        };
        for (pixel, column) in pixels.iter_mut().zip(0_u32..) {
            let (mut sum, mut covered) = (Vec3::ZERO, 0.0);
            for i in 0..factor * factor {
                let (x, y) = (column * factor + i % factor, row * factor + i / factor);
                let at = y as usize * picture.width as usize + x as usize;
                let id = picture.id[at];
                if id != NO_RECORD {
                    sum += (linear(color(id)) * spots[at].light).min(Vec3::ONE);
                    covered += 1.0;
                }
            }
            *pixel = match behind {
                Some(behind) => bytes(sum / samples + behind * (1.0 - covered / samples), 1.0),
                None if covered == 0.0 => [0; 4],
                None => bytes(sum / covered, covered / samples),
            };
        }
    });
    Image { width, height, pixels }
}

fn decode(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn bytes(color: Vec3, alpha: f32) -> [u8; 4] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
    let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
    let [r, g, b] = color.to_array().map(|c| byte(encode(c)));
    [r, g, b, byte(alpha)]
}
