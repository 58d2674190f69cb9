/*!
Records of close bricks, listed for shading by the CPU.

Bricks around the camera hold what `f32` cannot place, and spheres that the CPU draws. There are few of
them, so all their records that may be seen are listed with what the shader needs (`shade_common.wgsl`),
reckoned in `f64`; the GPU knows which of them are seen.

Let `c` be the centre, `r` the radius and `d` the direction of a ray. With `m = c x d / r` the cosine
between the normal and the way back is the root of `1 - m² / d²`, wherever the sphere lies. `m` is given
at a pixel that the sphere covers, or nearly so, where it is not larger than `d` is. It changes evenly from
pixel to pixel. So what is added in `f32` is about as large as the sum, and the sum as exact as `f32`.
*/

use crate::{paint::Paint, table::bound_of_sphere};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use puncta_core::{Camera, Content, Record, ScreenBound};
use rayon::prelude::*;

/// `Entry` of `shade_common.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Entry {
    m: [f32; 3],
    whole: u32,
    k: [f32; 3],
    color: u32,
}

/// The ids and entries of all records of some bricks that may be seen; spheres are at least so many
/// pixels large.
pub(crate) fn list<R: Record>(
    content: &Content<'_, R>,
    (camera, radius_min): (&Camera, f32),
    paint: &Paint<'_>,
    bricks: &[u32],
) -> (Vec<u32>, Vec<Entry>) {
    let records = |&brick: &u32| content.bricks[brick as usize].records.clone();
    let least = f64::from(radius_min) * camera.pixel_size();
    let entry = |index: u32| {
        let record = &content.scene.records[index as usize];
        let center = camera.place(record.position().as_dvec3());
        let mut radius = f64::from(record.radius());
        if radius > 0.0 {
            radius = radius.max(least * if camera.is_perspective() { center.z } else { 1.0 });
        }
        let bound = bound_of_sphere(camera, center, radius)?;
        let entry = Entry::new(camera, (center, radius), &bound, paint.word(index));
        Some((content.scene.id(index), entry))
    };
    bricks.par_iter().flat_map_iter(records).filter_map(entry).unzip()
}

impl Entry {
    fn new(
        camera: &Camera,
        (center, radius): (DVec3, f64),
        bound: &ScreenBound,
        color: u32,
    ) -> Self {
        let at = if !camera.is_perspective() {
            camera.pixel_of(center.truncate())
        } else if center.z > 0.0 {
            camera.pixel_of(center.truncate() / center.z)
        } else {
            DVec2::INFINITY
        };
        // In the bound; if the centre is not before the camera, somewhere in it.
        let within = |at: f64, [first, last]: [u16; 2]| {
            let (first, last) = (f64::from(first), f64::from(last));
            if at.is_finite() {
                at.round().clamp(first, last)
            } else {
                ((first + last) * 0.5).floor()
            }
        };
        let whole = DVec2::new(within(at.x, bound.columns), within(at.y, bound.rows));
        let ray = camera.ray(whole.x, whole.y);
        let (m, k) = if camera.is_perspective() {
            let m = center.cross(ray.extend(1.0));
            (DVec3::new(m.y, -m.x, m.z), center * camera.pixel_size())
        } else {
            ((ray - center.truncate()).extend(0.0), DVec3::Z * camera.pixel_size())
        };
        let whole = whole.as_uvec2();
        Self {
            m: (m / radius).as_vec3().to_array(),
            whole: whole.x | whole.y << 16,
            k: (k / radius).as_vec3().to_array(),
            color,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::assert_same_layout;
    use proptest::prelude::*;
    use puncta_core::View;

    #[test]
    fn an_entry_is_that_of_the_shaders() {
        let [.., (_, source)] = crate::shade_pass::SOURCES;
        assert_same_layout!(source, "Entry", Entry { m, whole, k, color });
    }

    /// As `light` of `shade.wgsl`.
    fn facing(camera: &Camera, entry: &Entry, pixel: [i32; 2]) -> f32 {
        let whole = [entry.whole & 0xffff, entry.whole >> 16].map(|side| side as i32);
        let by = [(pixel[0] - whole[0]) as f32, (pixel[1] - whole[1]) as f32];
        let [x, y, z] = entry.k;
        let turn = [z * by[0], -z * by[1], -(x * by[1] + y * by[0])];
        let m: f32 = entry.m.iter().zip(turn).map(|(m, turn)| (m + turn) * (m + turn)).sum();
        let ray = camera.ray(pixel[0].into(), pixel[1].into()).as_vec2();
        let step = if camera.is_perspective() { 1.0 } else { 0.0 };
        let a = 1.0 + step * ray.length_squared();
        ((a - m) / a).clamp(0.0, 1.0).sqrt()
    }

    proptest! {
        /// At whatever pixel, entries say how much a sphere faces the ray, as the camera does.
        #[test]
        fn entries_face_as_the_camera_says(
            center in prop::array::uniform3(-3.0_f64..3.0),
            depth in -2.0_f64..40.0,
            radius in 0.01_f64..4.0,
            orthographic in any::<bool>(),
            fov in 0.02_f64..2.0,
        ) {
            let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y).unwrap();
            let view = view.with_size(97, 61).unwrap().with_near(1e-3).unwrap();
            let view = if orthographic {
                view.with_orthographic(fov * 4.0).unwrap()
            } else {
                view.with_perspective(fov).unwrap()
            };
            let camera = Camera::new(&view, DVec3::ZERO);
            let center = DVec3::new(center[0], center[1], depth);
            let Some(bound) = bound_of_sphere(&camera, center, radius) else { return Ok(()) };
            let entry = Entry::new(&camera, (center, radius), &bound, 0);
            for row in 0..61 {
                for column in 0..97 {
                    let ray = camera.ray(column.into(), row.into());
                    if let Some(hit) = camera.hit(ray, center, radius) {
                        let found = f64::from(facing(&camera, &entry, [column, row]));
                        // At rims, where the square of the cosine is small, its root is less exact.
                        let error = (found * found - hit.facing * hit.facing).abs();
                        prop_assert!(error < 4e-6, "{} is not {}", found, hit.facing);
                    }
                }
            }
        }
    }
}
