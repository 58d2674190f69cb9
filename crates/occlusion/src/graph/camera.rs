/*!
The camera among the cells of a grid, in whole numbers.

In index space a cell is a unit cube: a position is `(position - corner) * scale`, so that its whole
part is the index of its cell. The outermost cells of a grid may reach further than that to hold
what lies far away. Here they are unit cubes as well, as if what they hold lay at the edge of the
grid. That may put a brick of such a cell a little too early or too late into an order; no picture
hangs on it.

Coordinates are fixed point, in units of 2^-17 cell. The planes between cells and the centers of
sides are even numbers of units. The camera is brought to an odd one: half of it, rounded down,
times two, plus one. So it never lies on a plane between cells nor straight above the center of a
side, and a camera that does counts to the upper cell. Whatever is decided by comparing has an
answer then.

Parallel rays have a direction instead, in 2^-40 of its largest coordinate. A camera that is more
than 2^40 cells away, where neighboring rays differ by less than a unit, is taken for one.
*/

use glam::DVec3;
use puncta_core::View;
use puncta_grid::Cells;

/// The bits of a coordinate that tell the place within a cell.
const FRACTION: u32 = 17;

/// The distance in cells from which on rays are parallel.
const FAR: f64 = (1_u64 << 40) as f64;

/// Where all rays lead to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Camera {
    /// A point; its coordinates are odd and less than 2^58.
    At([i64; 3]),
    /// The direction of all rays; its coordinates are at most 2^40.
    Along([i64; 3]),
}

impl Camera {
    /// The camera of a view onto cells that are relative to `origin`.
    pub(crate) fn new(cells: &Cells, view: &View, origin: DVec3) -> Self {
        if !view.is_perspective() {
            return Self::along(-view.forward());
        }
        let corner = cells.corner().as_dvec3();
        let place = ((view.eye() - origin) - corner) * f64::from(cells.scale());
        if place.abs().max_element() < FAR {
            Self::At(place.to_array().map(odd))
        } else {
            // A quarter of each cannot be beyond all numbers.
            Self::along((view.eye() * 0.25 - origin * 0.25) - corner * 0.25)
        }
    }

    /// Parallel rays along any vector that has a length.
    fn along(vector: DVec3) -> Self {
        let scaled = vector / vector.abs().max_element() * FAR;
        Self::Along(scaled.to_array().map(whole))
    }

    /// The cell that holds the camera, if it is a point.
    pub(crate) fn cell(&self) -> Option<[i64; 3]> {
        match self {
            Self::At(place) => Some(place.map(|coordinate| coordinate >> FRACTION)),
            Self::Along(_) => None,
        }
    }

    /// The cell that is nearest to the camera. Along each axis, every ray gets nearer to it or
    /// stays.
    pub(crate) fn nearest(&self, dims: [u32; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| {
            let last = dims[axis].saturating_sub(1);
            let nearest = match self {
                Self::At(place) => place[axis] >> FRACTION,
                Self::Along(direction) => direction[axis].signum() * i64::from(last),
            };
            u32::try_from(nearest.max(0)).unwrap_or(last).min(last)
        })
    }

    /// The indices of cells from which the camera is seen upwards along an axis, and downwards:
    /// those below the first number, and those above the second one.
    pub(crate) fn bounds(&self, axis: usize) -> [i64; 2] {
        match self {
            Self::At(place) => [place[axis] >> FRACTION; 2],
            Self::Along(direction) => match direction[axis].signum() {
                1 => [i64::MAX; 2],
                0 => [i64::MIN, i64::MAX],
                _ => [i64::MIN; 2],
            },
        }
    }

    /// The way from the center of a side of a cell to the camera, below 2^59 along each axis.
    ///
    /// The side is normal to `axis`, in the direction of `step`.
    #[inline(always)]
    pub(crate) fn way(&self, cell: [i64; 3], axis: usize, step: i64) -> [i64; 3] {
        match self {
            Self::At(place) => {
                let mut way = std::array::from_fn(|i| {
                    place[i] - ((cell[i] << FRACTION) + (1 << (FRACTION - 1)))
                });
                way[axis] -= step << (FRACTION - 1);
                way
            }
            Self::Along(direction) => *direction,
        }
    }
}

/// The odd number of units that is nearest to a number of cells, the upper one of two.
fn odd(cells: f64) -> i64 {
    let half = whole((cells * f64::from(1 << (FRACTION - 1))).floor());
    2 * half + 1
}

/// A number as a whole one; those here are below 2^57.
fn whole(number: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "the range is small")]
    let whole = number.round() as i64;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use puncta_core::Sphere;
    use puncta_grid::{Grid, GridConfig};

    fn cells() -> Cells {
        let mut corners = [Sphere::new([0.0; 3], 0.0), Sphere::new([8.0; 3], 0.0)];
        Grid::sort(&mut corners, &GridConfig::longest_side(8)).unwrap().cells().clone()
    }

    fn camera(eye: DVec3, origin: DVec3) -> Camera {
        let view = View::look_at(eye, origin, DVec3::Z).unwrap();
        Camera::new(&cells(), &view, origin)
    }

    #[test]
    fn a_camera_on_a_plane_counts_to_the_upper_cell() {
        let below = 3.0 - f64::EPSILON * 2.0;
        let camera = camera(DVec3::new(3.0, below, 3.5), DVec3::ZERO);
        let half = 1 << (FRACTION - 1);
        assert_eq!(camera, Camera::At([6 * half + 1, 6 * half - 1, 7 * half + 1]));
        assert_eq!(camera.cell(), Some([3, 2, 3]));
        assert_eq!(camera.bounds(0), [3, 3]);
        assert_eq!(camera.way([2, 3, 3], 0, 1), [1, -half - 1, 1]);
    }

    #[test]
    fn a_scene_far_from_the_origin_is_the_same() {
        let shift = DVec3::new(1e7, -3e7, 1e7);
        let eye = DVec3::new(3.25, -5.5, 99.0);
        assert_eq!(camera(eye + shift, shift), camera(eye, DVec3::ZERO));
    }

    #[test]
    fn a_camera_far_away_is_a_direction() {
        let near = camera(DVec3::new(-1e12, 1e12, 4.0), DVec3::ZERO);
        assert_eq!(near.cell(), Some([-1_000_000_000_000, 1_000_000_000_000, 4]));
        for far in [2e12, 1e300] {
            let camera = camera(DVec3::new(-far, far, 0.5 * far), DVec3::ZERO);
            assert_eq!(camera, Camera::Along([-(1 << 40), 1 << 40, 1 << 39]), "{far}");
            assert_eq!(camera.nearest([8, 7, 1]), [0, 6, 0]);
        }
        let view = View::look_at(DVec3::splat(1e308), DVec3::ZERO, DVec3::Z).unwrap();
        let split = Camera::new(&cells(), &view, DVec3::splat(f64::MIN));
        assert_eq!(split, Camera::Along([1 << 40; 3]));
    }

    #[test]
    fn parallel_rays_come_from_behind_the_picture() {
        let view = View::look_at(DVec3::ZERO, DVec3::NEG_Y, DVec3::Z).unwrap();
        let camera = Camera::new(&cells(), &view.with_orthographic(1.0).unwrap(), DVec3::ZERO);
        assert_eq!(camera, Camera::Along([0, 1 << 40, 0]));
        assert_eq!([0, 1].map(|axis| camera.bounds(axis)), [[i64::MIN, i64::MAX], [i64::MAX; 2]]);
    }
}
