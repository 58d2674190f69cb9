//! The sort at sizes where all its steps are at work: stripes, stuck rows, buckets of buckets, both
//! ways to sort a bucket. Inputs that should suit it, and inputs that should not.

#![allow(
    clippy::cast_possible_truncation,
    clippy::unwrap_used,
    reason = "a test may panic, and its numbers are small"
)]

mod naive;

use glam::Vec3;
use puncta_core::{Record, Scalar, Scene, Sphere};
use puncta_grid::{Fit, Grid, GridConfig, Order, Resolution};

/// Numbers that look random, the same ones each time.
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn next(&mut self) -> f32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn cube(&mut self, count: usize, side: f32) -> Vec<Sphere> {
        let mut at = || self.next() * side;
        (0..count).map(|_| Sphere::new([at(), at(), at()], at() * 1e-3)).collect()
    }
}

/// A color for an index, that other columns do not have.
fn color(index: u32) -> [u8; 4] {
    index.wrapping_mul(2_654_435_769).to_be_bytes()
}

/// Sorts a scene with all kinds of columns, and checks it against the plain twin.
fn check(records: &[Sphere], config: &GridConfig) {
    let count = records.len() as u32;
    let mut scene = Scene::new(records.to_vec());
    scene.attributes.colors = Some((0..count).map(color).collect());
    scene.attributes.elements = Some((0..count).map(|i| (i % 257) as u8).collect());
    for factor in [1.0, -0.5] {
        let values = (0..count).map(|i| i as f32 * factor).collect();
        scene.attributes.scalars.push(Scalar { name: factor.to_string(), values });
    }
    let grid = Grid::sort_scene(&mut scene, config).unwrap();
    let ids = scene.attributes.ids.clone().unwrap();
    naive::check(records, &scene.records, &ids, &grid);
    for (row, &id) in ids.iter().enumerate() {
        assert_eq!(scene.records[row], records[id as usize]);
        assert_eq!(scene.attributes.colors.as_ref().unwrap()[row], color(id));
        assert_eq!(scene.attributes.elements.as_ref().unwrap()[row], (id % 257) as u8);
        assert_eq!(scene.attributes.scalars[0].values[row], id as f32);
        assert_eq!(scene.attributes.scalars[1].values[row], id as f32 * -0.5);
    }
    for (brick, color) in grid.bricks().iter().zip(grid.colors().unwrap()) {
        let run = brick.records.start as usize..brick.records.end as usize;
        let colors = &scene.attributes.colors.as_ref().unwrap()[run];
        for (channel, &mean) in color.iter().enumerate() {
            let sum: f64 = colors.iter().map(|color| f64::from(color[channel])).sum();
            assert!((f64::from(mean) - sum / colors.len() as f64).abs() <= 0.5);
        }
        if config.order == Order::Stable {
            let run = brick.records.start as usize..brick.records.end as usize;
            assert!(ids[run].is_sorted(), "rows do not keep their order");
        }
    }
    let mut plain = records.to_vec();
    assert_eq!(Grid::sort(&mut plain, config).unwrap().bricks(), grid.bricks());
    if config.order == Order::Stable {
        assert_eq!(plain, scene.records);
    }
}

fn config(resolution: Resolution) -> GridConfig {
    GridConfig { resolution, ..GridConfig::default() }
}

#[test]
fn stripes_sort_what_comes_in_any_order() {
    // Enough for four stripes and more than one round.
    let mut records = Random(1).cube(1_200_000, 1.0);
    check(&records, &config(Resolution::LongestSide(40)));
    let key = |sphere: &Sphere| sphere.center.map(|x| (x * 40.0) as u32);
    records.sort_by_key(key);
    check(&records, &config(Resolution::LongestSide(40)));
    records.reverse();
    check(&records, &GridConfig { order: Order::Stable, ..config(Resolution::LongestSide(30)) });
}

#[test]
fn stripes_that_get_what_others_need_leave_nothing_behind() {
    // The records of each bucket lie where only one stripe finds them.
    let (count, buckets) = (1_u32 << 20, 64);
    let records: Vec<Sphere> = (0..count)
        .map(|i| {
            let within = i % (count / buckets);
            let bucket = within * buckets / (count / buckets);
            Sphere::new([bucket as f32, 0.0, 0.0], 0.1)
        })
        .collect();
    check(&records, &config(Resolution::LongestSide(64)));
    // And the other way round: the first half of the rows belongs into the second half of buckets.
    let half = |i: u32| (i.wrapping_mul(2_654_435_769) >> 27) + if i < count / 2 { 32 } else { 0 };
    let records: Vec<Sphere> =
        (0..count).map(|i| Sphere::new([0.0, half(i) as f32, 1.0], 0.1)).collect();
    check(&records, &config(Resolution::LongestSide(64)));
}

