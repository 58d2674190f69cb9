use super::{edits::EDITS_MAX, *};
use crate::{Error, Scene, Sphere};
use proptest::prelude::*;
use std::sync::atomic::AtomicUsize;

/// What can be done with a column.
#[derive(Clone, Debug)]
enum Action {
    Push(u8),
    Extend(Vec<u8>),
    Truncate(usize),
    Reverse,
}

fn action() -> impl Strategy<Value = Action> {
    prop_oneof![
        any::<u8>().prop_map(Action::Push),
        prop::collection::vec(any::<u8>(), 0..9).prop_map(Action::Extend),
        (0..9_usize).prop_map(Action::Truncate),
        Just(Action::Reverse),
    ]
}

proptest! {
    #[test]
    fn columns_do_what_vectors_do(
        start: Vec<u8>,
        actions in prop::collection::vec(action(), 0..9),
    ) {
        let held: Arc<[u8]> = start.clone().into();
        let shared = Column::from(Arc::clone(&held));
        let mut columns = [Column::from(start.clone()), shared.clone()];
        let mut twin = start.clone();
        for action in actions {
            for values in columns.iter_mut().map(Column::to_mut).chain([&mut twin]) {
                match &action {
                    Action::Push(value) => values.push(*value),
                    Action::Extend(_) => {}
                    Action::Truncate(length) => values.truncate(*length),
                    Action::Reverse => values.reverse(),
                }
            }
            if let Action::Extend(more) = action {
                columns.iter_mut().for_each(|column| column.extend(more.clone()));
                twin.extend(more);
            }
            prop_assert_eq!(&columns[0], &twin);
            prop_assert_eq!(&columns[1], &columns[0]);
        }
        prop_assert_eq!(shared, start);
        for column in columns {
            prop_assert_eq!(format!("{column:?}"), format!("{twin:?}"));
            prop_assert!(twin.iter().eq(&column));
            prop_assert_eq!(column.into_vec(), twin.clone());
        }
    }
}

#[test]
fn owned_values_move_and_are_not_copied() {
    let values = vec![1, 2, 3];
    let place = values.as_ptr();
    let mut column = Column::from(values);
    assert!(!column.is_shared());
    column.to_mut().swap(0, 2);
    assert_eq!(column.as_ptr(), place);
    let values = column.into_vec();
    assert_eq!(values.as_ptr(), place);
}

#[test]
fn shared_values_stay_where_they_are_until_they_change() {
    let held: Arc<[u32]> = Arc::new([4, 5, 6]);
    let column = Column::from(Arc::clone(&held));
    let mut changed = column.clone();
    assert!(changed.is_shared());
    assert_eq!(changed.as_ptr(), held.as_ptr());
    changed.to_mut()[0] = 7;
    let place = changed.as_ptr();
    changed.to_mut()[1] = 8;
    assert_eq!((changed.as_ptr(), changed.is_shared()), (place, false));
    assert_eq!(changed, [7, 8, 6]);
    assert_eq!(column.as_ptr(), held.as_ptr());
    assert_eq!(*held, [4, 5, 6]);
}

#[test]
fn edits_are_told_until_they_are_too_many() {
    let mut column = Column::from(vec![0_u8; 9]);
    let start = column.version();
    assert_eq!(column.changes_since(start), Some(vec![]));
    let mut versions = vec![start];
    for i in 0..EDITS_MAX {
        column.edit(i % 9..9)[0] += 1;
        versions.push(column.version());
    }
    assert_eq!(column.changes_since(start).map(|ranges| ranges.len()), Some(EDITS_MAX));
    let last = std::iter::once((EDITS_MAX - 1) % 9..9).collect();
    assert_eq!(column.changes_since(versions[EDITS_MAX - 1]), Some(last));
    let copy = column.clone();
    column.edit(3..3);
    assert_eq!(column.changes_since(start), None);
    assert_eq!(column.changes_since(versions[1]).map(|ranges| ranges.len()), Some(EDITS_MAX));
    assert_eq!(column.changes_since(u64::MAX), None);
    // Of what another column has become since, nothing is known.
    assert_eq!(copy.changes_since(column.version()), None);
    let reversed = Range { start: 7, end: 2 };
    assert!(column.edit(reversed).is_empty());
    assert!(column.edit(100..200).is_empty());
}

#[test]
fn versions_tell_of_changes() {
    let mut column = Column::from(vec![1, 2]);
    let first = column.version();
    let clone = column.clone();
    assert_eq!((clone.version(), column.len()), (first, 2));
    column.to_mut()[0] = 5;
    let second = column.version();
    assert!(first != second && clone.version() == first);
    column.extend([3]);
    assert!(![first, second].contains(&column.version()));
    assert_ne!(Column::from(vec![1, 2]).version(), first);
    let emptied = column.version();
    column.clear();
    assert_ne!(column.version(), emptied);
    assert_eq!(Column::<u8>::new().version(), Column::<u8>::default().version());
}

#[test]
fn a_holder_goes_with_its_last_column() {
    let held: Arc<[u8]> = Arc::new([1]);
    let one = Column::from(Arc::clone(&held));
    let mut other = one.clone();
    drop(one);
    assert_eq!(Arc::strong_count(&held), 2);
    other.to_mut();
    assert_eq!(Arc::strong_count(&held), 1);
}

#[test]
fn equality_goes_by_values() {
    let column = Column::from([1.0, f32::NAN]);
    assert_ne!(column, column.clone());
    let column = Column::from([1.0, 2.0]);
    assert_eq!(column, Column::shared(vec![1.0, 2.0]));
    assert_eq!(vec![1.0, 2.0], column);
    assert_eq!(column, *[1.0, 2.0].as_slice());
    assert_ne!(column, [1.0]);
    assert_eq!(Column::<u8>::default(), []);
}

/// Lends out one value less each time.
struct Shrinking(Vec<u8>, AtomicUsize);

impl AsRef<[u8]> for Shrinking {
    fn as_ref(&self) -> &[u8] {
        let gone = self.1.fetch_add(1, Ordering::Relaxed);
        &self.0[..self.0.len().saturating_sub(gone)]
    }
}

#[test]
fn a_holder_that_loses_values_is_told() {
    let mut scene = Scene::new(vec![Sphere::default(); 3]);
    let holder = Shrinking(vec![6; 3], AtomicUsize::new(0));
    scene.attributes.elements = Some(Column::shared(holder));
    assert_eq!(scene.validate(), Ok(()));
    let error = Error::AttributeLength { name: "elements".into(), values: 2, records: 3 };
    assert_eq!(scene.validate(), Err(error));
}
