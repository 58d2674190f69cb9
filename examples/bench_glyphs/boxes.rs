/*!
Boxes: blocks of a world and cuboids, as the records that representations are made of.

The picture tells of each pixel which box it shows, and which face of it: `8 id + face`, where a face is
`2 axis + side`. So representations must agree in both.
*/

use crate::noise::Noise;
use anyhow::Result;
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{DVec3, Vec3};
use puncta::{
    Bounds, Cuboid,
    avc::{Block, BlockWorld, Filling},
};

/// The face of an id that is not told.
pub(crate) const ANY_FACE: u32 = 7;

/// What a record is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A [`Block`]; worlds have so many cells along a side.
    Block { side: u32 },
    /// A [`Cuboid`].
    Cuboid,
}

impl Kind {
    /// Bytes of a record.
    pub(crate) const fn bytes(self) -> usize {
        match self {
            Self::Block { .. } => size_of::<Block>(),
            Self::Cuboid => size_of::<Cuboid>(),
        }
    }

    /// How a shader reads a record.
    pub(crate) const fn wgsl(self) -> &'static str {
        match self {
            Self::Block { .. } => include_str!("block.wgsl"),
            Self::Cuboid => include_str!("cuboid.wgsl"),
        }
    }

    /// Cells along a side of the world; 1 if there is none.
    pub(crate) const fn side(self) -> u32 {
        match self {
            Self::Block { side } => side,
            Self::Cuboid => 1,
        }
    }
}

/// A box in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solid {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
    pub(crate) id: u32,
}

/// The number of a cell, which is the id of its block.
pub(crate) const fn number([x, y, z]: [u32; 3], side: u32) -> u32 {
    x + side * (y + side * z)
}

/// Records of one kind.
#[derive(Debug)]
pub(crate) struct Boxes {
    pub(crate) kind: Kind,
    words: Vec<u32>,
}

impl Boxes {
    /// A world of so many cells along a side: all blocks, and those with faces that no other block
    /// covers. Types are noise of 16 steps; those up to the `threshold` are air.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is up to 16")]
    pub(crate) fn world(side: u32, threshold: Option<u8>) -> Result<[Self; 2]> {
        let noise = Noise::new(1, 7.0);
        let kind = |cell: [u16; 3]| {
            let value = (16.0 * noise.at(cell.map(|k| f64::from(k) + 0.5))).round() as u8;
            match threshold {
                Some(threshold) if value <= threshold => 0,
                _ => value.max(1),
            }
        };
        let mut world = BlockWorld::new([side; 3])?;
        world.fill(|cell| Filling::solid(kind(cell)));
        let exposed = world.surface(kind);
        let mut all = Vec::new();
        let side = u16::try_from(side)?;
        for z in 0..side {
            for y in 0..side {
                let row = (0..side).map(|x| Block::new([x, y, z], kind([x, y, z])));
                all.extend(row.filter(|block| block.kind != 0));
            }
        }
        let kind = Kind::Block { side: side.into() };
        Ok([all, exposed].map(|blocks| Self { kind, words: pod_collect_to_vec(&blocks) }))
    }

    /// Bars on a plane: where they are is regular, their sides and heights are noise of their own.
    #[expect(clippy::cast_possible_truncation, reason = "coordinates are small")]
    pub(crate) fn bars(count: u32) -> Self {
        let side = (1..).find(|side| side * side >= u64::from(count)).unwrap_or(1);
        let [width, depth, height] = [2, 3, 4].map(|seed| Noise::new(seed, 2.5));
        let mut records: Vec<Cuboid> = Vec::new();
        for index in 0..u64::from(count) {
            let (x, y) = ((index % side) as f64 + 0.5, (index / side) as f64 + 0.5);
            let share = |noise: Noise| 0.1 + 0.85 * noise.flat(x, y);
            let extent = [share(width), share(depth), 12.0 * share(height)].map(|x| x as f32);
            records.push(Cuboid::new([x as f32, y as f32, extent[2] * 0.5], extent));
        }
        Self { kind: Kind::Cuboid, words: pod_collect_to_vec(&records) }
    }

    pub(crate) fn len(&self) -> usize {
        self.words.len() * 4 / self.kind.bytes()
    }

    /// The records as they lie on the device.
    pub(crate) fn bytes(&self) -> &[u8] {
        cast_slice(&self.words)
    }

    /// The box of a record.
    pub(crate) fn get(&self, index: usize) -> Solid {
        let stride = self.kind.bytes() / 4;
        let words = &self.words[index * stride..][..stride];
        match self.kind {
            Kind::Block { side } => {
                let cell = [words[0] & 0xffff, words[0] >> 16, words[1] & 0xffff];
                let low = Vec3::from(cell.map(|k| k as f32));
                Solid { low, high: low + 1.0, id: number(cell, side) }
            }
            Kind::Cuboid => {
                let real = |k: usize| f32::from_bits(words[k]);
                let half = Vec3::new(real(3), real(4), real(5)) * 0.5;
                let center = Vec3::new(real(0), real(1), real(2));
                let id = u32::try_from(index).unwrap_or(u32::MAX);
                Solid { low: center - half, high: center + half, id }
            }
        }
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let mut bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        for solid in (0..self.len()).map(|index| self.get(index)) {
            bounds.min = bounds.min.min(solid.low.as_dvec3());
            bounds.max = bounds.max.max(solid.high.as_dvec3());
        }
        bounds
    }
}
