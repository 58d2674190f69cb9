//! Which brick a record lies in: its level of detail is that of the brick.

use puncta_core::Brick;

/// Finds the bricks of records.
#[derive(Clone, Debug)]
pub struct Holders<'a> {
    bricks: &'a [Brick],
    /// By record, if bricks do not lie in the order of their records.
    by_record: Option<Vec<u32>>,
}

const NONE: u32 = u32::MAX;

impl<'a> Holders<'a> {
    /// For these bricks of a scene with so many records. Those of grids lie in the order of their records and are searched as they are;
    /// for others 4 bytes a record are needed.
    #[must_use]
    pub fn new(bricks: &'a [Brick], records: usize) -> Self {
        let is_next = |pair: &[Brick]| pair[0].records.end <= pair[1].records.start;
        let is_in_order = bricks.windows(2).all(is_next)
            && bricks.iter().all(|brick| brick.records.start <= brick.records.end);
        let by_record = (!is_in_order).then(|| {
            let mut by_record = vec![NONE; records];
            // The first brick of a record is entered last.
            for (index, brick) in bricks.iter().enumerate().rev() {
                let index = u32::try_from(index).unwrap_or(NONE);
                let range = brick.records.start as usize..(brick.records.end as usize).min(records);
                if let Some(records) = by_record.get_mut(range) {
                    records.fill(index);
                }
            }
            by_record
        });
        Self { bricks, by_record }
    }

    /// The brick of a record, as an index; the first one if several hold it, `None` if there is none.
    #[must_use]
    pub fn find(&self, record: u32) -> Option<u32> {
        if let Some(by_record) = &self.by_record {
            return by_record.get(record as usize).copied().filter(|&brick| brick != NONE);
        }
        let index = self.bricks.partition_point(|brick| brick.records.end <= record);
        let brick = self.bricks.get(index)?;
        let holds = brick.records.contains(&record);
        holds.then(|| u32::try_from(index).ok()).flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use puncta_core::Aabb;

    proptest! {
        /// Whatever the order of bricks, the first one that holds a record is found.
        #[test]
        fn the_first_holder_is_found(
            mut ranges in prop::collection::vec((0_u32..40, 0_u32..6), 0..12),
            is_sorted in any::<bool>(),
        ) {
            if is_sorted {
                let mut from = 0;
                for range in &mut ranges {
                    *range = (from + range.0 / 8, range.1);
                    from = range.0 + range.1;
                }
            }
            let brick = |&(start, count): &(u32, u32)| Brick {
                records: start..start + count,
                bounds: Aabb::EMPTY,
                radius_max: 0.0,
                density: 0.0,
            };
            let bricks: Vec<Brick> = ranges.iter().map(brick).collect();
            let holders = Holders::new(&bricks, 200);
            for record in 0..150 {
                let expected = bricks.iter().position(|brick| brick.records.contains(&record));
                prop_assert_eq!(holders.find(record).map(|brick| brick as usize), expected);
            }
        }
    }
}
