//! Shading on the GPU makes the images that the CPU makes: of whatever scene, coloring, background and
//! view, within whatever memory, and in a program's own pass.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, its numbers are small, and it shares parts with others"
)]

use glam::DVec3;
use gpu::open;
use puncta::{
    Background, Bricks, ColorMap, Coloring, Content, CpuRenderer, Depth, FrustumCull, Gpu,
    GpuConfig, GpuRenderer, Grid, GridConfig, Image, Paint, Picture, Pipeline, Scene, ShadeConfig,
    Shading, Sphere, View, core::Scalar, gpu::Extent, shade,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

mod gpu;
mod window;

/// The share of the pixels that may differ by more than one step in a channel.
const SHARE_MAX: f64 = 1e-5;

/// Spheres in a cube, with all the columns that one can color by.
fn cloud(seed: u64, count: usize, radii: [f32; 2]) -> (Scene, Grid) {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut sphere = || {
        let center = [0; 3].map(|_| random.random::<f32>() * 2.0 - 1.0);
        let share = random.random::<f32>();
        Sphere { center, radius: radii[0] * (radii[1] / radii[0]).powf(share) }
    };
    let spheres: Vec<Sphere> = (0..count).map(|_| sphere()).collect();
    let mut scene = Scene::new(spheres);
    let colors: Vec<[u8; 4]> = (0..count).map(|_| random.random::<u32>().to_le_bytes()).collect();
    scene.attributes.colors = Some(colors.into());
    let elements: Vec<u8> = (0..count).map(|_| random.random::<u8>() % 20).collect();
    scene.attributes.elements = Some(elements.into());
    let values: Vec<f32> = (0..count).map(|_| random.random()).collect();
    scene.attributes.scalars.push(Scalar { name: "charge".into(), values: values.into() });
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(12)).unwrap();
    (scene, grid)
}

fn view(random: &mut Pcg64Mcg, distance: f64) -> View {
    let mut axis = || DVec3::from([0; 3].map(|_| random.random::<f64>() - 0.5)).normalize();
    View::look_at(axis() * distance, DVec3::ZERO, axis()).unwrap().with_size(300, 210).unwrap()
}

fn content<'a>(scene: &'a Scene, grid: &'a Grid) -> Content<'a, Sphere> {
    Content { scene, bricks: grid.bricks(), blocks: grid.blocks() }
}

fn fine(view: &View, supersample: u32) -> View {
    view.clone().with_size(view.width() * supersample, view.height() * supersample).unwrap()
}

fn by_cpu(scene: &Scene, grid: &Grid, view: &View, shading: &Shading<'_>) -> (Picture, Image) {
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    let picture = pipeline.render(scene, grid, &fine(view, shading.supersample)).unwrap();
    let image = shade(scene, view, &picture, shading).unwrap();
    (picture, image)
}

type OnGpu = Pipeline<(FrustumCull, Depth), GpuRenderer>;

fn pipeline(gpu: &Gpu, record_bytes: u64) -> OnGpu {
    let config = GpuConfig { record_bytes, ..GpuConfig::default() };
    Pipeline::new((FrustumCull, Depth::default()), GpuRenderer::new(gpu, config).unwrap())
}

/// Shades what was drawn last; `key` stands for the colors.
fn by_gpu(
    pipeline: &mut OnGpu,
    (scene, grid): (&Scene, &Grid),
    shading: &Shading<'_>,
    key: u64,
) -> Image {
    let config = ShadeConfig {
        background: shading.background,
        ambient: shading.ambient,
        supersample: shading.supersample,
    };
    let colors = shading.coloring.colors(scene).unwrap();
    let of = |index| colors.of(index);
    let paint = match shading.coloring {
        Coloring::Uniform(color) => Paint::Uniform(color),
        _ => Paint::Each { key, of: &of },
    };
    let content = content(scene, grid);
    pipeline.renderer_mut().shade_image(&content, &config, &paint).unwrap()
}

/// By how many steps each pixel differs, in the channel that differs most.
fn steps(a: &Image, b: &Image) -> Vec<u8> {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let step = |(a, b): (&[u8; 4], &[u8; 4])| {
        a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    };
    a.pixels.iter().zip(&b.pixels).map(step).collect()
}

/// For each pixel of an image, whether all of it shows the same records in two pictures.
fn same_records(a: &Picture, b: &Picture, image: &Image) -> Vec<bool> {
    let (width, factor) = (image.width as usize, (a.width / image.width) as usize);
    let is_same = |pixel: usize| {
        let first = pixel / width * factor * a.width as usize + pixel % width * factor;
        (0..factor * factor).all(|sample| {
            let place = first + sample / factor * a.width as usize + sample % factor;
            a.id[place] == b.id[place]
        })
    };
    (0..image.pixels.len()).map(is_same).collect()
}

