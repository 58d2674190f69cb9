/*!
Normals from depths.

The inverse depth of a plane is linear over a perspective picture. So of the neighbors to the left and
to the right of a pixel, that is taken which goes on in a straight line and belongs to the same record;
the same above and below. Depths are right to some 2⁻²³, and neighboring rays are some 2⁻¹¹ apart, so
such a normal is right to a thousandth.
*/

use glam::{DVec3, Vec3};
use puncta::{NO_RECORD, Picture, View};

/// Which way to the neighbors: along a row, and along a column.
const WAYS: [[i64; 2]; 2] = [[1, 0], [0, 1]];

/// The outward normal in world coordinates of what a pixel shows. It faces the camera where the
/// neighbors do not tell.
pub(crate) fn normal(view: &View, picture: &Picture, column: u32, row: u32) -> Vec3 {
    let place = |column: i64, row: i64| -> Option<(u32, DVec3)> {
        let is_inside = (0..i64::from(picture.width)).contains(&column)
            && (0..i64::from(picture.height)).contains(&row);
        let at =
            is_inside.then(|| usize::try_from(row * i64::from(picture.width) + column).ok())??;
        let id = *picture.id.get(at).filter(|id| **id != NO_RECORD)?;
        Some((id, point(view, [column as f64, row as f64], picture.depth[at].into())))
    };
    let (column, row) = (i64::from(column), i64::from(row));
    let Some((id, here)) = place(column, row) else { return Vec3::ZERO };
    let step = |[x, y]: [i64; 2]| -> Option<DVec3> {
        let side = |sign: i64| {
            let at = |steps: i64| place(column + steps * sign * x, row + steps * sign * y);
            let (_, next) = at(1).filter(|(other, _)| *other == id)?;
            // How much the inverse depth bends; much if there is no telling.
            let bend = at(2).filter(|(other, _)| *other == id).map_or(1.0, |(_, after)| {
                let inverse = [here, next, after].map(|point| 1.0 / point.z);
                ((inverse[0] - 2.0 * inverse[1] + inverse[2]) * here.z).abs()
            });
            Some((bend, (next - here) * sign as f64))
        };
        let sides = [side(1), side(-1)].into_iter().flatten();
        sides.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, step)| step)
    };
    // In camera coordinates: right, up, forward. Rows run downwards.
    let found = match WAYS.map(step) {
        [Some(right), Some(down)] => right.cross(down).try_normalize(),
        _ => None,
    };
    let back = if view.is_perspective() { -here.normalize_or(DVec3::Z) } else { DVec3::NEG_Z };
    let normal = found.map_or(back, |normal| if normal.dot(back) < 0.0 { -normal } else { normal });
    (view.right() * normal.x + view.up() * normal.y + view.forward() * normal.z).as_vec3()
}

/// The place in camera coordinates of what a pixel shows.
pub(crate) fn point(view: &View, [column, row]: [f64; 2], depth: f64) -> DVec3 {
    let spread = if view.is_perspective() { depth } else { 1.0 };
    (view.ray(column, row) * spread).extend(depth)
}
