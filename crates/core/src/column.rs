/*!
Columns: values in a row, one for each record, wherever they lie.

A scene that was read owns its values. A scene that is larger than memory, or that another program
has built, must not be copied to be drawn: its columns are *shared* with whoever holds the values,
such as a mapped file, an `Arc`, or a buffer of a simulation. Both read as a slice. To change values
one asks for a `Vec`, which is there for an owned column and is copied for a shared one, just as
with [`std::borrow::Cow`].
*/

mod edits;

use edits::Edits;
use std::{
    fmt,
    ops::{Deref, Range},
    slice,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

/// Values in a row, one for each record: owned, or shared with whoever holds them.
///
/// A column reads as a slice. Taking the slice of a shared column is a virtual call, so a loop over
/// many values takes it once, before it starts, and does not index the column at each turn.
///
/// # Examples
///
/// A scene over records that somebody else holds; nothing is copied:
///
/// ```
/// use puncta_core::{Scene, Sphere};
/// use std::sync::Arc;
///
/// let held: Arc<[Sphere]> = Arc::new([Sphere::new([0.0; 3], 1.0), Sphere::new([2.0; 3], 0.5)]);
/// let mut scene = Scene::new(Arc::clone(&held));
/// assert!(scene.records.is_shared());
/// assert!(std::ptr::eq(&scene.records[0], &held[0]));
///
/// // To change a record copies them all, once. Those of the holder stay as they are.
/// scene.records.to_mut()[0].radius = 3.0;
/// scene.records.extend([Sphere::default()]);
/// assert_eq!(scene.records.len(), 3);
/// assert_eq!(held[0].radius, 1.0);
/// ```
///
/// [`Column::shared`] takes any type that lends out a slice, such as a view of a mapped file.
pub struct Column<T> {
    values: Storage<T>,
    version: u64,
    edits: Edits,
}

/// The versions that were given out.
static VERSIONS: AtomicU64 = AtomicU64::new(1);

fn next_version() -> u64 {
    VERSIONS.fetch_add(1, Ordering::Relaxed)
}

/// Where values lie.
enum Storage<T> {
    Owned(Vec<T>),
    Shared(Arc<dyn AsRef<[T]> + Send + Sync>),
}

impl<T> Column<T> {
    /// A column without values.
    #[must_use]
    pub const fn new() -> Self {
        Self { values: Storage::Owned(Vec::new()), version: 0, edits: Edits::since(0) }
    }

    /// The values that `holder` lends out. They are not copied; `holder` is dropped with the last
    /// clone of the column.
    ///
    /// The holder must lend the same values each time. Memory stays safe if it does not, but what
    /// is drawn is of no use then, and where values are gone that were counted before, indexing
    /// panics. [`Scene::validate`](crate::Scene::validate) tells of a length that is wrong by then.
    ///
    /// # Examples
    ///
    /// One of several runs of values in a buffer, such as a file that is mapped to memory:
    ///
    /// ```
    /// use puncta_core::Column;
    /// use std::{ops::Range, sync::Arc};
    ///
    /// struct Run {
    ///     buffer: Arc<Vec<f32>>,
    ///     range: Range<usize>,
    /// }
    ///
    /// impl AsRef<[f32]> for Run {
    ///     fn as_ref(&self) -> &[f32] {
    ///         &self.buffer[self.range.clone()]
    ///     }
    /// }
    ///
    /// let buffer = Arc::new(vec![0.5, 1.5, 2.5, 3.5]);
    /// let last = Column::shared(Run { buffer, range: 2..4 });
    /// assert_eq!(last, [2.5, 3.5]);
    /// ```
    #[must_use]
    pub fn shared(holder: impl AsRef<[T]> + Send + Sync + 'static) -> Self {
        Self::of(Storage::Shared(Arc::new(holder)))
    }

    /// A column of values that are new.
    fn of(values: Storage<T>) -> Self {
        let version = next_version();
        Self { values, version, edits: Edits::since(version) }
    }

    /// Whether somebody else holds the values, so that changing them copies them.
    #[must_use]
    pub const fn is_shared(&self) -> bool {
        matches!(self.values, Storage::Shared(_))
    }

    /// A number that changes whenever the values may have changed: columns of the same number hold
    /// the same values, in this process. So what was made of the values, such as a copy of them on a
    /// GPU, can be kept as long as the number stays.
    ///
    /// Values that a holder changes behind the column's back are not noticed.
    #[must_use]
    pub const fn version(&self) -> u64 {
        self.version
    }

    /// The ranges of values that may have changed since the column had a version; `None` if all may
    /// have, or if that is too long ago.
    #[must_use]
    pub fn changes_since(&self, version: u64) -> Option<Vec<Range<usize>>> {
        self.edits.after(version)
    }

    /// The values. For a shared column this is a virtual call.
    #[must_use]
    #[inline]
    pub fn as_slice(&self) -> &[T] {
        match &self.values {
            Storage::Owned(values) => values,
            Storage::Shared(holder) => (**holder).as_ref(),
        }
    }
}

impl<T: Clone> Column<T> {
    /// The values, to change them. A shared column copies them first and owns them from then on;
    /// other clones of it still share.
    ///
    /// Loops take the `Vec` once, before they start.
    #[inline]
    pub fn to_mut(&mut self) -> &mut Vec<T> {
        self.version = next_version();
        self.edits = Edits::since(self.version);
        self.owned()
    }

    /// The values of a range, as far as they are there, to change them where they are. What was made of
    /// the others, such as a copy on a GPU, can be kept: see [`Column::changes_since`]. A shared column
    /// copies all values first.
    ///
    /// # Examples
    ///
    /// ```
    /// use puncta_core::Column;
    ///
    /// let mut column = Column::from(vec![0; 1000]);
    /// let before = column.version();
    /// column.edit(10..20).fill(1);
    /// column.edit(990..2000).fill(2);
    /// assert_eq!(column.changes_since(before), Some(vec![10..20, 990..1000]));
    /// column.to_mut();
    /// assert_eq!(column.changes_since(before), None);
    /// ```
    pub fn edit(&mut self, range: Range<usize>) -> &mut [T] {
        let count = self.as_slice().len();
        let end = range.end.min(count);
        let range = range.start.min(end)..end;
        self.version = next_version();
        self.edits.add(self.version, range.clone());
        &mut self.owned()[range]
    }

    fn owned(&mut self) -> &mut Vec<T> {
        if let Storage::Shared(holder) = &self.values {
            self.values = Storage::Owned((**holder).as_ref().to_vec());
        }
        match &mut self.values {
            Storage::Owned(values) => values,
            Storage::Shared(_) => unreachable!("it was copied above"),
        }
    }

    /// Drops all values. The room that an owned column has stays for others; a shared one is let go
    /// of.
    pub fn clear(&mut self) {
        self.version = next_version();
        self.edits = Edits::since(self.version);
        match &mut self.values {
            Storage::Owned(values) => values.clear(),
            Storage::Shared(_) => *self = Self::new(),
        }
    }

    /// The values. Those of a shared column are copied.
    #[must_use]
    pub fn into_vec(self) -> Vec<T> {
        match self.values {
            Storage::Owned(values) => values,
            Storage::Shared(holder) => (*holder).as_ref().to_vec(),
        }
    }
}

impl<T> Deref for Column<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        self.as_slice()
    }
}

