//! What draws: the CPU, or a GPU.

use crate::options::{BackendKind, Options};
use anyhow::{Context, Result, bail};
use puncta::{
    Amount, Content, CpuRenderer, Gpu, GpuConfig, GpuRenderer, Picture, Renderer, Sphere, View,
    core::VisibleBrick, gpu::Extent,
};

/// One of the renderers.
#[derive(Debug)]
pub(crate) enum Backend {
    Cpu(CpuRenderer),
    Gpu(Box<GpuRenderer>),
}

impl Backend {
    /// The renderer that was asked for.
    pub(crate) fn new(options: &Options) -> Result<Self> {
        match options.backend {
            BackendKind::Cpu => {
                if options.adapter.is_some()
                    || options.setup.is_some()
                    || options.fragment.is_some()
                {
                    bail!("--adapter, --setup and --fragment are for --backend gpu");
                }
                Ok(Self::Cpu(CpuRenderer::default()))
            }
            BackendKind::Gpu => {
                let gpu = Gpu::new(options.adapter.as_deref(), Extent::Full)
                    .context("--backend cpu needs no GPU")?;
                let (setup, fragment) = (options.setup, options.fragment);
                let config = GpuConfig { setup, fragment, ..GpuConfig::default() };
                Ok(Self::Gpu(Box::new(GpuRenderer::new(&gpu, config)?)))
            }
        }
    }

    /// What it is, for people.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Cpu(_) => "CPU".to_owned(),
            Self::Gpu(renderer) => {
                let (setup, fragment) = (renderer.setup(), renderer.fragment());
                format!("{}, {setup}, {fragment}", renderer.gpu().name())
            }
        }
    }
}

impl Renderer<Sphere> for Backend {
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        match self {
            Self::Cpu(renderer) => Renderer::<Sphere>::begin(renderer, view)?,
            Self::Gpu(renderer) => Renderer::<Sphere>::begin(&mut **renderer, view)?,
        }
        Ok(())
    }

    fn draw(&mut self, content: &Content<'_, Sphere>, bricks: &[VisibleBrick]) -> Result<Amount> {
        Ok(match self {
            Self::Cpu(renderer) => renderer.draw(content, bricks)?,
            Self::Gpu(renderer) => renderer.draw(content, bricks)?,
        })
    }

    fn survey(
        &mut self,
        content: &Content<'_, Sphere>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>> {
        Ok(match self {
            Self::Cpu(renderer) => renderer.survey(content, left)?,
            Self::Gpu(renderer) => renderer.survey(content, left)?,
        })
    }

    fn finish(&mut self, content: &Content<'_, Sphere>) -> Result<Picture> {
        Ok(match self {
            Self::Cpu(renderer) => renderer.finish(content)?,
            Self::Gpu(renderer) => renderer.finish(content)?,
        })
    }
}
