/*!
The last step: the rows of a part are sorted in memory.

This is the stable sort of the grid: rows are in the order of their ids within a brick, which depends
on nothing else. A brick that continues in the next part is measured on from there.
*/

use crate::{
    census,
    dispatch::lanes_of,
    leaf::{Bricks, How},
    measure::describe,
    rows::Rows,
    sort,
};
use puncta_core::{Brick, Record, Scene, Sphere};
use wide::f32x4;

/// Measures the records of a brick.
#[derive(Clone, Copy, Debug)]
struct Tally {
    least: f32x4,
    most: f32x4,
    /// The sum of cubed radii.
    cubes: f64,
    count: u32,
}

impl Tally {
    fn of(members: &[Sphere]) -> Self {
        let mut tally = Self {
            least: f32x4::splat(f32::INFINITY),
            most: f32x4::splat(f32::NEG_INFINITY),
            cubes: 0.0,
            count: 0,
        };
        tally.add(members);
        tally
    }

    fn add(&mut self, members: &[Sphere]) {
        for record in members {
            let (lanes, radius) = (lanes_of(record), f64::from(record.radius()));
            self.least = lanes.fast_min(self.least);
            self.most = lanes.fast_max(self.most);
            self.cubes += radius * radius * radius;
            self.count += 1;
        }
    }

    fn finish(self, start: u32, sides: f32x4) -> Brick {
        describe(start..start + self.count, [self.least, self.most], self.cubes, sides)
    }
}

/// Sorts part after part, and collects their bricks.
pub(crate) struct Arranger {
    how: How,
    found: Bricks,
    /// The code of the last brick, which the next part may continue, and what was measured of it.
    open: Option<(u32, Tally)>,
    /// How many rows are in the bricks before that one.
    start: u32,
}

impl Arranger {
    /// An arranger of the first part; the coder's digit is that of the blocks.
    pub(crate) fn new(how: How) -> Self {
        Self { how, found: Bricks::default(), open: None, start: 0 }
    }

    /// Sorts the rows of the next part: the first ones of a block.
    pub(crate) fn arrange(&mut self, block: &mut Scene, count: usize) {
        let mut rows = Rows::of_scene(block).split_off_front(count);
        let counts = census::count(rows.records, &self.how.coder);
        let Bricks { bricks, codes, .. } = sort::sort(rows.reborrow(), self.how, &counts);
        let last = bricks.len().saturating_sub(1);
        for (index, (brick, code)) in bricks.into_iter().zip(codes).enumerate() {
            let members = &rows.records[brick.records.start as usize..brick.records.end as usize];
            if let Some((open, tally)) = &mut self.open
                && *open == code
            {
                tally.add(members);
                continue;
            }
            self.close();
            if index == last {
                self.open = Some((code, Tally::of(members)));
            } else {
                let count = brick.records.end - brick.records.start;
                self.add(code, Brick { records: self.start..self.start + count, ..brick });
            }
        }
    }

    /// Adds a brick.
    fn add(&mut self, code: u32, brick: Brick) {
        self.start = brick.records.end;
        self.found.bricks.push(brick);
        self.found.codes.push(code);
    }

    /// Adds the brick that is complete.
    fn close(&mut self) {
        if let Some((code, tally)) = self.open.take() {
            self.add(code, tally.finish(self.start, self.how.sides));
        }
    }

    /// All bricks.
    pub(crate) fn finish(mut self) -> Bricks {
        self.close();
        self.found
    }
}
