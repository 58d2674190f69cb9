//! What draws: the CPU, or a GPU.

use crate::options::{BackendKind, Options};
use anyhow::{Result, bail};
use puncta::{Amount, Content, CpuRenderer, Picture, Renderer, Sphere, View, core::VisibleBrick};

/// A renderer of either kind.
pub(crate) struct Backend {
    renderer: Box<dyn Renderer<Sphere, Error = anyhow::Error>>,
    /// What it is, for people.
    pub(crate) name: String,
}

impl Backend {
    /// The renderer that was asked for.
    pub(crate) fn new(options: &Options) -> Result<Self> {
        match options.backend {
            BackendKind::Cpu => {
                let Options { adapter, setup, fragment, .. } = options;
                if [adapter, setup, fragment].into_iter().any(Option::is_some) {
                    bail!("--adapter, --setup and --fragment are for --backend gpu");
                }
                let renderer = Box::new(AnyError(CpuRenderer::default()));
                Ok(Self { renderer, name: "CPU".to_owned() })
            }
            BackendKind::Gpu => gpu(options),
        }
    }
}

#[cfg(feature = "gpu")]
fn gpu(options: &Options) -> Result<Backend> {
    use anyhow::{Context, Error};
    use puncta::{Gpu, GpuConfig, GpuRenderer, gpu::Extent};
    let adapter = options.adapter.as_deref();
    let gpu = Gpu::new(adapter, Extent::Full).context("--backend cpu needs no GPU")?;
    let config = GpuConfig {
        setup: options.setup.as_deref().map(str::parse).transpose().map_err(Error::msg)?,
        fragment: options.fragment.as_deref().map(str::parse).transpose().map_err(Error::msg)?,
        ..GpuConfig::default()
    };
    let renderer = GpuRenderer::new(&gpu, config)?;
    let name = format!("{}, {}, {}", gpu.name(), renderer.setup(), renderer.fragment());
    Ok(Backend { renderer: Box::new(AnyError(renderer)), name })
}

#[cfg(not(feature = "gpu"))]
fn gpu(_: &Options) -> Result<Backend> {
    bail!("this build draws on the CPU only; build it with the feature gpu")
}

impl Renderer<Sphere> for Backend {
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        self.renderer.begin(view)
    }

    fn draw(&mut self, content: &Content<'_, Sphere>, bricks: &[VisibleBrick]) -> Result<Amount> {
        self.renderer.draw(content, bricks)
    }

    fn survey(
        &mut self,
        content: &Content<'_, Sphere>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>> {
        self.renderer.survey(content, left)
    }

    fn finish(&mut self, content: &Content<'_, Sphere>) -> Result<Picture> {
        self.renderer.finish(content)
    }
}

/// A renderer whose errors are those of a tool.
struct AnyError<D>(D);

impl<D> Renderer<Sphere> for AnyError<D>
where
    D: Renderer<Sphere>,
    anyhow::Error: From<D::Error>,
{
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        Ok(self.0.begin(view)?)
    }

    fn draw(&mut self, content: &Content<'_, Sphere>, bricks: &[VisibleBrick]) -> Result<Amount> {
        Ok(self.0.draw(content, bricks)?)
    }

    fn survey(
        &mut self,
        content: &Content<'_, Sphere>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>> {
        Ok(self.0.survey(content, left)?)
    }

    fn finish(&mut self, content: &Content<'_, Sphere>) -> Result<Picture> {
        Ok(self.0.finish(content)?)
    }
}
