//! A scene whose values somebody else holds is used as one that owns them, and is not copied.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use puncta::{
    ColorMap, Coloring, CpuRenderer, Depth, FrustumCull, Grid, GridConfig, Picture, Pipeline,
    Scene, Shading, Source, View,
    core::{Attributes, Column, Scalar},
    io::{self, synthetic::Generator},
    shade,
};
use std::{fs, sync::Arc};

fn generated(spec: &str) -> Scene {
    let generator: Generator = spec.parse().unwrap();
    let Ok(scene) = generator.into_scene();
    scene
}

/// The same values in the same order, held by something that is no scene.
fn share<T: Clone + Send + Sync + 'static>(column: &Column<T>) -> Column<T> {
    Arc::<[T]>::from(column.to_vec()).into()
}

fn shared(scene: &Scene) -> Scene {
    let Attributes { ids, colors, elements, scalars } = &scene.attributes;
    let scalar = |s: &Scalar| Scalar { name: s.name.clone(), values: share(&s.values) };
    let attributes = Attributes {
        ids: ids.as_ref().map(share),
        colors: colors.as_ref().map(share),
        elements: elements.as_ref().map(share),
        scalars: scalars.iter().map(scalar).collect(),
    };
    Scene { origin: scene.origin, records: share(&scene.records), attributes }
}

/// For each column whether it is shared.
fn sharing(scene: &Scene) -> Vec<bool> {
    let Attributes { ids, colors, elements, scalars } = &scene.attributes;
    let mut all = vec![scene.records.is_shared()];
    all.extend(ids.iter().map(Column::is_shared));
    all.extend(colors.iter().map(Column::is_shared));
    all.extend(elements.iter().map(Column::is_shared));
    all.extend(scalars.iter().map(|scalar| scalar.values.is_shared()));
    all
}

fn view(scene: &Scene) -> View {
    let bounds = scene.inner_bounds(0.01);
    let eye = bounds.center() + DVec3::new(2.0, -1.5, 1.0) * bounds.extent().max_element();
    let view = View::look_at(eye, bounds.center(), DVec3::Z).unwrap();
    view.with_size(96, 64).unwrap().fitted(&bounds)
}

fn render(scene: &Scene, grid: &Grid) -> Picture {
    let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
    pipeline.render(scene, grid, &view(scene)).unwrap()
}

#[test]
fn shared_scenes_are_drawn_shaded_and_written_where_they_lie() {
    let folder = tempfile::tempdir().unwrap();
    let map = ColorMap::default();
    for spec in ["lattice:n=3000", "hall:n=3000", "halo:n=3000"] {
        let mut owned = generated(spec);
        let grid = Grid::sort_scene(&mut owned, &GridConfig::longest_side(7)).unwrap();
        let shared = shared(&owned);
        assert!(shared == owned, "{spec}");
        let picture = render(&shared, &grid);
        assert!(picture.covered_pixels() > 100, "{spec}");
        assert!(picture == render(&owned, &grid), "{spec}");

        let name = owned.attributes.scalars[0].name.clone();
        let scalar = Coloring::Scalar { name: &name, map: &map, range: None };
        let palette = [[200, 10, 10], [10, 200, 10]];
        let colorings = [scalar, Coloring::Colors, Coloring::Elements(&palette)];
        for coloring in colorings.into_iter().filter(|coloring| coloring.check(&owned).is_ok()) {
            let shading = Shading { coloring, ..Shading::default() };
            let image = |scene| shade(scene, &view(&owned), &picture, &shading).unwrap();
            assert!(image(&shared) == image(&owned), "{spec}");
        }

        for ending in ["ply", "xyz", "mmpld"] {
            let path = |name| folder.path().join(format!("{name}.{ending}"));
            io::write(path("shared"), &shared).unwrap();
            io::write(path("owned"), &owned).unwrap();
            let bytes = |name| fs::read(path(name)).unwrap();
            assert!(bytes("shared") == bytes("owned"), "{spec} as {ending}");
        }
        assert!(sharing(&shared).iter().all(|is_shared| *is_shared), "{spec}");
    }
}

#[test]
fn a_sort_copies_what_is_shared_and_leaves_the_holder_alone() {
    let owned = generated("lattice:n=3000,jitter=0.1");
    let held = shared(&owned);
    let (mut one, mut two) = (owned.clone(), held.clone());
    let config = GridConfig::longest_side(5);
    let grids = [&mut one, &mut two].map(|scene| Grid::sort_scene(scene, &config).unwrap());
    assert_eq!(grids[0], grids[1]);
    assert!(one == two);
    assert!(one.records != owned.records, "the sort had nothing to do");
    assert!(sharing(&two).iter().all(|is_shared| !is_shared));
    assert!(held == owned);
}
