//! The pixels that closed solids must cover: every ray that meets any of their triangles.

use super::{Pixels, RUN, Ray, Solid, rays, triangles};
use glam::{DVec3, Vec4};
use puncta::{
    Brick, Glyph, Glyphs, Scene, View,
    avc::{Lens, Levels, Mesh, Sight},
    core::Camera,
};
use rayon::prelude::*;

/// Pixels that records must cover, as finely as they are drawn: `None` where that hangs on a hair. All of
/// their triangles count, whatever side of them is seen, and those that are left out because they surely
/// are not.
///
/// Checks on the way that each record is closed and looks outwards.
pub(crate) fn footprint<G: Glyph>(
    glyphs: &Glyphs<G>,
    scene: &Scene<G>,
    bricks: &[Brick],
    (view, hair): (&View, Pixels),
) -> Vec<Option<bool>> {
    let camera = Camera::new(view, scene.origin);
    let lens = Lens::new(&camera, glyphs.tolerance);
    let cloud = glyphs.cloud(&scene.records);
    let levels = Levels::new(&camera, bricks);
    let place = scene.origin - view.eye();
    let solid = |index: usize| -> Vec<[DVec3; 3]> {
        let level = levels.of(u32::try_from(index).unwrap());
        let position = scene.records[index].position();
        // From everywhere: nothing is left out.
        let sight = lens.sight(position, lens.nearest(level, &cloud, index));
        let form = G::form(&cloud, index, &Sight { eye: Vec4::ZERO, ..sight });
        Mesh::of::<G>(&form).check().unwrap();
        triangles::<G>(&form, position.as_dvec3(), G::ball(&cloud, index))
    };
    let moved = |triangle: [DVec3; 3]| triangle.map(|corner| place + corner);
    let triangles = (0..scene.records.len()).flat_map(solid).map(moved).collect();
    let all = Solid { id: 0, triangles };
    let row = |row: u32| -> Vec<Option<bool>> {
        let triangles = all.of_row(view, row, hair);
        let pixel = |column: u32| {
            let covers = |ray: Ray| {
                let near = &triangles[(column / RUN) as usize];
                let mut meets = near.iter().filter_map(|&triangle| ray.meet(triangle));
                meets.any(|(depth, _)| depth >= view.near())
            };
            let covered = rays(view, (column, row), hair).map(covers);
            covered.iter().all(|&is| is == covered[0]).then_some(covered[0])
        };
        (0..view.width()).map(pixel).collect()
    };
    (0..view.height()).into_par_iter().flat_map_iter(row).collect()
}
