/*!
Synthetic scenes: deterministic generators of particles and points of any number.

```
use puncta_core::Source;
use puncta_io::synthetic::Generator;

let generator: Generator = "cube:n=1000,r=0.02".parse()?;
assert_eq!(generator.to_string(), "cube:n=1000,r=0.02,seed=1");
let Ok(scene) = generator.into_scene();
assert_eq!(scene.records.len(), 1000);
# Ok::<(), puncta_io::synthetic::SpecError>(())
```

A text names the scene: a name, and after a colon `key=value` pairs between commas. Numbers may have
an exponent (`n=1e7`). [`Generator::kinds`] lists names, keys and defaults. Every scene has

* `n`, the exact number of records, from 1 to 4294967295,
* `r`, the radius of a record, in the units of the scene,
* `seed`, which changes every random choice.

In all scenes z is up.

# Scenes

**`cube`** is the scene to measure with: spheres scattered evenly and without order, with centers
from -1 to 1 on each axis. No attributes.

**`lattice`** is a crystal, cut to a block around the origin, in ångström: `kind=fcc` (copper),
`bcc` (iron) or `sc` (polonium). Atoms touch unless `spacing` parts them; `jitter` displaces them at
random by up to that share of the spacing. Records have an element and the scalar `layer`, which
counts the planes from below.

**`ablation`** is a metal block that a laser pulse has struck, in the manner of molecular dynamics:
a crystal with a crater, bubbles in the melt, jets, droplets, vapor, and a mushroom-shaped front.
The block reaches from -1 to 1 along x and y, and its surface is z = 0; the plume is some 1.8 high.
With more atoms the same event is drawn more finely. `cut=quarter` opens block and front towards
positive x and negative y, `cut=none` does not. The scalar `temperature` is in kelvin.

**`hall`** is a laser scan of an industrial hall, 60 m by 24 m and 10.5 m high, in survey
coordinates around (350000, 5800000, 110): density falls off with the distance from seven scanners,
and things throw shadows. `noise` is the error of distances in meters. Of all points, `strays` lie
up to 50 lengths of the hall away. Records have colors and the scalar `intensity`, 0 to 1.

**`halo`** is matter as cosmology finds it, in a periodic box from -50 to 50 Mpc/h: halos in halos
whose masses follow a power law, filaments, and voids. The scalar `density` is the logarithm to base
10 of the density in units of the mean.

# The same for ever

The same spec gives the same records and attributes, bit by bit: on every machine, in chunks of any
size, and in later versions unless the change log says otherwise. Memory for the generator itself
does not grow with `n`, so a [`Source`] of a thousand million records needs no more than a chunk.
*/

mod ablation;
mod cube;
mod hall;
mod halo;
mod lattice;
mod noise;
mod random;
mod spec;

pub use spec::{Key, Kind, SpecError};

use glam::DVec3;
use puncta_core::{Column, Scalar, Scene, Source, Sphere};
use spec::Spec;
use std::{convert::Infallible, fmt, str::FromStr};

static KINDS: [Kind; 5] = [cube::KIND, lattice::KIND, ablation::KIND, hall::KIND, halo::KIND];

/// A synthetic scene in the making: a [`Source`] of its records.
///
/// Parse it from a text (see the [module](self)); [`Display`](fmt::Display) prints the text with
/// all its keys. Records come in a fixed order, so there are no ids to store.
#[derive(Clone, Debug)]
pub struct Generator {
    spec: Spec,
    scene: Making,
    made: u64,
}

/// What there is of a scene until all its records are made.
#[derive(Clone, Debug)]
enum Making {
    Cube(cube::Cube),
    Lattice(lattice::Lattice),
    Ablation(Box<ablation::Ablation>),
    Hall(Box<hall::Hall>),
    Halo(Box<halo::Halo>),
}

/// A scene that makes one record after the other.
trait Make {
    /// Whether rows have a color.
    const COLORS: bool = false;
    /// Whether rows have an element.
    const ELEMENTS: bool = false;
    /// The name of the rows' value, if they have one.
    const SCALAR: Option<&'static str> = None;

    /// The next record. It is asked for as many as the spec says, and no more.
    fn row(&mut self) -> Row;
}

/// A record and its attributes.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    position: [f32; 3],
    radius: f32,
    color: [u8; 3],
    element: u8,
    value: f32,
}

impl Generator {
    /// The scenes that there are, for a list such as that of `--help`.
    #[must_use]
    pub fn kinds() -> &'static [Kind] {
        &KINDS
    }

    /// Whether a text names a scene, be its settings right or wrong: `cube`, `hall:n=5`.
    ///
    /// So a tool can tell a scene from a file. A file of such a name is reached as `./cube`.
    #[must_use]
    pub fn is_spec(text: &str) -> bool {
        let name = text.split_once(':').map_or(text, |(name, _)| name);
        KINDS.iter().any(|kind| kind.name == name)
    }

    /// What kind of scene it is.
    #[must_use]
    pub const fn kind(&self) -> &'static Kind {
        self.spec.kind()
    }

    /// The direction that points up in the scene; so far it is z in all of them.
    #[must_use]
    pub const fn up(&self) -> DVec3 {
        DVec3::Z
    }

    /// How many records the scene has, those already taken included.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.spec.count()
    }

    /// Makes room in all columns, for no more than what is needed.
    fn reserve_exact(&self, scene: &mut Scene, records: usize) {
        scene.records.to_mut().reserve_exact(records);
        let (colors, elements, scalar) = self.scene.columns();
        if colors {
            scene.attributes.colors.get_or_insert_default().to_mut().reserve_exact(records);
        }
        if elements {
            scene.attributes.elements.get_or_insert_default().to_mut().reserve_exact(records);
        }
        if let Some(name) = scalar {
            scalar_column(scene, name).reserve_exact(records);
        }
    }
}

