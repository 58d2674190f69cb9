//! The renderer: what is drawn, what is left out, and what is still open.

use crate::{
    Error,
    band::{Members, Piece},
    cache,
    drawing::Drawing,
    knowledge::Knowledge,
    shape::{Shape, Spheres},
    survey::{self, Outlook},
};
use puncta_avc::Level;
use puncta_core::{
    Amount, Brick, Camera, Content, Picture, Record, ScreenBound, View, VisibleBrick,
};
use std::sync::atomic::AtomicBool;

/// The share of the bricks that are drawn before blocks are tested for the first time, and the
/// smallest number: from then on twice as many each time.
const FIRST_SHARE: usize = 32;
const FIRST_MIN: usize = 256;

/// Draws exactly, on all cores of the present rayon pool: spheres, or glyphs if it is made
/// [of them](CpuRenderer::of).
///
/// At each pixel the picture shows the nearest point where its ray enters a sphere, or meets a triangle
/// of a glyph from in front, at a view depth of at least [`View::near`]; of equal depths the one with
/// the lower [`puncta_core::Scene::id`]. So what holds the camera is not drawn, and what the near plane
/// cuts open is hollow. What covers no pixel's centre is not seen, nor is a view depth beyond what
/// `f32` holds.
///
/// Against exact arithmetic, a silhouette is off by at most 1e-4 of a pixel and a view depth by at
/// most 2⁻²² of itself. Set-up is in `f64`, from offsets relative to the eye; so neither a narrow
/// angle nor the distance of the scene from the world's origin changes that. Only the last digits of
/// `f64` set a limit: a surface that is nearer to the eye than 1e-8 of its size.
///
/// Curved surfaces of glyphs are drawn as finely as the nearest point of their brick needs
/// ([`puncta_avc::Glyphs::tolerance`]). A record's triangles depend on the view and the record's brick, and on nothing
/// that was drawn before.
///
/// Bricks and blocks of bricks that lie behind what was drawn before are left out; the picture is the
/// same as if they were drawn. It does not depend on the number of threads, and neither does what is
/// left out.
///
/// # Examples
///
/// See the [crate's page](crate).
#[derive(Clone, Debug)]
pub struct CpuRenderer<S = Spheres> {
    pub(crate) shape: S,
    frame: Option<Drawing>,
    /// The ids of the picture before this one, and whether anything was drawn since.
    last: Vec<u32>,
    has_drawn: bool,
    knowledge: Knowledge,
    outlook: Outlook,
}

impl Default for CpuRenderer {
    fn default() -> Self {
        Self::with(Spheres)
    }
}

impl<S> CpuRenderer<S> {
    pub(crate) fn with(shape: S) -> Self {
        Self {
            shape,
            frame: None,
            last: Vec::new(),
            has_drawn: false,
            knowledge: Knowledge::default(),
            outlook: Outlook::default(),
        }
    }

    /// Starts a new picture.
    pub(crate) fn start(&mut self, view: &View) {
        self.knowledge.clear();
        self.outlook.clear();
        match &mut self.frame {
            Some(drawing) => {
                // A picture of nothing is no reason to forget the one before.
                if self.has_drawn {
                    std::mem::swap(&mut self.last, &mut drawing.id);
                }
                drawing.restart(view);
            }
            None => self.frame = Some(Drawing::new(view)),
        }
        self.has_drawn = false;
    }

    /// Draws bricks, and leaves out what is found hidden on the way.
    pub(crate) fn draw_bricks<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Error>
    where
        S: Shape<R>,
    {
        let camera = self.prepare(content, bricks)?;
        let (mut rest, mut drawn) = (bricks, Amount::default());
        let mut count = (bricks.len() / FIRST_SHARE).max(FIRST_MIN);
        while !rest.is_empty() {
            let (now, later) = rest.split_at(count.min(rest.len()));
            drawn += self.draw_round(content, &camera, now)?;
            rest = later;
            count *= 2;
            if !rest.is_empty() {
                let drawing = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
                drawing.freshen();
                self.knowledge.hide_blocks(content, drawing);
            }
        }
        Ok(drawn)
    }

