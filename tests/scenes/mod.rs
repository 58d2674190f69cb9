//! The scenes of the promise of exactness, and views that are odd: what every renderer is tested with.

use glam::DVec3;
use proptest::prelude::*;
use puncta::{Scene, Sphere, View};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Uniform in a cube, with radii that are uniform in their logarithm.
pub(crate) fn cloud(
    random: &mut Pcg64Mcg,
    count: usize,
    half: f32,
    radii: [f32; 2],
) -> Vec<Sphere> {
    let mut sphere = || {
        let center = [0; 3].map(|_| half * (random.random::<f32>() * 2.0 - 1.0));
        let share = random.random::<f32>();
        Sphere { center, radius: radii[0] * (radii[1] / radii[0]).powf(share) }
    };
    (0..count).map(|_| sphere()).collect()
}

/// A view from a random place at this distance, with a random roll.
fn view(random: &mut Pcg64Mcg, distance: f64, target: DVec3) -> View {
    let mut axis = || DVec3::from([0; 3].map(|_| random.random::<f64>() - 0.5)).normalize();
    let eye = target + axis() * distance;
    View::look_at(eye, target, axis()).unwrap().with_size(160, 120).unwrap()
}

/// The scenes of the promise: their names, records and views.
pub(crate) fn scenes() -> Vec<(String, Scene, View)> {
    let mut random = Pcg64Mcg::seed_from_u64(20);
    let mut scenes = Vec::new();
    let mut add = |name: String, scene, view| scenes.push((name, scene, view));
    let fine = [1e-3, 0.05];
    let four_decades = [3e-5, 0.3];
    for round in 0..4 {
        let scene = Scene::new(cloud(&mut random, 1500, 1.0, four_decades));
        let outside = view(&mut random, 3.0, DVec3::ZERO);
        add(format!("four decades of radii {round}"), scene, outside);

        let scene = Scene::new(cloud(&mut random, 1500, 1.0, fine));
        let height = 0.2 + random.random::<f64>() * 2.0;
        let parallel = view(&mut random, 3.0, DVec3::ZERO).with_orthographic(height).unwrap();
        add(format!("orthographic {round}"), scene, parallel);

        let scene = Scene::new(cloud(&mut random, 1500, 1.0, four_decades));
        let inside = view(&mut random, 0.6, DVec3::ZERO);
        add(format!("camera inside the cloud {round}"), scene, inside);

        let scene = Scene::new(cloud(&mut random, 1500, 1.0, [0.01, 0.3]));
        let cut = view(&mut random, 1.0, DVec3::ZERO).with_near(0.3).unwrap();
        let cut = if round % 2 == 0 { cut } else { cut.with_orthographic(1.5).unwrap() };
        add(format!("near plane cuts spheres {round}"), scene, cut);
    }
    let scene = Scene::new(cloud(&mut random, 1500, 1.0, fine));
    let narrow = view(&mut random, 1000.0, DVec3::ZERO);
    add(
        "0.1 degrees from 1000 units".into(),
        scene,
        narrow.with_perspective(0.1_f64.to_radians()).unwrap(),
    );

    let scene = Scene::new(cloud(&mut random, 1500, 1.0, fine));
    let wide = view(&mut random, 0.9, DVec3::ZERO);
    add("95 degrees".into(), scene, wide.with_perspective(95_f64.to_radians()).unwrap());

    let mut scene = Scene::new(cloud(&mut random, 1500, 1.0, fine));
    scene.origin = DVec3::new(1e7, -1e7, 1e7);
    let far = view(&mut random, 3.0, scene.origin);
    add("moved by 1e7".into(), scene, far);

    // Large discs at a middling distance: where f32 has the least to spare.
    let scene = Scene::new(cloud(&mut random, 60, 1.0, [0.05, 0.2]));
    let large = view(&mut random, 6.0, DVec3::ZERO);
    add("large discs".into(), scene, large.with_perspective(20_f64.to_radians()).unwrap());
    scenes
}

/// A camera at any distance from a sphere of any size, at any angle, in pictures of any shape.
pub(crate) fn odd_view() -> impl Strategy<Value = View> {
    let sizes = prop_oneof![Just((1, 1)), Just((40, 1)), Just((1, 40)), Just((24, 18))];
    let place = [-2.0_f64..2.0, -2.0..2.0, -2.0..2.0].prop_map(DVec3::from);
    let look = (place.clone(), place, -2.0_f64..2.254, any::<bool>());
    (sizes, look, -7.0_f64..1.0).prop_filter_map(
        "a degenerate view",
        |((width, height), (eye, target, angle, is_perspective), near)| {
            let view = View::look_at(eye, target, DVec3::Z).ok()?.with_size(width, height).ok()?;
            let view = view.with_near(10_f64.powf(near)).ok()?;
            if is_perspective {
                view.with_perspective(10_f64.powf(angle).to_radians()).ok()
            } else {
                view.with_orthographic(10_f64.powf(angle - 1.0)).ok()
            }
        },
    )
}