impl<T> AsRef<[T]> for Column<T> {
    fn as_ref(&self) -> &[T] {
        self.as_slice()
    }
}

impl<'a, T> IntoIterator for &'a Column<T> {
    type Item = &'a T;
    type IntoIter = slice::Iter<'a, T>;

    fn into_iter(self) -> slice::Iter<'a, T> {
        self.as_slice().iter()
    }
}

impl<T> Default for Column<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// A clone of a shared column shares, too; one of an owned column is a copy.
impl<T: Clone> Clone for Column<T> {
    fn clone(&self) -> Self {
        let values = match &self.values {
            Storage::Owned(values) => Storage::Owned(values.clone()),
            Storage::Shared(holder) => Storage::Shared(Arc::clone(holder)),
        };
        Self { values, version: self.version, edits: self.edits.clone() }
    }
}

impl<T: fmt::Debug> fmt::Debug for Column<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_slice().fmt(f)
    }
}

impl<T> From<Vec<T>> for Column<T> {
    fn from(values: Vec<T>) -> Self {
        Self::of(Storage::Owned(values))
    }
}

impl<T, const N: usize> From<[T; N]> for Column<T> {
    fn from(values: [T; N]) -> Self {
        Vec::from(values).into()
    }
}

/// The values are shared, not copied.
impl<T: Send + Sync + 'static> From<Arc<[T]>> for Column<T> {
    fn from(values: Arc<[T]>) -> Self {
        Self::shared(values)
    }
}

impl<T> FromIterator<T> for Column<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Vec::from_iter(values).into()
    }
}

/// As [`Column::to_mut`], this copies the values of a shared column first.
impl<T: Clone> Extend<T> for Column<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, values: I) {
        self.to_mut().extend(values);
    }
}

/// Columns are equal when their values are, whoever holds these.
impl<T: PartialEq> PartialEq for Column<T> {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl<T: Eq> Eq for Column<T> {}

impl<T: PartialEq> PartialEq<[T]> for Column<T> {
    fn eq(&self, other: &[T]) -> bool {
        self.as_slice() == other
    }
}

impl<T: PartialEq> PartialEq<Vec<T>> for Column<T> {
    fn eq(&self, other: &Vec<T>) -> bool {
        self.as_slice() == other
    }
}

impl<T: PartialEq, const N: usize> PartialEq<[T; N]> for Column<T> {
    fn eq(&self, other: &[T; N]) -> bool {
        self.as_slice() == other
    }
}

impl<T: PartialEq> PartialEq<Column<T>> for Vec<T> {
    fn eq(&self, other: &Column<T>) -> bool {
        self == other.as_slice()
    }
}

#[cfg(test)]
mod tests;
