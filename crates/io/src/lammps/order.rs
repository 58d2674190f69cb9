//! Order by atom id, in place.

use puncta_core::{Column, Scene};

/// Orders the records of a scene by atom id, and makes their ids ranks.
///
/// `atoms` has the atom id of each row of the frame; rows of the same id keep their order. Returns
/// how many rows have the id of another one before them, and the first such id.
pub(super) fn by_id(scene: &mut Scene, atoms: &[i64]) -> Option<(u64, i64)> {
    if atoms.windows(2).all(|pair| pair[0] < pair[1]) {
        return None;
    }
    let mut order: Vec<u32> = (0..u32::MAX).zip(atoms).map(|(row, _)| row).collect();
    order.sort_unstable_by_key(|&row| (atoms.get(row as usize), row));
    let same = repeated(&order, atoms);
    if scene.attributes.ids.is_some() {
        rank_ids(scene, &mut order);
    }
    apply(scene, &mut order);
    same
}

/// How many rows, in this order, have the id of the row before them, and the first such id. The id
/// of rows that have none is the largest number; they do not count.
fn repeated(order: &[u32], atoms: &[i64]) -> Option<(u64, i64)> {
    let atom = |row: u32| atoms.get(row as usize).copied().filter(|id| *id != i64::MAX);
    let pairs = order.windows(2).filter_map(|pair| {
        let (one, two) = (atom(pair[0])?, atom(pair[1])?);
        (one == two).then_some(one)
    });
    pairs.fold(None, |found, id| match found {
        None => Some((1, id)),
        Some((count, first)) => Some((count + 1, first)),
    })
}

/// Where rows were skipped: makes the ids, which are rows, ranks, and `order` one of records.
fn rank_ids(scene: &mut Scene, order: &mut Vec<u32>) {
    let Some(ids) = scene.attributes.ids.as_mut().map(Column::to_mut) else { return };
    // The inverse of the order: the rank of each row.
    let mut ranks = vec![0; order.len()];
    for (rank, row) in (0..u32::MAX).zip(&*order) {
        if let Some(slot) = ranks.get_mut(*row as usize) {
            *slot = rank;
        }
    }
    for id in ids.iter_mut() {
        *id = ranks.get(*id as usize).copied().unwrap_or(*id);
    }
    order.clear();
    order.extend((0..u32::MAX).zip(&*ids).map(|(record, _)| record));
    order.sort_unstable_by_key(|&record| ids.get(record as usize));
}

/// Moves records so that the one at `order[k]` comes to `k`. The order becomes 0, 1, 2, ...
fn apply(scene: &mut Scene, order: &mut [u32]) {
    for (_, first) in (0..order.len()).zip(0..u32::MAX) {
        // A cycle: each place takes the record of the next one, and the last one has the first.
        let mut place = first;
        while let Some(next) = order.get_mut(place as usize) {
            let next = std::mem::replace(next, place);
            if next == first {
                break;
            }
            scene.swap(place as usize, next as usize);
            place = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use puncta_core::Sphere;

    /// A scene of rows whose x is the index of the row; some rows are left out.
    fn scene(rows: u16, skipped: &[u16]) -> Scene {
        let kept: Vec<u16> = (0..rows).filter(|row| !skipped.contains(row)).collect();
        let record = |row: &u16| Sphere::new([f32::from(*row), 0.0, 0.0], 1.0);
        let mut scene = Scene::new(kept.iter().map(record).collect::<Vec<_>>());
        if !skipped.is_empty() {
            scene.attributes.ids = Some(kept.iter().map(|row| u32::from(*row)).collect());
        }
        scene
    }

    #[test]
    fn any_order_is_put_right() {
        let mut state = 12_345_u32;
        for count in [1_u16, 2, 3, 10, 1000] {
            for skipped in [&[][..], &[0, 7, 8]] {
                let mut atoms: Vec<i64> = (0..i64::from(count)).map(|i| i * 3 - 50).collect();
                for i in (1..atoms.len()).rev() {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    atoms.swap(i, state as usize % (i + 1));
                }
                let mut scene = scene(count, skipped);
                assert_eq!(by_id(&mut scene, &atoms), None);
                let ids: Vec<u32> = (0..).zip(&scene.records).map(|(k, _)| scene.id(k)).collect();
                assert!(ids.is_sorted());
                for (record, id) in scene.records.iter().zip(ids) {
                    let row = atoms.iter().position(|atom| *atom == i64::from(id) * 3 - 50);
                    assert_eq!(row.map(|row| row as f32), Some(record.center[0]));
                }
            }
        }
    }

    #[test]
    fn a_rotation_takes_linear_time() {
        let count = 60_000;
        let atoms: Vec<i64> = (0..i64::from(count)).map(|i| (i + 1) % i64::from(count)).collect();
        let mut scene = scene(count, &[]);
        by_id(&mut scene, &atoms);
        assert_eq!(scene.records[0].center[0], f32::from(count - 1));
        assert!(scene.records[1..].iter().zip(0_u16..).all(|(r, i)| r.center[0] == f32::from(i)));
    }

    #[test]
    fn atoms_of_one_id_keep_their_order() {
        let mut scene = scene(6, &[]);
        let atoms = [5, 2, 5, 1, 5, i64::MAX];
        assert_eq!(by_id(&mut scene, &atoms), Some((2, 5)));
        let rows: Vec<f32> = scene.records.iter().map(|record| record.center[0]).collect();
        assert_eq!(rows, [3.0, 1.0, 0.0, 2.0, 4.0, 5.0]);
    }
}
