//! Gradient noise, after Perlin, 2002: the same on every machine, from nothing but a seed.

use glam::{IVec3, Vec3};

/// Noise in space, from about -1 to 1; features are about 1 in size.
pub(crate) fn noise(place: Vec3, seed: u32) -> f32 {
    let floor = place.floor();
    let (cell, p) = (floor.as_ivec3(), place - floor);
    let fade = p * p * p * (p * (p * 6.0 - 15.0) + 10.0);
    let corner = |x: i32, y: i32, z: i32| {
        let offset = IVec3::new(x, y, z);
        gradient(hash(cell + offset, seed), p - offset.as_vec3())
    };
    let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
    let row = |y: i32, z: i32| mix(corner(0, y, z), corner(1, y, z), fade.x);
    let layer = |z: i32| mix(row(0, z), row(1, z), fade.y);
    mix(layer(0), layer(1), fade.z)
}

/// A sum of noises, each of half the size and a part of the strength of the one before.
pub(crate) fn sum(place: Vec3, octaves: u16, part: f32, seed: u32) -> f32 {
    let (mut total, mut weight, mut all) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        let scale = f32::from(1_u16 << octave.min(15));
        total += weight * noise(place * scale, seed.wrapping_add(u32::from(octave)));
        all += weight;
        weight *= part;
    }
    total / all
}

/// The slope along one of twelve directions to the edges of a cube.
fn gradient(hash: u32, p: Vec3) -> f32 {
    let h = hash >> 28;
    let u = if h < 8 { p.x } else { p.y };
    let v = match h {
        0..=3 => p.y,
        12 | 14 => p.x,
        _ => p.z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// A number that looks like chance, for each cell.
pub(crate) fn hash(cell: IVec3, seed: u32) -> u32 {
    let [x, y, z] = cell.to_array().map(i32::cast_unsigned);
    let mut h = seed.wrapping_mul(0x9e37_79b9)
        ^ x.wrapping_mul(0x8da6_b343)
        ^ y.wrapping_mul(0xd816_3841)
        ^ z.wrapping_mul(0xcb1a_b31f);
    // The finisher of MurmurHash3.
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^ h >> 16
}

/// The same as a number from 0 to 1.
pub(crate) fn chance(cell: IVec3, seed: u32) -> f32 {
    (hash(cell, seed) >> 8) as f32 / (1 << 24) as f32
}
