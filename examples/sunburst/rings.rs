/*!
Rings, and turns cut into parts.

Rings become narrower outwards, so that there is room for any depth.
*/

/// The radius of the whole.
pub(crate) const RADIUS: f64 = 500.0;

/// The radius of the disc in the middle, which is the folder itself.
const MIDDLE: f64 = 90.0;

/// How wide a ring is, by that within it.
const NARROWING: f64 = 0.87;

/// The inner and outer radius of the middle and of each ring around it.
pub(crate) fn rings(levels: usize) -> Vec<[f64; 2]> {
    let widths: Vec<f64> =
        std::iter::successors(Some(1.0), |width| Some(width * NARROWING)).take(levels).collect();
    let sum: f64 = widths.iter().sum();
    let mut rings = vec![[0.0, MIDDLE]];
    let mut inner = MIDDLE;
    for width in widths {
        let outer = inner + width / sum * (RADIUS - MIDDLE);
        rings.push([inner, outer]);
        inner = outer;
    }
    rings
}

/// Cuts a part of a turn into parts in proportion to bytes.
pub(crate) fn shares([from, to]: [f64; 2], bytes: &[u64]) -> Vec<[f64; 2]> {
    let all: u64 = bytes.iter().sum();
    let mut before = 0;
    let mut at = |bytes: u64| {
        before += bytes;
        from + (to - from) * (before as f64 / all.max(1) as f64)
    };
    let mut start = from;
    bytes.iter().map(|&bytes| [std::mem::replace(&mut start, at(bytes)), start]).collect()
}
