//! Who takes part: the representations of each kind of scene, and the renderers of the library.

use crate::{
    baked,
    baked::Shape,
    boxes::{Boxes, number},
    curves::Curves,
    device::Device,
    easel::Easel,
    expanded,
    glyphs::Place,
    instanced, mesh,
    own::Own,
    pulled,
    scene::{Content, Scene},
    way::Way,
};
use anyhow::{Context, Result};
use puncta::{Bricks, CpuRenderer, Glyph, GpuConfig, GpuRenderer, View, avc::Block};
use std::rc::Rc;

const PULLED: &str = "AVC, pulled";
const EXPANDED: &str = "AVC, expanded";
const MESHES: &str = "AVC, mesh shader";
const EXPOSED: [&str; 2] = ["exposed blocks, pulled", "exposed blocks, expanded"];
const OWN: [&str; 2] = ["CpuRenderer", "GpuRenderer"];
const OWN_EXPOSED: [&str; 2] = ["exposed blocks, CpuRenderer", "exposed blocks, GpuRenderer"];

/// The devices that take part.
#[derive(Debug)]
pub(crate) struct Devices {
    pub(crate) plain: Rc<Device>,
    /// With mesh shaders.
    pub(crate) meshes: Option<Rc<Device>>,
}

/// A representation, or why it cannot be.
pub(crate) type Candidate<'a> = (&'static str, Result<Box<dyn Way + 'a>>);

/// All of a scene.
pub(crate) fn all<'a>(devices: &Devices, scene: &'a Scene) -> Vec<Candidate<'a>> {
    let view = &scene.view;
    let easel =
        |device: &Rc<Device>| Rc::new(Easel::new(Rc::clone(device), view, scene.parameters()));
    let easels =
        Easels { plain: easel(&devices.plain), meshes: devices.meshes.as_ref().map(easel) };
    match &scene.content {
        Content::Cuboids(both) => {
            let (boxes, curves) = &**both;
            let mut all = of_boxes(boxes, &easels);
            all.extend(own(OWN, (curves, view), &easels, |id| curves.scene.id(id)));
            all
        }
        Content::Blocks(both) => {
            let [(boxes, blocks), (exposed, exposed_blocks)] = &**both;
            let side = boxes.kind.side();
            let cell = |blocks: &'a Curves<Block>| {
                move |id| number(blocks.scene.records[id as usize].cell.map(u32::from), side)
            };
            let mut all = of_boxes(boxes, &easels);
            all.extend(own(OWN, (blocks, view), &easels, cell(blocks)));
            all.push((EXPOSED[0], boxed(pulled::boxes(&easels.plain, exposed))));
            all.push((EXPOSED[1], boxed(expanded::boxes(&easels.plain, exposed))));
            all.extend(own(OWN_EXPOSED, (exposed_blocks, view), &easels, cell(exposed_blocks)));
            all
        }
        Content::Arcs(curves) => of_glyphs(curves, scene, &easels),
        Content::Tubes(curves) => of_glyphs(curves, scene, &easels),
    }
}

/// Where is drawn.
struct Easels {
    plain: Rc<Easel>,
    meshes: Option<Rc<Easel>>,
}

impl Easels {
    fn meshes(&self) -> Result<&Rc<Easel>> {
        self.meshes.as_ref().context("the adapter has no mesh shaders")
    }
}

fn boxed<'a, W: Way + 'a>(way: Result<W>) -> Result<Box<dyn Way + 'a>> {
    way.map(|way| Box::new(way) as Box<dyn Way>)
}

fn of_boxes<'a>(boxes: &'a Boxes, easels: &Easels) -> Vec<Candidate<'a>> {
    let easel = &easels.plain;
    let shape = |shape: Shape| (shape.name(), boxed(baked::boxes(easel, boxes, shape)));
    let mut all: Vec<Candidate<'a>> = [Shape::List, Shape::Indexed, Shape::Strip].map(shape).into();
    all.push(("instances", boxed(instanced::boxes(easel, boxes))));
    all.push((PULLED, boxed(pulled::boxes(easel, boxes))));
    all.push((EXPANDED, boxed(expanded::boxes(easel, boxes))));
    all.push((MESHES, boxed(easels.meshes().and_then(|easel| mesh::boxes(easel, boxes)))));
    all
}

fn of_glyphs<'a, G: Glyph, B: Bricks>(
    curves: &'a Curves<G, B>,
    scene: &'a Scene,
    easels: &Easels,
) -> Vec<Candidate<'a>> {
    let view = &scene.view;
    let place = Place { curves, levels: curves.levels(view), view, is_whole: scene.is_whole };
    let easel = &easels.plain;
    let mut all: Vec<Candidate<'a>> = vec![
        (Shape::List.name(), boxed(place.baked(easel, false))),
        (Shape::Indexed.name(), boxed(place.baked(easel, true))),
        (PULLED, boxed(place.pulled(easel))),
        (EXPANDED, boxed(place.expanded(easel))),
        (MESHES, boxed(easels.meshes().and_then(|easel| place.meshes(easel)))),
    ];
    all.extend(own(OWN, (curves, view), easels, |id| id));
    all
}

/// The renderers of the library. `name` tells what the other representations call a record.
fn own<'a, G: Glyph, B: Bricks>(
    names: [&'static str; 2],
    (curves, view): (&'a Curves<G, B>, &'a View),
    easels: &Easels,
    name: impl Fn(u32) -> u32 + Clone + 'a,
) -> [Candidate<'a>; 2] {
    let cpu = CpuRenderer::of(curves.glyphs.clone());
    let cpu = Own::new(cpu, curves, view, Box::new(name.clone()));
    // Room for all records, their ids, and some to spare.
    let records = curves.scene.records.len() as u64 + 4096;
    let config =
        GpuConfig { record_bytes: records * (size_of::<G>() as u64 + 8), ..GpuConfig::default() };
    let gpu = GpuRenderer::of(&easels.plain.device.gpu, curves.glyphs.clone(), config);
    let gpu = gpu.map(|gpu| Own::new(gpu, curves, view, Box::new(name)));
    [(names[0], boxed(Ok(cpu))), (names[1], boxed(gpu.map_err(Into::into)))]
}
