//! Glyphs on the GPU: their geometry is that of the CPU's twins, vertex by vertex, and their pictures are
//! those of the reference and of the CPU.

#![cfg(feature = "gpu")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::print_stdout,
    dead_code,
    reason = "a test may panic and talk, its numbers are small, and it shares parts with others"
)]

use glam::{DVec3, Vec3, Vec4};
use gpu::{bits, differing, open};
use puncta::{
    Brick, Bricks, CpuRenderer, Cuboid, Depth, FrustumCull, Glyphs, Gpu, GpuConfig, GpuRenderer,
    Grid, GridConfig, Picture, Pipeline, Scene, View,
    avc::{Arc, Block, BlockWorld, Filling, Mesh, Node, Polygon, PolygonSet, Sight},
    core::Aabb,
    gpu::{Extent, Solids, wgpu},
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use solids::{
    Reference,
    scenes::{Sample, cloud, scenes},
};
use std::f64::consts::TAU;

mod gpu;
mod solids;

/// What the renderer on the GPU promises: see `solids::Pixels`.
const GPU: solids::Pixels = 1e-3;

type Draws<G> = Pipeline<(FrustumCull, Depth), GpuRenderer<Solids<G>>>;

fn draws<G: Sample>(gpu: &Gpu) -> Draws<G> {
    let renderer = GpuRenderer::of(gpu, G::glyphs(), GpuConfig::default()).unwrap();
    Pipeline::new((FrustumCull, Depth::default()), renderer)
}

fn on_cpu<G: Sample>(scene: &Scene<G>, held: &G::Held, view: &View) -> Picture {
    let renderer = CpuRenderer::of(G::glyphs());
    Pipeline::new((FrustumCull, Depth::default()), renderer).render(scene, held, view).unwrap()
}

/// Views of records from anywhere, near and far.
fn sights(random: &mut Pcg64Mcg, count: usize) -> Vec<Sight> {
    let mut sight = || {
        let eye = [0; 3].map(|_| 4.0 * random.random::<f32>() - 2.0);
        let [x, y, z] = eye;
        Sight {
            eye: Vec4::new(x, y, z, f32::from(u8::from(random.random::<bool>()))),
            nearest: 10_f32.powf(4.0 * random.random::<f32>() - 2.0),
            sharpness: 10_f32.powf(4.0 * random.random::<f32>()),
            pixel: 1e-3,
        }
    };
    (0..count).map(|_| sight()).collect()
}

/// Counts and triangles are the same bit by bit, vertices up to some units in the last place of the size
/// of the glyph.
fn twins_agree<G: Sample>() {
    let Some(gpu) = open(Extent::Core) else { return };
    let glyphs = G::glyphs();
    let mut renderer = GpuRenderer::of(&gpu, glyphs.clone(), GpuConfig::default()).unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(31);
    let mut records = cloud::<G>(&mut random, 1500, 1.0, [1e-3, 0.5]);
    // Zeros are nothing.
    records[17] = G::zeroed();
    let sights = sights(&mut random, records.len());
    let cloud = glyphs.cloud(&records);
    let (mut vertices, mut worst) = (0, 0.0_f32);
    for (index, mesh) in renderer.meshes(&records, &sights).unwrap().iter().enumerate() {
        let own = Mesh::of::<G>(&G::form(&cloud, index, &sights[index]));
        assert_eq!(mesh.triangles.len(), own.triangles.len(), "{index} {:?}", records[index]);
        assert!(mesh.triangles == own.triangles, "{index} {:?}", records[index]);
        assert_eq!(mesh.vertices.len(), own.vertices.len());
        let size = own.vertices.iter().fold(0.0_f32, |size, vertex| size.max(vertex.length()));
        for (a, b) in mesh.vertices.iter().zip(&own.vertices) {
            worst = worst.max((a - b).length() / size);
            vertices += 1;
        }
    }
    println!("{vertices} vertices, off by {worst:e} of the size of their glyph at most");
    assert!(vertices > 3000);
    // A few roundings of a cosine and of what it is multiplied with.
    assert!(worst < 8.0 * f32::EPSILON, "{worst:e}");
}

/// Pictures of every `step`-th scene, smaller by a factor along each side. Each covers so many pixels.
fn pictures_agree<G: Sample>(gpu: Option<&Gpu>, (step, factor): (usize, u32), least: usize) {
    let Some(gpu) = gpu else { return };
    let mut pipeline = draws::<G>(gpu);
    let (mut pixels, mut other) = (0, 0);
    for (name, mut scene, view) in scenes::<G>().into_iter().step_by(step) {
        let size = (view.width() / factor, view.height() / factor);
        let view = view.with_size(size.0, size.1).unwrap();
        let held = G::hold(&mut scene, 8);
        pipeline.forget();
        let picture = pipeline.render(&scene, &held, &view).unwrap();
        let reference = Reference::new(&G::glyphs(), &scene, held.bricks(), &view);
        let verdict =
            reference.compare(&picture, GPU).unwrap_or_else(|what| panic!("{name}: {what}"));
        let of_cpu = on_cpu(&scene, &held, &view);
        let differ = differing(&picture, &of_cpu);
        println!("{name:<28} covered {:>6} other {differ:>3}", verdict.covered);
        // A lane on its own may go through few triangles.
        let can_share = gpu.device().limits().max_compute_workgroup_storage_size >= 1 << 14;
        let missed = pipeline.renderer().missed_bricks();
        assert!(!can_share || missed == 0, "{name}: {missed} bricks are too much for the device");
        // What was seen before is drawn first, and changes nothing.
        let again = pipeline.render(&scene, &held, &view).unwrap();
        assert!(bits(&again) == bits(&picture), "{name}: the second picture is another one");
        assert!(verdict.covered >= least, "{name} shows too little");
        // Edges that run through the centres of pixels hang on a hair by themselves.
        if !name.contains("stacks") && !name.contains("from 1e6") {
            pixels += picture.id.len();
            other += differ;
        }
    }
    println!("{other} of {pixels} pixels differ from those of the CPU");
    // One pixel in 100 000 may differ, and one is the least that small pictures can tell.
    assert!(other <= 1 + pixels / 100_000, "{other} of {pixels} pixels");
}

/// Records of which one word is odd: no number, too large, negative, nothing.
fn odd_records<G: Sample>(odd: &[f32]) -> Vec<G> {
    let mut random = Pcg64Mcg::seed_from_u64(33);
    let mut records = cloud::<G>(&mut random, 800, 1.0, [1e-2, 0.5]);
    let words = size_of::<G>() / 4;
    for record in bytemuck::cast_slice_mut::<G, u32>(&mut records).chunks_exact_mut(2 * words) {
        record[random.random_range(0..words)] = odd[random.random_range(0..odd.len())].to_bits();
    }
    records
}

/// Records that are degenerate are counted, are the same for both renderers, and no vertex is NaN.
fn odd_records_agree<G: Sample>() {
    let Some(gpu) = open(Extent::Core) else { return };
    let glyphs = G::glyphs();
    let mut renderer = GpuRenderer::of(&gpu, glyphs.clone(), GpuConfig::default()).unwrap();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, -0.0];
    let records = odd_records::<G>(&[&odd[..], &[1e38, -1e38, 1e-40]].concat());
    let cloud = glyphs.cloud(&records);
    let sights = sights(&mut Pcg64Mcg::seed_from_u64(34), records.len());
    let meshes = renderer.meshes(&records, &sights).unwrap();
    let mut empty = 0;
    for (index, mesh) in meshes.iter().enumerate() {
        let own = Mesh::of::<G>(&G::form(&cloud, index, &sights[index]));
        assert_eq!(mesh.triangles, own.triangles, "{index} {:?}", records[index]);
        assert_eq!(mesh.vertices.len(), own.vertices.len());
        let mut all = mesh.vertices.iter().chain(&own.vertices);
        assert!(all.all(|vertex| vertex.is_finite()), "{index} {:?}", records[index]);
        assert!(own.triangles.is_empty() || G::fault(&cloud, index).is_none());
        empty += usize::from(own.triangles.is_empty());
    }
    let faults = glyphs.faults(&records).sum();
    println!("{faults} faults, {empty} without a triangle");
    assert!(faults > 50 && faults <= empty as u64);

    // All in one brick that nobody has measured.
    let records = odd_records::<G>(&odd);
    let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let bricks = vec![Brick { records: 0..800, bounds, radius_max: 2.0, density: 1.0 }];
    let scene = Scene::new(records);
    let view = View::look_at(DVec3::new(2.0, 3.0, 5.0), DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(80, 60).unwrap();
    let picture = Pipeline::new((), renderer).render(&scene, &bricks, &view).unwrap();
    let own = Pipeline::new((), CpuRenderer::of(glyphs)).render(&scene, &bricks, &view).unwrap();
    assert!(picture.covered_pixels() > 20);
    let other = differing(&picture, &own);
    assert!(other <= 1, "{other} pixels differ");
}

macro_rules! glyphs {
    ($($name:ident: $glyph:ty, $step:literal, $factor:literal, $covered:literal;)+) => { $(mod $name {
        use super::*;

        #[test]
        fn twins_are_the_same() {
            twins_agree::<$glyph>();
        }

        #[test]
        fn odd_records_do_no_harm() {
            odd_records_agree::<$glyph>();
        }

        #[test]
        fn pictures_agree_with_the_reference() {
            pictures_agree::<$glyph>(gpu::gpu(), ($step, $factor), $covered);
        }

        #[test]
        fn pictures_of_core_webgpu_agree_with_the_reference() {
            let gpu = open(Extent::Core);
            pictures_agree::<$glyph>(gpu.as_ref(), (3 * $step, $factor), $covered);
        }
    })+ };
}

solids::all_glyphs!(glyphs);

/// Where a group cannot keep its forms, each lane draws a record of its own.
#[test]
fn groups_may_share_little() {
    let Some(_) = gpu::gpu() else { return };
    let limits = wgpu::Limits { max_compute_workgroup_storage_size: 1024, ..Default::default() };
    let gpu = gpu::own_device(&limits);
    pictures_agree::<Node>(Some(&gpu), (6, 2), 50);
    pictures_agree::<Arc>(Some(&gpu), (6, 2), 50);
}

/// A world of some caves, and views of it from outside and from within a cave.
fn world() -> (BlockWorld, Vec<View>) {
    let mut random = Pcg64Mcg::seed_from_u64(41);
    let mut world = BlockWorld::new([40, 36, 30]).unwrap();
    let holes: Vec<([f32; 3], f32)> = (0..25)
        .map(|_| {
            let place = [40.0, 36.0, 30.0].map(|side| side * random.random::<f32>());
            (place, 2.0 + 5.0 * random.random::<f32>())
        })
        .collect();
    world.fill(|cell| {
        let cell = Vec3::from(cell.map(|c| f32::from(c) + 0.5));
        let is_hole =
            |(place, radius): &([f32; 3], f32)| cell.distance(Vec3::from(*place)) < *radius;
        if holes.iter().any(is_hole) { Filling::Air } else { Filling::solid(1) }
    });
    let middle = DVec3::new(20.0, 18.0, 15.0);
    let mut views: Vec<View> = (0..4)
        .map(|_| {
            let axis = DVec3::from([0; 3].map(|_| random.random::<f64>() - 0.5)).normalize();
            let view = View::look_at(
                middle + axis * 60.0,
                middle,
                DVec3::Z + DVec3::new(axis.y, axis.z, axis.x) * 0.1,
            );
            view.unwrap().with_size(200, 150).unwrap()
        })
        .collect();
    let within = Vec3::from(holes[0].0).as_dvec3();
    let view = View::look_at(within, middle, DVec3::Z).unwrap().with_size(200, 150).unwrap();
    views.push(view.with_perspective(1.8).unwrap());
    let flat = views[0].clone().with_orthographic(50.0).unwrap();
    views.push(flat);
    (world, views)
}

/// What is left out of a world is not seen: its surface looks as all of its blocks do, on both renderers.
#[test]
fn surfaces_of_worlds_look_as_all_of_their_blocks() {
    let (world, views) = world();
    let config = GridConfig::longest_side(6);
    let scene = |blocks: Vec<Block>| {
        let mut scene = Scene::new(blocks);
        let grid = Grid::sort_scene(&mut scene, &config).unwrap();
        (scene, grid)
    };
    let (all, all_held) = scene(world.all(|_| 1));
    let (surface, held) = scene(world.surface(|_| 1));
    assert!(surface.records.len() * 2 < all.records.len());
    let glyphs = || Glyphs::<Block>::new([]);
    let depth = Depth::default;
    let mut cpu = Pipeline::new((FrustumCull, depth()), CpuRenderer::of(glyphs()));
    let gpu = gpu::gpu();
    let mut other = 0;
    for view in &views {
        let expected = cpu.render(&all, &all_held, view).unwrap();
        let found = cpu.render(&surface, &held, view).unwrap();
        // Ids are those of other lists; cells are the same.
        let cells = |scene: &Scene<Block>, picture: &Picture| -> Vec<Option<[u16; 3]>> {
            let cell = |&id: &u32| scene.records.get(id as usize).map(|block| block.cell);
            picture.id.iter().map(cell).collect()
        };
        assert!(expected.covered_pixels() > 3000);
        assert!(cells(&all, &expected) == cells(&surface, &found));
        assert!(expected.depth == found.depth);
        let reference = Reference::new(&glyphs(), &surface, held.bricks(), view);
        reference.compare(&found, solids::CPU).unwrap();
        if let Some(gpu) = gpu {
            let renderer = GpuRenderer::of(gpu, glyphs(), GpuConfig::default()).unwrap();
            let mut pipeline = Pipeline::new((FrustumCull, depth()), renderer);
            let picture = pipeline.render(&surface, &held, view).unwrap();
            reference.compare(&picture, GPU).unwrap();
            other += differing(&picture, &found);
        }
    }
    println!("{other} pixels differ");
    assert!(other <= 2, "{other} of 180000 pixels");
}

/// Records that are changed where they are are brought again with their segments, and no others; the
/// picture is that of a scene that was like that from the start.
#[test]
fn ranges_can_be_changed() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut random = Pcg64Mcg::seed_from_u64(51);
    let mut scene = Scene::new(cloud::<Cuboid>(&mut random, 20_000, 1.0, [0.01, 0.05]));
    let mut grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(9)).unwrap();
    let view = View::look_at(DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(160, 120).unwrap();
    let mut pipeline = draws::<Cuboid>(gpu);
    let first = pipeline.render(&scene, &grid, &view).unwrap();
    let brought = pipeline.renderer().brought_bytes();
    // 24 bytes of a cuboid and its id, 20 segments.
    assert_eq!(brought, 20 * 1024 * 28);
    let seen = first.visible_records()[100] as usize;
    let range = seen..(seen + 50).min(scene.records.len());
    for cuboid in scene.records.edit(range.clone()) {
        cuboid.extent = cuboid.extent.map(|side| side * 6.0);
    }
    grid.refit(&scene.records, range).unwrap();
    let changed = pipeline.render(&scene, &grid, &view).unwrap();
    assert!(bits(&changed) != bits(&first));
    let again = pipeline.renderer().brought_bytes() - brought;
    assert!(again == 28 * 1024 || again == 2 * 28 * 1024, "{again} bytes");
    let mut fresh = draws::<Cuboid>(gpu);
    assert!(bits(&fresh.render(&scene, &grid, &view).unwrap()) == bits(&changed));
    assert_eq!(differing(&changed, &on_cpu(&scene, &grid, &view)), 0);
    // A grid that was measured again skips as one that is made anew.
    assert!(grid.refit(&scene.records, 0..usize::MAX).is_ok());
    scene.records.edit(7..8)[0].center[1] = f32::NAN;
    let error = grid.refit(&scene.records, 0..100).unwrap_err();
    assert!(error.to_string().starts_with("record 7 lies at"), "{error}");
}

