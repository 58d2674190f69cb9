/*!
Shading of glyphs: from ids to an image.

A headlight alone shows the faces of a block alike that are seen at one angle. So half of the light that
has a direction comes from [`SUN`], which stands still in the world: `(1 + n.s) / 2` of it reaches a
surface with the normal `n`, also one that looks away from it. The directions to the faces of a box lie
so that any two that can be seen at once differ by a fifth of that light or more.

Each record that is seen becomes geometry again, once for each band of rows, and its facets are drawn
over the pixels that show it.
*/

use crate::{
    Error, Shading,
    image::{check, image, to_f32},
};
use glam::DVec3;
use puncta_avc::{Cloud, Facet, Glyph, Glyphs, Lens, Levels, Surface};
use puncta_core::{Bricks, Camera, Image, NO_RECORD, Picture, Scene, View};
use rayon::prelude::*;

/// The direction to the sun in the world, not of length 1: mostly above, which is along z.
const SUN: DVec3 = DVec3::new(0.0, -1.0, 2.0);

/// How much of the light that has a direction comes from the sun.
const SUN_SHARE: f64 = 0.5;

/// The share of light that has a direction, on a surface of which nothing can be said.
const ANY: f32 = 0.5;

/// How far around a pixel its record is looked for, in pixels: what renderers may be off, and more.
const AWAY: [f64; 3] = [2e-3, 0.1, 1.0];

/// How many rows of pixels are done together.
const ROWS: usize = 16;

/// Makes an image of a picture of glyphs in this scene.
///
/// The image has the size of `view`; `picture` has [`Shading::supersample`] times as many rows and
/// columns. `bricks` are those from which it was drawn: they say how finely each record was drawn. Of
/// several that hold a record the first one counts.
///
/// With the cosines `f` and `s` between the surface's normal and the ways to the eye and to a sun that
/// stands still in the world, a surface of color `c` shows
/// `c (ambient + (1 - ambient) (f / 2 + (1 + s) / 4))`.
///
/// # Errors
///
/// When the sizes do not go together, the picture is not one of this scene, or the scene lacks the
/// column to color by.
///
/// # Examples
///
/// See [`CpuRenderer::of`](crate::CpuRenderer::of).
#[expect(clippy::too_many_arguments, reason = "all of it is needed to know what a pixel shows")]
pub fn shade_glyphs<G: Glyph, B: Bricks + ?Sized>(
    glyphs: &Glyphs<G>,
    scene: &Scene<G>,
    bricks: &B,
    view: &View,
    picture: &Picture,
    shading: &Shading<'_>,
) -> Result<Image, Error> {
    let factor = check(scene, view, picture, shading)?;
    let fine = view.clone().with_size(picture.width, picture.height)?;
    let camera = Camera::new(&fine, scene.origin);
    let lens = Lens::new(&camera, glyphs.tolerance);
    let light =
        Light { camera: &camera, sun: camera.turn(SUN.normalize()), ambient: shading.ambient };
    let levels = Levels::new(&camera, bricks.bricks());
    let shares = shares(&glyphs.cloud(&scene.records), (&lens, light), &levels, picture);
    let width = picture.width as usize;
    let share = |column, row, _| shares[row * width + column];
    image(scene, (view, factor), picture, shading, share)
}

/// The share of light at each pixel of a picture that shows something.
fn shares<G: Glyph>(
    cloud: &Cloud<'_, G>,
    (lens, light): (&Lens<'_>, Light<'_>),
    levels: &Levels<'_>,
    picture: &Picture,
) -> Vec<f32> {
    let width = picture.width as usize;
    let mut shares = vec![0.0; picture.id.len()];
    let bands = shares.par_chunks_mut(width * ROWS).zip(picture.id.par_chunks(width * ROWS));
    bands.enumerate().for_each(|(band, (shares, ids))| {
        let depth = vec![f64::INFINITY; ids.len()];
        let mut band = Band { light, first_row: band * ROWS, width, ids, shares, depth };
        let mut surface = Surface::default();
        for pixels in pixels_by_id(ids).chunk_by(|a, b| a.0 == b.0) {
            let id = pixels[0].0;
            surface.fill(lens, cloud, id as usize, levels.of(id));
            band.shade(&surface, pixels, lens);
        }
    });
    shares
}

