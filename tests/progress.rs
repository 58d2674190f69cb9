//! Promise 2: a picture that says it is settled is the complete one, and what is not open does not
//! change; a new view takes over at once, and starts with what was seen before.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use proptest::prelude::*;
use puncta::{
    Amount, Brick, Budget, Content, CpuRenderer, Depth, Frame, FrustumCull, Grid, GridConfig,
    NO_RECORD, Picture, Pipeline, Progress, Record, Renderer, Scene, Sphere, View, Visible,
    core::{Aabb, VisibleBrick},
};
use std::time::Duration;
use steps::{Any, Opens, bits, check_steps, front, moved, orders, scene, view, wall};

mod steps;

impl Opens for CpuRenderer {
    fn open(&mut self, view: &View) -> Vec<bool> {
        let rows = 0..view.height();
        rows.flat_map(|row| (0..view.width()).map(move |column| (column, row)))
            .map(|(column, row)| self.is_open(column, row))
            .collect()
    }
}

/// The picture of all records: those of one brick, which is drawn wholly or not at all.
fn complete(scene: &Scene, view: &View) -> Picture {
    let mut brick = Brick {
        records: 0..u32::try_from(scene.records.len()).unwrap(),
        bounds: Aabb::EMPTY,
        radius_max: 0.0,
        density: 0.0,
    };
    for record in scene.records.iter() {
        brick.bounds.add(record.position());
        brick.radius_max = brick.radius_max.max(record.radius());
    }
    let mut pipeline = Pipeline::new((), CpuRenderer::default());
    pipeline.render(scene, &vec![brick], view).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 200, ..ProptestConfig::with_cases(400) })]

    /// At every step no pixel outside of the open set changes later, and in the end the picture is
    /// the complete one, bit by bit.
    #[test]
    fn what_is_not_open_does_not_change(
        seed in any::<u64>(),
        cells in 1_u32..14,
        view in view(),
        order in orders(),
        budget in prop_oneof![Just(1_u64), 2_u64..600],
        before in view(),
        has_cache in any::<bool>(),
    ) {
        let mut scene = scene(seed);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(cells)).unwrap();
        let view = moved(&view, scene.origin);
        let expected = bits(&complete(&scene, &view));
        let mut pipeline = Pipeline::new((FrustumCull, order.stage()), CpuRenderer::default());
        if has_cache {
            pipeline.render(&scene, &grid, &moved(&before, scene.origin)).unwrap();
        }
        check_steps(&mut pipeline, (&scene, &grid), (&view, budget), &expected)?;
    }

    /// The first step draws what was seen before, each record once, and nothing else.
    #[test]
    fn what_was_seen_is_drawn_first(
        seed in any::<u64>(),
        cells in 1_u32..14,
        before in view(),
        view in view(),
    ) {
        let mut scene = scene(seed);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(cells)).unwrap();
        let [before, view] = [before, view].map(|view| moved(&view, scene.origin));
        let mut pipeline = Pipeline::new((), CpuRenderer::default());
        let seen = pipeline.render(&scene, &grid, &before).unwrap().visible_records();
        let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
        let first = steps.next();
        if seen.is_empty() {
            prop_assert!(first.is_none_or(|first| first.unwrap().recalled == 0));
            return Ok(());
        }
        let first = first.unwrap().unwrap();
        prop_assert_eq!(first.recalled, seen.len() as u64);
        prop_assert_eq!(first.drawn, Amount::default());
        let only = seen.iter().map(|&id| scene.records[id as usize]).collect::<Vec<_>>();
        let mut expected = complete(&Scene { origin: scene.origin, ..Scene::new(only) }, &view);
        let renamed = expected.id.iter_mut().filter(|id| **id != NO_RECORD);
        renamed.for_each(|id| *id = seen[*id as usize]);
        let picture = steps.picture().unwrap();
        for (at, (now, expected)) in bits(&picture).into_iter().zip(bits(&expected)).enumerate() {
            // Among the seen, ids of equal depth may be in another order than their original ids.
            let is_tie = now.0 == expected.0
                && now.1 != NO_RECORD
                && scene.records[now.1 as usize] == scene.records[expected.1 as usize];
            prop_assert!(now == expected || is_tie, "pixel {}", at);
        }
    }
}

#[test]
fn a_wall_costs_what_is_seen_of_it() {
    let (scene, grid) = wall();
    let view = front(&scene);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let mut steps = pipeline.progressive(&scene, &grid, &view, 1000).unwrap();
    let last = steps.by_ref().last().unwrap().unwrap();
    assert!(last.settled());
    let all = scene.records.len() as u64;
    assert!(last.drawn.records < all / 2, "{} of {all}", last.drawn.records);
    assert_eq!(last.drawn.records + last.skipped.records, all);
    assert_eq!(bits(&steps.picture().unwrap()), bits(&complete(&scene, &view)));
    // In one go as well.
    pipeline.forget::<Sphere>();
    let mut steps = pipeline.progressive(&scene, &grid, &view, u64::MAX).unwrap();
    let once = steps.next().unwrap().unwrap();
    assert!(once.settled() && once.drawn.records < all / 2);
}

#[test]
fn progress_does_not_depend_on_the_number_of_threads() {
    let (scene, grid) = wall();
    let view = front(&scene);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut pipeline = Pipeline::new((FrustumCull, Any::MostOpen), CpuRenderer::default());
            pipeline.render(&scene, &grid, &front(&scene).orbited(DVec3::ZERO, 0.1, 0.0)).unwrap();
            let mut steps = pipeline.progressive(&scene, &grid, &view, 700).unwrap();
            steps.by_ref().map(Result::unwrap).collect::<Vec<Progress>>()
        })
    };
    let one = run(1);
    assert!(one.len() > 3);
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
}

