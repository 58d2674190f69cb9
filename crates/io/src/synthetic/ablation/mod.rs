/*!
The ablation: a metal block that a laser pulse has struck, a moment later.

It is built in the manner of molecular dynamics of laser ablation, where the same parts appear (for
instance Wu and Zhigilei, *Microscopic mechanisms of laser spallation and ablation of metal targets
from large-scale molecular dynamics simulations*, Applied Physics A 114, 2014). From below:

* the block, a face-centred cubic crystal, disordered where it is molten; the pulse has left a
  crater with a raised rim, bubbles in the melt below it and a pressure wave running into the
  crystal. A quarter of block and front is cut away to show them (`cut=none` keeps it);
* jets from the rim and the floor that break up into droplets, whose sizes follow a power law;
* vapor: single atoms, fewer and faster further up;
* the front: a torn, mushroom-shaped sheet of hot, dense matter that rolls up at its brim.

Units: the block reaches from -1 to 1 along x and y, and its surface is z = 0; z is up. Every length
but those of the atoms is the same for any `n`: more atoms draw the same event more finely. So the
default radius shrinks with the cube root of `n`, and vapor and front, which one looks through or
at, get as many atoms as cover the same area. Nine in ten atoms are in the block. The `temperature`
is in kelvin: 300 in the cold block, some 3000 at the crater, 2000 to 3500 in droplets, around 4000
in vapor and up to 6000 in the front.
*/

mod plume;
mod target;

use super::{
    Make, Row,
    random::{Random, cube_root, single, whole},
    spec::{Domain, Key, Kind, Spec},
};
use glam::DVec3;
use plume::Plume;
use target::{Crystal, Target};

pub(super) const KIND: Kind = Kind {
    name: "ablation",
    about: "a metal block struck by a laser pulse: crater, bubbles, droplets, vapor and front",
    keys: &[
        Key::count("1000000"),
        Key::derived(
            "r",
            "0.9 / cbrt(n)",
            |spec| 0.9 / cube_root(spec.number("n")),
            "radius of the atoms",
        ),
        Key::new("cut", Domain::Word(&["quarter", "none"]), "quarter", "what to cut away"),
        Key::seed(),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Ablation {
    target: Target,
    crystal: Crystal,
    vapor_left: u64,
    plume: Plume,
    radius: f32,
    random: Random,
}

/// An atom of some part.
#[derive(Clone, Copy, Debug)]
struct Atom {
    place: DVec3,
    temperature: f64,
}

impl Ablation {
    pub(super) fn new(spec: &Spec) -> Self {
        let n = spec.count() as f64;
        let target = Target::new(spec.seed(), spec.word("cut") == "quarter");
        let mut plume = Plume::new(spec.seed(), &target);
        // What is made of n^(2/3) atoms of radius c n^(-1/3) is as dense to the eye for any n.
        let sheet = cube_root(n) * cube_root(n);
        let vapor = (VAPOR * sheet).min(0.05 * n);
        let front = (FRONT * sheet).min(0.15 * n).max(FRONT_SHARE * n);
        let atom_volume = (target.volume() + plume.liquid_volume()) / (n - vapor - front);
        plume.fill(atom_volume, front / sheet);
        Self {
            crystal: Crystal::new(cube_root(4.0 * atom_volume)),
            target,
            vapor_left: whole(vapor),
            plume,
            radius: spec.radius(),
            random: Random::new(spec.seed(), 3),
        }
    }

    /// The next atom: first those of the block, then vapor and droplets; the front takes the rest.
    fn atom(&mut self) -> Atom {
        if let Some(atom) = self.crystal.next_atom(&self.target, &mut self.random) {
            return atom;
        }
        if self.vapor_left > 0 {
            self.vapor_left -= 1;
            return self.plume.vapor(&mut self.random);
        }
        match self.plume.next_of_liquid(&mut self.random) {
            Some(atom) => atom,
            None => self.plume.front(&mut self.random),
        }
    }
}

/// How many atoms of vapor there are, for each `n^(2/3)`.
const VAPOR: f64 = 0.45;

/// How many atoms the front has at least, for each `n^(2/3)` and as a share of all.
const FRONT: f64 = 4.5;
const FRONT_SHARE: f64 = 0.05;

impl Make for Ablation {
    const SCALAR: Option<&'static str> = Some("temperature");

    fn row(&mut self) -> Row {
        let atom = self.atom();
        Row {
            position: atom.place.to_array().map(single),
            radius: self.radius,
            value: single(atom.temperature),
            ..Row::default()
        }
    }
}
