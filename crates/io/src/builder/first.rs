/*!
A first row that comes last.

A reader may learn only behind all rows that a line in front of them was a row too. It then adds
that row as the last one, having said so with [`Builder::first_comes`]. A scene is put in order at
the end. A survey keeps a copy of the row, and the first chunk begins with it.
*/

use super::{Builder, Row};

/// What is known of a first row that comes last.
#[derive(Clone, Debug, Default)]
pub(super) enum First {
    /// None did come.
    #[default]
    None,
    /// It is the next one.
    Next,
    /// It came, and cannot be used.
    Skipped,
    /// It came; these are its values.
    Row(Values),
}

/// The values of a row.
#[derive(Clone, Debug)]
pub(super) struct Values {
    position: [f64; 3],
    pub(super) radius: Option<f32>,
    color: [u8; 4],
    element: u8,
    scalars: Vec<f32>,
}

impl Values {
    pub(super) fn of(row: &Row<'_>, radius: Option<f32>) -> Self {
        let Row { position, color, element, scalars, .. } = *row;
        Self { position, radius, color, element, scalars: scalars.to_vec() }
    }

    pub(super) fn row(&self) -> Row<'_> {
        let Self { position, color, element, ref scalars, .. } = *self;
        Row { position, color, element, scalars, ..Row::default() }
    }
}

impl Builder<'_> {
    /// Says that the row to be added next, the last one, stands before all others in the file.
    pub(crate) fn first_comes(&mut self) {
        self.first = First::Next;
    }

    /// Puts the first row in its place.
    pub(super) fn put_first(&mut self) {
        if !matches!(self.first, First::Next) {
            return;
        }
        if let Some(ids) = &mut self.ids {
            for id in ids.iter_mut() {
                *id = if u64::from(*id) + 1 == self.rows { 0 } else { *id + 1 };
            }
            if ids.last() != Some(&0) {
                return;
            }
            ids.rotate_right(1);
        }
        self.records.rotate_right(1);
        if let Some(colors) = &mut self.colors {
            colors.rotate_right(1);
        }
        if let Some(elements) = &mut self.elements {
            elements.rotate_right(1);
        }
        for (_, scalar) in &mut self.scalars {
            scalar.values.to_mut().rotate_right(1);
        }
    }
}