/// The sum over many images, so that a share of 1e-5 is something.
#[derive(Default)]
struct Tally {
    pixels: usize,
    covered: usize,
    /// Pixels that differ at all, and by more than a step.
    differing: usize,
    beyond: usize,
    /// Pixels that show other records: where two are equally near, or a ray touches.
    other: usize,
}

impl Tally {
    fn add(&mut self, name: &str, cpu: (&Image, &Picture), gpu: (&Image, &Picture)) {
        let same = same_records(cpu.1, gpu.1, cpu.0);
        let of_same = || steps(cpu.0, gpu.0).into_iter().zip(&same).filter(|(_, same)| **same);
        let differing = of_same().filter(|(step, _)| *step > 0).count();
        let beyond = of_same().filter(|(step, _)| *step > 1).count();
        let other = same.iter().filter(|same| !**same).count();
        println!(
            "{name:<50} beyond a step {beyond:>3}, differing {differing:>5}, other {other:>3}"
        );
        self.pixels += same.len();
        self.covered += cpu.1.covered_pixels() * same.len() / cpu.1.id.len();
        self.differing += differing;
        self.beyond += beyond;
        self.other += other;
    }

    fn check(&self) {
        let Self { pixels, covered, differing, beyond, other } = *self;
        println!("of {pixels} pixels {beyond} beyond a step, {differing} differing, {other} other");
        assert!(covered * 10 > pixels, "there must be something to shade");
        assert!(beyond as f64 <= SHARE_MAX * pixels as f64, "{beyond} of {pixels} pixels differ");
        assert!(other * 2000 < pixels, "{other} of {pixels} pixels show other records");
    }
}

const ELEMENTS: [[u8; 3]; 12] = {
    let mut colors = [[0; 3]; 12];
    let mut i = 0;
    while i < 12 {
        colors[i] = [i as u8 * 21, 255 - i as u8 * 13, 90 + i as u8 * 7];
        i += 1;
    }
    colors
};

const BACKGROUNDS: [Background; 3] = [
    Background::Solid([10, 200, 60]),
    Background::Gradient([24, 28, 36], [166, 75, 88]),
    Background::Transparent,
];

fn colorings(map: &ColorMap) -> [Coloring<'_>; 5] {
    [
        Coloring::Uniform([196, 203, 212]),
        Coloring::Colors,
        Coloring::Elements(&ELEMENTS),
        Coloring::Scalar { name: "charge", map, range: None },
        Coloring::Height { axis: DVec3::new(0.6, 0.0, 0.8), map, range: Some([-0.8, 0.9]) },
    ]
}

/// Views from outside, from within, with parallel rays, through narrow and wide lenses, cut open.
fn views(random: &mut Pcg64Mcg) -> Vec<(&'static str, View)> {
    let mut at = |distance| view(random, distance);
    vec![
        ("outside", at(3.5)),
        ("orthographic", at(3.0).with_orthographic(2.2).unwrap()),
        ("inside", at(0.5)),
        ("inside, orthographic", at(0.2).with_orthographic(0.7).unwrap()),
        ("cut open", at(1.0).with_near(0.4).unwrap()),
        ("far away", at(500.0).with_perspective(0.005).unwrap()),
        ("wide", at(0.9).with_perspective(2.2).unwrap()),
    ]
}

/// All colorings, backgrounds, supersamplings and views, in one renderer each.
fn compare(extent: Extent) {
    let Some(gpu) = open(extent) else { return };
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let map = ColorMap::default();
    let mut tally = Tally::default();
    for (round, radii) in [[3e-4, 0.2], [0.01, 0.06], [0.2, 0.9]].into_iter().enumerate() {
        let (scene, grid) = cloud(round as u64, 8000 / (1 + 20 * (round / 2)), radii);
        let mut on_gpu = pipeline(&gpu, 1 << 24);
        for (place, (name, view)) in views(&mut random).into_iter().enumerate() {
            let key = place + round;
            let shading = Shading {
                coloring: colorings(&map)[key % 5],
                background: BACKGROUNDS[place % 3],
                ambient: 0.1 + 0.2 * round as f32,
                supersample: 1 + (key as u32) % 3,
            };
            let (picture, cpu) = by_cpu(&scene, &grid, &view, &shading);
            let fine = fine(&view, shading.supersample);
            let drawn = on_gpu.render(&scene, &grid, &fine).unwrap();
            let found = by_gpu(&mut on_gpu, (&scene, &grid), &shading, key as u64 % 5);
            let name = format!("{name}, {radii:?}, supersample {}", shading.supersample);
            tally.add(&name, (&cpu, &picture), (&found, &drawn));
        }
    }
    tally.check();
}