/// What all glyphs share changes the next picture, and nothing is brought for it.
#[test]
fn styles_can_be_changed() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut random = Pcg64Mcg::seed_from_u64(52);
    let mut scene = Scene::new(cloud::<Node>(&mut random, 3000, 1.0, [0.01, 0.5]));
    let view = View::look_at(DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(160, 120).unwrap();
    let held = Node::hold(&mut scene, 8);
    let mut pipeline = draws::<Node>(gpu);
    let first = pipeline.render(&scene, &held, &view).unwrap();
    let brought = pipeline.renderer().brought_bytes();
    pipeline.renderer_mut().glyphs_mut().style.selected = 3;
    pipeline.renderer_mut().glyphs_mut().style.selection = 0;
    let glyphs = pipeline.renderer().glyphs().clone();
    let second = pipeline.render(&scene, &held, &view).unwrap();
    assert_eq!(pipeline.renderer().brought_bytes(), brought);
    let is_hidden = |picture: &Picture| {
        let nodes = picture.visible_records().into_iter();
        nodes.filter(|&node| scene.records[node as usize].trajectory == 3).count()
    };
    assert!(is_hidden(&first) > 20 && is_hidden(&second) == 0);
    let mut cpu = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::of(glyphs));
    assert!(differing(&second, &cpu.render(&scene, &held, &view).unwrap()) <= 1);
}