    /// Draws the records that were seen in the picture before.
    pub(crate) fn draw_seen<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<u64, Error>
    where
        S: Shape<R>,
    {
        let camera = self.prepare(content, bricks)?;
        let ids = cache::visible(&self.last);
        let runs = cache::runs(&ids, content.bricks, bricks);
        let holders: Vec<u32> = runs.iter().map(|(brick, _)| *brick).collect();
        let bounds = self.knowledge.bounds(content, &camera, &holders);
        let pieces: Vec<Piece<'_>> = runs
            .iter()
            .zip(bounds)
            .map(|((brick, ids), bound)| {
                piece(&content.bricks[*brick as usize], bound, Members::Some(ids))
            })
            .collect();
        self.draw_pieces(content, &camera, &pieces)?;
        Ok(runs.iter().map(|(_, ids)| ids.len() as u64).sum())
    }

    pub(crate) fn forget_seen(&mut self) {
        self.last.clear();
        self.has_drawn = false;
    }

    /// Finds what the bricks that are left may still change.
    pub(crate) fn look_at<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Error> {
        let camera = self.prepare(content, left)?;
        let drawing = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
        drawing.freshen();
        self.knowledge.hide_blocks(content, drawing);
        let indices = indices(left);
        let bounds = self.knowledge.bounds(content, &camera, &indices);
        self.knowledge.keep(&indices, &bounds);
        self.outlook = survey::survey(drawing, left, &bounds);
        Ok(Some(self.outlook.count(drawing)))
    }

    pub(crate) fn picture(&self) -> Result<Picture, Error> {
        let drawing = self.frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
        let mut picture = Picture::new(drawing.view.width(), drawing.view.height())?;
        let (width, stride) = (picture.width as usize, drawing.stride);
        let seen = |row: usize| row * stride..row * stride + width;
        for (row, (depth, id)) in
            picture.depth.chunks_mut(width).zip(picture.id.chunks_mut(width)).enumerate()
        {
            depth.copy_from_slice(&drawing.depth[seen(row)]);
            id.copy_from_slice(&drawing.id[seen(row)]);
        }
        Ok(picture)
    }

    /// Whether the bricks that were left when [`puncta_core::Renderer::survey`] was last asked may still change a
    /// pixel. Before that, all pixels are open.
    ///
    /// Those drawn since count as left.
    #[must_use]
    pub fn is_open(&self, column: u32, row: u32) -> bool {
        let is_inside =
            |drawing: &&Drawing| column < drawing.view.width() && row < drawing.view.height();
        self.frame
            .as_ref()
            .filter(is_inside)
            .is_some_and(|drawing| self.outlook.is_open(drawing, column as usize, row as usize))
    }

    /// Checks what is to be drawn, and gets ready for it.
    fn prepare<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Camera, Error> {
        let drawing = self.frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
        content.validate(bricks)?;
        let camera = Camera::new(&drawing.view, content.scene.origin);
        self.knowledge.prepare(content, &camera);
        Ok(camera)
    }

    /// Draws some bricks, and tells how much of them it had to draw.
    fn draw_round<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        camera: &Camera,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Error>
    where
        S: Shape<R>,
    {
        let bounds = self.knowledge.bounds(content, camera, &indices(bricks));
        let whole = |(brick, bound): (&VisibleBrick, ScreenBound)| {
            let brick = &content.bricks[brick.index() as usize];
            piece(brick, bound, Members::All(brick.records.clone()))
        };
        let seen = bricks.iter().zip(bounds).filter(|(_, bound)| !bound.is_empty());
        let pieces: Vec<Piece<'_>> = seen.map(whole).collect();
        self.draw_pieces(content, camera, &pieces)
    }

    fn draw_pieces<R: Record>(
        &mut self,
        content: &Content<'_, R>,
        camera: &Camera,
        pieces: &[Piece<'_>],
    ) -> Result<Amount, Error>
    where
        S: Shape<R>,
    {
        let drawing = self.frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
        let ids = content.scene.attributes.ids.as_deref();
        let records = content.scene.records.as_slice();
        drawing.draw((camera, ids), (&self.shape, records), pieces);
        let amounts = pieces.iter().map(Piece::drawn);
        let drawn = amounts.fold(Amount::default(), |mut sum, amount| {
            sum += amount;
            sum
        });
        self.has_drawn |= drawn.bricks > 0;
        Ok(drawn)
    }
}

fn indices(bricks: &[VisibleBrick]) -> Vec<u32> {
    bricks.iter().map(VisibleBrick::index).collect()
}

fn piece<'a>(brick: &Brick, bound: ScreenBound, members: Members<'a>) -> Piece<'a> {
    let level = Level::of(brick, bound.nearest);
    Piece { bound, level, members, is_drawn: AtomicBool::new(false) }
}
