//! The grid against what it promises: same records, right boxes, right statistics.

use glam::Vec3;
use proptest::prelude::*;
use puncta_core::{Block, Bricks, Record, Scalar, Scene, Sphere};
use puncta_grid::{Error, Fit, Grid, GridConfig, Order, Resolution};

/// Coordinates of all sizes, many of them equal, and some at the edges of what `f32` can hold.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -1.0_f32..1.0,
        2 => (-8_i8..8).prop_map(f32::from),
        1 => 1e7_f32..1.0001e7,
        1 => -1e-30_f32..1e-30,
        1 => prop_oneof![Just(f32::MAX), Just(f32::MIN), Just(f32::MIN_POSITIVE), Just(-0.0)],
    ]
}

fn spheres() -> impl Strategy<Value = Vec<Sphere>> {
    let sphere = ([coordinate(), coordinate(), coordinate()], 0.0_f32..1e3);
    prop::collection::vec(sphere.prop_map(|(center, radius)| Sphere { center, radius }), 0..300)
}

fn resolution() -> impl Strategy<Value = Resolution> {
    prop_oneof![
        (1_u32..60).prop_map(Resolution::LongestSide),
        (0_u32..60).prop_map(Resolution::RecordsPerBrick),
        (0.01_f32..1e4).prop_map(Resolution::Width),
    ]
}

fn config() -> impl Strategy<Value = GridConfig> {
    let fit = prop_oneof![Just(Fit::Robust), Just(Fit::Whole)];
    let order = prop_oneof![Just(Order::Any), Just(Order::Stable)];
    (resolution(), fit, order).prop_map(|(resolution, fit, order)| GridConfig {
        resolution,
        fit,
        order,
    })
}

fn bits(sphere: &Sphere) -> [u32; 4] {
    let [x, y, z] = sphere.center.map(f32::to_bits);
    [x, y, z, sphere.radius.to_bits()]
}

fn sorted_bits(spheres: &[Sphere]) -> Vec<[u32; 4]> {
    let mut all: Vec<_> = spheres.iter().map(bits).collect();
    all.sort_unstable();
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn bricks_hold_what_they_say(before in spheres(), config in config()) {
        let mut after = before.clone();
        let grid = match Grid::sort(&mut after, &config) {
            Err(Error::Resolution { dims }) if matches!(config.resolution, Resolution::Width(_)) => {
                prop_assert!(dims.iter().map(|&dim| dim as f64).product::<f64>() > 1e6, "{dims:?} cells are few");
                prop_assert_eq!(before, after);
                return Ok(());
            }
            grid => grid.unwrap(),
        };
        prop_assert_eq!(sorted_bits(&before), sorted_bits(&after));
        prop_assert_eq!(grid.blocks(), Block::of_runs(grid.bricks()));
        let mut next = 0;
        for (index, brick) in (0_u32..).zip(grid.bricks()) {
            prop_assert_eq!(brick.records.start, next);
            prop_assert!(brick.records.start < brick.records.end, "an empty brick is stored");
            next = brick.records.end;
            let place = grid.cell_of(index).unwrap();
            prop_assert_eq!(grid.brick_at(place), Some(index));
            let cell = grid.cells().bounds(place);
            let members = &after[brick.records.start as usize..brick.records.end as usize];
            for sphere in members {
                prop_assert!(cell.contains(sphere.position()), "{:?} in {:?}", sphere, cell);
                prop_assert!(sphere.position().cmplt(cell.max).all(), "cells are half open");
                prop_assert!(brick.bounds.contains(sphere.position()));
            }
            let least = members.iter().map(Sphere::position).reduce(Vec3::min);
            let largest = members.iter().map(Sphere::position).reduce(Vec3::max);
            prop_assert_eq!(Some(brick.bounds.min), least);
            prop_assert_eq!(Some(brick.bounds.max), largest);
            let radius = members.iter().map(|sphere| sphere.radius).reduce(f32::max);
            prop_assert_eq!(Some(brick.radius_max), radius);
            prop_assert!(brick.density >= 0.0 && brick.density.is_finite());
        }
        prop_assert_eq!(next as usize, before.len());
    }

    #[test]
    fn attributes_and_ids_follow(records in spheres(), config in config()) {
        let mut scene = Scene::new(records.clone());
        let values: Vec<f32> = (0..records.len()).map(|i| i as f32).collect();
        scene.attributes.scalars.push(Scalar { name: "index".into(), values: values.into() });
        if Grid::sort_scene(&mut scene, &config).is_err() {
            return Ok(());
        }
        // A second sort with another grid must not forget the first order.
        Grid::sort_scene(&mut scene, &GridConfig::longest_side(5)).unwrap();
        for (index, record) in (0_u32..).zip(&scene.records) {
            let id = scene.id(index);
            prop_assert_eq!(bits(record), bits(&records[id as usize]));
            prop_assert_eq!(scene.attributes.scalars[0].values[index as usize], id as f32);
        }
    }
}

