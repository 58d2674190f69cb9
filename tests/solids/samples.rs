//! Records of all glyphs, for the scenes that renderers are tested with.

use super::scenes::Sample;
use puncta::{
    Glyphs, Grid, GridConfig, Scene,
    avc::{Arc, Arrow, Disc, Node, NodeStyle, Polygon, PolygonSet, Prism, Runs},
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::sync::OnceLock;

fn sorted<G: puncta::Record>(scene: &mut Scene<G>, cells: u32) -> Grid {
    Grid::sort_scene(scene, &GridConfig::longest_side(cells)).unwrap()
}

/// A share of one, evenly spread over the decades of 0.03 to 1.
fn share(random: &mut Pcg64Mcg) -> f32 {
    10_f32.powf(-1.5 * random.random::<f32>())
}

fn direction(random: &mut Pcg64Mcg) -> [f32; 3] {
    let axes = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    match random.random_range(0..8_usize) {
        axis @ 0..4 => axes[axis],
        _ => [0; 3].map(|_| random.random::<f32>() - 0.5),
    }
}

impl Sample for Prism {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let prism = Self::new(center, size * share(random), size * share(random));
        let sides = [0, 3, 4, 5, 6, 12, 64][random.random_range(0..7)];
        prism.with_sides(sides).with_turn(random.random())
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([])
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        sorted(scene, cells)
    }
}

impl Sample for Disc {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        Self::new(center, direction(random), size)
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([])
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        sorted(scene, cells)
    }
}

impl Sample for Arrow {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let vector = direction(random).map(|part| part * size * share(random));
        let radius = size * 0.2 * share(random);
        if random.random() {
            Self::cone(center, vector, radius)
        } else {
            Self::new(center, vector, radius)
        }
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([])
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        sorted(scene, cells)
    }
}

impl Sample for Arc {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let inner = [0.0, 0.5, 0.95][random.random_range(0..3)] * size;
        let start = 2.0 * random.random::<f32>() - 1.0;
        let turns = [1.0, 1.5, 0.25, random.random(), random.random()][random.random_range(0..5)];
        Self {
            center,
            radii: [inner, size],
            turns: [start, start + turns],
            height: size * share(random),
        }
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([])
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        sorted(scene, cells)
    }
}

/// Polygons of many sizes: stars, some of which have a hole.
fn stars() -> &'static PolygonSet {
    static STARS: OnceLock<PolygonSet> = OnceLock::new();
    STARS.get_or_init(|| {
        let mut random = Pcg64Mcg::seed_from_u64(9);
        let mut set = PolygonSet::default();
        for step in 0..48_u8 {
            let size = 10_f64.powf(f64::from(step) / 8.0 - 4.0);
            let corners = random.random_range(3..14_usize);
            let ring = |random: &mut Pcg64Mcg, radius: f64, spread: f64| -> Vec<[f64; 2]> {
                let place = |corner: usize| {
                    let angle = (corner as f64 + 0.3 * random.random::<f64>()) / corners as f64;
                    let radius = radius * (1.0 - spread * random.random::<f64>());
                    let (sin, cos) = (angle * std::f64::consts::TAU).sin_cos();
                    [radius * cos, radius * sin]
                };
                (0..corners).map(place).collect()
            };
            let mut rings = vec![ring(&mut random, size, 0.6)];
            if step % 3 == 0 && corners > 5 {
                rings.push(ring(&mut random, size * 0.2, 0.3));
            }
            set.push(&rings, 0.0, (size * 0.7) as f32).unwrap();
        }
        assert!(set.failures.is_empty() && set.records.len() == 48);
        set
    })
}

impl Sample for Polygon {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let place = ((size.log10() + 4.0) * 8.0).clamp(0.0, 47.0) as usize;
        let record = stars().records[place];
        Self { position: center, height: record.height * share(random), ..record }
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([]).with_table(stars().table.clone())
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        sorted(scene, cells)
    }
}

/// Pieces between places that have nothing to do with each other: thin ones, and joints of all angles.
impl Sample for Node {
    type Held = Runs;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let motion = [size, random.random::<f32>()];
        // Short enough that few of them hold the eye, which takes very many triangles.
        let center = center.map(|x| x * 0.3);
        Self::new(center, random.random_range(0..4), random.random(), motion)
    }

    /// A trajectory that stays at one of its places for a node.
    fn solid(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Vec<Self> {
        let trajectory = random.random_range(0..4);
        // No smaller than its tubes are thick, for the eye is outside.
        let size = size.max(0.2);
        let mut node = |number: u16| {
            let center = center.map(|x| x + size * (random.random::<f32>() - 0.5));
            let motion = [random.random::<f32>(), random.random()];
            Self::new(center, trajectory, f32::from(number), motion)
        };
        let mut nodes: Vec<Self> = (0..4).map(&mut node).collect();
        nodes.insert(2, nodes[2]);
        nodes
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new(NodeStyle {
            radii: [0.002, 0.05],
            speeds: [0.01, 0.5],
            width: 3.0,
            ball: 0.04,
            kind: NodeStyle::LINE,
            near: 1.5,
            acceleration: 0.7,
            special: NodeStyle::BALL,
            selected: 2,
            selection: NodeStyle::TUBE,
        })
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Runs {
        let glyphs = Self::glyphs();
        Runs::with_length(&glyphs.cloud(&scene.records), 4 + 64 / cells as usize)
    }
}
