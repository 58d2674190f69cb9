//! Tests of worlds of blocks, against loops over all cells.

use super::*;
use crate::{Block, Glyph, Glyphs, Mesh, Sight};
use glam::{DVec3, I64Vec3};
use proptest::prelude::*;
use puncta_core::Record;
use std::collections::HashMap;

/// A number that is as good as random, for each cell.
fn noise([x, y, z]: [u16; 3], seed: u64) -> u64 {
    let mut n = seed ^ u64::from(x) << 40 ^ u64::from(y) << 20 ^ u64::from(z);
    for _ in 0..2 {
        n = (n ^ n >> 31).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    n ^ n >> 29
}

/// Fillings with these shares, of 256, of opaque and of clear blocks.
fn filling(cell: [u16; 3], seed: u64, [opaque, clear]: [u64; 2]) -> Filling {
    match noise(cell, seed) & 255 {
        n if n < opaque => Filling::Opaque,
        n if n < opaque + clear => Filling::Clear,
        _ => Filling::Air,
    }
}

fn kind(cell: [u16; 3]) -> u8 {
    noise(cell, 77).to_le_bytes()[0] | 1
}

/// A world as a list of cells.
struct Plain {
    dims: [u32; 3],
    cells: Vec<Filling>,
}

impl Plain {
    fn new(dims: [u32; 3], seed: u64, shares: [u64; 2]) -> Self {
        let cells = Self::order(dims).map(|cell| filling(cell, seed, shares)).collect();
        Self { dims, cells }
    }

    /// All cells by y, then x, then z.
    fn order(dims: [u32; 3]) -> impl Iterator<Item = [u16; 3]> {
        let [width, depth, height] = dims.map(|side| u16::try_from(side).unwrap());
        let columns = (0..depth).flat_map(move |y| (0..width).map(move |x| (x, y)));
        columns.flat_map(move |(x, y)| (0..height).map(move |z| [x, y, z]))
    }

    fn at(&self, cell: I64Vec3) -> Filling {
        let [width, depth, height] = self.dims.map(i64::from);
        let is_in =
            cell.cmpge(I64Vec3::ZERO).all() && cell.cmplt(I64Vec3::new(width, depth, height)).all();
        if !is_in {
            return Filling::Air;
        }
        self.cells[usize::try_from((cell.y * width + cell.x) * height + cell.z).unwrap()]
    }

    /// The blocks with those faces whose neighbor does not hide them.
    fn blocks(&self, hides: impl Fn(I64Vec3) -> bool) -> Vec<Block> {
        let mut blocks = Vec::new();
        for cell in Self::order(self.dims) {
            let at = I64Vec3::from(cell.map(i64::from));
            if self.at(at) == Filling::Air {
                continue;
            }
            let mut faces = 0;
            for face in 0..6 {
                let neighbor = at + outward(face);
                let is_covered = self.at(neighbor) == Filling::Opaque && hides(neighbor);
                faces |= u8::from(!is_covered) << face;
            }
            if faces != 0 {
                blocks.push(Block { cell, kind: kind(cell), faces });
            }
        }
        blocks
    }
}

fn outward(face: u8) -> I64Vec3 {
    I64Vec3::AXES[usize::from(face / 2)] * if face & 1 == 1 { 1 } else { -1 }
}

fn world(dims: [u32; 3], seed: u64, shares: [u64; 2]) -> BlockWorld {
    let mut world = BlockWorld::new(dims).unwrap();
    world.fill(|cell| filling(cell, seed, shares));
    world
}

/// Sides that lie on either side of the borders of words.
fn dims() -> impl Strategy<Value = [u32; 3]> {
    let height =
        prop_oneof![2 => 1..=130_u32, 1 => prop::sample::select(vec![63, 64, 65, 127, 128, 129])];
    (1..=9_u32, 1..=9_u32, height).prop_map(<[u32; 3]>::from)
}

fn shares() -> impl Strategy<Value = [u64; 2]> {
    prop_oneof![
        [0..=256_u64, 0..=60_u64],
        Just([128, 0]),
        Just([256, 0]),
        [200..=250_u64, 0..=10_u64]
    ]
}

proptest! {
    #[test]
    fn the_surface_is_that_of_loops(dims in dims(), seed in any::<u64>(), shares in shares()) {
        let (world, plain) = (world(dims, seed, shares), Plain::new(dims, seed, shares));
        prop_assert_eq!(world.surface(kind), plain.blocks(|_| true));
        prop_assert_eq!(world.all(kind), plain.blocks(|_| false));
        let count = plain.cells.iter().filter(|&&cell| cell != Filling::Air).count();
        prop_assert_eq!(world.count(), count as u64);
        prop_assert!(Plain::order(dims).zip(&plain.cells).all(|(cell, &filling)| world.get(cell) == filling));
    }

    /// Wherever the eye is, in the world or around it, near the borders of cells or on them.
    #[test]
    fn what_is_near_an_eye_hides_nothing(
        dims in dims(),
        seed in any::<u64>(),
        shares in shares(),
        eye in [-100..900_i32, -100..900, -100..8900],
        reach in prop_oneof![0..40_i32, 0..400_i32],
    ) {
        let (world, plain) = (world(dims, seed, shares), Plain::new(dims, seed, shares));
        // In these steps, all that follows is exact.
        let (eye, reach) = (DVec3::from(eye.map(f64::from)) / 64.0, f64::from(reach) / 64.0);
        let hides = |cell: I64Vec3| {
            let low = cell.as_dvec3();
            eye.clamp(low, low + 1.0).distance_squared(eye) > reach * reach
        };
        prop_assert_eq!(world.surface_around(eye, reach, kind), plain.blocks(hides));
    }

    /// The faces of the surface fit together along each edge, and hold as much as there are blocks.
    #[test]
    fn the_surface_is_closed(dims in dims(), seed in any::<u64>(), opaque in 0..=256_u64) {
        let world = world(dims, seed, [opaque, 0]);
        let glyphs = Glyphs::new([]);
        let blocks = world.surface(kind);
        let cloud = glyphs.cloud(&blocks);
        let mut edges: HashMap<[[i64; 3]; 2], i32> = HashMap::new();
        let mut faces = HashMap::new();
        let mut volume = 0.0;
        for (index, block) in blocks.iter().enumerate() {
            let mesh = Mesh::of::<Block>(&Block::form(&cloud, index, &Sight::everywhere(1.0)));
            let place = |at: u32| block.position().as_dvec3() + mesh.vertices[at as usize].as_dvec3();
            for triangle in &mesh.triangles {
                let corners = triangle.map(place);
                let mut key = corners.map(|corner| corner.as_i64vec3().to_array());
                for i in 0..3 {
                    let (a, b) = (key[i], key[(i + 1) % 3]);
                    *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
                }
                key.sort_unstable();
                *faces.entry(key).or_insert(0) += 1;
                volume += corners[0].dot(corners[1].cross(corners[2])) / 6.0;
            }
        }
        prop_assert!(edges.values().all(|&sum| sum == 0));
        prop_assert!(faces.values().all(|&count| count == 1));
        prop_assert!((volume - world.count() as f64).abs() < 1e-6 * (1.0 + world.count() as f64));
    }

    /// A ray meets the same block first, whether all blocks are drawn or the surface around the eye,
    /// if it starts within the reach.
    #[test]
    fn rays_meet_the_same_blocks(
        dims in [1..=7_u32, 1..=7, 60..=70_u32],
        seed in any::<u64>(),
        shares in shares(),
        eye in [-1.0..8.0_f64, -1.0..8.0, 55.0..72.0],
        near in 0.0..3.0_f64,
        directions in prop::collection::vec([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 20),
    ) {
        let world = world(dims, seed, shares);
        let eye = DVec3::from(eye);
        let (all, around) = (world.all(kind), world.surface_around(eye, near, kind));
        for direction in directions.into_iter().map(DVec3::from) {
            prop_assume!(direction.abs().min_element() > 1e-3);
            let direction = direction.normalize();
            prop_assert_eq!(
                first(&all, eye, direction, near),
                first(&around, eye, direction, near)
            );
        }
    }

    #[test]
    fn cells_that_are_set_are_those_that_are_filled(
        dims in dims(),
        seed in any::<u64>(),
        shares in shares(),
        others in shares(),
    ) {
        let mut other = world(dims, seed ^ 1, others);
        for cell in Plain::order(dims) {
            other.set(cell, filling(cell, seed, shares)).unwrap();
        }
        let world = world(dims, seed, shares);
        prop_assert_eq!(other.surface(kind), world.surface(kind));
        prop_assert!(Plain::order(dims).all(|cell| other.get(cell) == world.get(cell)));
        let mut by_columns = BlockWorld::new(dims).unwrap();
        by_columns.fill_columns(|[x, y], column| {
            for (z, cell) in (0..).zip(column) {
                *cell = filling([x, y, z], seed, shares);
            }
        });
        prop_assert_eq!(by_columns, world);
    }
}

/// The first block whose drawn face a ray enters beyond a distance.
fn first(blocks: &[Block], eye: DVec3, direction: DVec3, near: f64) -> Option<[u16; 3]> {
    let entry = |block: &Block| {
        let low = DVec3::from(block.cell.map(f64::from));
        let entries = (0..3).filter_map(move |axis| {
            let side = usize::from(direction[axis] < 0.0);
            let distance = (low[axis] + side as f64 - eye[axis]) / direction[axis];
            let at = eye + direction * distance - low;
            let is_on = (0..3).all(|other| other == axis || (0.0..=1.0).contains(&at[other]));
            let is_drawn = block.faces >> (2 * axis + side) & 1 == 1;
            (is_on && is_drawn && distance >= near).then_some(distance)
        });
        entries.fold(f64::INFINITY, f64::min)
    };
    let distances = blocks.iter().map(|block| (entry(block), block.cell));
    let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
    nearest.0.is_finite().then_some(nearest.1)
}

#[test]
fn sides_and_cells_are_checked() {
    for (dims, axis) in [([0, 1, 1], 0), ([1, 2049, 1], 1), ([1, 1, u32::MAX], 2)] {
        let error = BlockWorldError::Side { axis, side: dims[axis] };
        assert_eq!(BlockWorld::new(dims), Err(error));
        assert!(error.to_string().contains(&dims[axis].to_string()), "{error}");
    }
    let mut world = BlockWorld::new([2, 3, 65]).unwrap();
    assert_eq!(world.dims(), [2, 3, 65]);
    for cell in [[2, 0, 0], [0, 3, 0], [0, 0, 65], [u16::MAX; 3]] {
        let error = world.set(cell, Filling::Opaque).unwrap_err();
        assert!(error.to_string().contains(&format!("{cell:?}")), "{error}");
        assert_eq!(world.get(cell), Filling::Air);
    }
    assert_eq!(world.count(), 0);
    assert!(world.surface(kind).is_empty());
}

/// Eyes that are no place add nothing, and an endless reach adds everything.
#[test]
fn odd_eyes_are_understood() {
    let world = world([5, 5, 70], 1, [256, 0]);
    let surface = world.surface(kind);
    let middle = DVec3::splat(2.5);
    for (eye, reach) in [
        (DVec3::NAN, 1.0),
        (DVec3::INFINITY, f64::INFINITY),
        (middle, f64::NAN),
        (middle, -1.0),
        (middle * 1e300, 1.0),
    ] {
        assert_eq!(world.surface_around(eye, reach, kind), surface, "{eye} {reach}");
    }
    assert_eq!(world.surface_around(middle, f64::INFINITY, kind), world.all(kind));
    assert_eq!(world.surface_around(middle, 1e300, kind), world.all(kind));
}

/// More columns than are worked on together, and a second axis that is longer than the first.
#[test]
fn large_worlds_are_in_order() {
    let (dims, shares) = ([3, 400, 70], [100, 20]);
    let plain = Plain::new(dims, 5, shares);
    assert_eq!(world(dims, 5, shares).surface(kind), plain.blocks(|_| true));
}