#[test]
fn the_plain_and_the_scene_sort_agree() {
    let records: Vec<Sphere> = (0..5000_u32)
        .map(|i| [i * 7919 % 997, i * 104 % 991, i * 31 % 83].map(|x| x as f32))
        .map(|center| Sphere::new(center, 1.0))
        .collect();
    let (mut plain, mut scene) = (records.clone(), Scene::new(records));
    let config = GridConfig::default();
    let grid = Grid::sort(&mut plain, &config).unwrap();
    assert_eq!(grid, Grid::sort_scene(&mut scene, &config).unwrap());
    assert_eq!(plain, scene.records);
}

#[test]
fn density_is_the_share_of_the_volume() {
    // One sphere of radius 1/2 in each of 8 unit cells.
    let mut spheres: Vec<Sphere> = (0..8_u8)
        .map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| if bit == 1 { 2.0 } else { 0.0 }))
        .map(|center| Sphere::new(center, 0.5))
        .collect();
    let grid = Grid::sort(&mut spheres, &GridConfig::longest_side(2)).unwrap();
    assert_eq!(grid.bricks().len(), 8);
    for brick in grid.bricks() {
        assert!((brick.density - std::f32::consts::PI / 6.0).abs() < 1e-6, "{}", brick.density);
    }
}

#[test]
fn no_records_make_no_bricks() {
    let grid = Grid::sort(&mut [] as &mut [Sphere], &GridConfig::default()).unwrap();
    assert!(grid.bricks().is_empty());
    assert_eq!(grid.brick_at([0, 0, 0]), None);
}

#[test]
fn strays_have_bricks_of_their_own() {
    let town: Vec<Sphere> = (0..10_000_u16)
        .map(|i| Sphere::new([f32::from(i % 100), f32::from(i / 100), 0.0], 0.5))
        .collect();
    let config = GridConfig { resolution: Resolution::Width(10.0), ..GridConfig::default() };
    let plain = Grid::sort(&mut town.clone(), &config).unwrap();
    assert_eq!(plain.dims(), [10, 10, 1]);
    for axis in 0..3 {
        for far in [-1e6_f32, 1e6] {
            let mut records = town.clone();
            let mut stray = Sphere::new([50.0, 50.0, 0.0], 0.5);
            stray.center[axis] = far;
            records.insert(5000, stray);
            let grid = Grid::sort(&mut records, &config).unwrap();
            let mut dims = plain.dims();
            dims[axis] += 1;
            assert_eq!(grid.dims(), dims);
            assert!((grid.cells().width() - 10.0).abs() < 1e-5, "cells are as wide as asked");
            let lengths = grid.bricks().iter().map(|brick| brick.records.len());
            assert_eq!(lengths.filter(|&length| length == 1).count(), 1, "the stray is alone");
            assert!(grid.bricks().len() == 101 && grid.brick_at([0; 3]).is_some() == (far > 0.0));
        }
    }
}

#[test]
fn a_few_strays_do_not_make_cells_larger() {
    let mut records: Vec<Sphere> = (0..10_000_u16)
        .map(|i| Sphere::new([f32::from(i % 100), f32::from(i / 100), 0.0], 0.5))
        .collect();
    for i in 0..30 {
        records.insert(i * 300, Sphere::new([1e6 + i as f32, -1e5 * i as f32, 7e5], 0.5));
    }
    let grid = Grid::sort(&mut records, &GridConfig::longest_side(20)).unwrap();
    assert!(grid.cells().width() < 15.0, "{}", grid.cells().width());
    let whole = GridConfig { fit: Fit::Whole, ..GridConfig::longest_side(20) };
    let grid = Grid::sort(&mut records, &whole).unwrap();
    assert!(grid.cells().width() > 1e5, "{}", grid.cells().width());
}

#[test]
fn the_first_of_the_records_that_are_wrong_is_named_and_nothing_changes() {
    let count = 70_000_usize;
    let good = |i: usize| Sphere::new([(i * 7919 % 997) as f32, (i % 31) as f32, 0.0], 1.0);
    let mut records: Vec<Sphere> = (0..count).map(good).collect();
    for index in [60_000, 100, 40_000] {
        records[index].center[2] = f32::INFINITY;
        records[index + 1].radius = -1.0;
    }
    let mut scene = Scene::new(records);
    let before = scene.clone();
    for fit in [Fit::Robust, Fit::Whole] {
        let config = GridConfig { fit, ..GridConfig::default() };
        let error = Grid::sort_scene(&mut scene, &config).unwrap_err();
        assert!(matches!(error, Error::Position { index: 100, .. }), "{error}");
        assert!(scene == before, "a scene that cannot be sorted is changed");
    }
    let mut nowhere = vec![Sphere::new([f32::NAN; 3], 1.0); 10_000];
    let error = Grid::sort(&mut nowhere, &GridConfig::default()).unwrap_err();
    assert!(matches!(error, Error::Position { index: 0, .. }), "{error}");
}

#[test]
fn records_that_no_grid_can_hold_are_named() {
    let sort = |sphere| Grid::sort(&mut [Sphere::default(), sphere], &GridConfig::default());
    let error = sort(Sphere::new([0.0, f32::NAN, 0.0], 1.0)).unwrap_err();
    assert!(matches!(error, Error::Position { index: 1, .. }));
    for radius in [f32::NAN, f32::INFINITY, -1.0] {
        let error = sort(Sphere::new([0.0; 3], radius)).unwrap_err();
        assert!(matches!(error, Error::Radius { index: 1, .. }), "{radius}");
    }
}
