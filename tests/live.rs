//! Drawing in the background: whatever views come and when, the last one is drawn completely, and
//! its picture is the one that is drawn in the foreground.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use proptest::prelude::*;
use puncta::{
    Budget, CpuRenderer, Density, Depth, FrustumCull, Grid, GridConfig, Live, Picture, Pipeline,
    Progress, Scene, Sphere, Stage, View,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::{
    collections::BTreeSet,
    sync::{
        Arc,
        mpsc::{Receiver, channel},
    },
    time::Duration,
};

type Order = Box<dyn Stage<Grid> + Send>;

/// Spheres in a cube.
fn cube(seed: u64, count: usize) -> (Arc<Scene>, Arc<Grid>) {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut sphere = || {
        let mut axis = || random.random::<f32>() * 2.0 - 1.0;
        Sphere::new([axis(), axis(), axis()], 0.06)
    };
    let mut scene = Scene::new((0..count).map(|_| sphere()).collect::<Vec<_>>());
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(8)).unwrap();
    (Arc::new(scene), Arc::new(grid))
}

/// From somewhere around the cube.
fn view(yaw: f64, pitch: f64) -> View {
    let view = View::look_at(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y).unwrap();
    view.with_size(64, 48).unwrap().orbited(DVec3::ZERO, yaw, pitch)
}

fn render(scene: &Scene, grid: &Grid, view: &View) -> Picture {
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    pipeline.render(scene, grid, view).unwrap()
}

fn bits(picture: &Picture) -> Vec<(u32, u32)> {
    picture.depth.iter().map(|depth| depth.to_bits()).zip(picture.id.iter().copied()).collect()
}

/// What a step told.
struct Told {
    view: View,
    progress: Progress,
    is_first: bool,
    picture: Picture,
}

/// Draws in the background; each step is told.
fn spawn(
    content: &(Arc<Scene>, Arc<Grid>),
    order: Order,
    budget: Budget,
    mut after: impl FnMut() + Send + 'static,
) -> (Live<Sphere, Grid>, Receiver<Told>) {
    let (scene, grid) = content.clone();
    let (tell, told) = channel();
    let pipeline = Pipeline::new((FrustumCull, order), CpuRenderer::default());
    let live = Live::spawn(scene, grid, pipeline, budget, move |step| {
        let (view, is_first) = (step.view.clone(), step.latency.is_some());
        let progress = *step.progress.as_ref().unwrap();
        let picture = step.picture().unwrap();
        tell.send(Told { view, progress, is_first, picture }).ok();
        after();
    });
    (live.unwrap(), told)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Views and scenes come at any time, some after a rest.
    #[test]
    fn the_last_picture_is_complete(
        seed in any::<u64>(),
        counts in [0_usize..3000, 0_usize..3000],
        asked in prop::collection::vec(
            (-3.0_f64..3.0, -1.5_f64..1.5, 0_u8..8, any::<bool>()),
            1..40,
        ),
        budget in prop_oneof![
            (1_u64..2000).prop_map(Budget::Records),
            (0_u64..300).prop_map(|micros| Budget::Time(Duration::from_micros(micros))),
        ],
        by_density in any::<bool>(),
    ) {
        let contents = counts.map(|count| cube(seed, count));
        let order: Order =
            if by_density { Box::new(Density::default()) } else { Box::new(Depth::default()) };
        let (live, told) = spawn(&contents[0], order, budget, || ());
        let (mut at, mut sent) = (0, Vec::new());
        for (yaw, pitch, kind, has_rest) in asked {
            sent.push(view(yaw, pitch));
            let view = view(yaw, pitch);
            if kind == 0 {
                at = 1 - at;
                let (scene, grid) = contents[at].clone();
                live.show_from(scene, grid, view).unwrap();
            } else {
                live.look(view).unwrap();
            }
            if has_rest {
                live.wait_idle().unwrap();
            }
        }
        live.wait_idle().unwrap();
        drop(live);
        let told: Vec<Told> = told.iter().collect();
        let last = told.last().unwrap();
        prop_assert!(last.progress.settled());
        prop_assert_eq!(Some(&last.view), sent.last());
        let (scene, grid) = &contents[at];
        prop_assert_eq!(bits(&last.picture), bits(&render(scene, grid, &last.view)));
        // Pictures are begun in the order in which they were asked for, and each at most once.
        let mut sent = sent.iter();
        for first in told.iter().filter(|step| step.is_first) {
            prop_assert!(sent.any(|view| *view == first.view));
        }
    }
}

#[test]
fn of_a_burst_of_views_the_last_one_is_drawn() {
    let content = cube(1, 20_000);
    let (go, may_go) = channel::<()>();
    let after = move || may_go.recv().unwrap_or_default();
    let (live, told) = spawn(&content, Box::new(Depth::default()), 500.into(), after);
    let go = go; // It is dropped before the thread is waited for, also if this fails.
    live.look(view(0.0, 0.0)).unwrap();
    // The first step is told; all else comes before the second.
    let first = told.recv().unwrap();
    assert!(!first.progress.settled());
    let views: Vec<View> = (1..=1000).map(|i| view(f64::from(i) * 0.01, 0.3)).collect();
    views.iter().for_each(|view| live.look(view.clone()).unwrap());
    drop(go);
    live.wait_idle().unwrap();
    let told: Vec<Told> = told.try_iter().collect();
    assert!(told.len() > 2 && told.iter().all(|step| Some(&step.view) == views.last()));
    assert!(told[0].is_first && told[1..].iter().all(|step| !step.is_first));
    let last = told.last().unwrap();
    assert!(last.progress.settled());
    assert_eq!(bits(&last.picture), bits(&render(&content.0, &content.1, &last.view)));
}

/// Views that come faster than steps interrupt every picture. What was not seen from the first view
/// is seen all the same while the camera turns, not only when it rests.
#[test]
fn a_camera_that_never_rests_is_shown_what_is_new() {
    let content = cube(2, 20_000);
    let (go, may_go) = channel::<()>();
    let after = move || may_go.recv().unwrap_or_default();
    let (live, told) = spawn(&content, Box::new(Depth::default()), 500.into(), after);
    let go = go; // It is dropped before the thread is waited for, also if this fails.
    let first = view(0.0, 0.0);
    live.look(first.clone()).unwrap();
    let mut pictures = Vec::new();
    for i in 1..=200 {
        let step = told.recv().unwrap();
        live.look(view(f64::from(i) * 0.01, 0.0)).unwrap();
        go.send(()).unwrap();
        assert!(!step.progress.settled(), "it is overtaken each time");
        pictures.push(step);
    }
    let begun = pictures.iter().filter(|step| step.is_first).count();
    assert!((pictures.len() / 2..pictures.len()).contains(&begun), "{begun}");
    let known: BTreeSet<u32> =
        render(&content.0, &content.1, &first).visible_records().into_iter().collect();
    let seen = pictures.last().unwrap().picture.visible_records();
    let new = seen.iter().filter(|id| !known.contains(id)).count();
    assert!(new * 2 > seen.len(), "{new} of {}", seen.len());
    drop(go);
}
