//! Records of all glyphs, for the scenes that renderers are tested with.

use super::scenes::Sample;
use puncta::{
    Glyphs, Grid, GridConfig, Scene,
    avc::{Arc, Arrow, Disc, Prism},
};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

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
