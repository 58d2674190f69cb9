/*!
The origin of a scene: near the data, and so that nothing is lost.

A stored position is an `f32` offset from the origin, with an error of 2⁻²⁴ of its length; so the
origin must lie near the data, but not so that it spoils numbers which `f32` holds exactly. Let `c`
be the centre and `e` the longest side of the data's box. On each axis the origin is 0 where
`|c| <= 1.5 e`, else `c` rounded to a multiple of `s`, the largest power of two up to `e`. Then

* offsets are at most `2 e` long, and
* if a coordinate `p` is an `f32`, so is `p - origin`: it is a multiple of `ulp(p)` and at most
  `e / 2 + s / 2 <= 1.5 s`, while `|p| >= e >= s`, so `|p - origin| / ulp(p) <= 1.5 * 2^23 < 2^24`.

Rows of single precision are stored as they are and moved to the origin at the end, exactly. Rows of
double precision must know the origin at once: the first ones wait until there are enough to choose
it. It lies among the data, so offsets are at most some 3 `e` long even if these rows tell little of
the rest. For them the box leaves out one in a hundred rows at each end of an axis: a few strays must
not take the digits from all the others.
*/

use glam::DVec3;
use puncta_core::inner_range;

/// The share of rows of double precision that may be strays, at either end of an axis.
pub(super) const STRAYS: f64 = 0.01;

/// The origin for these positions, of which a share at either end of an axis may be strays: see the
/// module's text.
pub(super) fn choose<I: Iterator<Item = [f64; 3]>>(
    positions: impl Fn() -> I,
    strays: f64,
) -> DVec3 {
    let along = |axis: usize| inner_range(|| positions().map(|position| position[axis]), strays);
    let [x, y, z] = [along(0), along(1), along(2)];
    of_box(DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]))
}

/// The origin for a box without strays.
pub(super) fn of_box(min: DVec3, max: DVec3) -> DVec3 {
    let (center, extent) = (min + (max - min) * 0.5, (max - min).max_element());
    // Points that coincide have no extent: their position itself is the best origin.
    if extent == 0.0 {
        return center;
    }
    let step = extent.log2().floor().exp2();
    let round = |c: f64| match (c / step).round() * step {
        _ if c.abs() <= 1.5 * extent => 0.0,
        rounded if rounded.is_finite() => rounded,
        // The step is so small beside `c` that the quotient overflows.
        _ => c,
    };
    DVec3::new(round(center.x), round(center.y), round(center.z))
}
