//! The plain twin of the grid: records gathered by the cell that holds them, one after the other.

use puncta_core::{Aabb, Record};
use puncta_grid::{Cells, Grid};
use std::collections::BTreeMap;

/// A brick, as one would compute it with pencil and paper.
#[derive(Debug)]
pub(crate) struct NaiveBrick {
    pub(crate) bounds: Aabb,
    pub(crate) radius_max: f32,
    pub(crate) density: f64,
    /// Indices into the records as they were.
    pub(crate) members: Vec<u32>,
}

/// The bricks of records, by the place of their cells.
pub(crate) fn bricks<R: Record>(records: &[R], cells: &Cells) -> BTreeMap<[u32; 3], NaiveBrick> {
    let mut bricks: BTreeMap<[u32; 3], NaiveBrick> = BTreeMap::new();
    for (index, record) in (0..).zip(records) {
        let brick = bricks.entry(cells.place(record.position())).or_insert(NaiveBrick {
            bounds: Aabb::EMPTY,
            radius_max: 0.0,
            density: 0.0,
            members: vec![],
        });
        brick.bounds.add(record.position());
        brick.radius_max = brick.radius_max.max(record.radius());
        brick.density += 4.0 / 3.0 * std::f64::consts::PI * f64::from(record.radius()).powi(3);
        brick.members.push(index);
    }
    let all = bricks.values().fold(Aabb::EMPTY, |mut all, brick| {
        all.add(brick.bounds.min);
        all.add(brick.bounds.max);
        all
    });
    for brick in bricks.values_mut() {
        for axis in 0..3 {
            let extent = |bounds: &Aabb| f64::from(bounds.max[axis] - bounds.min[axis]);
            let cell = if cells.dims()[axis] == 1 { extent(&all) } else { cells.width().into() };
            let side = cell.max(extent(&brick.bounds)).max(2.0 * f64::from(brick.radius_max));
            brick.density /= side;
        }
    }
    bricks
}

/// Checks a grid and the ids that its records had against the twin.
pub(crate) fn check<R: Record>(before: &[R], after: &[R], ids: &[u32], grid: &Grid) {
    let expected = bricks(before, grid.cells());
    assert_eq!(grid.bricks().len(), expected.len());
    let mut next = 0;
    for (index, brick) in (0_u32..).zip(grid.bricks()) {
        let place = grid.cell_of(index).unwrap();
        assert_eq!(grid.brick_at(place), Some(index));
        let naive = &expected[&place];
        assert_eq!(brick.records.start, next, "bricks lie one behind the other");
        next = brick.records.end;
        let run = brick.records.start as usize..brick.records.end as usize;
        let mut members = ids[run.clone()].to_vec();
        members.sort_unstable();
        assert_eq!(members, naive.members);
        assert_eq!(brick.bounds, naive.bounds);
        assert_eq!(brick.radius_max, naive.radius_max);
        // Sums in `f64`, whatever their order, agree to far better than an `f32`.
        let expected = if naive.density.is_finite() { naive.density as f32 } else { 0.0 };
        let error = (brick.density - expected).abs();
        assert!(error <= expected.abs() * 2e-7, "{} is not {expected}", brick.density);
        let cell = grid.cells().bounds(place);
        for record in &after[run] {
            let position = record.position();
            assert!(cell.min.cmple(position).all() && position.cmplt(cell.max).all());
        }
    }
    assert_eq!(next as usize, before.len());
}
