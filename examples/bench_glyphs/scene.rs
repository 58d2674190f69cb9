//! Scenes by their names, and how they are seen.

use crate::{
    Options,
    boxes::Boxes,
    curves::{self, Curves},
};
use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;
use puncta::{
    Bounds, Cuboid, Glyph, Glyphs, View,
    avc::{Arc, Block, Lens, Node, NodeStyle, Runs},
    core::Camera,
};

/// At what share of the distance the eye stands if it is close. All of the scene is before it still.
const CLOSE: f64 = 0.45;

/// A scene: what it is made of, and the view.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) content: Content,
    pub(crate) view: View,
    /// Whether all of it is in the picture.
    pub(crate) is_whole: bool,
}

/// What a scene is made of.
#[derive(Debug)]
pub(crate) enum Content {
    /// All blocks, and those that no others hide.
    Blocks(Box<[(Boxes, Curves<Block>); 2]>),
    Cuboids(Box<(Boxes, Curves<Cuboid>)>),
    Arcs(Box<Curves<Arc>>),
    Tubes(Box<Curves<Node, Runs>>),
}

impl Scene {
    /// A scene such as `blocks:32`.
    pub(crate) fn new(name: &str, options: &Options) -> Result<Self> {
        let tolerance = options.tolerance;
        let (kind, size) = parse(name)?;
        let is_world = matches!(kind, "blocks" | "caves");
        ensure!(!is_world || size <= 256, "a world has up to 256 cells along a side");
        let content = match kind {
            "blocks" => blocks(Boxes::world(size, None)?)?,
            "caves" => blocks(Boxes::world(size, Some(8))?)?,
            "cuboids" => Content::Cuboids(Box::new(of_library(Boxes::bars(size))?)),
            "arcs" => Content::Arcs(Box::new(arcs(size, tolerance)?)),
            "tubes" => Content::Tubes(Box::new(tubes(size, tolerance))),
            _ => bail!("{kind:?} is none of blocks, caves, cuboids, arcs, tubes"),
        };
        ensure!(content.len() > 0, "nothing is in it");
        let bounds = content.bounds();
        let mut view = overview(&bounds, options.size)?;
        if options.close {
            let center = bounds.center();
            let eye = center.lerp(view.eye(), CLOSE);
            let [width, height] = options.size;
            view = View::look_at(eye, center, DVec3::Z)?.with_size(width, height)?;
        }
        Ok(Self { name: name.to_owned(), content, view, is_whole: !options.close })
    }

    /// The cells along a side of a world, and the sharpness of curves.
    pub(crate) fn parameters(&self) -> (u32, f32) {
        let camera = Camera::new(&self.view, DVec3::ZERO);
        let sharpness = |tolerance: f32| Lens::new(&camera, tolerance).sharpness;
        match &self.content {
            Content::Blocks(both) => (both[0].0.kind.side(), 0.0),
            Content::Cuboids(_) => (1, 0.0),
            Content::Arcs(curves) => (1, sharpness(curves.glyphs.tolerance)),
            Content::Tubes(curves) => (1, sharpness(curves.glyphs.tolerance)),
        }
    }
}

/// All of it, seen from above one of its corners.
pub(crate) fn overview(bounds: &Bounds, [width, height]: [u32; 2]) -> Result<View> {
    let eye = DVec3::new(-0.6, -1.0, 0.7);
    let view = View::look_at(eye, DVec3::ZERO, DVec3::Z)?.with_size(width, height)?;
    Ok(view.fitted(bounds))
}

fn blocks([all, exposed]: [Boxes; 2]) -> Result<Content> {
    Ok(Content::Blocks(Box::new([of_library(all)?, of_library(exposed)?])))
}

/// A kind of scene, and its size.
pub(crate) fn parse(name: &str) -> Result<(&str, u32)> {
    let (kind, size) = name.split_once(':').context("a scene is written as blocks:32")?;
    let size: f64 = size.parse().with_context(|| format!("{size:?} is no number"))?;
    ensure!((1.0..=1e8).contains(&size) && size.fract() == 0.0, "{size} is no count");
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    let count = size as u32;
    Ok((kind, count))
}

/// So many arcs.
pub(crate) fn arcs(count: u32, tolerance: f32) -> Result<Curves<Arc>> {
    Curves::sort(Glyphs::new([]).with_tolerance(tolerance), curves::arcs(count))
}

/// So many nodes of tubes.
pub(crate) fn tubes(count: u32, tolerance: f32) -> Curves<Node, Runs> {
    let glyphs = Glyphs::new(NodeStyle::tubes(0.05)).with_tolerance(tolerance);
    Curves::keep(glyphs, curves::tubes(count))
}

/// Boxes, and the same as the library has them.
fn of_library<G: Glyph<Style = [u32; 0]>>(boxes: Boxes) -> Result<(Boxes, Curves<G>)> {
    let records = bytemuck::pod_collect_to_vec(boxes.bytes());
    let curves = Curves::sort(Glyphs::new([]), records)?;
    Ok((boxes, curves))
}

impl Content {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Blocks(both) => both[0].0.len(),
            Self::Cuboids(both) => both.0.len(),
            Self::Arcs(curves) => curves.scene.records.len(),
            Self::Tubes(curves) => curves.scene.records.len(),
        }
    }

    fn bounds(&self) -> Bounds {
        match self {
            Self::Blocks(both) => both[0].0.bounds(),
            Self::Cuboids(both) => both.0.bounds(),
            Self::Arcs(curves) => curves.bounds(),
            Self::Tubes(curves) => curves.bounds(),
        }
    }
}
