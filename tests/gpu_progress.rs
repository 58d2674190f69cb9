//! Promise 2 on the GPU: what is not open does not change, what is settled is complete, and a picture
//! begins with what was seen in the one before.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, and shares parts with others"
)]

use gpu::{gpu, of_everything, open};
use proptest::{prelude::*, test_runner::TestRunner};
use puncta::{
    Amount, Budget, Depth, Frame, FrustumCull, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig,
    NO_RECORD, Pipeline, Sphere, View, Visible,
    gpu::{Extent, Setup},
};
use std::{cell::RefCell, time::Duration};
use steps::{Opens, Ordered, bits, check_steps, front, moved, orders, scene, view, wall};

mod gpu;
mod steps;

impl Opens for GpuRenderer {
    fn open(&mut self, _: &View) -> Vec<bool> {
        self.open_pixels().unwrap()
    }
}

fn runner(cases: u32) -> TestRunner {
    TestRunner::new(ProptestConfig {
        failure_persistence: None,
        max_shrink_iters: 50,
        ..ProptestConfig::with_cases(cases)
    })
}

fn renderer(gpu: &Gpu) -> GpuRenderer {
    GpuRenderer::new(gpu, GpuConfig::default()).unwrap()
}

/// In all orders and budgets, with and without the picture before.
fn steps_are_sound(gpu: &Gpu, cases: u32) {
    // Pipelines are built anew for each order; what was seen by others comes along in the renderer.
    let kept = RefCell::new(Some(renderer(gpu)));
    let budgets = prop_oneof![1 => Just(1_u64), 6 => 2_u64..600];
    let strategy = ((any::<u64>(), 1_u32..9, orders(), budgets), view(), view(), any::<bool>());
    let result = runner(cases).run(&strategy, |(what, view, before, has_cache)| {
        let (seed, cells, order, budget) = what;
        let mut scene = scene(seed);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(cells)).unwrap();
        let [view, before] = [view, before].map(|view| moved(&view, scene.origin));
        let expected = bits(&of_everything(gpu, &scene, grid.bricks(), &view));
        let used = kept.borrow_mut().take().unwrap_or_else(|| renderer(gpu));
        let mut pipeline: Ordered<_> = Pipeline::new((FrustumCull, order.stage()), used);
        if has_cache {
            pipeline.render(&scene, &grid, &before).unwrap();
        } else {
            pipeline.forget::<Sphere>();
        }
        check_steps(&mut pipeline, (&scene, &grid), (&view, budget), &expected)?;
        let inner = std::mem::replace(pipeline.renderer_mut(), renderer(gpu));
        *kept.borrow_mut() = Some(inner);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn what_is_not_open_does_not_change() {
    let Some(gpu) = gpu() else { return };
    steps_are_sound(gpu, 60);
}

#[test]
fn what_is_not_open_does_not_change_on_core_webgpu() {
    let Some(gpu) = open(Extent::Core) else { return };
    steps_are_sound(&gpu, 30);
}

/// The first step draws what was seen before, and nothing else.
#[test]
fn what_was_seen_is_drawn_first() {
    let Some(gpu) = gpu() else { return };
    let pipeline = RefCell::new(Pipeline::new((), renderer(gpu)));
    let whole = std::cell::Cell::new(0);
    let strategy = (any::<u64>(), 1_u32..9, view(), view());
    let result = runner(100).run(&strategy, |(seed, cells, before, view)| {
        let mut scene = scene(seed);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(cells)).unwrap();
        let [before, view] = [before, view].map(|view| moved(&view, scene.origin));
        let pipeline = &mut *pipeline.borrow_mut();
        pipeline.forget::<Sphere>();
        let seen = pipeline.render(&scene, &grid, &before).unwrap().visible_records();
        let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
        let Some(first) = steps.next().map(Result::unwrap) else { return Ok(()) };
        prop_assert!(first.recalled <= seen.len() as u64);
        if first.recalled == 0 {
            return Ok(());
        }
        prop_assert_eq!(first.drawn, Amount::default());
        let picture = steps.picture().unwrap();
        let shown = picture.visible_records();
        prop_assert!(shown.iter().all(|id| seen.binary_search(id).is_ok()));
        if first.recalled == seen.len() as u64 {
            whole.set(whole.get() + 1);
            // What is complete shows nothing else at the pixels where it shows what was seen.
            let complete = of_everything(gpu, &scene, grid.bricks(), &view);
            for (now, then) in picture.id.iter().zip(&complete.id) {
                let must = *then != NO_RECORD && seen.binary_search(then).is_ok();
                prop_assert!(!must || now == then);
            }
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    println!("all that was seen was drawn first in {} pictures", whole.get());
    assert!(whole.get() > 10);
}

#[test]
fn from_outside_all_that_was_seen_is_drawn_first() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = wall();
    let view = front(&scene);
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer(gpu));
    let seen = pipeline.render(&scene, &grid, &view).unwrap().visible_records();
    let expected = bits(&of_everything(gpu, &scene, grid.bricks(), &view));
    let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
    // Views of which nothing was drawn are no reason to forget.
    for turn in [0.01, 0.02, 0.0] {
        steps.look(&view.clone().orbited(scene.bounds().center(), turn, 0.0)).unwrap();
    }
    assert_eq!(steps.next().unwrap().unwrap().recalled, seen.len() as u64);
    steps.look(&view).unwrap();
    assert_eq!(steps.next().unwrap().unwrap().recalled, seen.len() as u64);
    assert!(bits(&steps.picture().unwrap()) == expected);
    pipeline.forget::<Sphere>();
    let mut steps = pipeline.progressive(&scene, &grid, &view, 100).unwrap();
    assert_eq!(steps.next().unwrap().unwrap().recalled, 0);
}

#[test]
fn a_wall_costs_what_is_seen_of_it() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = wall();
    let view = front(&scene);
    let expected = bits(&of_everything(gpu, &scene, grid.bricks(), &view));
    let all = scene.records.len() as u64;
    for setup in [Setup::Triangle, Setup::Compute] {
        let config = GpuConfig { setup: Some(setup), ..GpuConfig::default() };
        let renderer = GpuRenderer::new(gpu, config).unwrap();
        let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
        for budget in [1000, u64::MAX] {
            pipeline.forget::<Sphere>();
            let mut steps = pipeline.progressive(&scene, &grid, &view, budget).unwrap();
            let last = steps.by_ref().last().unwrap().unwrap();
            assert!(last.settled());
            println!("{setup}, budget {budget}: {} of {all} drawn", last.drawn.records);
            assert!(last.drawn.records < all / 2, "{} of {all}", last.drawn.records);
            assert_eq!(last.drawn.records + last.skipped.records, all);
            assert!(bits(&steps.picture().unwrap()) == expected);
        }
    }
}

/// What a stage drops is not drawn from the cache either.
#[test]
fn the_cache_holds_nothing_that_a_stage_drops() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = wall();
    let view = front(&scene);
    let is_lower = std::cell::Cell::new(false);
    let floor = |frame: &Frame<'_, Grid>, visible: &mut Visible| {
        let bricks = puncta::Bricks::bricks(frame.bricks);
        let keeps = |index: u32| bricks[index as usize].bounds.max.y < 12.0;
        visible.bricks.retain(|brick| !is_lower.get() || keeps(brick.index()));
    };
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default(), floor), renderer(gpu));
    pipeline.render(&scene, &grid, &view).unwrap();
    is_lower.set(true);
    let seen = pipeline.render(&scene, &grid, &view).unwrap().visible_records();
    assert!(!seen.is_empty());
    assert!(seen.iter().all(|&id| scene.records[id as usize].center[1] < 12.0));
}

#[test]
fn a_budget_of_time_ends_too() {
    let Some(gpu) = gpu() else { return };
    let (scene, grid) = wall();
    let view = front(&scene);
    let expected = bits(&of_everything(gpu, &scene, grid.bricks(), &view));
    for time in [Duration::ZERO, Duration::from_micros(300), Duration::from_secs(1000)] {
        let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer(gpu));
        let mut steps = pipeline.progressive(&scene, &grid, &view, Budget::Time(time)).unwrap();
        assert!(steps.by_ref().last().unwrap().unwrap().settled());
        assert!(bits(&steps.picture().unwrap()) == expected);
    }
}
