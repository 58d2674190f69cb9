//! A renderer that leaves nothing out, as far as anyone can tell.
//!
//! What is hidden changes no pixel, so the picture after each step is that of a renderer that draws
//! all it is given. Only the counts differ, and that nothing is known to be hidden before it is
//! drawn. This is what the thesis measured.

use puncta::{
    Amount, Brick, Content, CpuRenderer, Picture, Record, Renderer, View, core::VisibleBrick,
    cpu::Error,
};

/// What becomes of bricks that lie behind what was drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Hidden {
    #[default]
    Skipped,
    Drawn,
}

/// The renderer of the CPU that counts what is hidden in one of two ways.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counting {
    pub(crate) hidden: Hidden,
    renderer: CpuRenderer,
}

impl Counting {
    pub(crate) fn new(hidden: Hidden) -> Self {
        Self { hidden, renderer: CpuRenderer::default() }
    }
}

impl<R: Record> Renderer<R> for Counting {
    type Error = Error;

    fn begin(&mut self, view: &View) -> Result<(), Error> {
        Renderer::<R>::begin(&mut self.renderer, view)
    }

    fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
        let drawn = self.renderer.draw(content, bricks)?;
        let all: &[Brick] = content.bricks;
        Ok(if self.hidden == Hidden::Drawn { Amount::of(all, bricks) } else { drawn })
    }

    fn recall(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<u64, Error> {
        self.renderer.recall(content, bricks)
    }

    fn forget(&mut self) {
        Renderer::<R>::forget(&mut self.renderer);
    }

    fn survey(
        &mut self,
        content: &Content<'_, R>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Error> {
        match self.hidden {
            Hidden::Skipped => self.renderer.survey(content, left),
            Hidden::Drawn => Ok(None),
        }
    }

    fn finish(&mut self, content: &Content<'_, R>) -> Result<Picture, Error> {
        Renderer::<R>::finish(&mut self.renderer, content)
    }
}
