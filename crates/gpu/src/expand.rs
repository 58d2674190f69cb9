//! The geometry of glyphs as a GPU makes it, as lists: to be compared with that of the CPU, or exported.

use crate::{
    Error, GpuRenderer, Solids,
    kernel::{Kernel, Work, read, shader, storage},
    shape::{Draw, Shape},
    solid_shaders::glyph_source,
    survey::words,
};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use puncta_avc::{Glyph, Mesh, Sight};
use puncta_core::Scene;

/// `Sight` of the prelude.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SightData {
    eye: [f32; 4],
    nearest: f32,
    sharpness: f32,
    pixel: f32,
    spare: f32,
}

pub(crate) fn source<G: Glyph>() -> String {
    let before = if G::HAS_NEIGHBORS { 1 } else { 0 };
    let constant = format!("const BEFORE: u32 = {before}u;\n");
    [&constant, &glyph_source::<G>(), shader!("glyph_expand")].concat()
}

impl<G: Glyph> GpuRenderer<Solids<G>> {
    /// The geometry of records, each for its view of them, as the device makes it.
    ///
    /// # Errors
    ///
    /// When it does not fit into memory in one piece, or the device fails.
    pub fn meshes(&mut self, records: &[G], sights: &[Sight]) -> Result<Vec<Mesh>, Error> {
        let count = records.len().min(sights.len());
        if count == 0 {
            return Ok(Vec::new());
        }
        let scene = Scene::new(records.to_vec());
        let layout = self.shape.layout();
        let mut packed = Vec::new();
        self.shape.pack(&scene, 0..records.len(), &mut packed);
        let around = (layout.before + layout.after) as usize;
        packed.resize((records.len() + around) * layout.words as usize, 0);
        let data = |sight: &Sight| SightData {
            eye: sight.eye.to_array(),
            nearest: sight.nearest,
            sharpness: sight.sharpness,
            pixel: sight.pixel,
            spare: 0.0,
        };
        let sights: Vec<SightData> = sights[..count].iter().map(data).collect();
        self.shape.share(&self.gpu, 0.0)?;
        let sizes = self.sizes(&packed, &sights)?;
        let mut end = [0_u64; 2];
        let starts: Vec<[u64; 2]> = sizes
            .iter()
            .map(|&[vertices, triangles]| {
                let start = end;
                end = [end[0] + u64::from(vertices), end[1] + u64::from(triangles)];
                start
            })
            .collect();
        let (vertices, triangles) = self.lists((&packed, &sights), &starts, end)?;
        let part = |start: u64, size: u32| {
            let start = usize::try_from(start).unwrap_or(usize::MAX);
            start..start.saturating_add(size as usize)
        };
        let mesh = |(start, &[vertex, triangle]): (&[u64; 2], &[u32; 2])| Mesh {
            vertices: vertices[part(start[0], vertex)].to_vec(),
            triangles: triangles[part(start[1], triangle)].to_vec(),
        };
        Ok(starts.iter().zip(&sizes).map(mesh).collect())
    }

    /// How many vertices and triangles each record has; nothing is nothing.
    fn sizes(&mut self, packed: &[u32], sights: &[SightData]) -> Result<Vec<[u32; 2]>, Error> {
        let (gpu, pool) = (&self.gpu, &mut self.bench.pool);
        let Some(common) = self.shape.common.clone() else { return Ok(Vec::new()) };
        let sizes = storage(gpu, "expand::sizes", sights.len() as u64 * 8)?;
        let (list, views) = inputs(gpu, packed, sights)?;
        gpu.guard("geometry", || {
            let kernel = Kernel::new(gpu, "expand::measure", (&source::<G>(), "measure"), &[]);
            let mut work = Work::new(gpu, "expand::measure");
            let bindings = [
                (3, list.as_entire_binding()),
                (4, bound(&views, sights.len() as u64 * 32)),
                (5, sizes.as_entire_binding()),
                (13, common.as_entire_binding()),
            ];
            kernel.run(&mut work, &bindings, u32::try_from(sights.len()).unwrap_or(u32::MAX));
            work.submit();
        })?;
        let found = words(&read(gpu, pool, &[(&sizes, 0..sights.len() as u64 * 8)])?);
        let size = |size: &[u32]| if size[1] == 0 { [0, 0] } else { [size[0], size[1]] };
        Ok(found.chunks_exact(2).map(size).collect())
    }

