//! What blocks are made of.

use super::{
    glyphs::palette::mix,
    noise::{chance, hash},
};
use glam::IVec3;

/// What a block is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Kind {
    Air,
    Grass,
    Dirt,
    Stone,
    Slate,
    Sand,
    Snow,
    Coal,
    Iron,
    Gold,
    Gem,
    Wood,
    Leaf,
    Blossom,
}

/// A color for each kind, and how much it differs from block to block.
const COLORS: [([u8; 3], f64); 14] = [
    ([0, 0, 0], 0.0),
    ([116, 164, 72], 0.10),
    ([128, 102, 80], 0.08),
    ([138, 138, 142], 0.06),
    ([84, 84, 96], 0.07),
    ([224, 205, 148], 0.04),
    ([244, 247, 252], 0.02),
    ([44, 44, 50], 0.10),
    ([202, 150, 116], 0.06),
    ([250, 206, 66], 0.06),
    ([72, 216, 222], 0.08),
    ([102, 74, 48], 0.08),
    ([62, 118, 50], 0.16),
    ([232, 158, 178], 0.14),
];

impl Kind {
    /// The color of a block of a kind in a cell.
    pub(crate) fn color(kind: u8, cell: [u16; 3]) -> [u8; 3] {
        let Some(&(color, spread)) = COLORS.get(usize::from(kind)) else { return [128; 3] };
        let cell = IVec3::from(cell.map(i32::from));
        let share = f64::from(chance(cell, 77)) * spread;
        mix(color, if hash(cell, 78) & 1 == 0 { [255; 3] } else { [0; 3] }, share)
    }
}