#[test]
fn images_are_those_of_the_cpu() {
    compare(Extent::Full);
}

#[test]
fn images_are_those_of_the_cpu_with_nothing_but_webgpu() {
    compare(Extent::Core);
}

#[test]
fn one_picture_is_shaded_in_all_ways() {
    let Some(gpu) = open(Extent::Full) else { return };
    let map = ColorMap::named("magma_r").unwrap();
    let (scene, grid) = cloud(7, 20_000, [0.005, 0.05]);
    let view = view(&mut Pcg64Mcg::seed_from_u64(8), 3.0);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    let drawn = on_gpu.render(&scene, &grid, &fine(&view, 2)).unwrap();
    let mut tally = Tally::default();
    for (key, coloring) in colorings(&map).into_iter().enumerate() {
        for background in BACKGROUNDS {
            let shading = Shading { coloring, background, ambient: 0.18, supersample: 2 };
            let (picture, cpu) = by_cpu(&scene, &grid, &view, &shading);
            let found = by_gpu(&mut on_gpu, (&scene, &grid), &shading, key as u64);
            tally.add(&format!("{background:?}"), (&cpu, &picture), (&found, &drawn));
        }
    }
    tally.check();
}

/// What was drawn has long left the GPU when it is shaded.
#[test]
fn scenes_larger_than_the_budget_are_shaded() {
    for extent in [Extent::Full, Extent::Core] {
        let Some(gpu) = open(extent) else { return };
        let (scene, grid) = cloud(11, 60_000, [0.004, 0.02]);
        let budget = 24 * 1024 * 5;
        assert!((budget as usize) < scene.records.len() * 24 / 8);
        let mut random = Pcg64Mcg::seed_from_u64(12);
        let mut on_gpu = pipeline(&gpu, budget);
        let mut tally = Tally::default();
        for key in 0..4 {
            let view = view(&mut random, 2.0 + key as f64);
            let shading = Shading { coloring: Coloring::Colors, ..Shading::default() };
            let (picture, cpu) = by_cpu(&scene, &grid, &view, &shading);
            let drawn = on_gpu.render(&scene, &grid, &view).unwrap();
            let found = by_gpu(&mut on_gpu, (&scene, &grid), &shading, 0);
            assert!(on_gpu.renderer().record_bytes() <= budget);
            tally.add("budget", (&cpu, &picture), (&found, &drawn));
        }
        tally.check();
    }
}

/// Large pictures are shaded in more than one band.
#[test]
fn large_pictures_are_shaded_in_bands() {
    let Some(gpu) = open(Extent::Full) else { return };
    let (scene, grid) = cloud(15, 10_000, [0.005, 0.1]);
    let view = view(&mut Pcg64Mcg::seed_from_u64(16), 1.6).with_size(1151, 1000).unwrap();
    let map = ColorMap::default();
    let coloring = Coloring::Scalar { name: "charge", map: &map, range: None };
    let shading = Shading { coloring, supersample: 2, ..Shading::default() };
    let (picture, cpu) = by_cpu(&scene, &grid, &view, &shading);
    assert!(picture.id.len() > 1 << 22);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    let drawn = on_gpu.render(&scene, &grid, &fine(&view, 2)).unwrap();
    let found = by_gpu(&mut on_gpu, (&scene, &grid), &shading, 0);
    let mut tally = Tally::default();
    tally.add("bands", (&cpu, &picture), (&found, &drawn));
    tally.check();
}

/// With ambient light alone, a covered pixel shows its color and any other one the background. Nothing
/// is left over, whatever was in the buffers before.
#[test]
fn all_covered_pixels_get_their_color() {
    let Some(gpu) = open(Extent::Full) else { return };
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let (scene, grid) = cloud(22, 5000, [1e-3, 0.4]);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    for (key, (name, view)) in views(&mut random).into_iter().enumerate() {
        let picture = on_gpu.render(&scene, &grid, &view).unwrap();
        let coloring = Coloring::Colors;
        let background = Background::Transparent;
        let shading = Shading { coloring, background, ambient: 1.0, supersample: 1 };
        let image = by_gpu(&mut on_gpu, (&scene, &grid), &shading, key as u64);
        let colors = coloring.colors(&scene).unwrap();
        assert!(picture.covered_pixels() > 1000, "{name}");
        for (pixel, (&id, found)) in picture.id.iter().zip(&image.pixels).enumerate() {
            let [r, g, b] = if id == puncta::NO_RECORD { [0; 3] } else { colors.of(id) };
            let alpha = if id == puncta::NO_RECORD { 0 } else { 255 };
            assert_eq!(*found, [r, g, b, alpha], "{name}: pixel {pixel} shows {id}");
        }
    }
}

