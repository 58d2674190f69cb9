//! Rows: records and the columns that go with them, to be moved together.

use bytemuck::cast_slice_mut;
use puncta_core::{Attributes, Record, Scene};
use std::{mem, ops::Range};

/// Records and their columns; all are equally long.
#[derive(Debug)]
pub(crate) struct Rows<'a, R> {
    pub(crate) records: &'a mut [R],
    pub(crate) lanes: Vec<Lane<'a>>,
    /// Which of the columns has the colors.
    pub(crate) colors: Option<usize>,
}

/// A column: one value for each record, of a size that the sort knows.
#[derive(Debug)]
pub(crate) enum Lane<'a> {
    Words(&'a mut [[u8; 4]]),
    Bytes(&'a mut [u8]),
}

impl<'a, R: Record> Rows<'a, R> {
    /// Records without columns.
    pub(crate) fn new(records: &'a mut [R]) -> Self {
        Self { records, lanes: Vec::new(), colors: None }
    }

    /// Records and their ids, without other columns.
    pub(crate) fn with_ids(records: &'a mut [R], ids: &'a mut [u32]) -> Self {
        Self { records, lanes: vec![Lane::Words(cast_slice_mut(ids))], colors: None }
    }

    /// The records of a scene and all their attributes, the ids first.
    pub(crate) fn of_scene(scene: &'a mut Scene<R>) -> Self {
        let Attributes { ids, colors, elements, scalars } = &mut scene.attributes;
        let colors_at = colors.is_some().then_some(usize::from(ids.is_some()));
        let ids = ids.as_mut().map(|ids| Lane::Words(cast_slice_mut(ids.to_mut())));
        let colors = colors.as_mut().map(|colors| Lane::Words(colors.to_mut()));
        let elements = elements.as_mut().map(|elements| Lane::Bytes(elements.to_mut()));
        let scalars = scalars.iter_mut().map(|s| Lane::Words(cast_slice_mut(s.values.to_mut())));
        let lanes = ids.into_iter().chain(colors).chain(elements).chain(scalars).collect();
        Self { records: scene.records.to_mut(), lanes, colors: colors_at }
    }

    /// The first `count` rows; the others stay.
    pub(crate) fn split_off_front(&mut self, count: usize) -> Self {
        Self {
            records: split_off_front(&mut self.records, count),
            lanes: self.lanes.iter_mut().map(|lane| lane.split_off_front(count)).collect(),
            colors: self.colors,
        }
    }

    /// The same rows, borrowed for less long.
    pub(crate) fn reborrow(&mut self) -> Rows<'_, R> {
        Rows {
            records: self.records,
            lanes: self.lanes.iter_mut().map(Lane::reborrow).collect(),
            colors: self.colors,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.records.len()
    }
}

impl<'a> Lane<'a> {
    fn split_off_front(&mut self, count: usize) -> Self {
        match self {
            Self::Words(words) => Self::Words(split_off_front(words, count)),
            Self::Bytes(bytes) => Self::Bytes(split_off_front(bytes, count)),
        }
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Words(words) => words.len(),
            Self::Bytes(bytes) => bytes.len(),
        }
    }

    /// The values of some rows.
    pub(crate) fn part(&mut self, rows: Range<usize>) -> Lane<'_> {
        match self {
            Self::Words(words) => Lane::Words(&mut words[rows]),
            Self::Bytes(bytes) => Lane::Bytes(&mut bytes[rows]),
        }
    }

    fn reborrow(&mut self) -> Lane<'_> {
        match self {
            Self::Words(words) => Lane::Words(words),
            Self::Bytes(bytes) => Lane::Bytes(bytes),
        }
    }
}

/// Cuts the first `count` values off a slice.
fn split_off_front<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (front, back) = mem::take(slice).split_at_mut(count);
    *slice = back;
    front
}
