/*!
The lattice: a crystal cut to a block around the origin, of touching atoms.

It is made of planes along z. A plane of the simple cubic crystal holds one atom for each cell, one
of the body-centred crystal too, and one of the face-centred crystal two; planes lie one, a half and
a half of a cell apart. The block is a cube, as nearly as whole cells go; where the last plane is
not full, it ends in a step.

Lengths are ångström with the default radius, that of copper (1.28) as a metal. z is up.
*/

use super::{
    Make, Row,
    random::{Random, cube_root, single, whole},
    spec::{Domain, Key, Kind, Spec},
};
use glam::DVec3;

pub(super) const KIND: Kind = Kind {
    name: "lattice",
    about: "a crystal of touching atoms, cut to a block, with its planes as a scalar",
    keys: &[
        Key::count("1000000"),
        Key::new("r", Domain::Length, "1.28", "radius of the atoms"),
        Key::derived("spacing", "2 r", |spec| 2.0 * spec.number("r"), "distance of neighbors"),
        Key::new("kind", Domain::Word(&["fcc", "bcc", "sc"]), "fcc", "Bravais lattice"),
        Key::new("jitter", Domain::Share, "0", "random displacement, as a share of the spacing"),
        Key::seed(),
    ],
};

/// A plane of the crystal, repeated and shifted.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The side of the cubic cell, in units of the distance of neighbors.
    side: f64,
    /// How far the planes are apart, in sides.
    plane_step: f64,
    /// The shift of every second plane along x and y, in sides.
    shift: f64,
    /// How many atoms a plane has for each cell.
    atoms: u64,
    /// The atomic number of a metal with this crystal.
    element: u8,
}

