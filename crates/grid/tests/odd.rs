//! Records that misbehave, and data at the ends of what numbers can hold: nothing hangs, nothing
//! panics by itself, and records are only moved.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::Vec3;
use proptest::prelude::*;
use puncta_core::{Record, Scene, Sphere};
use puncta_grid::{Error, Fit, Grid, GridConfig, Order, Resolution};
use std::{
    cell::Cell,
    panic::{AssertUnwindSafe, catch_unwind},
};

thread_local! {
    /// How often this thread asked for a position.
    static CALLS: Cell<u32> = const { Cell::new(0) };
    /// How often it asked the first record.
    static FIRST: Cell<u32> = const { Cell::new(0) };
}

/// What is wrong with a record.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Whim {
    /// Never twice at the same place.
    Moves,
    /// Seldom, nowhere.
    Vanishes,
    /// Often, infinitely far.
    Flees,
    /// Far away in every second look at all records.
    Returns,
    /// Some time, it panics.
    Panics,
}

/// A record that lies somewhere else when it is asked again.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fickle {
    mark: u32,
    whim: Whim,
}

/// More than are sorted without stripes.
const COUNT: u32 = 50_000;

impl Record for Fickle {
    fn position(&self) -> Vec3 {
        let calls = CALLS.get() + 1;
        CALLS.set(calls);
        let home = Vec3::splat(self.mark as f32 * 1e-6);
        let random = (calls ^ self.mark).wrapping_mul(2_654_435_769) as f32 / u32::MAX as f32;
        match self.whim {
            Whim::Moves => Vec3::new(1.0, 7.0, 91.0).map(|factor| (random * factor).fract()),
            Whim::Vanishes if calls.is_multiple_of(1000) => Vec3::NAN,
            Whim::Flees if calls.is_multiple_of(3) => Vec3::NEG_INFINITY,
            Whim::Returns if self.mark == 0 => {
                // The sample asks once, and each look twice.
                FIRST.set(FIRST.get() + 1);
                home + (FIRST.get() / 2 % 2) as f32 * 1e6
            }
            Whim::Panics if calls == 5 * COUNT => panic!("a record panics, as it is meant to"),
            _ => home,
        }
    }

    fn radius(&self) -> f32 {
        0.5
    }
}

fn configs() -> impl Iterator<Item = GridConfig> {
    let resolutions = [Resolution::RecordsPerBrick(4), Resolution::LongestSide(1000)];
    let fits = [(Fit::Robust, Order::Any), (Fit::Whole, Order::Stable)];
    let with = |resolution, (fit, order)| GridConfig { resolution, fit, order };
    resolutions.into_iter().flat_map(move |resolution| fits.map(|fit| with(resolution, fit)))
}

#[test]
fn fickle_records_are_only_moved() {
    use Whim::{Flees, Moves, Panics, Returns, Vanishes};
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for whim in [Moves, Vanishes, Flees, Returns, Panics] {
        for config in configs() {
            let records: Vec<Fickle> = (0..COUNT).map(|mark| Fickle { mark, whim }).collect();
            let mut scene = Scene::new(records);
            pool.install(|| {
                CALLS.set(0);
                FIRST.set(0);
            });
            let sorted = catch_unwind(AssertUnwindSafe(|| {
                pool.install(|| Grid::sort_scene(&mut scene, &config))
            }));
            assert!(sorted.is_ok() || whim == Panics, "{whim:?}, {config:?}");
            let mut marks: Vec<u32> = scene.records.iter().map(|record| record.mark).collect();
            assert!(marks.iter().all(|&mark| mark < COUNT));
            if whim != Panics {
                marks.sort_unstable();
                assert!(marks.into_iter().eq(0..COUNT), "{whim:?}, {config:?}");
            }
        }
    }
}

/// Coordinates of which most are at an edge of something.
fn edge() -> impl Strategy<Value = f32> {
    let huge = [f32::MAX, f32::MIN, -3e38, 3e38, 2.9e38];
    let tiny = [0.0, -0.0, f32::from_bits(1), -f32::MIN_POSITIVE];
    prop_oneof![
        3 => any::<f32>().prop_filter("not finite", |x| x.is_finite()),
        2 => prop::sample::select(huge.to_vec()),
        2 => prop::sample::select(tiny.to_vec()),
        1 => -1.0_f32..1.0,
    ]
}

fn resolution() -> impl Strategy<Value = Resolution> {
    let cells = prop::sample::select(vec![1, 2, 7, 1000, u32::MAX]);
    let records = prop::sample::select(vec![0, 1, 5, u32::MAX]);
    let width = prop_oneof![Just(f32::MIN_POSITIVE), Just(f32::MAX), 1e-37_f32..1e38];
    prop_oneof![
        cells.prop_map(Resolution::LongestSide),
        records.prop_map(Resolution::RecordsPerBrick),
        width.prop_map(Resolution::Width),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn cells_hold_their_records_at_all_edges(
        points in prop::collection::vec([edge(), edge(), edge()], 1..40),
        // The first two are strays if the others are many.
        repeat in prop::sample::select(vec![1_usize, 30, 300]),
        resolution in resolution(),
        fit in prop_oneof![Just(Fit::Robust), Just(Fit::Whole)],
    ) {
        let times = |index: usize| if index < 2 { 1 } else { repeat };
        let mut spheres: Vec<Sphere> = (0..).zip(&points)
            .flat_map(|(index, &point)| std::iter::repeat_n(Sphere::new(point, 0.5), times(index)))
            .collect();
        let count = spheres.len();
        let grid = match Grid::sort(&mut spheres, &GridConfig { resolution, fit, order: Order::Any }) {
            Err(Error::Resolution { .. }) if !matches!(resolution, Resolution::RecordsPerBrick(_)) => {
                return Ok(());
            }
            grid => grid.unwrap(),
        };
        prop_assert!(grid.cells().corner().is_finite(), "{}", grid.cells().corner());
        prop_assert!(grid.cells().scale() > 0.0 && grid.cells().scale().is_finite());
        prop_assert_eq!(grid.bricks().iter().map(|brick| brick.records.len()).sum::<usize>(), count);
        for (index, brick) in (0_u32..).zip(grid.bricks()) {
            let place = grid.cell_of(index).unwrap();
            let cell = grid.cells().bounds(place);
            for sphere in &spheres[brick.records.start as usize..brick.records.end as usize] {
                prop_assert_eq!(grid.cells().place(sphere.position()), place);
                prop_assert!(cell.contains(sphere.position()));
                prop_assert!(sphere.position().cmplt(cell.max).all());
                prop_assert!(brick.bounds.contains(sphere.position()));
            }
        }
    }
}

#[test]
fn the_sign_of_zero_does_not_hang_on_threads() {
    let zero = |is_negative: bool| if is_negative { -0.0 } else { 0.0 };
    let record = |i: u32| [zero(i >= 100_000), zero(i < 100_000), zero(i.is_multiple_of(7))];
    let records: Vec<Sphere> = (0..200_000).map(|i| Sphere::new(record(i), 0.5)).collect();
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let config = GridConfig { fit: Fit::Whole, ..GridConfig::default() };
        let grid = pool.install(|| Grid::sort(&mut records.clone(), &config)).unwrap();
        assert!(grid.cells().corner().is_negative_bitmask() == 0, "{}", grid.cells().corner());
    }
}