/// Large triangles, most of which lie one behind the other, in a large picture: no lane is given up.
#[test]
fn large_glyphs_are_drawn_whole() {
    let Some(gpu) = gpu::gpu() else { return };
    let mut random = Pcg64Mcg::seed_from_u64(71);
    let mut records = cloud::<Cuboid>(&mut random, 300, 1.0, [0.5, 0.9]);
    records.push(Cuboid::new([0.0; 3], [1.9, 1.8, 1.7]));
    let mut scene = Scene::new(records);
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(1)).unwrap();
    for distance in [2.6, 4.0, 6.0] {
        let eye = DVec3::new(0.7, 0.5, 0.3).normalize() * distance;
        let view = View::look_at(eye, DVec3::ZERO, DVec3::Z).unwrap();
        let view = view.with_size(1024, 768).unwrap();
        let picture = draws::<Cuboid>(gpu).render(&scene, &grid, &view).unwrap();
        let other = differing(&picture, &on_cpu(&scene, &grid, &view));
        println!("{other} of {} pixels differ", picture.id.len());
        assert!(other <= 7, "{other} of 786432 pixels");
    }
}

/// More large triangles in one brick than the device has room for: the CPU draws them. Whether there is
/// room for what is seen depends on the order.
#[test]
fn what_there_is_no_room_for_is_drawn() {
    let mut random = Pcg64Mcg::seed_from_u64(72);
    let mut records = cloud::<Cuboid>(&mut random, 20_000, 0.1, [0.5, 0.6]);
    let eye = Vec3::new(7.0, 5.0, 3.0);
    let distance = |cuboid: &Cuboid| Vec3::from(cuboid.center).distance(eye);
    records.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let bounds = Aabb { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
    let bricks = vec![Brick { records: 0..20_000, bounds, radius_max: 1.0, density: 1.0 }];
    let view = View::look_at(eye.as_dvec3(), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(192, 192).unwrap().with_perspective(0.05).unwrap();
    for nearest_first in [true, false] {
        let scene = Scene::new(records.clone());
        let mut cpu = Pipeline::new((), CpuRenderer::of(Cuboid::glyphs()));
        let expected = cpu.render(&scene, &bricks, &view).unwrap();
        for extent in [Extent::Full, Extent::Core] {
            let Some(gpu) = open(extent) else { return };
            let renderer = GpuRenderer::of(&gpu, Cuboid::glyphs(), GpuConfig::default()).unwrap();
            let mut pipeline = Pipeline::new((), renderer);
            let picture = pipeline.render(&scene, &bricks, &view).unwrap();
            assert_eq!(pipeline.renderer().missed_bricks(), 1);
            assert!(picture.covered_pixels() > 2000);
            let other = differing(&picture, &expected);
            assert!(other <= 1, "{extent:?}, {nearest_first}: {other} pixels differ");
        }
        records.reverse();
    }
}

/// A record of more triangles than a group of lanes may go through: the CPU draws it.
#[test]
fn records_of_very_many_triangles_are_drawn() {
    let Some(gpu) = gpu::gpu() else { return };
    let corner = |k: u32| {
        let (angle, radius) = (f64::from(k) / 120_000.0 * TAU, f64::from(9 + k % 2) * 0.1);
        [radius * angle.cos(), radius * angle.sin()]
    };
    let mut set = PolygonSet::default();
    set.push(&[(0..120_000).map(corner).collect::<Vec<_>>()], 0.0, 0.3).unwrap();
    set.push(&[[[-0.2, -0.2], [0.3, -0.2], [0.0, 0.2]]], 0.4, 0.1).unwrap();
    let glyphs = Glyphs::<Polygon>::new([]).with_table(set.table);
    let mut scene = Scene::new(set.records);
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(1)).unwrap();
    let view = View::look_at(DVec3::new(20.0, 10.0, 25.0), DVec3::ZERO, DVec3::Z).unwrap();
    let view = view.with_size(160, 120).unwrap().with_perspective(0.07).unwrap();
    let mut cpu = Pipeline::new((), CpuRenderer::of(glyphs.clone()));
    let expected = cpu.render(&scene, &grid, &view).unwrap();
    assert_eq!(expected.visible_records().len(), 2);
    let renderer = GpuRenderer::of(gpu, glyphs, GpuConfig::default()).unwrap();
    let mut pipeline = Pipeline::new((), renderer);
    let picture = pipeline.render(&scene, &grid, &view).unwrap();
    assert_eq!(pipeline.renderer().missed_bricks(), 1);
    let other = differing(&picture, &expected);
    assert!(other <= 1, "{other} of {} pixels", picture.id.len());
    // What was seen is drawn first now, and not without what is too much.
    let mut steps = pipeline.progressive(&scene, &grid, &view, 2).unwrap();
    steps.next().unwrap().unwrap();
    assert_eq!(differing(&steps.picture().unwrap(), &picture), 0);
}
