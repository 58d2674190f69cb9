/*!
Ways to draw a scene: what all of them can do, and those that are a list of steps of a device.

Without pixels: WebGPU cannot turn the rasteriser off. Everything is moved so far to the right that each
triangle lies beyond that side of the picture. So all vertices are made, and the clipper drops all
triangles. What is left out by a compute shader is what the view leaves out where it is.
*/

use crate::easel::{Easel, Sight};
use anyhow::{Result, ensure};
use puncta::gpu::wgpu;
use std::{ops::Range, rc::Rc};

/// What lies in memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    /// All that grows with the number of glyphs.
    pub(crate) glyphs: u64,
    /// What does not.
    pub(crate) fixed: u64,
    /// What is written anew in each frame.
    pub(crate) scratch: u64,
}

/// A representation of a scene that can be drawn.
pub(crate) trait Way {
    fn footprint(&self) -> Footprint;

    /// Draws a frame and waits until it is done. `false`: it cannot be drawn away from the picture.
    fn draw(&mut self, sight: Sight) -> Result<bool>;

    /// What the pixels of the last frame show: `8 id + face`.
    fn words(&mut self) -> Result<Vec<u32>>;

    /// How often a vertex is made in a frame, if that can be told.
    fn vertices(&mut self) -> Result<Option<u64>>;

    /// Checks what can be checked after a frame.
    fn check(&self) -> Result<()> {
        Ok(())
    }
}

/// Something to do in a frame.
#[derive(Debug)]
pub(crate) enum Step {
    Compute { pipeline: wgpu::ComputePipeline, bound: wgpu::BindGroup, groups: u32 },
    Draw(Box<Draw>),
}

/// A draw call, and what it needs.
#[derive(Debug)]
pub(crate) struct Draw {
    pub(crate) pipeline: wgpu::RenderPipeline,
    pub(crate) bound: wgpu::BindGroup,
    pub(crate) vertices: Vec<wgpu::Buffer>,
    pub(crate) indices: Option<(wgpu::Buffer, wgpu::IndexFormat)>,
    pub(crate) call: Call,
}

#[derive(Clone, Debug)]
pub(crate) enum Call {
    Vertices(u32, Range<u32>),
    Indices(u32, Range<u32>),
    Indirect(wgpu::Buffer),
    Meshes(u32, u32),
}

/// Room for indices: what was wanted must fit, and be what the CPU expects.
#[derive(Debug)]
pub(crate) struct Room {
    pub(crate) arguments: wgpu::Buffer,
    pub(crate) indices: u64,
    pub(crate) expected: Option<u64>,
}

/// A list of steps.
#[derive(Debug)]
pub(crate) struct Recipe {
    pub(crate) easel: Rc<Easel>,
    pub(crate) footprint: Footprint,
    pub(crate) steps: Vec<Step>,
    pub(crate) rooms: Vec<Room>,
}

impl Recipe {
    fn run(&self, sight: Sight, count: Option<&wgpu::QuerySet>) -> Result<u32> {
        self.easel.look(sight);
        let gpu = &self.easel.device.gpu;
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        let is_draw = |step: &Step| matches!(step, Step::Draw(_));
        let mut passes = 0;
        for steps in self.steps.chunk_by(|a, b| is_draw(a) == is_draw(b)) {
            if !is_draw(&steps[0]) {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for step in steps {
                    if let Step::Compute { pipeline, bound, groups } = step {
                        pass.set_pipeline(pipeline);
                        pass.set_bind_group(0, bound, &[]);
                        pass.dispatch_workgroups(*groups, 1, 1);
                    }
                }
                continue;
            }
            let mut pass = self.easel.pass(&mut encoder, passes == 0);
            if let Some(count) = count {
                pass.begin_pipeline_statistics_query(count, passes);
            }
            for step in steps {
                if let Step::Draw(draw) = step {
                    draw.encode(&mut pass);
                }
            }
            if count.is_some() {
                pass.end_pipeline_statistics_query();
            }
            passes += 1;
        }
        gpu.queue().submit([encoder.finish()]);
        gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
        Ok(passes)
    }
}

impl Draw {
    fn encode(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bound, &[]);
        for (slot, buffer) in (0..).zip(&self.vertices) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        if let Some((buffer, format)) = &self.indices {
            pass.set_index_buffer(buffer.slice(..), *format);
        }
        match &self.call {
            Call::Vertices(vertices, instances) => pass.draw(0..*vertices, instances.clone()),
            Call::Indices(indices, instances) => {
                pass.draw_indexed(0..*indices, 0, instances.clone());
            }
            Call::Indirect(arguments) => pass.draw_indexed_indirect(arguments, 0),
            Call::Meshes(groups, slices) => pass.draw_mesh_tasks(*groups, *slices, 1),
        }
    }
}

impl Way for Recipe {
    fn footprint(&self) -> Footprint {
        self.footprint
    }

    fn draw(&mut self, sight: Sight) -> Result<bool> {
        self.run(sight, None).map(|_| true)
    }

    fn words(&mut self) -> Result<Vec<u32>> {
        self.easel.words()
    }

    fn vertices(&mut self) -> Result<Option<u64>> {
        let draws = self.steps.iter().filter(|step| matches!(step, Step::Draw(_))).count();
        let has_meshes = self
            .steps
            .iter()
            .any(|step| matches!(step, Step::Draw(draw) if matches!(draw.call, Call::Meshes(..))));
        if !self.easel.can_count() || has_meshes {
            return Ok(None);
        }
        let device = &self.easel.device;
        let count = u32::try_from(draws)?;
        let set = device.gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("Recipe::vertices"),
            ty: wgpu::QueryType::PipelineStatistics(
                wgpu::PipelineStatisticsTypes::VERTEX_SHADER_INVOCATIONS,
            ),
            count,
        });
        let passes = self.run(Sight::Here, Some(&set))?;
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let buffer = device.buffer("Recipe::counted", 8 * u64::from(count), usage);
        let mut encoder = device.gpu.device().create_command_encoder(&Default::default());
        encoder.resolve_query_set(&set, 0..passes, &buffer, 0);
        device.gpu.queue().submit([encoder.finish()]);
        let words = device.read(&buffer)?;
        let counts = words.chunks_exact(2).take(passes as usize);
        Ok(Some(counts.map(|pair| u64::from(pair[0]) | u64::from(pair[1]) << 32).sum()))
    }

    fn check(&self) -> Result<()> {
        for room in &self.rooms {
            let arguments = self.easel.device.read(&room.arguments)?;
            let wanted = u64::from(arguments[5]);
            ensure!(wanted <= room.indices, "room for {} of {wanted} indices", room.indices);
            if let Some(expected) = room.expected {
                ensure!(wanted == expected, "{wanted} indices instead of {expected}");
            }
        }
        Ok(())
    }
}
