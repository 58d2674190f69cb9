//! Drawing pictures of a scene, from the camera and from the sky.

use super::{backend::Backend, built::Built, options::Drawing as Options, progress::Bar};
use anyhow::Result;
use puncta::{Amount, Bricks, Depth, FrustumCull, Glyph, Picture, Pipeline, View};

/// A scene, and what draws it.
pub(crate) struct Drawing<'a, G: Glyph, B> {
    built: &'a Built<G, B>,
    pipeline: Pipeline<(FrustumCull, Depth), Backend<G>>,
}

impl<'a, G: Glyph + 'static, B: Bricks> Drawing<'a, G, B> {
    pub(crate) fn new(options: &Options, built: &'a Built<G, B>) -> Result<Self> {
        let backend = Backend::new(options, &built.glyphs)?;
        let pipeline = Pipeline::new((FrustumCull, Depth::default()), backend);
        Ok(Self { built, pipeline })
    }

    /// What draws, for people.
    pub(crate) fn backend(&self) -> &str {
        &self.pipeline.renderer().name
    }

    /// Draws the whole picture, with a progress bar, and says what it took.
    pub(crate) fn picture(&mut self, view: &View) -> Result<(Picture, Amount)> {
        let Built { scene, bricks, .. } = self.built;
        let budget = (scene.records.len() as u64 / 100).max(1 << 18);
        let mut steps = self.pipeline.progressive(scene, bricks, view, budget)?;
        let all = steps.progress().left.records;
        let bar = Bar::counting("drawing", all);
        for step in &mut steps {
            bar.set(all - step?.left.records.min(all));
        }
        bar.finish();
        Ok((steps.picture()?, steps.progress().drawn))
    }

    /// Draws a picture without a bar.
    pub(crate) fn quietly(&mut self, view: &View) -> Result<Picture> {
        let Built { scene, bricks, .. } = self.built;
        self.pipeline.render(scene, bricks, view)
    }
}
