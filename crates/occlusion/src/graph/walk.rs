/*!
The walk of a ray over cells, from the center of a side of a brick towards the camera.

This is the walk of Amanatides and Woo (*A Fast Voxel Traversal Algorithm for Ray Tracing*, 1987) in
whole numbers, arranged so that no step hangs on a branch.

Let `d` be the way to the camera, without signs, and `a` the distance from the start to the next
plane between cells along each axis, in half cells. The ray crosses the plane of an axis `i` at
`a_i / d_i` of the way. Which of two planes comes first is told by the sign of

```text
E_ij = a_i d_j - a_j d_i
```

If both are crossed at once, the axis of the lower index is first. So if `i < j`, the plane of `i`
is first if `E_ij <= 0`, that is, if `E_ij - 1` is negative. After a step along `i`, `a_i` is larger
by two half cells, and `E_ij` by `2 d_j`.

Let `w` be the axis along which the way is longest. Between two of its planes, a ray crosses at most
one plane of each other axis. So the walk goes from plane to plane of `w`. For each other axis `u`,
the sign of `E_uw` tells whether one of its planes is in between; if both have one, `E_uv` tells
which is first. Signs become masks, masks become steps, and the three cells are tested together.

No number is too large: the planes next to each other in the order of the walk are never further
apart than two half cells along one axis, so that `|E_ij| <= 2 d_i + 2 d_j + 1`, where `d < 2^59`.

A ray always ends: it enters the cell of the camera or leaves the grid, and both are marked.
*/

use crate::graph::{
    AWAY, CAMERA,
    address::{NOWHERE, stepped},
    camera::Camera,
    occupancy::Occupancy,
};

/// All rays to a camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays<'a> {
    occupancy: &'a Occupancy,
    camera: &'a Camera,
    /// For each axis, the parts of addresses below the first and above the second one see the
    /// camera.
    bounds: [[i64; 2]; 3],
}

impl<'a> Rays<'a> {
    /// The rays between the cells that hold bricks.
    pub(crate) fn new(occupancy: &'a Occupancy, camera: &'a Camera, dims: [u32; 3]) -> Self {
        let part = |axis: usize, index: i64| match u32::try_from(index) {
            Ok(index) if index < dims[axis] => occupancy.axes().part(axis, index).cast_signed(),
            _ if index < 0 => i64::MIN,
            _ => i64::MAX,
        };
        let bounds = |axis: usize| camera.bounds(axis).map(|index| part(axis, index));
        Self { occupancy, camera, bounds: std::array::from_fn(bounds) }
    }

    /// What the rays from the sides of a brick meet first; a side is normal to each axis.
    #[inline(always)]
    pub(crate) fn edges(&self, address: u64) -> [u32; 3] {
        let mut edges = [AWAY; 3];
        if address == NOWHERE {
            return edges;
        }
        let axes = self.occupancy.axes();
        for (axis, edge) in edges.iter_mut().enumerate() {
            let part = address & axes.mask(axis);
            let [up, down] = self.bounds[axis];
            let step = i64::from(part.cast_signed() < up) - i64::from(part.cast_signed() > down);
            if step != 0 {
                let beyond = stepped(part, axes.delta(axis, step), axes.mask(axis));
                let met = self.occupancy.met(address ^ part ^ beyond);
                *edge = met.unwrap_or_else(|| self.walk_from(address, axis, step));
            }
        }
        // A brick of which no side faces the camera holds it.
        if edges == [AWAY; 3] { [CAMERA; 3] } else { edges }
    }

    /// What the ray from a side meets, if the cell beyond it is empty.
    fn walk_from(&self, address: u64, side: usize, step: i64) -> u32 {
        let axes = self.occupancy.axes();
        let mut parts = [0, 1, 2].map(|axis| address & axes.mask(axis));
        parts[side] = stepped(parts[side], axes.delta(side, step), axes.mask(side));
        walk(self.occupancy, self.camera.way(axes.cell(address), side, step), parts, side)
    }
}

/// Walks on from the cell beyond a side, which is empty; gives what is met.
fn walk(occupancy: &Occupancy, way: [i64; 3], parts: [u64; 3], side: usize) -> u32 {
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
    let gaps = [u, v, w].map(|axis| !axes.mask(axis));
    let deltas = [u, v, w].map(|axis| axes.delta(axis, way[axis]));
    // Parts of addresses with ones in the gaps between their bits: they hand a carry on.
    let [mut at_u, mut at_v, mut at_w] =
        [parts[u] | gaps[0], parts[v] | gaps[1], parts[w] | gaps[2]];
    loop {
        // All ones where a plane of the axis is before that of `w`.
        let (is_u, is_v) = (u_w >> 63, v_w >> 63);
        let next_u = at_u.wrapping_add(deltas[0] & is_u.cast_unsigned()) | gaps[0];
        let next_v = at_v.wrapping_add(deltas[1] & is_v.cast_unsigned()) | gaps[1];
        let next_w = at_w.wrapping_add(deltas[2]) | gaps[2];
        // If there is only one plane in between, this may be the cell where the ray is.
        let one = at_w & if u_v < 0 { next_u & at_v } else { at_u & next_v };
        let two = next_u & next_v & at_w;
        let three = next_u & next_v & next_w;
        if occupancy.ends(one) | occupancy.ends(two) | occupancy.ends(three) {
            let met = [one, two, three].into_iter().find_map(|address| occupancy.met(address));
            return met.unwrap_or(CAMERA);
        }
        (at_u, at_v, at_w) = (next_u, next_v, next_w);
        u_w += (dw & is_u) - du;
        v_w += (dw & is_v) - dv;
        u_v += (dv & is_u) - (du & is_v);
    }
}