/// The pixels that show a record, by its id: ids and indices.
fn pixels_by_id(ids: &[u32]) -> Vec<(u32, u32)> {
    let pixels = ids.iter().copied().zip(0..).filter(|(id, _)| *id != NO_RECORD);
    let mut pixels: Vec<(u32, u32)> = pixels.collect();
    pixels.sort_unstable();
    pixels
}

/// Where light comes from.
#[derive(Clone, Copy, Debug)]
struct Light<'a> {
    camera: &'a Camera,
    /// In camera coordinates.
    sun: DVec3,
    ambient: f32,
}

impl Light<'_> {
    /// The share of light that reaches a surface with this normal, where the ray of a pixel meets it.
    fn share(&self, normal: DVec3, column: f64, row: f64) -> f32 {
        let back = if self.camera.is_perspective() {
            -self.camera.ray(column, row).extend(1.0).normalize()
        } else {
            DVec3::NEG_Z
        };
        self.mix(normal, normal.dot(back))
    }

    fn mix(&self, normal: DVec3, facing: f64) -> f32 {
        let sun = 0.5 + 0.5 * normal.dot(self.sun);
        let light = to_f32((1.0 - SUN_SHARE) * facing.clamp(0.0, 1.0) + SUN_SHARE * sun);
        self.ambient + (1.0 - self.ambient) * light
    }
}

/// Some rows of a picture.
#[derive(Debug)]
struct Band<'a> {
    light: Light<'a>,
    first_row: usize,
    width: usize,
    ids: &'a [u32],
    shares: &'a mut [f32],
    /// The depth of what was found at each pixel; +inf where nothing was.
    depth: Vec<f64>,
}