impl Cell {
    fn named(word: &str) -> Self {
        match word {
            // Polonium is the one element that is simple cubic.
            "sc" => Self { side: 1.0, plane_step: 1.0, shift: 0.0, atoms: 1, element: 84 },
            "bcc" => {
                let side = 2.0 / 3.0_f64.sqrt();
                Self { side, plane_step: 0.5, shift: 0.5, atoms: 1, element: 26 }
            }
            _ => {
                let side = 2.0_f64.sqrt();
                Self { side, plane_step: 0.5, shift: 0.5, atoms: 2, element: 29 }
            }
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Lattice {
    cell: Cell,
    /// The side of a cell.
    side: f64,
    /// How many cells a plane has along x, and along y.
    cells: u64,
    /// The index of the next atom.
    next: u64,
    /// The middle of the block, as seen from its first atom.
    middle: DVec3,
    jitter: f64,
    radius: f32,
    random: Random,
}

impl Lattice {
    pub(super) fn new(spec: &Spec) -> Self {
        let cell = Cell::named(spec.word("kind"));
        let side = cell.side * spec.number("spacing");
        let planes_per_cell = 1.0 / cell.plane_step;
        let all_cells = spec.count() as f64 / (cell.atoms as f64 * planes_per_cell);
        let cells = whole(cube_root(all_cells).round()).max(1);
        let planes = spec.count().div_ceil(cells * cells * cell.atoms);
        let across = (cells as f64 - 1.0 + 0.5 * (planes_per_cell - 1.0)) * 0.5;
        let up = (planes as f64 - 1.0) * cell.plane_step * 0.5;
        Self {
            cell,
            side,
            cells,
            next: 0,
            middle: DVec3::new(across, across, up) * side,
            jitter: spec.number("jitter") * spec.number("spacing"),
            radius: spec.radius(),
            random: Random::new(spec.seed(), 0),
        }
    }
}

impl Make for Lattice {
    const ELEMENTS: bool = true;
    const SCALAR: Option<&'static str> = Some("layer");

    #[inline]
    fn row(&mut self) -> Row {
        let per_plane = self.cells * self.cells * self.cell.atoms;
        let (plane, in_plane) = (self.next / per_plane, self.next % per_plane);
        let (site, atom) = (in_plane / self.cell.atoms, in_plane % self.cell.atoms);
        self.next += 1;
        let (column, line) = ((site % self.cells) as f64, (site / self.cells) as f64);
        // The second atom of a face-centred plane sits in the middle of the cell's face. Every
        // second plane is shifted: along x and y if body-centred, along x alone if face-centred.
        let middle = 0.5 * atom as f64;
        let shift = self.cell.shift * (plane % 2) as f64;
        let mut x = column + middle + shift;
        if self.cell.atoms == 2 && x >= column + 1.0 {
            x -= 1.0;
        }
        let y = line + middle + if self.cell.atoms == 1 { shift } else { 0.0 };
        let z = plane as f64 * self.cell.plane_step;
        let mut place = DVec3::new(x, y, z) * self.side - self.middle;
        if self.jitter > 0.0 {
            place += self.random.in_cube() * self.jitter;
        }
        Row {
            position: place.to_array().map(single),
            radius: self.radius,
            element: self.cell.element,
            value: plane as f32,
            ..Row::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::synthetic::Generator;
    use puncta_core::{Scene, Source};

    fn scene(spec: &str) -> Scene {
        let Ok(scene) = spec.parse::<Generator>().unwrap().into_scene();
        scene
    }

    /// In the bulk every atom has 6, 8 or 12 neighbors at the distance of two radii, and none
    /// nearer: that is what simple, body-centred and face-centred cubic mean.
    #[test]
    fn atoms_have_the_neighbors_of_their_crystal() {
        for (kind, neighbors, element) in [("sc", 6, 84), ("bcc", 8, 26), ("fcc", 12, 29)] {
            let scene = scene(&format!("lattice:n=3000,r=0.5,kind={kind}"));
            assert_eq!(scene.attributes.elements, Some(vec![element; 3000].into()));
            let nearest_to_origin = (0..3000)
                .min_by(|a, b| scene.position(*a).length().total_cmp(&scene.position(*b).length()))
                .unwrap();
            let center = scene.position(nearest_to_origin);
            assert!(center.length() < 1.0, "{kind} lies around {center}");
            let distances: Vec<f64> =
                (0..3000).map(|i| (scene.position(i) - center).length()).collect();
            let touching = distances.iter().filter(|d| (**d - 1.0).abs() < 1e-5).count();
            let nearer = distances.iter().filter(|d| **d < 1.0 - 1e-5).count();
            assert_eq!((touching, nearer), (neighbors, 1), "{kind}");
        }
    }

    #[test]
    fn a_block_is_near_a_cube_around_the_origin() {
        for kind in ["sc", "bcc", "fcc"] {
            let bounds = scene(&format!("lattice:n=100000,kind={kind}")).bounds();
            assert!(bounds.center().length() < 1e-3, "{kind}: {bounds:?}");
            let sides = bounds.extent();
            let ratio = sides.max_element() / sides.min_element();
            assert!(ratio < 1.06, "{kind}: sides {sides}");
        }
    }

    #[test]
    fn full_cubes_are_full() {
        // 4 atoms in each of 5 x 5 x 5 cells, and not one plane more.
        let scene = scene("lattice:n=500");
        let layers = &scene.scalar("layer").unwrap().values;
        assert_eq!(layers.iter().copied().fold(0.0, f32::max), 9.0);
        assert_eq!(layers.iter().filter(|layer| **layer == 9.0).count(), 50);
    }

    #[test]
    fn jitter_moves_atoms_by_a_share_of_the_spacing() {
        let (still, shaken) = (scene("lattice:n=1000"), scene("lattice:n=1000,jitter=0.1"));
        let moved = |i| (still.position(i) - shaken.position(i)).abs().max_element() / 2.56;
        let largest = (0..1000).map(moved).fold(0.0, f64::max);
        assert!((0.09..=0.1001).contains(&largest), "{largest}");
    }
}