    fn lists(
        &mut self,
        (packed, sights): (&[u32], &[SightData]),
        starts: &[[u64; 2]],
        end: [u64; 2],
    ) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), Error> {
        let (gpu, pool) = (&self.gpu, &mut self.bench.pool);
        let (bytes, limit) = (end[0].max(end[1]) * 12, gpu.binding_bytes_max());
        if bytes > limit {
            return Err(Error::TableTooLarge { bytes, limit });
        }
        let Some(common) = self.shape.common.clone() else { return Ok(Default::default()) };
        let vertices = storage(gpu, "expand::vertices", end[0] * 12)?;
        let triangles = storage(gpu, "expand::triangles", end[1] * 12)?;
        let (list, views) = inputs(gpu, packed, sights)?;
        // They are below the limit of a binding, and so of 32 bits.
        let small = |start: &[u64; 2]| start.map(|part| u32::try_from(part).unwrap_or(u32::MAX));
        let starts: Vec<[u32; 2]> = starts.iter().map(small).collect();
        let places = filled(gpu, "expand::starts", bytemuck::cast_slice(&starts))?;
        gpu.guard("geometry", || {
            let kernel = Kernel::new(gpu, "expand::expand", (&source::<G>(), "expand"), &[]);
            let mut work = Work::new(gpu, "expand::expand");
            let bindings = [
                (3, list.as_entire_binding()),
                (4, bound(&views, sights.len() as u64 * 32)),
                (6, places.as_entire_binding()),
                (7, vertices.as_entire_binding()),
                (8, triangles.as_entire_binding()),
                (13, common.as_entire_binding()),
            ];
            // A group for each record.
            let items = u32::try_from(sights.len() * 64).unwrap_or(u32::MAX);
            kernel.run(&mut work, &bindings, items);
            work.submit();
        })?;
        let parts = [(&vertices, 0..end[0] * 12), (&triangles, 0..end[1] * 12)];
        let found = words(&read(gpu, pool, &parts)?);
        let (vertices, triangles) = found.split_at(usize::try_from(end[0] * 3).unwrap_or(0));
        let vertex =
            |v: &[u32]| Vec3::new(f32::from_bits(v[0]), f32::from_bits(v[1]), f32::from_bits(v[2]));
        Ok((
            vertices.chunks_exact(3).map(vertex).collect(),
            triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        ))
    }
}

fn inputs(
    gpu: &crate::Gpu,
    packed: &[u32],
    sights: &[SightData],
) -> Result<(wgpu::Buffer, wgpu::Buffer), Error> {
    let records = filled(gpu, "expand::records", bytemuck::cast_slice(packed))?;
    Ok((records, filled(gpu, "expand::sights", bytemuck::cast_slice(sights))?))
}

fn filled(gpu: &crate::Gpu, label: &'static str, bytes: &[u8]) -> Result<wgpu::Buffer, Error> {
    let limit = gpu.binding_bytes_max();
    if bytes.len() as u64 > limit {
        return Err(Error::TableTooLarge { bytes: bytes.len() as u64, limit });
    }
    let buffer = storage(gpu, label, bytes.len() as u64)?;
    gpu.guard(label, || gpu.queue.write_buffer(&buffer, 0, bytes))?;
    Ok(buffer)
}

/// The first bytes of a buffer, which say how many items there are.
fn bound(buffer: &wgpu::Buffer, bytes: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: 0,
        size: std::num::NonZeroU64::new(bytes),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::assert_same_layout;
    use puncta_avc::Cuboid;

    #[test]
    fn a_sight_is_that_of_the_shaders() {
        let source = source::<Cuboid>();
        let module =
            crate::shaders::module("Sight", &source, naga::valid::Capabilities::empty()).unwrap();
        let (size, members) = crate::shaders::layout(&module, "Sight");
        assert_eq!(size as usize, size_of::<SightData>());
        let offsets: Vec<u32> = members.iter().map(|(_, offset, _)| *offset).collect();
        assert_eq!(offsets, [0, 16, 20, 24]);
        let source = "struct Sight { eye: vec4<f32>, nearest: f32, sharpness: f32, pixel: f32, \
            spare: f32 } var<private> sight: Sight;";
        assert_same_layout!(source, "Sight", SightData { eye, nearest, sharpness, pixel, spare });
    }
}
