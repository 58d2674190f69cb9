//! Synthetic scenes: the same for ever, whatever the chunks, and what they are said to be.

use proptest::prelude::*;
use puncta_core::{Attributes, Record, Scene, Source, Sphere};
use puncta_io::synthetic::{Generator, SpecError};

fn generator(spec: &str) -> Generator {
    spec.parse().unwrap_or_else(|error| panic!("{spec}: {error}"))
}

fn scene(spec: &str) -> Scene {
    let Ok(scene) = generator(spec).into_scene();
    scene
}

fn names() -> impl Iterator<Item = &'static str> {
    Generator::kinds().iter().map(|kind| kind.name)
}

/// FNV-1a over origin, records and attributes.
fn checksum(scene: &Scene) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bytes: &[u8]| {
        for byte in bytes {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    scene.origin.to_array().iter().for_each(|x| add(&x.to_le_bytes()));
    for record in &scene.records {
        record.center.iter().for_each(|x| add(&x.to_le_bytes()));
        add(&record.radius.to_le_bytes());
    }
    scene.attributes.colors.iter().flatten().for_each(|color| add(color));
    scene.attributes.elements.iter().for_each(|elements| add(elements));
    for scalar in &scene.attributes.scalars {
        add(scalar.name.as_bytes());
        scalar.values.iter().for_each(|value| add(&value.to_le_bytes()));
    }
    hash
}

/// A change here changes pictures and measurements of everybody: it must be meant, and told.
#[test]
fn scenes_are_what_they_always_were() {
    let stored = [
        ("cube:n=20000", 0x016b_2fb2_6156_336f),
        ("lattice:n=20000", 0x0906_6d60_d6f4_6291),
        ("lattice:n=20000,kind=bcc,jitter=0.1", 0x214a_3274_04e2_8e3a),
        ("ablation:n=20000", 0xf95c_2d6b_38fd_ae3a),
        ("ablation:n=20000,cut=none,seed=2", 0xd988_c6be_64e4_2ce3),
        ("hall:n=20000", 0x4872_5147_f029_0a65),
        ("halo:n=20000", 0xe978_26c9_14d5_a37b),
    ];
    let found = stored.map(|(spec, _)| (spec, checksum(&scene(spec))));
    assert_eq!(found, stored, "{found:#x?}");
}

#[test]
fn chunks_give_what_the_whole_gives() {
    for name in names() {
        let spec = format!("{name}:n=3000");
        let whole = scene(&spec);
        for limit in [1, 7, 255, 256, 257, 2999, 3000, 3001, usize::MAX] {
            let mut source = generator(&spec);
            let mut chunks = Scene::new(Vec::new());
            while source.append(&mut chunks, limit) == Ok(limit) {}
            assert!(whole == chunks, "{name} in chunks of {limit}");
            assert_eq!(source.remaining(), Some(0));
            assert_eq!(source.append(&mut chunks, 10), Ok(0), "{name} has come to its end");
        }
    }
}

/// With little memory, a scene is cleared between two chunks.
#[test]
fn cleared_scenes_take_the_next_chunk() {
    for name in names() {
        let spec = format!("{name}:n=1000");
        let whole = scene(&spec);
        let mut source = generator(&spec);
        let mut chunk = Scene::new(Vec::new());
        for start in [0, 400, 800] {
            chunk.records.to_mut().clear();
            chunk.attributes = Attributes::default();
            let count = source.append(&mut chunk, 400).unwrap();
            assert_eq!(chunk.records, whole.records[start..start + count], "{name}");
            assert_eq!(chunk.validate(), Ok(()), "{name}");
            assert_eq!(chunk.origin, whole.origin, "{name}");
        }
    }
}

#[test]
fn counts_are_exact_and_records_can_be_drawn() {
    for name in names() {
        for n in [1, 2, 3, 4, 5, 7, 10, 19, 40, 99, 100, 1000, 12_345, 100_003] {
            let scene = scene(&format!("{name}:n={n}"));
            assert_eq!(scene.records.len(), n, "{name}");
            assert_eq!(scene.validate(), Ok(()), "{name}:n={n}");
            for record in &scene.records {
                assert!(record.position().is_finite(), "{name}:n={n}: {record:?}");
                assert!(record.radius > 0.0 && record.radius.is_finite(), "{name}: {record:?}");
            }
            for scalar in &scene.attributes.scalars {
                assert!(scalar.values.iter().all(|value| value.is_finite()), "{name}:n={n}");
            }
        }
    }
}

#[test]
fn memory_is_that_of_the_records() {
    for name in names() {
        let mut scene = scene(&format!("{name}:n=10007"));
        assert_eq!(scene.records.to_mut().capacity(), 10_007, "{name}");
        assert!(scene.attributes.ids.is_none(), "{name}");
        for scalar in &mut scene.attributes.scalars {
            assert_eq!(scalar.values.to_mut().capacity(), 10_007, "{name}");
        }
        let colors = scene.attributes.colors.as_mut();
        assert!(colors.is_none_or(|colors| colors.to_mut().capacity() == 10_007), "{name}");
    }
}

/// The largest scenes start at once, and no settings lead out of the numbers.
#[test]
fn extremes_are_made() {
    for name in names() {
        for spec in ["n=4294967295", "n=4294967295,r=1e30", "r=1e-30", "seed=18446744073709551615"]
        {
            let mut source = generator(&format!("{name}:{spec}"));
            let mut scene = Scene::new(Vec::new());
            assert_eq!(source.append(&mut scene, 1000), Ok(1000), "{name}:{spec}");
            assert!(scene.records.iter().all(|record| record.position().is_finite()), "{spec}");
            assert!(scene.records.iter().all(|record| record.radius > 0.0), "{name}:{spec}");
        }
    }
    for (kind, jitter) in [("sc", 0), ("bcc", 1), ("fcc", 1)] {
        let spec = format!("lattice:n=4e9,r=1e30,spacing=1e30,kind={kind},jitter={jitter}");
        let mut scene = Scene::new(Vec::new());
        assert_eq!(generator(&spec).append(&mut scene, 10), Ok(10));
        assert!(scene.records.iter().all(|record| record.position().is_finite()), "{spec}");
    }
}

#[test]
fn seeds_make_other_scenes_and_specs_are_complete() {
    for name in names() {
        let plain = generator(name);
        let full = plain.to_string();
        assert_eq!(generator(&full).to_string(), full);
        for key in plain.kind().keys {
            assert!(full.contains(&format!("{}=", key.name)), "{full} lacks {}", key.name);
            assert!(!key.about.is_empty() && !key.allowed().is_empty());
        }
        for key in ["n", "r", "seed"] {
            assert!(plain.kind().keys.iter().any(|k| k.name == key), "{name} lacks {key}");
        }
        if name != "lattice" {
            let [one, two] = [1, 2].map(|seed| scene(&format!("{name}:n=500,seed={seed}")));
            assert_ne!(one.records, two.records, "{name}");
        }
    }
    assert_eq!(
        generator("hall:n=2.5e5,noise=0").to_string(),
        "hall:n=250000,r=0.08,noise=0,strays=20,seed=1"
    );
}

#[test]
fn specs_are_told_from_files() {
    for spec in ["cube", "cube:", "hall:n=5", "halo:nonsense"] {
        assert!(Generator::is_spec(spec), "{spec}");
    }
    for file in ["./cube", "cube.xyz", "cub", "", "C:\\cube", "hall.e57:1", "Cube"] {
        assert!(!Generator::is_spec(file), "{file}");
    }
}

#[test]
fn errors_name_the_key_the_value_and_what_is_allowed() {
    let kinds = "there are cube, lattice, ablation, hall, halo";
    let keys = "its keys are n, r, seed";
    let whole = "must be a whole number from";
    let n = |value: &str| format!("n of cube {whole} 1 to 4294967295, not \"{value}\"");
    let r = |value: &str| format!("r of cube must be a number from 1e-30 to 1e30, not \"{value}\"");
    let form = |text| format!("a setting of cube must be of the form key=value, not \"{text}\"");
    let cases = [
        ("dice:n=5", format!("there is no scene \"dice\"; {kinds}")),
        ("", format!("there is no scene \"\"; {kinds}")),
        ("cube:m=5", format!("cube has no key \"m\"; {keys}")),
        ("cube:n=5, r=1", format!("cube has no key \" r\"; {keys}")),
        ("cube:", form("")),
        ("cube:n=5,", form("")),
        ("cube:5", form("5")),
        ("cube:n=0", n("0")),
        ("cube:n=4294967296", n("4294967296")),
        ("cube:n=1e10", n("1e10")),
        ("cube:n=1.5", n("1.5")),
        ("cube:n=-1", n("-1")),
        ("cube:n=10M", n("10M")),
        ("cube:n=", n("")),
        ("cube:n=99999999999999999999", n("99999999999999999999")),
        ("cube:r=0", r("0")),
        ("cube:r=-1", r("-1")),
        ("cube:r=nan", r("nan")),
        ("cube:r=inf", r("inf")),
        ("cube:r=1e31", r("1e31")),
        ("cube:r=a=b\n", r("a=b\\n")),
        ("cube:seed=-1", format!("seed of cube {whole} 0 to 18446744073709551615, not \"-1\"")),
        ("cube:n=5,n=5", "n of cube is given twice".into()),
        ("lattice:kind=hcp", "kind of lattice must be one of fcc, bcc, sc, not \"hcp\"".into()),
        ("lattice:jitter=2", "jitter of lattice must be a number from 0 to 1, not \"2\"".into()),
        ("hall:strays=1001", format!("strays of hall {whole} 0 to 1000, not \"1001\"")),
    ];
    for (spec, expected) in cases {
        let error = spec.parse::<Generator>().err().map(|error: SpecError| error.to_string());
        assert_eq!(error, Some(expected), "{spec}");
    }
}

/// The hall lies in its box; the strays do not, and make the box of all points useless.
#[test]
fn strays_spoil_the_bounds_of_the_hall() {
    let scene = scene("hall");
    let count = scene.records.len();
    assert_eq!(count, 2_000_000);
    for axis in 0..3 {
        let mut values: Vec<f32> = scene.records.iter().map(|r| r.center[axis]).collect();
        values.sort_unstable_by(f32::total_cmp);
        let inner = values[count - 1 - count / 2000] - values[count / 2000];
        let hall = [60.0, 24.0, 10.5][axis];
        assert!((0.98 * hall..1.01 * hall).contains(&inner), "axis {axis}: {inner}");
        let outer = values[count - 1] - values[0];
        assert!(outer > 20.0 * inner, "axis {axis}: {outer} is not far more than {inner}");
    }
    let far = |record: &&Sphere| {
        let [x, y, z] = record.center.map(f32::abs);
        x > 30.5 || y > 12.5 || z > 11.0
    };
    assert_eq!(scene.records.iter().filter(far).count(), 20);
    let farthest = scene.records.iter().map(|r| r.position().length()).fold(0.0, f32::max);
    assert!((600.0..=3000.0).contains(&farthest), "{farthest}");
    assert!((scene.position(0) - glam::DVec3::new(350_000.0, 5_800_000.0, 110.0)).length() < 50.0);
}

/// The floor near a scanner is far denser than the floor between two of them.
#[test]
fn the_hall_is_denser_near_scanners() {
    let scene = scene("hall:n=500000,strays=0,noise=0");
    let floor = |x: f32, y: f32| {
        let near = |p: [f32; 3]| p[2].abs() < 1e-3 && (p[0] - x).hypot(p[1] - y) < 0.4;
        scene.records.iter().filter(|record| near(record.center)).count()
    };
    let (near, far) = (floor(1.0, -0.3), floor(6.6, -0.2));
    assert!(far > 10 && near > 10 * far, "{near} near a scanner, {far} between two");
}

/// The numbers of records in the cells of a grid of 32³ over a cube of this half side, most
/// populous first.
fn cells(scene: &Scene, half: f32) -> Vec<usize> {
    let mut cells = vec![0; 32 * 32 * 32];
    for record in &scene.records {
        let [x, y, z] = record
            .center
            .map(|x| (0..31).take_while(|i| x >= half * ((i + 1) as f32 / 16.0 - 1.0)).count());
        cells[(z * 32 + y) * 32 + x] += 1;
    }
    cells.sort_unstable_by(|a, b| b.cmp(a));
    cells
}

/// One cell in a hundred holds nearly half of all halo records; of the evenly scattered cube, it
/// holds little more than a hundredth.
#[test]
fn the_densities_of_halos_have_a_heavy_tail() {
    let share = |cells: &[usize], part: usize| {
        let all: usize = cells.iter().sum();
        cells[..cells.len() / part].iter().sum::<usize>() as f64 / all as f64
    };
    let halo = cells(&scene("halo:n=400000"), 50.0);
    assert!(share(&halo, 100) > 0.4, "{}", share(&halo, 100));
    assert!(share(&halo, 2) > 0.95, "{}", share(&halo, 2));
    assert!(*halo.last().unwrap() < 4, "voids are empty but for what is spread evenly");
    let cube = cells(&scene("cube:n=400000"), 1.0);
    assert!(share(&cube, 100) < 0.02, "{}", share(&cube, 100));
}

/// Where a record says it is dense, there are others close by, and nearly none where it says not.
#[test]
fn the_density_of_halos_is_that_of_their_records() {
    let scene = scene("halo:n=300000");
    let density = &scene.scalar("density").unwrap().values;
    let neighbors = |range: std::ops::Range<f32>| {
        let chosen = (0..density.len()).filter(|i| range.contains(&density[*i]));
        let chosen: Vec<usize> = chosen.step_by(97).take(60).collect();
        assert!(chosen.len() > 20, "{} records are in {range:?}", chosen.len());
        let count = |i: &usize| {
            let center = scene.records[*i].position();
            scene.records.iter().filter(|r| r.position().distance(center) < 0.5).count() as f64
        };
        chosen.iter().map(count).sum::<f64>() / chosen.len() as f64
    };
    // A ball of this radius holds 0.157 records at the mean density, besides the one it is around.
    let (void, web, halo) = (neighbors(-2.0..-0.5), neighbors(0.8..1.4), neighbors(3.0..3.5));
    assert!(web > 5.0 * void && halo > 5.0 * web, "{void}, {web}, {halo}");
}

/// The plume is above the block and hotter; the block has a crater, a rim and bubbles.
#[test]
fn the_ablation_has_its_parts() {
    let scene = scene("ablation:n=300000,cut=none");
    let temperatures = &scene.scalar("temperature").unwrap().values;
    let share = |chosen: &dyn Fn([f32; 3]) -> bool| {
        let count = scene.records.iter().filter(|record| chosen(record.center)).count();
        count as f64 / scene.records.len() as f64
    };
    let mean = |chosen: &dyn Fn([f32; 3]) -> bool| {
        let pairs = scene.records.iter().zip(temperatures);
        let values: Vec<f64> =
            pairs.filter(|(r, _)| chosen(r.center)).map(|(_, t)| f64::from(*t)).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let plume = share(&|p| p[2] > 0.3);
    assert!((0.06..0.25).contains(&plume), "{plume} is the share of the plume");
    let block = share(&|p| p[2] < 0.1);
    assert!((0.7..0.94).contains(&block), "{block} is the share of the block");
    // Vapor thins out above the front, and the front is the hottest.
    assert!(share(&|p| p[2] > 2.2) < 0.1 * plume);
    let (cold, cap) = (mean(&|p| p[2] < -0.6), mean(&|p| p[2] > 1.4 && p[2] < 1.8));
    assert!(cold < 700.0 && cap > 3500.0, "{cold} K below, {cap} K in the cap");
    assert!(mean(&|p| p[2] > 0.3) > 3000.0);
    // In the crater there is next to nothing where the block is full elsewhere.
    let slice = |p: [f32; 3]| (-0.2..-0.05).contains(&p[2]);
    let crater = share(&|p| p[0].hypot(p[1]) < 0.2 && slice(p));
    let full = share(&|p| (p[0] - 0.75).hypot(p[1] - 0.75) < 0.2 && slice(p));
    assert!(crater < 0.15 * full, "{crater} in the crater, {full} beside it");
    let slice = |p: [f32; 3]| (0.03..0.1).contains(&p[2]);
    let rim = share(&|p| (0.5..0.8).contains(&p[0].hypot(p[1])) && slice(p));
    let plain = share(&|p| p[0].abs().max(p[1].abs()) > 0.9 && slice(p));
    assert!(rim > 20.0 * plain, "{rim} in the rim, {plain} beyond");
}

/// The cut takes the quarter of positive x and negative y from the block.
#[test]
fn the_cut_takes_a_quarter_of_the_block() {
    let share = |spec: &str| {
        let scene = scene(spec);
        let block = || scene.records.iter().filter(|record| record.center[2] < -0.45);
        let cut = block().filter(|r| r.center[0] > 0.05 && r.center[1] < -0.05).count();
        cut as f64 / block().count() as f64
    };
    assert_eq!(share("ablation:n=50000"), 0.0);
    let whole = share("ablation:n=50000,cut=none");
    assert!((0.2..0.25).contains(&whole), "{whole}");
}

proptest! {
    /// Any text gives a generator or an error, and what a generator prints gives the same again.
    #[test]
    fn any_text_is_read_or_refused(
        name in "cube|lattice|ablation|hall|halo|.{0,4}",
        settings in ":((n|r|seed|kind|jitter|noise|strays|cut)=[0-9a-z.e+-]{0,4},?){0,3}|:.{0,12}|",
    ) {
        let text = name + &settings;
        if let Ok(generator) = text.parse::<Generator>() {
            let full = generator.to_string();
            prop_assert_eq!(self::generator(&full).to_string(), full);
            prop_assert!(Generator::is_spec(&text));
        }
    }

    /// Values that are allowed are taken, in any order, and come back from the full text.
    #[test]
    fn allowed_values_come_back(
        n in 1..=u64::from(u32::MAX),
        exponent in -29_i32..30,
        digits in 1.0..10.0_f64,
        seed: u64,
        jitter in 0.0..=1.0_f64,
        kind in prop::sample::select(vec!["sc", "bcc", "fcc"]),
    ) {
        let r = digits * 10.0_f64.powi(exponent);
        let settings = format!("seed={seed},r={r:e},jitter={jitter},n={n},kind={kind}");
        let generator = generator(&format!("lattice:{settings}"));
        prop_assert_eq!(generator.remaining(), Some(n));
        let full = generator.to_string();
        prop_assert_eq!(self::generator(&full).to_string(), full.clone());
        for part in [format!("n={n}"), format!("seed={seed}"), format!("kind={kind}")] {
            prop_assert!(full.contains(&part), "{} lacks {}", full, part);
        }
        let read = full.split(',').find_map(|part| part.strip_prefix("r=")).map(str::parse);
        prop_assert_eq!(read, Some(Ok(r)));
    }
}
