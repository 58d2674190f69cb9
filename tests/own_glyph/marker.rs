//! The glyph of `docs/own_glyph.md`.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta::Record;
use puncta::avc::{Cloud, Fault, Glyph, Sight, Size};

#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Marker {
    pub(crate) tip: [f32; 3],
    pub(crate) height: f32,
    pub(crate) weight: f32,
}

impl Record for Marker {
    fn position(&self) -> Vec3 {
        self.tip.into()
    }
    fn radius(&self) -> f32 {
        self.height * 1.5
    } // all vertices are within
}

impl Glyph for Marker {
    type Style = f32; // the least weight that is drawn: change it, and nothing is brought again
    type Form<'a> = Vec3; // half of its width, its height, and whether it is there
    const WGSL: &'static str = include_str!("marker.wgsl");

    fn form<'a>(cloud: &Cloud<'a, Self>, index: usize, _: &Sight) -> Vec3 {
        let Self { height, weight, .. } = cloud.get(index);
        let is_there = height > 1e-18 && height < 1e18 && weight >= *cloud.style;
        Vec3::new(height * 0.5, height, if is_there { 1.0 } else { 0.0 })
    }
    fn size(form: &Vec3) -> Size {
        if form.z > 0.0 { Size { vertices: 5, triangles: 6 } } else { Size::NOTHING }
    }
    fn vertex(form: &Vec3, vertex: u32) -> Vec3 {
        let side = |bit: u32| if vertex & bit != 0 { form.x } else { -form.x };
        if vertex == 4 { Vec3::ZERO } else { Vec3::new(side(1), side(2), form.y) }
    }
    fn triangle(_: &Vec3, triangle: u32) -> [u32; 3] {
        [[0, 1, 3], [0, 3, 2], [1, 0, 4], [3, 1, 4], [2, 3, 4], [0, 2, 4]][triangle as usize % 6]
    }
    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault> {
        let Self { tip: [x, y, z], height, weight } = cloud.get(index);
        let is_finite = [x, y, z, height, weight].iter().all(|number| number.is_finite());
        if !is_finite { Some(Fault::NotFinite) } else { (height <= 0.0).then_some(Fault::NoExtent) }
    }
}
