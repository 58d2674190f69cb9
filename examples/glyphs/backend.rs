//! What draws: the one place that knows of the CPU and of GPUs.

use super::options::BackendKind;
use anyhow::{Result, bail};
use puncta::{
    Amount, Content, Glyph, Glyphs, Picture, Renderer, View,
    avc::{Lens, Surface},
    core::{Camera, VisibleBrick},
};

/// A renderer of either kind.
pub(crate) struct Backend<G: Glyph> {
    renderer: Box<dyn Renderer<G, Error = anyhow::Error>>,
    /// What it is, for people.
    pub(crate) name: String,
}

impl<G: Glyph + 'static> Backend<G> {
    /// The renderer that was asked for.
    pub(crate) fn new(kind: BackendKind, glyphs: &Glyphs<G>) -> Result<Self> {
        match kind {
            BackendKind::Cpu => Ok(Self {
                renderer: Box::new(Naive { glyphs: glyphs.clone(), view: None, picture: None }),
                name: "CPU".to_owned(),
            }),
            BackendKind::Gpu => bail!("glyphs are drawn on the CPU only"),
        }
    }
}

impl<G: Glyph> Renderer<G> for Backend<G> {
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        self.renderer.begin(view)
    }

    fn draw(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<Amount> {
        self.renderer.draw(content, bricks)
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

struct Naive<G: Glyph> {
    glyphs: Glyphs<G>,
    view: Option<View>,
    picture: Option<Picture>,
}

impl<G: Glyph> Renderer<G> for Naive<G> {
    type Error = anyhow::Error;

    fn begin(&mut self, view: &View) -> Result<()> {
        self.view = Some(view.clone());
        self.picture = Some(Picture::new(view.width(), view.height())?);
        Ok(())
    }

    #[allow(clippy::all, clippy::cast_possible_truncation, reason = "x")]
    fn draw(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<Amount> {
        let view = self.view.as_ref().unwrap();
        let picture = self.picture.as_mut().unwrap();
        let camera = Camera::new(view, content.scene.origin);
        let lens = Lens::new(&camera, self.glyphs.tolerance);
        let cloud = self.glyphs.cloud(&content.scene.records);
        let mut surface = Surface::default();
        for brick in bricks {
            let records = content.bricks[brick.index() as usize].records.clone();
            for index in records {
                surface.fill(&lens, &cloud, index as usize, brick.near());
                for facet in surface.facets() {
                    let [a, b] = facet.rows(view.height());
                    for row in a..=b {
                        let [first, last] = facet.span(row as f64, view.width());
                        let depths = facet.depth_of_row(row as f64);
                        for column in first..=last {
                            let depth = depths.at(column as f64) as f32;
                            let at = row as usize * view.width() as usize + column as usize;
                            if depth < picture.depth[at]
                                || (depth == picture.depth[at]
                                    && content.scene.id(index) < content.scene.id(picture.id[at]))
                            {
                                picture.depth[at] = depth;
                                picture.id[at] = index;
                            }
                        }
                    }
                }
            }
        }
        Ok(Amount::of(content.bricks, bricks))
    }

    fn finish(&mut self, _: &Content<'_, G>) -> Result<Picture> {
        Ok(self.picture.clone().unwrap())
    }
}
