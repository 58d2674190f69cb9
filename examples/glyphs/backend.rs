//! What draws: the one place that knows of the CPU and of GPUs.

use super::options::{BackendKind, Drawing};
use anyhow::{Context, Result, bail};
use puncta::{
    Amount, Content, CpuRenderer, Glyph, Glyphs, Gpu, GpuConfig, GpuRenderer, Picture, Renderer,
    View, core::VisibleBrick, gpu::Extent,
};

/// A renderer of either kind.
pub(crate) struct Backend<G: Glyph> {
    renderer: Box<dyn Renderer<G, Error = anyhow::Error> + Send>,
    /// What it is, for people.
    pub(crate) name: String,
}

impl<G: Glyph + 'static> Backend<G> {
    /// The renderer that was asked for.
    pub(crate) fn new(options: &Drawing, glyphs: &Glyphs<G>) -> Result<Self> {
        match options.backend {
            BackendKind::Cpu if options.adapter.is_some() => {
                bail!("--adapter is for --backend gpu")
            }
            BackendKind::Cpu => {
                let renderer = Box::new(AnyError(CpuRenderer::of(glyphs.clone())));
                Ok(Self { renderer, name: "CPU".to_owned() })
            }
            BackendKind::Gpu => gpu(options, glyphs),
        }
    }
}

fn gpu<G: Glyph + 'static>(options: &Drawing, glyphs: &Glyphs<G>) -> Result<Backend<G>> {
    let adapter = options.adapter.as_deref();
    let gpu = Gpu::new(adapter, Extent::Full).context("--backend cpu needs no GPU")?;
    let renderer = GpuRenderer::of(&gpu, glyphs.clone(), GpuConfig::default())?;
    Ok(Backend { name: gpu.name().to_owned(), renderer: Box::new(AnyError(renderer)) })
}

impl<G: Glyph> Renderer<G> for Backend<G> {
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        self.renderer.begin(view)
    }

    fn draw(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<Amount> {
        self.renderer.draw(content, bricks)
    }

    fn recall(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<u64> {
        self.renderer.recall(content, bricks)
    }

    fn forget(&mut self) {
        self.renderer.forget();
    }

    fn survey(
        &mut self,
        content: &Content<'_, G>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>> {
        self.renderer.survey(content, left)
    }

    fn finish(&mut self, content: &Content<'_, G>) -> Result<Picture> {
        self.renderer.finish(content)
    }
}

/// A renderer whose errors are those of a tool.
struct AnyError<D>(D);

impl<G, D> Renderer<G> for AnyError<D>
where
    G: Glyph,
    D: Renderer<G>,
    anyhow::Error: From<D::Error>,
{
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        Ok(self.0.begin(view)?)
    }

    fn draw(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<Amount> {
        Ok(self.0.draw(content, bricks)?)
    }

    fn recall(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<u64> {
        Ok(self.0.recall(content, bricks)?)
    }

    fn forget(&mut self) {
        self.0.forget();
    }

    fn survey(
        &mut self,
        content: &Content<'_, G>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>> {
        Ok(self.0.survey(content, left)?)
    }

    fn finish(&mut self, content: &Content<'_, G>) -> Result<Picture> {
        Ok(self.0.finish(content)?)
    }
}
