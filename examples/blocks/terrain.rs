/*!
A landscape: mountains and meadows, deserts and woods, and below them caves and ores.

Everything is a function of a cell and a seed, but for the height of the ground, which is kept.
*/

use super::{
    kind::Kind,
    noise::{chance, noise, sum},
};
use glam::{IVec2, IVec3, Vec3};
use rayon::prelude::*;

/// How far apart trees stand, at least on average.
const TREES_APART: i32 = 9;

/// The part of the world's height that lies below the lowest and the highest ground.
const GROUND: [f32; 2] = [0.17, 0.60];

/// A landscape in a box of cells.
#[derive(Debug)]
pub(crate) struct Terrain {
    dims: [u16; 3],
    seed: u32,
    /// How many cells are ground, for each column: those of one y together.
    heights: Vec<u16>,
}

impl Terrain {
    pub(crate) fn new(dims: [u16; 3], seed: u32) -> Self {
        let [width, length, _] = dims.map(i32::from);
        let mut terrain = Self { dims, seed, heights: Vec::new() };
        let columns =
            (0..length).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| (x, y)));
        terrain.heights = columns.map(|(x, y)| terrain.raise(x, y)).collect();
        terrain
    }

    /// The height of the ground in a column.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
    fn raise(&self, x: i32, y: i32) -> u16 {
        let place = Vec3::new(x as f32, y as f32, 0.0);
        let warp = Vec3::new(
            sum(place / 90.0, 2, 0.5, self.seed ^ 11),
            sum(place / 90.0, 2, 0.5, self.seed ^ 12),
            0.0,
        );
        let place = place + warp * 26.0;
        // Ridges are where noise is zero; they rise where it is high country.
        let country = smooth(0.5 + 0.9 * sum(place / 190.0, 2, 0.5, self.seed ^ 1));
        let ridge = 1.0 - sum(place / 120.0, 4, 0.5, self.seed ^ 2).abs() * 2.6;
        let hills = 0.5 + 0.5 * sum(place / 62.0, 4, 0.45, self.seed ^ 3);
        let share = 0.04 + 0.26 * hills + 0.78 * country * ridge.max(0.0).powf(1.6);
        let high = f32::from(self.dims[2].min(self.dims[0].max(self.dims[1])));
        let [low, top] = GROUND.map(|part| part * high);
        (low + (top - low) * share).clamp(1.0, f32::from(self.dims[2])) as u16
    }

    fn height(&self, IVec2 { x, y }: IVec2) -> Option<i32> {
        let [width, length, _] = self.dims.map(i32::from);
        let is_in = (0..width).contains(&x) && (0..length).contains(&y);
        let index = is_in.then(|| usize::try_from(y * width + x).ok())??;
        self.heights.get(index).map(|&height| i32::from(height))
    }

    /// A column of cells, and the trees that may reach into it.
    pub(crate) fn column(&self, [x, y]: [u16; 2]) -> Column<'_> {
        let at = IVec2::new(x.into(), y.into());
        let net = at.div_euclid(IVec2::splat(TREES_APART));
        let squares = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| net + IVec2::new(dx, dy)));
        let trees = squares.filter_map(|square| self.tree(square, at)).collect();
        Column { terrain: self, at, height: self.height(at).unwrap_or(0), trees }
    }

    /// Tunnels are where two noises are both near zero, halls where a third one is high.
    fn is_cave(&self, place: IVec3, height: i32) -> bool {
        if place.z < 3 {
            return false;
        }
        let p = place.as_vec3() * Vec3::new(1.0, 1.0, 1.35);
        let is_thin =
            |seed: u32, size: f32, width: f32| noise(p / size, self.seed ^ seed).abs() < width;
        // Only few tunnels come up to the surface.
        let deep = ((height - place.z) as f32 / 14.0).min(1.0);
        let width = 0.05 + 0.06 * deep;
        (is_thin(21, 34.0, width) && is_thin(22, 34.0, width))
            || (deep >= 1.0 && noise(p / 52.0, self.seed ^ 23) > 0.56)
    }

    fn ground(&self, place: IVec3, height: i32) -> Kind {
        let (p, below) = (place.as_vec3(), height - 1 - place.z);
        let flat = Vec3::new(p.x, p.y, 0.0);
        let (high, rough) = self.climate(place.truncate(), height);
        #[expect(clippy::cast_possible_truncation, reason = "it is 1 to 5")]
        let soil = 3 + (2.0 * noise(flat / 17.0, self.seed ^ 31)).round() as i32;
        let is_dry = sum(flat / 150.0, 2, 0.5, self.seed ^ 32) > 0.12;
        if below < soil {
            return if high > 0.62 {
                if below < 2 && rough < 4 { Kind::Snow } else { Kind::Stone }
            } else if rough > 3 || high > 0.52 {
                Kind::Stone
            } else if is_dry && high < 0.3 {
                Kind::Sand
            } else if below == 0 {
                Kind::Grass
            } else {
                Kind::Dirt
            };
        }
        let deep = 1.0 - p.z / height.max(1) as f32;
        let ore = |size: f32, limit: f32, seed: u32| noise(p / size, self.seed ^ seed) > limit;
        if deep > 0.72 && ore(8.0, 0.60, 41) {
            Kind::Gem
        } else if deep > 0.5 && ore(9.0, 0.59, 42) {
            Kind::Gold
        } else if ore(10.0, 0.58, 43) {
            Kind::Iron
        } else if ore(11.0, 0.56, 44) {
            Kind::Coal
        } else if deep + 0.06 * noise(p / 20.0, self.seed ^ 45) > 0.6 {
            Kind::Slate
        } else if noise(p / Vec3::new(60.0, 60.0, 7.0), self.seed ^ 46) > 0.5 {
            Kind::Dirt
        } else {
            Kind::Stone
        }
    }

    /// How high the ground lies, as a share of all heights there are, and how steep it is.
    fn climate(&self, at: IVec2, height: i32) -> (f32, i32) {
        let around = [IVec2::X, IVec2::NEG_X, IVec2::Y, IVec2::NEG_Y];
        let other = |way: IVec2| self.height(at + way).unwrap_or(height);
        let rough = around.map(|way| (other(way) - height).abs()).into_iter().max().unwrap_or(0);
        let high = f32::from(self.dims[2].min(self.dims[0].max(self.dims[1])));
        let [low, top] = GROUND.map(|part| part * high);
        let flat = at.as_vec2().extend(0.0);
        let blur = 0.05 * noise(flat / 11.0, self.seed ^ 51);
        ((height as f32 - low) / (top - low) + blur, rough)
    }

    /// The tree of a square of the net, if there is one and it reaches into a column.
    fn tree(&self, square: IVec2, column: IVec2) -> Option<Tree> {
        let roll = |seed: u32| chance(square.extend(0), self.seed ^ seed);
        #[expect(clippy::cast_possible_truncation, reason = "it is below the side of a square")]
        let within = |seed: u32| (roll(seed) * TREES_APART as f32) as i32;
        let at = square * TREES_APART + IVec2::new(within(61), within(62));
        if (column - at).abs().max_element() > 4 {
            return None;
        }
        let height = self.height(at)?;
        let wood = 0.35 + 0.9 * sum(at.as_vec2().extend(0.0) / 70.0, 2, 0.5, self.seed ^ 63);
        let root = at.extend(height - 1);
        let is_meadow = || self.ground(root, height) == Kind::Grass && !self.is_cave(root, height);
        #[expect(clippy::cast_possible_truncation, reason = "it is below 4")]
        let trunk = 4 + (roll(65) * 4.0) as i32;
        let leaf = if roll(68) > 0.88 { Kind::Blossom } else { Kind::Leaf };
        let foot = at.extend(height);
        let tree = Tree { foot, trunk, radius: 2.3 + 1.2 * roll(66), leaf };
        (roll(64) <= wood && is_meadow()).then_some(tree)
    }
}

