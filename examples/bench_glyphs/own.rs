//! The renderers of the library: what they skip is part of the comparison.

use crate::{
    boxes::ANY_FACE,
    curves::Curves,
    easel::{NOTHING, Sight},
    way::{Footprint, Way},
};
use anyhow::{Error, Result};
use puncta::{Bricks, Depth, FrustumCull, Glyph, NO_RECORD, Pipeline, Renderer, View};

/// A renderer with a scene of its own.
pub(crate) struct Own<'a, G: Glyph, B, D> {
    pipeline: Pipeline<(FrustumCull, Depth), D>,
    curves: &'a Curves<G, B>,
    view: &'a View,
    /// What representations call a record, by its place in the scene.
    name: Box<dyn Fn(u32) -> u32 + 'a>,
}

impl<'a, G: Glyph, B: Bricks, D> Own<'a, G, B, D> {
    pub(crate) fn new(
        renderer: D,
        curves: &'a Curves<G, B>,
        view: &'a View,
        name: Box<dyn Fn(u32) -> u32 + 'a>,
    ) -> Self {
        let pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
        Self { pipeline, curves, view, name }
    }
}

impl<G: Glyph, B: Bricks, D: Renderer<G>> Way for Own<'_, G, B, D>
where
    Error: From<D::Error>,
{
    /// What is in the memory of the CPU: records, bricks and the table.
    fn footprint(&self) -> Footprint {
        let Curves { scene, bricks, glyphs } = self.curves;
        let records = size_of_val(scene.records.as_slice());
        let bytes = records + size_of_val(bricks.bricks()) + 4 * glyphs.table.len();
        Footprint { glyphs: bytes as u64, fixed: size_of::<G::Style>() as u64, scratch: 0 }
    }

    fn draw(&mut self, sight: Sight) -> Result<bool> {
        if sight == Sight::Away {
            return Ok(false);
        }
        // Otherwise what was seen would be drawn first.
        self.pipeline.forget::<G>();
        let Curves { scene, bricks, .. } = self.curves;
        for step in &mut self.pipeline.progressive(scene, bricks, self.view, u64::MAX)? {
            step?;
        }
        Ok(true)
    }

    fn words(&mut self) -> Result<Vec<u32>> {
        let picture = self.pipeline.render(&self.curves.scene, &self.curves.bricks, self.view)?;
        let word = |id: &u32| {
            if *id == NO_RECORD { NOTHING } else { 8 * (self.name)(*id) + ANY_FACE }
        };
        Ok(picture.id.iter().map(word).collect())
    }

    fn vertices(&mut self) -> Result<Option<u64>> {
        Ok(None)
    }
}
