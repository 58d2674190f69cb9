//! Sources: records in chunks, for scenes that need not be in memory at once.

use crate::{Record, Scene};
use std::convert::Infallible;

/// Something that gives records chunk by chunk: memory, a file, a generator.
///
/// A chunk is appended to a [`Scene`]. Whoever wants it all keeps one scene and lets it grow;
/// whoever has little memory clears the scene between two calls.
///
/// # Examples
///
/// A source of one's own: points on a line, made when they are asked for.
///
/// ```
/// use puncta_core::{Scene, Source, Sphere};
/// use std::convert::Infallible;
///
/// struct Line {
///     next: u16,
/// }
///
/// impl Source for Line {
///     type Record = Sphere;
///     type Error = Infallible;
///
///     fn remaining(&self) -> Option<u64> {
///         Some(u64::from(1000 - self.next))
///     }
///
///     fn append(&mut self, scene: &mut Scene, limit: usize) -> Result<usize, Infallible> {
///         let end = (usize::from(self.next) + limit).min(1000);
///         let run = usize::from(self.next)..end;
///         let sphere = |i: usize| Sphere::new([i as f32, 0.0, 0.0], 0.5);
///         scene.records.extend(run.clone().map(sphere));
///         self.next = end as u16;
///         Ok(run.len())
///     }
/// }
///
/// let scene = Line { next: 0 }.into_scene()?;
/// assert_eq!(scene.records.len(), 1000);
/// # Ok::<(), Infallible>(())
/// ```
pub trait Source: Sized {
    /// The type of the records.
    type Record: Record;
    /// What can go wrong.
    type Error;

    /// How many records are still to come, exactly; `None` if that is not known.
    fn remaining(&self) -> Option<u64>;

    /// Appends at most `limit` records, and their attributes, to `scene`; returns how many.
    ///
    /// Less than `limit` means that the source has come to its end. The origin of the scene is set
    /// by the first call and stays the same from then on.
    ///
    /// The scene is one that is empty, was cleared, or holds what this source gave before. Where
    /// records lie in the order of the source, they need no ids; so whoever clears the scene must
    /// count, and add what was cleared to the index of a record to have its id.
    ///
    /// # Errors
    ///
    /// When the records cannot be had. Those before them are in the scene by then.
    fn append(
        &mut self,
        scene: &mut Scene<Self::Record>,
        limit: usize,
    ) -> Result<usize, Self::Error>;

    /// All records at once.
    ///
    /// # Errors
    ///
    /// When the records cannot be had.
    fn into_scene(mut self) -> Result<Scene<Self::Record>, Self::Error> {
        const CHUNK: usize = 1 << 16;
        let mut scene = Scene::new(Vec::new());
        let remaining = self.remaining().and_then(|remaining| usize::try_from(remaining).ok());
        // Room is a favor: a source that promises more than there is memory grows as it goes.
        scene.records.to_mut().try_reserve_exact(remaining.unwrap_or(0)).ok();
        while self.append(&mut scene, CHUNK)? == CHUNK {}
        Ok(scene)
    }
}

/// Records that are in memory, as a [`Source`].
#[derive(Clone, Debug)]
pub struct SliceSource<'a, R> {
    records: &'a [R],
}

impl<'a, R: Record> SliceSource<'a, R> {
    /// A source of these records.
    #[must_use]
    pub const fn new(records: &'a [R]) -> Self {
        Self { records }
    }
}

impl<R: Record> Source for SliceSource<'_, R> {
    type Record = R;
    type Error = Infallible;

    fn remaining(&self) -> Option<u64> {
        Some(self.records.len() as u64)
    }

    fn append(&mut self, scene: &mut Scene<R>, limit: usize) -> Result<usize, Infallible> {
        let (chunk, rest) = self.records.split_at(limit.min(self.records.len()));
        scene.records.to_mut().extend_from_slice(chunk);
        self.records = rest;
        Ok(chunk.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;

    #[test]
    fn chunks_give_what_the_whole_gives() {
        let records: Vec<Sphere> =
            (0_u16..200).map(|i| Sphere::new([f32::from(i); 3], 1.0)).collect();
        let Ok(whole) = SliceSource::new(&records).into_scene();
        let mut source = SliceSource::new(&records);
        let mut chunks = Scene::new(Vec::new());
        while source.append(&mut chunks, 7) == Ok(7) {}
        assert_eq!(whole.records, records);
        assert_eq!(chunks.records, records);
        assert_eq!(source.remaining(), Some(0));
    }
}
