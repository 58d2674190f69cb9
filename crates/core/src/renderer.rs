/*!
Renderers: what draws bricks into a picture, and how it tells where the picture stands.

A renderer may know better than the stages what can still be seen. While it draws, it leaves out what
lies behind everything drawn before. It is asked what each brick that is left could still change
([`Renderer::survey`]): that certifies the end of a picture. And it may begin with the records that
were seen in its last picture ([`Renderer::recall`]), because most of them will be seen again.
*/

use crate::{Block, Brick, Error, Picture, Record, Scene, View, VisibleBrick};
use std::ops::{AddAssign, Range, Sub};

/// What there is to draw.
#[derive(Debug)]
pub struct Content<'a, R> {
    /// The scene that the bricks are made of.
    pub scene: &'a Scene<R>,
    /// All bricks of the scene.
    pub bricks: &'a [Brick],
    /// Blocks of them: see [`Bricks::blocks`](crate::Bricks::blocks).
    pub blocks: &'a [Block],
}

impl<R> Clone for Content<'_, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Content<'_, R> {}

impl<R: Record> Content<'_, R> {
    /// Checks that the scene is valid, that its bricks are made of records that are there, and that
    /// those in play are among the bricks. Renderers that index do this first.
    ///
    /// # Errors
    ///
    /// As [`Scene::validate`], [`Error::BrickRange`] or [`Error::UnknownBrick`].
    pub fn validate(&self, visible: &[VisibleBrick]) -> Result<(), Error> {
        self.scene.validate()?;
        let records = self.scene.records.len();
        for index in visible.iter().map(VisibleBrick::index) {
            let bricks = self.bricks.len();
            let brick =
                self.bricks.get(index as usize).ok_or(Error::UnknownBrick { index, bricks })?;
            let Range { start, end } = brick.records;
            if start > end || end as usize > records {
                return Err(Error::BrickRange { brick: index as usize, start, end, records });
            }
        }
        Ok(())
    }
}

/// Draws bricks into a picture.
///
/// Drawing is order independent: whatever the order of the bricks, the picture shows the nearest
/// surface, and the lower [`Scene::id`] where two are equally near.
///
/// A picture begins with [`begin`](Self::begin), and ends when the next one begins. In between, the
/// other methods may be called in any order and any number of times. Different contents may go into one
/// picture, but ids do not tell them apart, and a renderer may refuse it. A renderer may know bricks and blocks by where they lie in
/// memory: until the picture ends, none of them may change, nor others take their place.
///
/// # Examples
///
/// A renderer that draws nothing but counts what it would have to draw:
///
/// ```
/// use puncta_core::{Amount, Content, Error, Picture, Record, Renderer, View, VisibleBrick};
///
/// #[derive(Default)]
/// struct Count {
///     size: (u32, u32),
///     drawn: Amount,
/// }
///
/// impl<R: Record> Renderer<R> for Count {
///     type Error = Error;
///
///     fn begin(&mut self, view: &View) -> Result<(), Error> {
///         *self = Self { size: (view.width(), view.height()), drawn: Amount::default() };
///         Ok(())
///     }
///
///     fn draw(&mut self, content: &Content<'_, R>, bricks: &[VisibleBrick]) -> Result<Amount, Error> {
///         let amount = Amount::of(content.bricks, bricks);
///         self.drawn += amount;
///         Ok(amount)
///     }
///
///     fn finish(&mut self, _: &Content<'_, R>) -> Result<Picture, Error> {
///         Picture::new(self.size.0, self.size.1)
///     }
/// }
/// ```
pub trait Renderer<R: Record> {
    /// What can go wrong.
    type Error: From<Error>;

    /// Starts a new picture, whatever became of the one before.
    ///
    /// # Errors
    ///
    /// When there cannot be such a picture.
    fn begin(&mut self, view: &View) -> Result<(), Self::Error>;

    /// Draws bricks into the picture, in the order of the stages or another one, and returns what it
    /// drew: it may leave out bricks that can change no pixel.
    ///
    /// # Errors
    ///
    /// When no picture was begun, the content is not valid, or the device fails.
    fn draw(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Self::Error>;

    /// Draws the records that were seen in the picture before this one, each once, as far as they
    /// lie in these bricks. Returns how many it drew.
    ///
    /// By default it remembers nothing.
    ///
    /// # Errors
    ///
    /// As [`Renderer::draw`].
    fn recall(
        &mut self,
        content: &Content<'_, R>,
        bricks: &[VisibleBrick],
    ) -> Result<u64, Self::Error> {
        let _ = (content, bricks);
        Ok(0)
    }

    /// Forgets what was seen in the pictures that it drew, which [`Renderer::recall`] would draw.
    fn forget(&mut self) {}

    /// Notes for each of the bricks that are left how much it may be expected to change, and whether it
    /// can change anything ([`VisibleBrick::set_gain`]), and returns how many pixels they can change
    /// together, at most. `None`, which is the default, says that the renderer does not know.
    ///
    /// # Errors
    ///
    /// As [`Renderer::draw`].
    fn survey(
        &mut self,
        content: &Content<'_, R>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Self::Error> {
        let _ = (content, left);
        Ok(None)
    }

    /// The picture of all that was drawn since [`Renderer::begin`], which was of this content. Drawing
    /// can go on afterwards.
    ///
    /// # Errors
    ///
    /// When no picture was begun, or the device fails.
    fn finish(&mut self, content: &Content<'_, R>) -> Result<Picture, Self::Error>;
}

/// An amount of bricks and of their records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Amount {
    /// A number of bricks.
    pub bricks: u64,
    /// The number of records in them.
    pub records: u64,
}

impl Amount {
    /// The amount of the bricks in play; those that are not among `bricks` hold nothing.
    #[must_use]
    pub fn of(bricks: &[Brick], visible: &[VisibleBrick]) -> Self {
        let records = |brick: &VisibleBrick| {
            bricks.get(brick.index() as usize).map_or(0, |brick| brick.records.len() as u64)
        };
        Self { bricks: visible.len() as u64, records: visible.iter().map(records).sum() }
    }
}

impl AddAssign for Amount {
    fn add_assign(&mut self, other: Self) {
        self.bricks += other.bricks;
        self.records += other.records;
    }
}

/// What remains; nothing where more is taken than there is.
impl Sub for Amount {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            bricks: self.bricks.saturating_sub(other.bricks),
            records: self.records.saturating_sub(other.records),
        }
    }
}

/// Where a picture stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// What was drawn.
    pub drawn: Amount,
    /// What was not drawn because it can change no pixel: it lies behind what was drawn, or beside the
    /// picture.
    pub skipped: Amount,
    /// What is still to be drawn.
    pub left: Amount,
    /// What the stages dropped.
    pub culled: Amount,
    /// How many records were drawn first because they were seen in the picture before. Their bricks
    /// are drawn all the same, unless they are skipped.
    pub recalled: u64,
    /// The number of pixels that anything left could still change, at most.
    pub open: u64,
}

impl Progress {
    /// Whether nothing that is left can change any pixel: the picture is complete.
    #[must_use]
    pub const fn settled(&self) -> bool {
        self.open == 0
    }
}
