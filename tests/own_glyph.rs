//! The glyph of `docs/own_glyph.md` is what it says there, closed, the same in both languages, and drawn.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, its numbers are small, and it shares parts with others"
)]

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use marker::Marker;
use puncta::{
    CpuRenderer, Depth, FrustumCull, Glyph, Glyphs, GpuConfig, GpuRenderer, Grid, GridConfig,
    Pipeline, Record, Scene, Shading, View,
    avc::{Cloud, Fault, Mesh, Sight, Size},
    shade_glyphs,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

mod gpu;
#[path = "own_glyph/marker.rs"]
mod marker;

fn markers(count: usize) -> Vec<Marker> {
    let mut random = Pcg64Mcg::seed_from_u64(61);
    let mut marker = || Marker {
        tip: [0; 3].map(|_| 2.0 * random.random::<f32>() - 1.0),
        height: 0.02 + 0.1 * random.random::<f32>(),
        weight: random.random(),
    };
    (0..count).map(|_| marker()).collect()
}

/// Without spaces, and without what only a module of its own needs.
fn squeezed(code: &str) -> String {
    let code = code.replace("pub(crate) ", "pub ").replace(",}", "}");
    let code: String = code.split_whitespace().collect();
    code.replace(",}", "}").replace(",)", ")").replace(",]", "]")
}

#[test]
fn the_page_shows_this_code() {
    let page = include_str!("../docs/own_glyph.md");
    let blocks: Vec<&str> = page.split("```").skip(1).step_by(2).collect();
    let rust = squeezed(blocks[0].strip_prefix("rust\n").unwrap());
    let own = include_str!("own_glyph/marker.rs");
    let own = squeezed(own.strip_prefix("//! The glyph of `docs/own_glyph.md`.\n").unwrap());
    // Formatting may order what is used and move braces; what is left must be the same.
    let letters = |code: &str| -> String {
        let mut letters: Vec<char> = code.chars().filter(|c| !"{},".contains(*c)).collect();
        letters.sort_unstable();
        letters.into_iter().collect()
    };
    assert_eq!(letters(&rust), letters(&own));
    assert_eq!(blocks[1].strip_prefix("wgsl\n").unwrap(), include_str!("own_glyph/marker.wgsl"));
}

#[test]
fn it_is_closed_and_within_its_ball() {
    let (glyphs, markers) = (Glyphs::<Marker>::new(0.5), markers(200));
    let cloud = glyphs.cloud(&markers);
    let mut drawn = 0;
    for (index, marker) in markers.iter().enumerate() {
        let mesh = Mesh::of::<Marker>(&Marker::form(&cloud, index, &Sight::everywhere(8.0)));
        mesh.check().unwrap();
        assert_eq!(mesh.triangles.is_empty(), marker.weight < 0.5);
        assert!(mesh.vertices.iter().all(|vertex| vertex.length() <= marker.radius()));
        drawn += usize::from(!mesh.triangles.is_empty());
    }
    assert!((50..150).contains(&drawn));
    let odd = Marker { tip: [f32::NAN; 3], height: 1.0, weight: 1.0 };
    let flat = Marker { tip: [0.0; 3], height: 0.0, weight: 1.0 };
    let faults = glyphs.faults(&[odd, flat, markers[0]]);
    assert_eq!((faults.not_finite, faults.no_extent, faults.sum()), (1, 1, 2));
}

#[test]
fn it_is_drawn_alike_on_both() {
    let glyphs = Glyphs::<Marker>::new(0.5);
    let mut scene = Scene::new(markers(5000));
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(6)).unwrap();
    let view = View::look_at(DVec3::new(2.5, 1.5, 0.7), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(320, 240).unwrap();
    let stages = || (FrustumCull, Depth::default());
    let mut cpu = Pipeline::new(stages(), CpuRenderer::of(glyphs.clone()));
    let picture = cpu.render(&scene, &grid, &view).unwrap();
    assert!(picture.covered_pixels() > 10_000);
    let image = shade_glyphs(&glyphs, &scene, &grid, &view, &picture, &Shading::default());
    assert_eq!(image.unwrap().pixels.len(), 320 * 240);
    let Some(gpu) = gpu::gpu() else { return };
    let mut renderer = GpuRenderer::of(gpu, glyphs.clone(), GpuConfig::default()).unwrap();
    let sights = vec![Sight::everywhere(8.0); scene.records.len()];
    let cloud = glyphs.cloud(&scene.records);
    for (index, mesh) in renderer.meshes(&scene.records, &sights).unwrap().iter().enumerate() {
        let own = Mesh::of::<Marker>(&Marker::form(&cloud, index, &sights[index]));
        assert_eq!(mesh, &own);
    }
    let mut pipeline = Pipeline::new(stages(), renderer);
    let other = gpu::differing(&pipeline.render(&scene, &grid, &view).unwrap(), &picture);
    println!("{other} of {} pixels differ", 320 * 240);
    assert!(other <= 1, "{other} pixels differ");
}

/// A marker whose shader uses a name that is taken.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(transparent)]
struct Clash(Marker);

impl Record for Clash {
    fn position(&self) -> Vec3 {
        self.0.position()
    }

    fn radius(&self) -> f32 {
        self.0.radius()
    }
}

impl Glyph for Clash {
    type Style = f32;
    type Form<'a> = ();
    const WGSL: &'static str = "fn place() {}";

    fn form<'a>(_: &Cloud<'a, Self>, _: usize, _: &Sight) {}

    fn size((): &()) -> Size {
        Size::NOTHING
    }

    fn vertex((): &(), _: u32) -> Vec3 {
        Vec3::ZERO
    }

    fn triangle((): &(), _: u32) -> [u32; 3] {
        [0; 3]
    }

    fn fault(_: &Cloud<'_, Self>, _: usize) -> Option<Fault> {
        None
    }
}

#[test]
fn names_that_are_taken_are_told() {
    let Some(gpu) = gpu::gpu() else { return };
    let clash = GpuRenderer::of(gpu, Glyphs::<Clash>::new(0.5), GpuConfig::default());
    let error = clash.unwrap_err().to_string();
    assert!(error.contains("redefinition of `place`"), "{error}");
}