impl FromStr for Generator {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        let spec = Spec::parse(text, &KINDS)?;
        let scene = match spec.kind().name {
            "lattice" => Making::Lattice(lattice::Lattice::new(&spec)),
            "ablation" => Making::Ablation(Box::new(ablation::Ablation::new(&spec))),
            "hall" => Making::Hall(Box::new(hall::Hall::new(&spec))),
            "halo" => Making::Halo(Box::new(halo::Halo::new(&spec))),
            _ => Making::Cube(cube::Cube::new(&spec)),
        };
        Ok(Self { spec, scene, made: 0 })
    }
}

impl fmt::Display for Generator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.spec.fmt(f)
    }
}

impl Source for Generator {
    type Record = Sphere;
    type Error = Infallible;

    fn remaining(&self) -> Option<u64> {
        Some(self.count() - self.made)
    }

    /// Appends to a scene that is empty, was cleared, or holds what this generator made before.
    fn append(&mut self, scene: &mut Scene, limit: usize) -> Result<usize, Infallible> {
        let left = usize::try_from(self.count() - self.made).unwrap_or(usize::MAX);
        let count = limit.min(left);
        scene.origin = self.scene.origin();
        match &mut self.scene {
            Making::Cube(making) => append(making, scene, count),
            Making::Lattice(making) => append(making, scene, count),
            Making::Ablation(making) => append(making.as_mut(), scene, count),
            Making::Hall(making) => append(making.as_mut(), scene, count),
            Making::Halo(making) => append(making.as_mut(), scene, count),
        }
        self.made += count as u64;
        Ok(count)
    }

    /// All records at once, in memory of exactly their size.
    fn into_scene(mut self) -> Result<Scene, Infallible> {
        let mut scene = Scene::new(Vec::new());
        let count = usize::try_from(self.count() - self.made).unwrap_or(usize::MAX);
        self.reserve_exact(&mut scene, count);
        self.append(&mut scene, count)?;
        Ok(scene)
    }
}

impl Making {
    /// The world position that rows are relative to.
    const fn origin(&self) -> DVec3 {
        match self {
            Self::Hall(_) => hall::ORIGIN,
            _ => DVec3::ZERO,
        }
    }

    /// Whether there are colors and elements, and the name of the scalar.
    const fn columns(&self) -> (bool, bool, Option<&'static str>) {
        const fn of<M: Make>() -> (bool, bool, Option<&'static str>) {
            (M::COLORS, M::ELEMENTS, M::SCALAR)
        }
        match self {
            Self::Cube(_) => of::<cube::Cube>(),
            Self::Lattice(_) => of::<lattice::Lattice>(),
            Self::Ablation(_) => of::<ablation::Ablation>(),
            Self::Hall(_) => of::<hall::Hall>(),
            Self::Halo(_) => of::<halo::Halo>(),
        }
    }
}

/// Appends the next rows of a scene.
fn append<M: Make>(making: &mut M, scene: &mut Scene, count: usize) {
    // Rows go into all columns in runs that stay in the cache, column by column.
    const RUN: usize = 256;
    let mut rows = [Row::default(); RUN];
    let mut left = count;
    scene.records.to_mut().reserve(count);
    while left > 0 {
        let run = &mut rows[..left.min(RUN)];
        run.fill_with(|| making.row());
        left -= run.len();
        scene.records.to_mut().extend(run.iter().map(|row| Sphere::new(row.position, row.radius)));
        if M::COLORS {
            let colors = scene.attributes.colors.get_or_insert_default().to_mut();
            colors.extend(run.iter().map(|row| [row.color[0], row.color[1], row.color[2], 255]));
        }
        if M::ELEMENTS {
            let elements = scene.attributes.elements.get_or_insert_default().to_mut();
            elements.extend(run.iter().map(|row| row.element));
        }
        if let Some(name) = M::SCALAR {
            scalar_column(scene, name).extend(run.iter().map(|row| row.value));
        }
    }
}

/// The values of the scalar of this name, which is made if there is none.
fn scalar_column<'a>(scene: &'a mut Scene, name: &str) -> &'a mut Vec<f32> {
    let scalars = &mut scene.attributes.scalars;
    let index = scalars.iter().position(|scalar| scalar.name == name).unwrap_or_else(|| {
        scalars.push(Scalar { name: name.to_owned(), values: Column::new() });
        scalars.len() - 1
    });
    scalars[index].values.to_mut()
}
