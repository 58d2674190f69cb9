/*!
Chunks: the rows of a file as scenes of about a megabyte, handed over one by one.

The reader runs on a thread of its own, and waits until somebody takes the chunk. A survey told
before what the rows are like, so each chunk is a part of the very scene that a reader would make of
the whole file. If the rows turn out to be others, then the file changed in between, which is an
error.
*/

use super::{Builder, Report, Row, Survey, first::First, survey::Digest};
use crate::error::{ErrorKind, Fault};
use puncta_core::{Scene, Sphere};
use std::sync::{Arc, OnceLock, Weak, mpsc::SyncSender};

/// How many bytes of records and columns a chunk has.
const CHUNK_BYTES: usize = 1 << 20;

/// Where rows go.
#[derive(Clone, Default)]
pub(crate) enum Sink {
    /// Into one scene.
    #[default]
    Scene,
    /// Nowhere: only what the whole file tells is kept.
    Survey(Arc<OnceLock<Survey>>),
    /// Into chunks.
    Chunks(Chunks),
}

/// What chunks are made with, and where they go.
#[derive(Clone)]
pub(crate) struct Chunks {
    pub(crate) survey: Arc<Survey>,
    pub(crate) outlet: Outlet,
}

/// The end of a channel into which chunks go.
#[derive(Clone)]
pub(crate) struct Outlet {
    pub(crate) sender: SyncSender<Scene>,
    /// Lives as long as somebody wants chunks.
    pub(crate) wanted: Weak<()>,
}

impl Sink {
    /// Whether nobody takes what is read any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        matches!(self, Self::Chunks(chunks) if chunks.outlet.wanted.strong_count() == 0)
    }
}

/// Chunks in the making.
pub(super) struct Chunking<'a> {
    chunks: &'a Chunks,
    /// How many rows a chunk has.
    rows_max: usize,
    /// How many rows were handed over.
    handed: u64,
    digest: Digest,
}

impl Chunking<'_> {
    /// Passes over a row that cannot be used; whether it was taken account of at the start.
    pub(super) fn skip(&self, first: &mut First) -> Result<bool, Fault> {
        if !self.chunks.survey.has_ids {
            return Err(ErrorKind::Changed.into());
        }
        let is_first = matches!(first, First::Next);
        if is_first {
            *first = First::Skipped;
        }
        Ok(is_first)
    }
}

impl<'a> Builder<'a> {
    /// Makes ready for chunks.
    pub(super) fn start_chunks(&mut self, chunks: &'a Chunks) {
        let survey = &*chunks.survey;
        self.origin = Some(survey.origin);
        self.ids = survey.has_ids.then(Vec::new);
        self.colors = self.colors.take().filter(|_| survey.has_colors);
        self.elements = self.elements.take().filter(|_| survey.has_elements);
        let columns = [self.ids.is_some(), self.colors.is_some()].into_iter();
        let row_bytes = size_of::<Sphere>()
            + 4 * (columns.filter(|is_there| *is_there).count() + self.scalars.len())
            + usize::from(self.elements.is_some());
        let count = usize::try_from(survey.count).unwrap_or(usize::MAX);
        let rows_max = (CHUNK_BYTES / row_bytes).min(count).max(1);
        self.chunking = Some(Chunking { chunks, rows_max, handed: 0, digest: Digest::default() });
        self.make_room(rows_max);
        match &survey.first {
            First::Row(values) => {
                self.store(&values.row(), values.radius.or(survey.radius).unwrap_or(f32::NAN));
            }
            First::Skipped => self.rows += 1,
            _ => {}
        }
    }

    /// Adds a row to the chunk, and hands it over if it is full.
    pub(super) fn chunk_row(&mut self, row: &Row<'_>, radius: Option<f32>) -> Result<(), Fault> {
        let Some(chunking) = &mut self.chunking else { return Ok(()) };
        chunking.digest.add(row.position, radius);
        // The chunks began with this row.
        if matches!(self.first, First::Next) {
            return Ok(());
        }
        let survey = &*chunking.chunks.survey;
        let mut row = *row;
        if chunking.handed + (self.records.len() as u64) < survey.black {
            row.color = [0, 0, 0, 255];
        }
        let (rows_max, radius) = (chunking.rows_max, radius.or(survey.radius).unwrap_or(f32::NAN));
        self.store(&row, radius);
        if self.records.len() < rows_max {
            return Ok(());
        }
        self.hand_over()?;
        self.make_room(rows_max);
        Ok(())
    }

    /// Hands over what there is.
    fn hand_over(&mut self) -> Result<(), Fault> {
        let chunk = self.take();
        let Some(chunking) = &mut self.chunking else { return Ok(()) };
        chunking.handed += chunk.records.len() as u64;
        if chunking.handed > chunking.chunks.survey.count {
            return Err(ErrorKind::Changed.into());
        }
        let nobody = |_| ErrorKind::Decoder("nobody takes what is read".into()).into();
        chunking.chunks.outlet.sender.send(chunk).map_err(nobody)
    }

    /// Hands over the last rows, if all of them were those of the survey.
    pub(super) fn finish_chunks(mut self) -> Result<(Scene, Report), Fault> {
        let is_same = self.chunking.as_ref().is_none_or(|chunking| {
            let (survey, rest) = (&chunking.chunks.survey, self.records.len() as u64);
            (chunking.handed + rest, chunking.digest) == (survey.count, survey.digest)
        });
        if !is_same {
            return Err(ErrorKind::Changed.into());
        }
        self.hand_over()?;
        Ok((Scene::new(Vec::new()), self.report))
    }

    /// Whether rows are handed over with what a survey told.
    pub(crate) fn plan(&self) -> Option<&Survey> {
        self.chunking.as_ref().map(|chunking| &*chunking.chunks.survey)
    }
}
