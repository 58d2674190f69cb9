//! The scenes of the promise of exactness, of any glyphs.

use glam::DVec3;
use puncta::{Bricks, Cuboid, Glyph, Glyphs, Grid, GridConfig, Scene, View};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Glyphs that scenes can be made of.
pub(crate) trait Sample: Glyph + PartialEq + std::fmt::Debug {
    /// What holds bricks of them.
    type Held: Bricks + Clone;

    /// A record of about this size.
    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self;

    /// Records that make one closed solid of about this size.
    fn solid(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Vec<Self> {
        vec![Self::sample(random, center, size)]
    }

    /// What all of them share.
    fn glyphs() -> Glyphs<Self>;

    /// Cuts a scene into bricks, finer with a larger number.
    fn hold(scene: &mut Scene<Self>, cells: u32) -> Self::Held;
}

impl Sample for Cuboid {
    type Held = Grid;

    fn sample(random: &mut Pcg64Mcg, center: [f32; 3], size: f32) -> Self {
        let mut side = || size * 10_f32.powf(-1.5 * random.random::<f32>());
        Self::new(center, [side(), side(), side()])
    }

    fn glyphs() -> Glyphs<Self> {
        Glyphs::new([])
    }

    fn hold(scene: &mut Scene<Self>, cells: u32) -> Grid {
        Grid::sort_scene(scene, &GridConfig::longest_side(cells)).unwrap()
    }
}

/// Uniform in a cube, with sizes that are uniform in their logarithm.
pub(crate) fn cloud<G: Sample>(
    random: &mut Pcg64Mcg,
    count: usize,
    half: f32,
    sizes: [f32; 2],
) -> Vec<G> {
    let mut record = || {
        let center = [0; 3].map(|_| half * (random.random::<f32>() * 2.0 - 1.0));
        let size = sizes[0] * (sizes[1] / sizes[0]).powf(random.random::<f32>());
        G::sample(random, center, size)
    };
    (0..count).map(|_| record()).collect()
}

/// A view from a random place at this distance, with a random roll.
pub(crate) fn view(random: &mut Pcg64Mcg, distance: f64, target: DVec3) -> View {
    let mut axis = || DVec3::from([0; 3].map(|_| random.random::<f64>() - 0.5)).normalize();
    let eye = target + axis() * distance;
    View::look_at(eye, target, axis()).unwrap().with_size(160, 120).unwrap()
}

/// The scenes of the promise: their names, records and views.
pub(crate) fn scenes<G: Sample>() -> Vec<(String, Scene<G>, View)> {
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let mut scenes = Vec::new();
    let mut add = |name: String, scene, view| scenes.push((name, scene, view));
    let origin = DVec3::ZERO;
    for round in 0..3 {
        let scene = Scene::new(cloud(&mut random, 800, 1.0, [3e-4, 0.8]));
        let outside = view(&mut random, 3.0, origin);
        add(format!("three decades of sizes {round}"), scene, outside);

        let scene = Scene::new(cloud(&mut random, 800, 1.0, [0.01, 0.3]));
        let height = 0.2 + random.random::<f64>() * 2.0;
        let parallel = view(&mut random, 3.0, origin).with_orthographic(height).unwrap();
        add(format!("orthographic {round}"), scene, parallel);

        let scene = Scene::new(cloud(&mut random, 800, 1.0, [1e-3, 0.4]));
        add(format!("camera inside the cloud {round}"), scene, view(&mut random, 0.6, origin));

        let mut records = cloud(&mut random, 400, 1.0, [0.05, 0.5]);
        records.push(G::sample(&mut random, [0.0; 3], 300.0));
        add(
            format!("camera inside a glyph {round}"),
            Scene::new(records),
            view(&mut random, 0.5, origin),
        );

        let scene = Scene::new(cloud(&mut random, 800, 1.0, [0.03, 0.8]));
        let cut = view(&mut random, 1.0, origin).with_near(0.3).unwrap();
        let cut = if round % 2 == 0 { cut } else { cut.with_orthographic(1.5).unwrap() };
        add(format!("near plane cuts glyphs {round}"), scene, cut);
    }
    let scene = Scene::new(cloud(&mut random, 800, 1.0, [1e-6, 1e6]));
    add("sizes of 1e-6 to 1e6".into(), scene, view(&mut random, 3.0, origin));

    let scene = Scene::new(cloud(&mut random, 800, 1.0, [0.01, 0.3]));
    let narrow = view(&mut random, 1e6, origin).with_perspective(2e-6).unwrap();
    add("from 1e6 units".into(), scene, narrow);

    let scene = Scene::new(cloud(&mut random, 800, 1.0, [0.01, 0.3]));
    let wide = view(&mut random, 0.9, origin);
    add("95 degrees".into(), scene, wide.with_perspective(95_f64.to_radians()).unwrap());

    let mut scene = Scene::new(cloud(&mut random, 800, 1.0, [0.01, 0.3]));
    scene.origin = DVec3::new(1e7, -1e7, 1e7);
    let far = view(&mut random, 3.0, scene.origin);
    add("moved by 1e7".into(), scene, far);

    // Sides are seen edge-on, and edges run through the centres of pixels.
    let straight = View::look_at(DVec3::new(0.0, 0.0, 3.0), origin, DVec3::Y).unwrap();
    let straight = straight.with_size(161, 121).unwrap();
    let scene = || Scene::new(stacks(&mut Pcg64Mcg::seed_from_u64(3)));
    add("stacks from the front".into(), scene(), straight.clone());
    add("stacks, orthographic".into(), scene(), straight.with_orthographic(121.0 / 64.0).unwrap());
    scenes
}

/// Glyphs side by side, many of which touch.
fn stacks<G: Sample>(random: &mut Pcg64Mcg) -> Vec<G> {
    let place = |i: u32| {
        [0, 3, 6].map(|shift| f32::from(u8::try_from(i >> shift & 7).unwrap()) * 0.25 - 0.875)
    };
    (0..512).filter(|i| i % 3 != 0).map(|i| G::sample(random, place(i), 0.25)).collect()
}
