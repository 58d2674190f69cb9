//! What the renderer is to a pipeline: one of spheres, or of glyphs.

use crate::{CpuRenderer, Error};
use puncta_avc::{Glyph, Glyphs};
use puncta_core::{Amount, Content, Picture, Record, Renderer, View, VisibleBrick};

/// Draws spheres of the radius of each record.
impl<R: Record> Renderer<R> for CpuRenderer {
    type Error = Error;

    fn begin(&mut self, view: &View) -> Result<(), Error> {
        self.start(view);
        Ok(())
    }

    fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
        self.draw_bricks(content, bricks)
    }

    fn recall(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<u64, Error> {
        self.draw_seen(content, bricks)
    }

    fn forget(&mut self) {
        self.forget_seen();
    }

    fn survey(
        &mut self,
        content: &Content<'_, R>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Error> {
        self.look_at(content, left)
    }

    fn finish(&mut self, _content: &Content<'_, R>) -> Result<Picture, Error> {
        self.picture()
    }
}

/// Draws the surfaces of glyphs.
impl<G: Glyph> Renderer<G> for CpuRenderer<Glyphs<G>> {
    type Error = Error;

    fn begin(&mut self, view: &View) -> Result<(), Error> {
        self.start(view);
        Ok(())
    }

    fn draw(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
        self.draw_bricks(content, bricks)
    }

    fn recall(&mut self, content: &Content<'_, G>, bricks: &[VisibleBrick]) -> Result<u64, Error> {
        self.draw_seen(content, bricks)
    }

    fn forget(&mut self) {
        self.forget_seen();
    }

    fn survey(
        &mut self,
        content: &Content<'_, G>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Error> {
        self.look_at(content, left)
    }

    fn finish(&mut self, _content: &Content<'_, G>) -> Result<Picture, Error> {
        self.picture()
    }
}

impl<G: Glyph> CpuRenderer<Glyphs<G>> {
    /// A renderer of these glyphs.
    ///
    /// # Examples
    ///
    /// ```
    /// use glam::DVec3;
    /// use puncta_avc::{Cuboid, Glyphs};
    /// use puncta_core::{Pipeline, Scene, View};
    /// use puncta_cpu::{CpuRenderer, Shading, shade_glyphs};
    /// use puncta_grid::{Grid, GridConfig};
    ///
    /// let mut scene = Scene::new(vec![Cuboid::new([0.0; 3], [2.0, 1.0, 1.0])]);
    /// let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    /// let view = View::look_at(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Y)?
    ///     .with_size(7, 5)?
    ///     .with_orthographic(2.0)?;
    /// let mut pipeline = Pipeline::new((), CpuRenderer::of(Glyphs::<Cuboid>::new([])));
    /// let picture = pipeline.render(&scene, &grid, &view)?;
    /// // All that looks at the camera lies at one depth.
    /// assert_eq!(picture.covered_pixels(), 5 * 3);
    /// assert!(picture.depth.iter().all(|&depth| depth == 8.5 || depth == f32::INFINITY));
    ///
    /// let glyphs = pipeline.renderer().glyphs();
    /// let image = shade_glyphs(glyphs, &scene, &grid, &view, &picture, &Shading::default())?;
    /// assert_eq!(image.pixels.len(), 7 * 5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of(glyphs: Glyphs<G>) -> Self {
        Self::with(glyphs)
    }

    /// What is drawn.
    #[must_use]
    pub const fn glyphs(&self) -> &Glyphs<G> {
        &self.shape
    }

    /// What is drawn, to change how.
    ///
    /// What was drawn since [`Renderer::begin`] stays as it was, so a change spoils that picture; the
    /// next one is not concerned.
    #[must_use]
    pub const fn glyphs_mut(&mut self) -> &mut Glyphs<G> {
        &mut self.shape
    }
}