/// What a renderer was asked to do.
#[derive(Debug, PartialEq)]
enum Call {
    Begin(DVec3),
    Recall,
    Draw(usize),
}

/// Notes what it is asked to do.
#[derive(Default)]
struct Notes(Vec<Call>);

impl<R: Record> Renderer<R> for Notes {
    type Error = puncta::core::Error;

    fn begin(&mut self, view: &View) -> Result<(), Self::Error> {
        self.0.push(Call::Begin(view.eye()));
        Ok(())
    }

    fn draw(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Self::Error> {
        self.0.push(Call::Draw(bricks.len()));
        Ok(Amount::of(content.bricks, bricks))
    }

    fn recall(&mut self, _: &Content<'_, R>, _: &[VisibleBrick]) -> Result<u64, Self::Error> {
        self.0.push(Call::Recall);
        Ok(0)
    }

    fn finish(&mut self, _: &Content<'_, R>) -> Result<Picture, Self::Error> {
        Picture::new(1, 1)
    }
}

/// A new view takes over between two steps, and nothing of the old one is drawn from then on.
#[test]
fn a_new_view_takes_over_within_one_budget() {
    let (scene, grid) = wall();
    let view = front(&scene);
    let per_brick = 8;
    let mut pipeline = Pipeline::new((), Notes::default());
    let mut steps = pipeline.progressive(&scene, &grid, &view, 10 * per_brick).unwrap();
    for _ in 0..3 {
        steps.next().unwrap().unwrap();
    }
    let next = view.clone().orbited(DVec3::ZERO, 0.1, 0.0);
    steps.look(&next).unwrap();
    assert_eq!(steps.view(), &next);
    assert_eq!(steps.progress().left.bricks, grid.bricks().len() as u64);
    steps.next().unwrap().unwrap();
    // Views that come faster than steps cost no drawing at all.
    let last = next.clone().orbited(DVec3::ZERO, 0.1, 0.0);
    steps.look(&next).unwrap();
    steps.look(&last).unwrap();
    assert_eq!(steps.by_ref().count(), grid.bricks().len().div_ceil(10));
    let notes = &pipeline.renderer().0;
    let (a, b, c) = (view.eye(), next.eye(), last.eye());
    let start = [Call::Begin(a), Call::Recall, Call::Draw(10), Call::Draw(10), Call::Draw(10)];
    assert_eq!(notes[..5], start);
    assert_eq!(notes[5..8], [Call::Begin(b), Call::Recall, Call::Draw(10)]);
    assert_eq!(notes[8..11], [Call::Begin(b), Call::Begin(c), Call::Recall]);
    let rest = &notes[11..];
    assert!(rest.iter().all(|call| matches!(call, Call::Draw(_))));
    let drawn = |call: &Call| if let Call::Draw(bricks) = call { *bricks } else { 0 };
    assert_eq!(rest.iter().map(drawn).sum::<usize>(), grid.bricks().len());
}

/// Views that come faster than anything is drawn do not make the renderer forget.
#[test]
fn the_cache_outlives_pictures_of_nothing() {
    let (scene, grid) = wall();
    let view = front(&scene);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let seen = pipeline.render(&scene, &grid, &view).unwrap().visible_records();
    let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
    for turn in [0.01, 0.02, 0.0] {
        steps.look(&view.clone().orbited(DVec3::ZERO, turn, 0.0)).unwrap();
    }
    let first = steps.next().unwrap().unwrap();
    assert_eq!(first.recalled, seen.len() as u64);
    assert_eq!(bits(&steps.picture().unwrap()), bits(&complete(&scene, &view)));
    pipeline.forget::<Sphere>();
    let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
    assert_eq!(steps.next().unwrap().unwrap().recalled, 0);
}

/// What a stage drops is not drawn from the cache either.
#[test]
fn the_cache_holds_nothing_that_a_stage_drops() {
    let (scene, grid) = wall();
    let view = front(&scene);
    let is_lower = std::cell::Cell::new(false);
    let floor = |frame: &Frame<'_, Grid>, visible: &mut Visible| {
        let bricks = frame.bricks.bricks();
        let keeps = |brick: &VisibleBrick| bricks[brick.index() as usize].bounds.max.y < 12.0;
        visible.bricks.retain(|brick| !is_lower.get() || keeps(brick));
    };
    let mut pipeline =
        Pipeline::new((FrustumCull, Depth::default(), floor), CpuRenderer::default());
    pipeline.render(&scene, &grid, &view).unwrap();
    is_lower.set(true);
    let picture = pipeline.render(&scene, &grid, &view).unwrap();
    let seen = picture.visible_records();
    assert!(!seen.is_empty());
    assert!(seen.iter().all(|&id| scene.records[id as usize].center[1] < 12.0));
}

#[test]
fn a_budget_of_time_ends_too() {
    let (scene, grid) = wall();
    let view = front(&scene);
    for time in [Duration::ZERO, Duration::from_micros(300), Duration::from_secs(1000)] {
        let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
        let mut steps = pipeline.progressive(&scene, &grid, &view, Budget::Time(time)).unwrap();
        assert!(steps.by_ref().last().unwrap().unwrap().settled());
        assert_eq!(bits(&steps.picture().unwrap()), bits(&complete(&scene, &view)));
    }
}