/// A picture that is not complete, or of nothing, can be shaded as well.
#[test]
fn unfinished_pictures_are_shaded() {
    let Some(gpu) = open(Extent::Full) else { return };
    let (scene, grid) = cloud(31, 30_000, [0.005, 0.03]);
    let view = view(&mut Pcg64Mcg::seed_from_u64(32), 3.0);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    let shading = Shading { coloring: Coloring::Colors, ..Shading::default() };
    let config = ShadeConfig::default();
    let colors = shading.coloring.colors(&scene).unwrap();
    let paint = Paint::Each { key: 0, of: &|index| colors.of(index) };
    let mut progressive = on_gpu.progressive(&scene, &grid, &view, 4000_u64).unwrap();
    let mut covered = Vec::new();
    for _ in 0..4 {
        let picture = progressive.picture().unwrap();
        let renderer = progressive.renderer_mut();
        let found = renderer.shade_image(&content(&scene, &grid), &config, &paint).unwrap();
        let expected = shade(&scene, &view, &picture, &shading).unwrap();
        assert!(steps(&expected, &found).iter().all(|step| *step <= 1));
        covered.push(picture.covered_pixels());
        progressive.next().unwrap().unwrap();
    }
    assert_eq!(covered[0], 0);
    assert!(covered.is_sorted() && covered[1] > 0 && covered[1] < covered[3], "{covered:?}");
}

#[test]
fn what_cannot_be_shaded_is_refused() {
    let Some(gpu) = open(Extent::Full) else { return };
    let (scene, grid) = cloud(41, 100, [0.01, 0.2]);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    let paint = Paint::Uniform([255; 3]);
    let config = ShadeConfig { supersample: 7, ..ShadeConfig::default() };
    let here = content(&scene, &grid);
    let begun = on_gpu.renderer_mut().shade_image(&here, &config, &paint);
    let not_begun = puncta::core::Error::NotBegun;
    assert_eq!(begun.unwrap_err(), puncta::gpu::Error::Core(not_begun));
    let view = view(&mut Pcg64Mcg::seed_from_u64(42), 3.0);
    on_gpu.render(&scene, &grid, &view).unwrap();
    let uneven = on_gpu.renderer_mut().shade_image(&here, &config, &paint).unwrap_err();
    assert_eq!(uneven, puncta::gpu::Error::Supersample { width: 300, height: 210, factor: 7 });
    let (other, other_grid) = cloud(43, 100, [0.01, 0.2]);
    let there = content(&other, &other_grid);
    let config = ShadeConfig::default();
    let strange = on_gpu.renderer_mut().shade_image(&there, &config, &paint).unwrap_err();
    assert_eq!(strange, puncta::gpu::Error::OtherContent);
}

/// The image appears in a pass of a program that has its own device, and hides what lies behind it.
#[test]
fn a_pass_of_ones_own_shows_the_image_in_depth() {
    let Some(own) = open(Extent::Core) else { return };
    let gpu = Gpu::from_device(own.device().clone(), own.queue().clone());
    let (scene, grid) = cloud(51, 2000, [0.02, 0.2]);
    let view = view(&mut Pcg64Mcg::seed_from_u64(52), 3.0);
    let mut on_gpu = pipeline(&gpu, 1 << 24);
    let picture = on_gpu.render(&scene, &grid, &view).unwrap();
    let shading = Shading { coloring: Coloring::Colors, ..Shading::default() };
    let image = by_gpu(&mut on_gpu, (&scene, &grid), &shading, 0);
    let colors = shading.coloring.colors(&scene).unwrap();
    let paint = Paint::Each { key: 0, of: &|index| colors.of(index) };
    let config = ShadeConfig::default();
    let renderer = on_gpu.renderer_mut();
    let shaded = renderer.shade(&content(&scene, &grid), &config, &paint).unwrap();
    // A wall of the program's own, at a view depth in the middle of the cloud.
    let (wall, near) = (2.8_f32, view.near() as f32);
    let mut is_before = [0; 2];
    for format in [window::PLAIN, window::LINEAR] {
        let found = window::draw(&gpu, (shaded, &view), (format, near / wall));
        for (pixel, found) in found.iter().enumerate() {
            let depth = picture.depth[pixel];
            // What lies in the wall within rounding may be on either side of it.
            if (depth - wall).abs() < 1e-5 {
                continue;
            }
            is_before[usize::from(depth < wall)] += 1;
            let expected = if depth < wall { image.pixels[pixel] } else { window::WALL };
            let most = found.iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max().unwrap();
            assert!(most <= 1, "pixel {pixel} of {format:?}: {found:?}, not {expected:?}");
        }
    }
    assert!(is_before.iter().all(|count| *count > 5000), "{is_before:?}");
}
