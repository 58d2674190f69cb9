/*!
Circles: their points, by turns, and how many chords they need.

An angle is given in turns: a quarter of a circle is 0.25. Reducing it to an eighth of a turn is exact
then, a full turn ends where it starts bit by bit, and arcs that share an angle share the point. The
accuracy that WGSL promises of `sin` and `cos` is 2⁻¹¹, so both twins use these polynomials instead
(those of Cephes, `sinf` and `cosf`); they are right to 2⁻²³.
*/

use glam::Vec2;
use std::f32::consts::FRAC_PI_2;

/// The point of the unit circle at an angle in turns, counterclockwise from (1, 0).
///
/// # Examples
///
/// ```
/// use glam::Vec2;
/// use puncta_avc::circle;
///
/// assert_eq!(circle(0.25), Vec2::Y);
/// assert_eq!(circle(-1.0), circle(3.0));
/// ```
#[must_use]
#[inline]
pub fn circle(turns: f32) -> Vec2 {
    let turns = turns - turns.floor();
    let quarter = (turns * 4.0 + 0.5).floor();
    let x = (turns * 4.0 - quarter) * FRAC_PI_2;
    let square = x * x;
    let sin =
        x + x * square * (-0.166_666_55 + square * (0.008_332_161 - square * 0.000_195_152_96));
    let cos = 1.0 - 0.5 * square
        + square
            * square
            * (0.041_666_646 + square * (-0.001_388_731_6 + square * 0.000_024_433_157));
    // It is 0 to 4.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is that small")]
    match quarter as u32 & 3 {
        0 => Vec2::new(cos, sin),
        1 => Vec2::new(-sin, cos),
        2 => Vec2::new(-cos, -sin),
        _ => Vec2::new(sin, -cos),
    }
}

#[cfg(test)]
mod tests {
    use super::circle;
    use glam::Vec2;
    use std::f64::consts::TAU;

    #[test]
    fn points_are_those_of_the_circle() {
        for step in -4096..=8192_i16 {
            let turns = f32::from(step) / 1000.0;
            let angle = f64::from(turns) * TAU;
            let found = circle(turns).as_dvec2();
            // Taking whole turns away rounds, unless there are none.
            let is_reduced = (0.0..=1.0).contains(&turns);
            let rounding = if is_reduced { 0.0 } else { TAU * f64::from(f32::EPSILON) };
            let slack = 1.7e-7 + rounding * f64::from(turns.abs().max(1.0));
            assert!((found.x - angle.cos()).abs() < slack, "{turns} {found}");
            assert!((found.y - angle.sin()).abs() < slack, "{turns} {found}");
        }
    }

    #[test]
    fn quarters_are_exact() {
        let quarters = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y, Vec2::X];
        for (turns, point) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().zip(quarters) {
            assert_eq!(circle(turns), point);
        }
    }
}