/// A tree.
#[derive(Clone, Copy, Debug)]
struct Tree {
    /// The lowest cell of the trunk.
    foot: IVec3,
    trunk: i32,
    /// Of the crown.
    radius: f32,
    leaf: Kind,
}

impl Tree {
    fn kind(&self, place: IVec3, seed: u32) -> Kind {
        let offset = place - self.foot;
        if offset.truncate() == IVec2::ZERO && (0..self.trunk).contains(&offset.z) {
            return Kind::Wood;
        }
        let crown = (offset - IVec3::new(0, 0, self.trunk)).as_vec3() * Vec3::new(1.0, 1.0, 0.9);
        let is_leaf =
            offset.z >= 2 && crown.length() < self.radius - 0.5 * chance(place, seed ^ 67);
        if is_leaf { self.leaf } else { Kind::Air }
    }
}

/// A column of cells.
#[derive(Debug)]
pub(crate) struct Column<'a> {
    terrain: &'a Terrain,
    at: IVec2,
    height: i32,
    trees: Vec<Tree>,
}

impl Column<'_> {
    /// Whether there is a block at a height.
    pub(crate) fn is_filled(&self, z: u16) -> bool {
        let place = self.at.extend(z.into());
        if place.z < self.height {
            !self.terrain.is_cave(place, self.height)
        } else {
            self.plant(place) != Kind::Air
        }
    }

    /// What the block at a height is made of.
    pub(crate) fn kind(&self, z: u16) -> Kind {
        let place = self.at.extend(z.into());
        if place.z >= self.height {
            self.plant(place)
        } else if self.terrain.is_cave(place, self.height) {
            Kind::Air
        } else {
            self.terrain.ground(place, self.height)
        }
    }

    fn plant(&self, place: IVec3) -> Kind {
        let kinds = self.trees.iter().map(|tree| tree.kind(place, self.terrain.seed));
        kinds.fold(Kind::Air, |found, kind| if found == Kind::Air { kind } else { found })
    }
}

/// From 0 to 1, flat at both ends.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
