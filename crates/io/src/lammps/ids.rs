/*!
The ids of atoms, and what they are for.

A scene is put into their order at the end, for which all of them are held. Chunks cannot be: their
records come in the order of the file, and so that nobody needs to hold all ids, it is looked at
what these are.

* They ascend already. Chunks are then what a scene is.
* They are some whole numbers without gaps, in any order, as those of a whole simulation are. The
  rank of an atom is then its id less the smallest one: each record has the id it has in a scene,
  but comes at another place. A warning says so.
* Else the ids of records are their rows in the file. A warning says so, too.

Whether numbers have gaps or come twice is seen by the sum of their hashes, which is compared with
that of all numbers between the smallest and the largest. Different numbers have the same sum with a
chance of 2^-64; the hash has a key of chance, so that no file can be made for it.
*/

use super::order;
use crate::{
    builder::{Builder, Ranks, Report},
    hash::mix,
};
use puncta_core::Scene;
use std::hash::{BuildHasher, RandomState};

/// What stands for the id of a row that has none.
const NONE: i64 = i64::MAX;

/// The ids of a frame.
pub(super) enum Ids {
    /// There are none.
    None,
    /// Those of all rows.
    Held(Vec<i64>),
    /// What is to be known of them in advance.
    Seen(Box<Seen>),
    /// What is known of them, and how many there were so far.
    Known(Ranks, u32),
}

impl Ids {
    pub(super) fn new(builder: &mut Builder<'_>, has_ids: bool) -> Self {
        if !has_ids {
            return Self::None;
        }
        if let Some(survey) = builder.plan() {
            return Self::Known(survey.ranks, 0);
        }
        match builder.survey_mut() {
            Some(_) => Self::Seen(Box::default()),
            None => Self::Held(Vec::new()),
        }
    }

    pub(super) fn reserve(&mut self, count: u64) {
        if let Self::Held(ids) = self {
            ids.reserve_exact(usize::try_from(count).unwrap_or(0));
        }
    }

    /// Takes the id of the next row, which may be one that cannot be used; returns what its record
    /// is known by, if that is not its row.
    pub(super) fn push(&mut self, id: i64, is_usable: bool) -> Option<u32> {
        match self {
            Self::None | Self::Known(Ranks::Rows, _) => None,
            Self::Held(ids) => {
                ids.push(id);
                None
            }
            Self::Seen(seen) => {
                seen.add(id, is_usable);
                None
            }
            Self::Known(Ranks::Counted, count) => (id != NONE).then(|| {
                *count += 1;
                *count - 1
            }),
            Self::Known(Ranks::From(first), _) => {
                id.checked_sub(*first).and_then(|rank| u32::try_from(rank).ok())
            }
        }
    }

    /// Tells a survey what was seen.
    pub(super) fn tell(&self, builder: &mut Builder<'_>) {
        let Self::Seen(seen) = self else { return };
        let (ranks, warning) = seen.ranks();
        warning.into_iter().for_each(|warning| builder.warn(warning));
        builder.survey_mut().into_iter().for_each(|survey| survey.set_ranks(ranks));
    }

    /// Puts a scene of all rows into the order of the ids.
    pub(super) fn put_in_order(&self, scene: &mut Scene, report: &mut Report) {
        let same = match self {
            Self::Held(ids) => order::by_id(scene, ids),
            Self::Seen(seen) if seen.is_ordered => seen.same,
            _ => None,
        };
        if let Some((count, first)) = same {
            let what = "atoms have the same id as another one before them";
            report.warnings.push(format!("{count} {what}; the first: {first}"));
        }
    }
}

/// What is known of ids that came one by one.
pub(super) struct Seen {
    /// How many rows there were, and whether the last one had an id.
    rows: u64,
    has_gaps: bool,
    /// The last, the smallest and the largest id.
    last: i64,
    min: i64,
    max: i64,
    /// Whether no id was smaller than the one before it.
    is_ordered: bool,
    /// How many ids were the same as the one before them, and the first of these.
    same: Option<(u64, i64)>,
    /// The sum of the hashes, and the key that they have.
    sum: u64,
    key: u64,
}

impl Default for Seen {
    fn default() -> Self {
        Self {
            rows: 0,
            has_gaps: false,
            last: i64::MIN,
            min: i64::MAX,
            max: i64::MIN,
            is_ordered: true,
            same: None,
            sum: 0,
            key: RandomState::new().hash_one(0),
        }
    }
}

impl Seen {
    fn add(&mut self, id: i64, is_usable: bool) {
        if id == NONE {
            self.has_gaps = true;
            // A row that is kept would move behind all others.
            self.is_ordered &= !is_usable;
            return;
        }
        if self.rows > 0 && id == self.last {
            let (count, _) = self.same.get_or_insert((0, id));
            *count += 1;
        }
        self.rows += 1;
        self.is_ordered &= id >= self.last;
        (self.last, self.min, self.max) = (id, self.min.min(id), self.max.max(id));
        self.sum = self.sum.wrapping_add(self.hash(id));
    }

    fn hash(&self, id: i64) -> u64 {
        mix(id.cast_unsigned().wrapping_add(self.key))
    }

    /// Where ids come from, and what is to be told of that.
    fn ranks(&self) -> (Ranks, Option<&'static str>) {
        if self.is_ordered {
            let ranks = if self.has_gaps { Ranks::Counted } else { Ranks::Rows };
            return (ranks, None);
        }
        if self.is_whole() {
            let warning = "the atoms come in the order of the file, not in that of their ids";
            return (Ranks::From(self.min), Some(warning));
        }
        let warning = "the atoms come in the order of the file, and are known by their rows: their \
                       ids are not consecutive";
        (Ranks::Rows, Some(warning))
    }

    /// Whether the ids are all whole numbers between the smallest and the largest, once each.
    fn is_whole(&self) -> bool {
        let count = self.max.checked_sub(self.min).and_then(|last| last.checked_add(1));
        let is_count = count.and_then(|count| u64::try_from(count).ok()) == Some(self.rows);
        let sum = || (self.min..=self.max).fold(0_u64, |sum, id| sum.wrapping_add(self.hash(id)));
        is_count && !self.has_gaps && sum() == self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranks(ids: &[i64]) -> Ranks {
        let mut seen = Seen::default();
        ids.iter().for_each(|&id| seen.add(id, id != NONE));
        seen.ranks().0
    }

    #[test]
    fn ids_without_gaps_are_known_in_any_order() {
        assert_eq!(ranks(&[]), Ranks::Rows);
        assert_eq!(ranks(&[1, 2, 3]), Ranks::Rows);
        assert_eq!(ranks(&[1, 5, 5, 7]), Ranks::Rows);
        assert_eq!(ranks(&[1, NONE, 5, 7]), Ranks::Counted);
        assert_eq!(ranks(&[3, 1, 2]), Ranks::From(1));
        assert_eq!(ranks(&[0, -1, 1, -2]), Ranks::From(-2));
        for ids in [&[3, 1, 4][..], &[3, 1, 3], &[2, 1, 1, 4], &[2, NONE, 1], &[i64::MIN, 0, -1]] {
            assert_eq!(ranks(ids), Ranks::Rows, "{ids:?}");
        }
        let many: Vec<i64> = (0..100_000).map(|i| i * 7919 % 100_000 + 17).collect();
        assert_eq!(ranks(&many), Ranks::From(17));
        let twice: Vec<i64> =
            many.iter().map(|&id| if id == 50_000 { 50_001 } else { id }).collect();
        assert_eq!(ranks(&twice), Ranks::Rows);
    }
}
