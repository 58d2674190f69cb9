/*!
The walk of a ray over cells, from the center of a side of a brick towards the camera.

This is the walk of Amanatides and Woo (*A Fast Voxel Traversal Algorithm for Ray Tracing*, 1987) in
whole numbers, arranged so that no step hangs on a branch.

Let `d` be the way to the camera, without signs, and `a` the distance from the start to the next plane
between cells along each axis, in half cells. The ray crosses the plane of an axis `i` at `a_i / d_i`
of the way. Which of two planes comes first is told by the sign of

```text
E_ij = a_i d_j - a_j d_i
```

If both are crossed at once, the axis of the lower index is first. So if `i < j`, the plane of `i` is
first if `E_ij <= 0`, that is, if `E_ij - 1` is negative. After a step along `i`, `a_i` is larger by
two half cells, and `E_ij` by `2 d_j`.

Let `w` be the axis along which the way is longest. Between two of its planes, a ray crosses at most
one plane of each other axis. So the walk goes from plane to plane of `w`. For each other axis `u`,
the sign of `E_uw` tells whether one of its planes is in between; if both have one, `E_uv` tells which
is first. Signs become masks, masks become steps, and the three cells are tested together.

No number is too large: the planes next to each other in the order of the walk are never further apart
than two half cells along one axis, so that `|E_ij| <= 2 d_i + 2 d_j + 1`, where `d < 2^59`.

A ray always ends: it enters the cell of the camera or leaves the box of the bricks in play, and both
are marked.
*/

use crate::graph::{
    AWAY, CAMERA,
    camera::Camera,
    occupancy::{NOWHERE, Occupancy, stepped},
};

/// What the rays from the sides of a brick meet first; a side is normal to each axis.
#[inline]
pub(crate) fn edges(occupancy: &Occupancy, camera: &Camera, place: [u32; 3]) -> [u32; 3] {
    if place == NOWHERE {
        return [AWAY; 3];
    }
    let axes = occupancy.axes();
    let parts = axes.parts(place);
    let steps: [i64; 3] = std::array::from_fn(|axis| camera.step(axis, place[axis]));
    if steps == [0; 3] {
        return [CAMERA; 3];
    }
    std::array::from_fn(|axis| {
        if steps[axis] == 0 {
            return AWAY;
        }
        let mut parts = parts;
        parts[axis] = stepped(parts[axis], axes.delta(axis, steps[axis]), axes.mask(axis));
        let address = parts[0] | parts[1] | parts[2];
        if occupancy.ends(address) {
            occupancy.met(address)
        } else {
            walk(occupancy, camera.way(place, axis, steps[axis]), parts, axis)
        }
    })
}

/// Walks on from the cell beyond a side, which is empty; gives what is met.
fn walk(occupancy: &Occupancy, way: [i64; 3], mut parts: [u64; 3], side: usize) -> u32 {
    let axes = occupancy.axes();
    let d = way.map(i64::abs);
    // The longest axis, and the two others in ascending order.
    let (w, u, v) = match (d[0] >= d[1], d[0] >= d[2], d[1] >= d[2]) {
        (true, true, _) => (0, 1, 2),
        (false, _, true) => (1, 0, 2),
        _ => (2, 0, 1),
    };
    // From the center of the side to the next plane, in half cells.
    let ahead = |axis: usize| if axis == side { 2 } else { 1 };
    let first = |i: usize, j: usize| ahead(i) * d[j] - ahead(j) * d[i] - i64::from(i < j);
    let (mut u_w, mut v_w, mut u_v) = (first(u, w), first(v, w), first(u, v));
    let (du, dv, dw) = (2 * d[u], 2 * d[v], 2 * d[w]);
    let masks = [u, v, w].map(|axis| axes.mask(axis));
    let deltas = [u, v, w].map(|axis| axes.delta(axis, way[axis]));
    parts = [parts[u], parts[v], parts[w]];
    loop {
        // All ones where a plane of the axis is before that of `w`.
        let (is_u, is_v) = (u_w >> 63, v_w >> 63);
        let u_is_first = u_v >> 63;
        let (first_u, first_v) = (is_u & u_is_first, is_v & !u_is_first);
        let step = |index: usize, mask: i64| {
            stepped(parts[index], deltas[index] & mask.cast_unsigned(), masks[index])
        };
        // If there is only one plane in between, this may be the cell where the ray is.
        let one = step(0, first_u) | step(1, first_v) | parts[2];
        let (next_u, next_v) = (step(0, is_u), step(1, is_v));
        let two = next_u | next_v | parts[2];
        let next_w = step(2, -1);
        let three = next_u | next_v | next_w;
        let ends = [one, two, three].map(|address| occupancy.ends(address));
        if ends[0] | ends[1] | ends[2] {
            let last = if ends[0] {
                one
            } else if ends[1] {
                two
            } else {
                three
            };
            return occupancy.met(last);
        }
        parts = [next_u, next_v, next_w];
        u_w += (dw & is_u) - du;
        v_w += (dw & is_v) - dv;
        u_v += (dv & is_u) - (du & is_v);
    }
}
