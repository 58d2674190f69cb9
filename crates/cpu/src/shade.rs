/*!
Shading: from ids to an image.

The light sits at the camera. With the cosine `f` between the surface's normal and the way back along
the ray, a surface of color `c` shows `c (ambient + (1 - ambient) f)`. Normals are computed again in
`f64` from the record and the pixel's ray, not from the depth, whose last digits would show.
*/

use crate::{
    Coloring, Error,
    image::{check, image, to_f32},
};
use puncta_core::{Background, Camera, Image, Picture, Record, Scene, View};

/// How to make an image of a picture.
#[derive(Clone, Debug)]
pub struct Shading<'a> {
    /// Where the colors of records come from.
    pub coloring: Coloring<'a>,
    /// What is seen where there is no record.
    pub background: Background,
    /// The share of light that reaches a surface from everywhere, 0 to 1.
    pub ambient: f32,
    /// How many pixels of the picture make one of the image, along each side.
    pub supersample: u32,
}

impl Default for Shading<'_> {
    fn default() -> Self {
        Self {
            coloring: Coloring::Uniform([196, 203, 212]),
            background: Background::default(),
            ambient: 0.18,
            supersample: 1,
        }
    }
}

/// Makes an image of a picture of the spheres of this scene.
///
/// The image has the size of `view`; `picture` has [`Shading::supersample`] times as many rows and
/// columns.
///
/// # Errors
///
/// When the sizes do not go together, the picture is not one of this scene, or the scene lacks the
/// column to color by.
pub fn shade<R: Record>(
    scene: &Scene<R>,
    view: &View,
    picture: &Picture,
    shading: &Shading<'_>,
) -> Result<Image, Error> {
    let factor = check(scene, view, picture, shading)?;
    let fine = view.clone().with_size(picture.width, picture.height)?;
    let camera = Camera::new(&fine, scene.origin);
    let records = scene.records.as_slice();
    let share = |column: usize, row: usize, id: u32| {
        let Some(record) = records.get(id as usize) else {
            return 0.0;
        };
        let center = camera.place(record.position().as_dvec3());
        let ray = camera.ray(column as f64, row as f64);
        let hit = camera.hit(ray, center, f64::from(record.radius()));
        // At a silhouette the surface is seen edge-on, whatever rounding says.
        let facing = hit.map_or(0.0, |hit| to_f32(hit.facing).clamp(0.0, 1.0));
        shading.ambient + (1.0 - shading.ambient) * facing
    };
    image(scene, (view, factor), picture, shading, share)
}
