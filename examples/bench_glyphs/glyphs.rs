//! Glyphs of any kind in all representations that they can have.

use crate::{
    baked::{Buffers, Plain},
    curves::{Curves, Levels},
    easel::Easel,
    expanded::{self, Run, Source},
    mesh,
    pipes::{READ, Raster, UNIFORM, layout},
    way::{Call, Draw, Footprint, Recipe, Step},
};
use anyhow::{Result, ensure};
use bytemuck::{bytes_of, cast_slice};
use glam::DVec3;
use puncta::{
    Bricks, Glyph, View,
    avc::{Lens, PRELUDE},
    core::Camera,
    gpu::wgpu::{self, BufferUsages, ShaderStages},
};
use std::rc::Rc;

/// Glyphs, what a view makes of them, and where they are drawn.
#[derive(Debug)]
pub(crate) struct Place<'a, G: Glyph, B> {
    pub(crate) curves: &'a Curves<G, B>,
    pub(crate) levels: Levels,
    pub(crate) view: &'a View,
    /// Whether all of the scene is in the picture, so that nothing is left out.
    pub(crate) is_whole: bool,
}

impl<G: Glyph, B: Bricks> Place<'_, G, B> {
    fn bytes(&self) -> &[u8] {
        cast_slice(self.curves.scene.records.as_slice())
    }

    fn count(&self) -> Result<u32> {
        Ok(u32::try_from(self.curves.scene.records.len())?)
    }

    /// How many bits of a code name a vertex.
    fn shift(&self) -> u32 {
        u32::BITS - self.levels.vertices_max.saturating_sub(1).leading_zeros()
    }

    fn constants(&self) -> String {
        let words = size_of::<G>() / 4;
        format!("const WORDS: u32 = {words}u;\nconst SHIFT: u32 = {}u;\n", self.shift())
    }

    /// Records, style, table, and where bricks begin.
    fn buffers(&self, easel: &Easel) -> Result<Vec<(u32, wgpu::Buffer)>> {
        let device = &easel.device;
        device.check(&[self.bytes().len() as u64])?;
        device.check_binding(self.bytes().len() as u64)?;
        let glyphs = &self.curves.glyphs;
        let filled = |binding: u32, bytes: &[u8]| {
            device.filled("glyphs", bytes, BufferUsages::STORAGE).map(|buffer| (binding, buffer))
        };
        Ok(vec![
            filled(1, self.bytes())?,
            filled(6, bytes_of(&glyphs.style))?,
            filled(7, cast_slice(glyphs.table.as_slice()))?,
            filled(8, cast_slice(&self.levels.nearest))?,
        ])
    }

    /// What grows with the number of glyphs: records, the table, where bricks begin.
    fn footprint(&self, scratch: u64) -> Footprint {
        let glyphs = &self.curves.glyphs;
        let nearest = 4 * self.levels.nearest.len();
        let bytes = self.bytes().len() + 4 * glyphs.table.len() + nearest;
        Footprint { glyphs: bytes as u64, fixed: size_of::<G::Style>() as u64, scratch }
    }

    /// Vertices that lie in memory, for this view alone; with indices if they are shared.
    pub(crate) fn baked(&self, easel: &Rc<Easel>, is_shared: bool) -> Result<Recipe> {
        let camera = Camera::new(self.view, DVec3::ZERO);
        let lens = Lens::new(&camera, self.curves.glyphs.tolerance);
        let corners = 3 * self.levels.sum();
        let count = self.count()?;
        let mesh = |index: u32| self.curves.mesh(&lens, &self.levels, index as usize);
        let vertices: u64 = if is_shared {
            (0..count).map(|index| mesh(index).vertices.len() as u64).sum()
        } else {
            corners
        };
        let indices = if is_shared { corners } else { 0 };
        let bytes = [vertices * size_of::<Plain>() as u64, 4 * indices];
        easel.device.check(&bytes)?;
        let buffers = Buffers::new(easel, bytes);
        let (mut at, mut at_index, mut first) = (0, 0, 0_u32);
        let (mut list, mut numbers) = (Vec::new(), Vec::new());
        for index in 0..count {
            let mesh = mesh(index);
            let plain =
                |vertex: u32| Plain { point: mesh.vertices[vertex as usize].to_array(), id: index };
            let corners = mesh.triangles.iter().flatten().copied();
            if is_shared {
                list.extend((0..u32::try_from(mesh.vertices.len())?).map(plain));
                numbers.extend(corners.map(|corner| first + corner));
                first += u32::try_from(mesh.vertices.len())?;
            } else {
                list.extend(corners.map(plain));
            }
            if list.len() > 1 << 18 || index + 1 == count {
                easel.device.fill(&buffers.vertices, &mut at, cast_slice(&list))?;
                easel.device.fill(&buffers.indices, &mut at_index, cast_slice(&numbers))?;
                list.clear();
                numbers.clear();
            }
        }
        let corners = u32::try_from(corners)?;
        let call =
            if is_shared { Call::Indices(corners, 0..1) } else { Call::Vertices(corners, 0..1) };
        Ok(buffers.plain(easel, call))
    }

    /// An instance for each glyph, with as many vertices as the largest one needs.
    pub(crate) fn pulled(&self, easel: &Rc<Easel>) -> Result<Recipe> {
        let device = &easel.device;
        let buffers = self.buffers(easel)?;
        let mut bindings = vec![(0, UNIFORM)];
        bindings.extend(buffers.iter().map(|(binding, _)| (*binding, READ)));
        let layout = layout(device, ShaderStages::VERTEX, &bindings);
        let pipeline = Raster {
            parts: &[
                include_str!("common.wgsl"),
                &self.constants(),
                PRELUDE,
                G::WGSL,
                include_str!("glyph.wgsl"),
                include_str!("pulled_glyph.wgsl"),
            ],
            layout: &layout,
            buffers: &[],
            strip: None,
        }
        .pipeline(easel);
        let mut bound = vec![(0, &easel.camera)];
        bound.extend(buffers.iter().map(|(binding, buffer)| (*binding, buffer)));
        let draw = Draw {
            pipeline,
            bound: device.bind(&layout, &bound),
            vertices: vec![],
            indices: None,
            call: Call::Vertices(3 * self.levels.most(), 0..self.count()?),
        };
        Ok(Recipe {
            easel: Rc::clone(easel),
            footprint: self.footprint(0),
            steps: vec![Step::Draw(Box::new(draw))],
            rooms: vec![],
        })
    }

    /// Indices that a compute shader writes.
    pub(crate) fn expanded(&self, easel: &Rc<Easel>) -> Result<Recipe> {
        let runs = self.runs(easel)?;
        let constants = self.constants();
        let source = Source {
            parts: vec![
                &constants,
                PRELUDE,
                G::WGSL,
                include_str!("glyph.wgsl"),
                include_str!("expanded_glyph.wgsl"),
            ],
            buffers: self.buffers(easel)?,
            glyph_bytes: self.bytes().len() as u64,
            runs,
        };
        let recipe = expanded::recipe(easel, &source)?;
        let footprint = self.footprint(recipe.footprint.scratch);
        Ok(Recipe { footprint, ..recipe })
    }

    /// Records whose indices fit into a binding, and whose codes into a number.
    fn runs(&self, easel: &Easel) -> Result<Vec<Run>> {
        let room_max = expanded::room_max(easel);
        let records_max = (1_u64 << (32 - self.shift())).min(expanded::RECORDS_MAX);
        let mut runs: Vec<Run> = Vec::new();
        for (index, triangles) in (0_u32..).zip(&self.levels.triangles) {
            let indices = 3 * u64::from(*triangles);
            ensure!(indices <= room_max, "a glyph of {indices} indices");
            let has_room = |run: &&mut Run| {
                let records = u64::from(run.records.end - run.records.start);
                run.room + indices <= room_max && records < records_max
            };
            match runs.last_mut().filter(has_room) {
                Some(run) => {
                    run.records.end = index + 1;
                    run.room += indices;
                }
                None => {
                    runs.push(Run { records: index..index + 1, room: indices, expected: None });
                }
            }
        }
        if self.is_whole {
            runs.iter_mut().for_each(|run| run.expected = Some(run.room));
        }
        Ok(runs)
    }

    /// Mesh shaders.
    pub(crate) fn meshes(&self, easel: &Rc<Easel>) -> Result<Recipe> {
        let constants = self.constants();
        let parts = [
            &constants,
            PRELUDE,
            G::WGSL,
            include_str!("glyph.wgsl"),
            include_str!("mesh_glyph.wgsl"),
        ];
        let buffers = self.buffers(easel)?;
        let slices = self.levels.most().div_ceil(mesh::SLICE);
        let steps = mesh::steps(easel, &parts, (&buffers, self.count()?, (1, slices)))?;
        let easel = Rc::clone(easel);
        Ok(Recipe { easel, footprint: self.footprint(0), steps, rooms: vec![] })
    }
}
