/*!
Frames: two vectors across a direction.

After Duff, Burgess, Christensen, Hery, Kensler, Liani and Villemin, *Building an Orthonormal Basis,
Revisited*, JCGT 6(1), 2017: nothing is divided by a small number. On either side of the plane z = 0 the
frame turns smoothly with the direction; which side it is, the sign bit tells, and not a computation
that rounds.
*/

use crate::extent::largest;
use glam::Vec3;

/// Two vectors of length 1, across a direction and each other. In this order, with the direction as
/// the third, they are right-handed. The direction may have any length but zero.
#[inline]
pub(crate) fn frame(direction: Vec3) -> [Vec3; 2] {
    let scaled = direction / largest(direction);
    let unit = scaled / scaled.dot(scaled).sqrt();
    let sign = if direction.z.is_sign_negative() { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + unit.z);
    let b = unit.x * unit.y * a;
    [
        Vec3::new(1.0 + sign * unit.x * unit.x * a, sign * b, -sign * unit.x),
        Vec3::new(b, sign + unit.y * unit.y * a, -unit.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::frame;
    use glam::Vec3;
    use proptest::prelude::*;

    fn check(direction: Vec3) -> Result<(), TestCaseError> {
        let [right, up] = frame(direction).map(Vec3::as_dvec3);
        let along = direction.as_dvec3().normalize();
        for (a, b, product) in [
            (right, right, 1.0),
            (up, up, 1.0),
            (right, up, 0.0),
            (right, along, 0.0),
            (up, along, 0.0),
        ] {
            prop_assert!((a.dot(b) - product).abs() < 1e-6, "{direction} {} {product}", a.dot(b));
        }
        prop_assert!(right.cross(up).dot(along) > 0.999_999);
        Ok(())
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal(
            direction in [-1.0_f32..1.0, -1.0..1.0, -1.0..1.0],
            scales in [-18..18_i32, -18..18, -18..18],
        ) {
            let direction = Vec3::from(direction);
            prop_assume!(direction.length() > 1e-3);
            check(direction)?;
            let scaled = direction * Vec3::from(scales.map(|scale| 10.0_f32.powi(scale)));
            prop_assume!(scaled.abs().max_element() > 1e-18);
            check(scaled)?;
        }
    }

    #[test]
    fn directions_along_the_axes_have_frames() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for z in [0.0, -0.0] {
                check(axis + Vec3::Z * z).unwrap();
                check(-axis + Vec3::Z * z).unwrap();
            }
        }
        check(Vec3::new(1e-7, 0.0, -1.0)).unwrap();
        check(Vec3::new(1.0, 1.0, -1e-40)).unwrap();
    }
}