impl Band<'_> {
    /// Finds how much light reaches the pixels that show a record with this surface.
    fn shade(&mut self, surface: &Surface, pixels: &[(u32, u32)], lens: &Lens<'_>) {
        let Some(around) = self.around(pixels) else { return };
        for facet in surface.facets() {
            self.shade_facet(facet, pixels[0].0, around);
        }
        // Not all renderers have silhouettes in exactly the same place.
        for &(_, pixel) in pixels {
            let pixel = pixel as usize;
            if self.depth[pixel] == f64::INFINITY {
                let (column, row) = self.place(pixel);
                self.shares[pixel] = self.near(surface, lens, [column as f64, row as f64]);
            }
        }
    }

    /// The columns and rows around pixels, first and last.
    fn around(&self, pixels: &[(u32, u32)]) -> Option<[[i64; 2]; 2]> {
        let places = || pixels.iter().map(|(_, pixel)| self.place(*pixel as usize));
        let columns = || places().map(|(column, _)| column);
        let rows = || places().map(|(_, row)| row);
        Some([[columns().min()?, columns().max()?], [rows().min()?, rows().max()?]])
    }

    /// The column and the row of a pixel of these rows.
    const fn place(&self, pixel: usize) -> (i64, i64) {
        ((pixel % self.width) as i64, (self.first_row + pixel / self.width) as i64)
    }

    /// Finds how much light reaches a facet where it is the nearest one at a pixel of its record.
    fn shade_facet(&mut self, facet: &Facet, id: u32, [columns, rows]: [[i64; 2]; 2]) {
        let [width, height] = self.light.camera.size();
        let spans = facet.spans([width, height]);
        let [top, bottom] = spans.rows();
        let normal = facet.normal();
        for row in top.max(rows[0])..=bottom.min(rows[1]) {
            let [first, last] = spans.of(row as f64);
            let depths = facet.depth_of_row(row as f64);
            for column in first.max(columns[0])..=last.min(columns[1]) {
                let pixel = self.pixel(column, row);
                let depth = depths.at(column as f64);
                if self.ids[pixel] == id && depth < self.depth[pixel] {
                    self.depth[pixel] = depth;
                    self.shares[pixel] = self.light.share(normal, column as f64, row as f64);
                }
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "both are inside")]
    const fn pixel(&self, column: i64, row: i64) -> usize {
        (row as usize - self.first_row) * self.width + column as usize
    }

    /// How much light reaches a surface near a pixel that shows it, though it surely does not meet it
    /// there.
    fn near(&self, surface: &Surface, lens: &Lens<'_>, [column, row]: [f64; 2]) -> f32 {
        const AROUND: [[f64; 2]; 8] = [
            [1.0, 0.0],
            [-1.0, 0.0],
            [0.0, 1.0],
            [0.0, -1.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ];
        let places = AWAY.into_iter().flat_map(|away| AROUND.map(|[x, y]| [x * away, y * away]));
        let meeting = |[x, y]: [f64; 2]| surface.meet(lens, column + x, row + y);
        let found = places.into_iter().find_map(meeting);
        let unknown = self.light.ambient + (1.0 - self.light.ambient) * ANY;
        found.map_or(unknown, |found| self.light.mix(found.normal, found.facing))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coloring, CpuRenderer};
    use proptest::prelude::*;
    use puncta_avc::Cuboid;
    use puncta_core::Pipeline;
    use puncta_grid::{Grid, GridConfig};

    fn view(eye: DVec3, is_perspective: bool) -> View {
        let view = View::look_at(eye, DVec3::splat(0.01), DVec3::Z).unwrap();
        let view = view.with_size(61, 47).unwrap();
        if is_perspective { view } else { view.with_orthographic(3.0).unwrap() }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// Light is that of what each ray meets, also if a picture shows what no ray meets.
        #[test]
        fn shares_are_those_of_meetings(
            eye in [-3.0..3.0, -3.0..3.0, 0.1..3.0_f64],
            is_perspective in any::<bool>(),
            cuboids in prop::collection::vec(
                ([-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0], [0.01_f32..1.0, 0.01_f32..1.0, 0.01_f32..1.0]),
                1..40,
            ),
            shift in 0_usize..70,
        ) {
            let records: Vec<Cuboid> =
                cuboids.iter().map(|&(center, extent)| Cuboid::new(center, extent)).collect();
            let mut scene = Scene::new(records);
            let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(3)).unwrap();
            let view = view(DVec3::from(eye), is_perspective);
            let glyphs = Glyphs::<Cuboid>::new([]);
            let mut pipeline = Pipeline::new((), CpuRenderer::of(glyphs.clone()));
            let mut picture = pipeline.render(&scene, &grid, &view).unwrap();
            picture.id.rotate_right(shift);
            let camera = Camera::new(&view, scene.origin);
            let lens = Lens::new(&camera, glyphs.tolerance);
            let light = Light { camera: &camera, sun: camera.turn(SUN.normalize()), ambient: 0.1 };
            let levels = Levels::new(&camera, grid.bricks());
            let cloud = glyphs.cloud(&scene.records);
            let found = shares(&cloud, (&lens, light), &levels, &picture);
            let mut surface = Surface::default();
            for (pixel, &id) in picture.id.iter().enumerate() {
                if id == NO_RECORD {
                    continue;
                }
                let (column, row) = ((pixel % 61) as f64, (pixel / 61) as f64);
                surface.fill(&lens, &cloud, id as usize, levels.of(id));
                prop_assert!((0.1..=1.0).contains(&found[pixel]));
                match surface.meet(&lens, column, row) {
                    Some(met) => prop_assert_eq!(found[pixel], light.mix(met.normal, met.facing)),
                    None => prop_assert!(shift > 0),
                }
            }
        }
    }

    #[test]
    fn the_faces_of_a_box_differ_from_all_corners() {
        let mut scene = Scene::new(vec![Cuboid::new([0.0; 3], [1.0; 3])]);
        let grid = Grid::sort_scene(&mut scene, &GridConfig::default()).unwrap();
        let glyphs = Glyphs::<Cuboid>::new([]);
        for corner in 0..8 {
            let side = |axis: u32| if corner >> axis & 1 == 1 { 3.0 } else { -3.0 };
            let view = view(DVec3::new(side(0), side(1), side(2)), false);
            let mut pipeline = Pipeline::new((), CpuRenderer::of(glyphs.clone()));
            let picture = pipeline.render(&scene, &grid, &view).unwrap();
            let coloring = Coloring::Uniform([255; 3]);
            let shading = Shading { coloring, ..Shading::default() };
            let image = shade_glyphs(&glyphs, &scene, &grid, &view, &picture, &shading).unwrap();
            let seen = image.pixels.iter().zip(&picture.id).filter(|(_, id)| **id == 0);
            let mut reds: Vec<u8> = seen.map(|(pixel, _)| pixel[0]).collect();
            reds.sort_unstable();
            reds.dedup();
            assert_eq!(reds.len(), 3, "{reds:?}");
            assert!(reds.windows(2).all(|pair| pair[1] - pair[0] >= 10), "{reds:?}");
        }
    }
}