#[test]
fn clusters_are_split_again_and_again() {
    // Nearly all records in a millionth of the volume, and that again.
    let mut random = Random(3);
    let mut records = random.cube(20_000, 1000.0);
    records.extend(random.cube(300_000, 10.0));
    records.extend(random.cube(300_000, 0.1));
    for fit in [Fit::Robust, Fit::Whole] {
        let resolution = Resolution::LongestSide(1000);
        check(&records, &GridConfig { fit, ..config(resolution) });
    }
    check(&records, &config(Resolution::RecordsPerBrick(1)));
}

#[test]
fn very_large_buckets_are_split_by_all_threads() {
    let mut random = Random(13);
    let mut records = random.cube(1000, 1000.0);
    records.extend(random.cube(1_200_000, 20.0).iter().map(|sphere| {
        // Not the first bucket of all.
        Sphere::new(sphere.center.map(|x| x + 720.0), sphere.radius)
    }));
    let resolution = Resolution::LongestSide(1000);
    check(&records, &GridConfig { fit: Fit::Whole, ..config(resolution) });
}

#[test]
fn equal_records_are_one_brick() {
    let records = vec![Sphere::new([3.0, -2.0, 1e7], 0.5); 700_000];
    check(&records, &config(Resolution::LongestSide(100)));
    check(&records, &GridConfig { order: Order::Stable, ..config(Resolution::Width(0.1)) });
}

#[test]
fn records_on_the_faces_of_cells_have_one_brick_each() {
    let records: Vec<Sphere> = (0..64_u32 * 64 * 64)
        .map(|i| Sphere::new([i % 64, i / 64 % 64, i / 4096].map(|x| x as f32), 0.5))
        .collect();
    check(&records, &config(Resolution::Width(1.0)));
    check(&records, &config(Resolution::LongestSide(63)));
    check(&records, &config(Resolution::LongestSide(21)));
    let far = |sphere: &Sphere| Sphere::new(sphere.center.map(|x| x + 1e7), 0.5);
    let records: Vec<Sphere> = records.iter().map(far).collect();
    check(&records, &config(Resolution::LongestSide(63)));
    check(&records, &config(Resolution::Width(1.0)));
}

#[test]
fn lines_planes_and_tiny_things_are_sorted() {
    let mut random = Random(5);
    let line: Vec<Sphere> =
        (0..100_000).map(|_| Sphere::new([random.next(), 7.0, -1.0], 0.0)).collect();
    check(&line, &config(Resolution::LongestSide(100_000)));
    check(&line, &config(Resolution::RecordsPerBrick(2)));
    let plane: Vec<Sphere> =
        (0..100_000).map(|_| Sphere::new([0.0, random.next(), random.next()], 1e-6)).collect();
    check(&plane, &config(Resolution::LongestSide(300)));
    let subnormal: Vec<Sphere> = (0..1000_u32)
        .map(|i| Sphere::new([f32::from_bits(i % 9), f32::from_bits(i % 7), 0.0], 1e-45))
        .collect();
    check(&subnormal, &config(Resolution::LongestSide(8)));
    let huge: Vec<Sphere> =
        (0..1000_u32).map(|i| Sphere::new([(i as f32 - 500.0) * 6e35, 0.0, 1.0], 1e30)).collect();
    check(&huge, &config(Resolution::LongestSide(8)));
}

#[test]
fn radii_of_all_sizes_are_measured() {
    let mut random = Random(9);
    let mut records = random.cube(50_000, 1.0);
    for (sphere, power) in records.iter_mut().zip((-20..20).cycle()) {
        sphere.radius = 10.0_f32.powi(power);
    }
    check(&records, &config(Resolution::LongestSide(20)));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let mut random = Random(7);
    let mut records = random.cube(900_000, 1.0);
    records.extend(random.cube(300_000, 0.01));
    let sort = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut scene = Scene::new(records.clone());
        let config = config(Resolution::LongestSide(50));
        let grid = pool.install(|| Grid::sort_scene(&mut scene, &config)).unwrap();
        (scene, grid)
    };
    let one = sort(1);
    assert!(one == sort(2) && one == sort(7), "the result depends on the number of threads");
}

/// A record of its own size: 12 bytes and what the padding adds.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Fat<const N: usize> {
    place: [f32; 3],
    padding: [u8; N],
}

impl<const N: usize> Record for Fat<N> {
    fn position(&self) -> Vec3 {
        self.place.into()
    }

    fn radius(&self) -> f32 {
        0.25
    }
}

fn check_size<const N: usize>() {
    let fat = |(i, sphere): (usize, &Sphere)| Fat { place: sphere.center, padding: [i as u8; N] };
    let records: Vec<Fat<N>> = Random(11).cube(600_000, 1.0).iter().enumerate().map(fat).collect();
    let mut scene = Scene::new(records.clone());
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(25)).unwrap();
    let ids = scene.attributes.ids.clone().unwrap();
    naive::check(&records, &scene.records, &ids, &grid);
    assert!(ids.iter().zip(&scene.records).all(|(&id, record)| records[id as usize] == *record));
}

#[test]
fn records_of_12_to_64_bytes_are_sorted() {
    check_size::<0>();
    check_size::<4>();
    check_size::<17>();
    check_size::<52>();
}
