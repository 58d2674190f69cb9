//! The scenes that are measured: full blocks of bricks, and scenes in several grids.

use crate::{
    clock::{self, Span},
    frame::{self, Way},
    input::Input,
    part::{self, Part},
    thesis::{self, Line},
    world::{self, Origin, Place, World, render_options},
};
use anyhow::{Context, Result, ensure};
use glam::DVec3;
use puncta::{Amount, Scene, Sphere, View};
use std::{num::NonZero, str::FromStr};

/// What was measured for one scene in one grid.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) dims: [u32; 3],
    /// What it is compared with.
    pub(crate) thesis: Option<Line>,
    pub(crate) bricks: usize,
    pub(crate) in_view: Amount,
    pub(crate) parts: Vec<(Part, Vec<Span>)>,
    /// The share of edges in which the graph and its twin agree.
    pub(crate) agreement: f64,
    pub(crate) frames: Vec<(Way, Amount, Vec<Span>)>,
}

impl Case {
    /// The median of the times of a part.
    pub(crate) fn median(&self, part: Part) -> Option<Span> {
        let (_, spans) = self.parts.iter().find(|(which, _)| *which == part)?;
        clock::median(spans)
    }
}

/// How often to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Often {
    pub(crate) parts: usize,
    pub(crate) slow: usize,
}

/// The cells of a block along its axes, written as 50x8x8.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dims([u32; 3]);

impl FromStr for Dims {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text:?} is no block like 50x8x8");
        let dims: Vec<u32> =
            text.split('x').map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
        let dims: [u32; 3] = dims.try_into().map_err(|_| wrong())?;
        let is_fine =
            dims.iter().all(|dim| (1..=1000).contains(dim)) && dims[0] >= dims[1].max(dims[2]);
        is_fine
            .then_some(Self(dims))
            .ok_or_else(|| "sides are 1 to 1000, the first is longest".into())
    }
}

/// Measures a full block of bricks.
pub(crate) fn block(dims: &Dims, size: &str, often: Often) -> Result<Case> {
    let Dims([x, y, z]) = *dims;
    let axis = |count: u32| 0..count;
    let cells = axis(z).flat_map(|z| axis(y).flat_map(move |y| axis(x).map(move |x| [x, y, z])));
    // The corners of the block are there, so that the box of the records is that of the cells.
    let place = |index: u32, count: u32| match index {
        0 => 0.0,
        last if last + 1 == count => count as f32,
        index => index as f32 + 0.5,
    };
    let sphere = |[i, j, k]: [u32; 3]| Sphere::new([place(i, x), place(j, y), place(k, z)], 0.45);
    let scene = Scene::new(cells.map(sphere).collect::<Vec<_>>());
    let input = Input {
        name: format!("block {x}x{y}x{z}"),
        format: "made".to_owned(),
        bounds: scene.bounds(),
        scene,
        skipped: 0,
        notices: vec![],
        up: DVec3::Z,
        scalar: None,
        outlook: None,
        known: None,
    };
    let cells = NonZero::new(x);
    let world = World::new(input, &render_options(&origin(None, size))?, cells)?;
    let bricks = world.grid.bricks().len();
    ensure!(
        u64::from(x) * u64::from(y) * u64::from(z) == bricks as u64,
        "the block has {bricks} bricks"
    );
    let title = format!("block {x}x{y}x{z}");
    let case = measure(&world, title, often)?;
    Ok(Case { thesis: thesis::like_block(bricks), ..case })
}

/// Measures a scene in all grids.
pub(crate) fn scene(
    name: &str,
    (size, grids): (&str, &[NonZero<u32>]),
    often: Often,
    tell: &mut impl FnMut(Case),
) -> Result<()> {
    let mut world =
        World::read(&Origin { grid: grids.first().copied(), ..origin(Some(name), size) })?;
    for (index, &cells) in grids.iter().enumerate() {
        if index > 0 {
            world.grid = world::sort(&mut world.input.scene, Some(cells))?;
        }
        let case = measure(&world, name.to_owned(), often)?;
        let frames = frame::measure(&world, &world.look(Place::Overview)?, often.slow)?;
        let is_hall = name.split(':').next() == Some("hall");
        let thesis = if is_hall { thesis::hall(cells.get()) } else { None };
        tell(Case { frames, thesis, ..case });
    }
    Ok(())
}

fn origin(input: Option<&str>, size: &str) -> Origin {
    Origin { input: input.map(str::to_owned), size: size.to_owned(), grid: None, radius: None }
}

/// Measures all but drawing.
fn measure(world: &World, name: String, often: Often) -> Result<Case> {
    let view: View = world.look(Place::Overview)?;
    let (in_view, parts) = part::measure(world, &view, often);
    let agreement = part::agreement(world, &view).context("there are no edges")?;
    // Where the plain twin differs, rounding decided; that is rare.
    ensure!(agreement > 0.995, "the graph and its twin agree in {agreement} of all edges only");
    Ok(Case {
        name,
        dims: world.grid.dims(),
        thesis: None,
        bricks: world.grid.bricks().len(),
        in_view,
        parts,
        agreement,
        frames: vec![],
    })
}
