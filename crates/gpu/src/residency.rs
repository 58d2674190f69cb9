/*!
Which records are on the GPU: segments of neighboring records in slots, the least recently used of
which make room.

A segment is [`SEGMENT`] records that lie together in the scene. Grids keep records that are near in
space near in memory, so the records of a brick lie in one segment or in a few. All segments are of one
size: whatever was in a slot before, anything fits.
*/

/// How many records make a segment.
pub(crate) const SEGMENT: u32 = 1024;

const NONE: u32 = u32::MAX;

/// A place for a segment, in a list from the most to the least recently used.
#[derive(Clone, Copy, Debug)]
struct Slot {
    segment: u32,
    before: u32,
    after: u32,
    /// The round that used it last; it is not taken away in the same round.
    round: u64,
    /// Whether the segment has changed since it was brought.
    is_stale: bool,
}

/// Segments and slots.
#[derive(Debug)]
pub(crate) struct Residency {
    slot_of: Vec<u32>,
    slots: Vec<Slot>,
    count: usize,
    newest: u32,
    oldest: u32,
}

/// Where a segment lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// It is there.
    Resident(u32),
    /// It got this slot, and must be brought there.
    Missing(u32),
    /// All slots are in use in this round.
    Full,
}

impl Residency {
    /// Nothing is there.
    pub(crate) fn new(segments: usize, slots: usize) -> Self {
        Self {
            slot_of: vec![NONE; segments],
            slots: Vec::new(),
            count: slots,
            newest: NONE,
            oldest: NONE,
        }
    }

    /// Where a segment is, if it is there as it is now; this does not count as use.
    pub(crate) fn find(&self, segment: u32) -> Option<u32> {
        self.slot(segment).filter(|&slot| !self.slots[slot as usize].is_stale)
    }

    /// The slot of a segment, whether or not it has changed since.
    fn slot(&self, segment: u32) -> Option<u32> {
        self.slot_of.get(segment as usize).copied().filter(|&slot| slot != NONE)
    }

    /// A segment has changed: it must be brought again before it is used.
    pub(crate) fn spoil(&mut self, segment: u32) {
        if let Some(slot) = self.slot(segment) {
            self.slots[slot as usize].is_stale = true;
        }
    }

    /// Makes sure that a segment has a slot during a round.
    pub(crate) fn take(&mut self, segment: u32, round: u64) -> Place {
        if let Some(slot) = self.slot(segment) {
            self.renew(slot, round);
            let is_stale = std::mem::take(&mut self.slots[slot as usize].is_stale);
            return if is_stale { Place::Missing(slot) } else { Place::Resident(slot) };
        }
        let slot = if self.slots.len() < self.count {
            self.slots.push(Slot {
                segment: NONE,
                before: NONE,
                after: NONE,
                round,
                is_stale: false,
            });
            let slot = u32::try_from(self.slots.len() - 1).unwrap_or(NONE);
            self.link(slot);
            slot
        } else {
            let slot = self.oldest;
            match self.slots.get(slot as usize) {
                Some(oldest) if oldest.round != round => slot,
                _ => return Place::Full,
            }
        };
        self.slots[slot as usize].is_stale = false;
        let before = std::mem::replace(&mut self.slots[slot as usize].segment, segment);
        if let Some(before) = self.slot_of.get_mut(before as usize) {
            *before = NONE;
        }
        self.slot_of[segment as usize] = slot;
        self.renew(slot, round);
        Place::Missing(slot)
    }

    /// Forgets a segment that was given a slot but could not be brought there.
    pub(crate) fn drop_all(&mut self) {
        *self = Self::new(self.slot_of.len(), self.count);
    }

    fn renew(&mut self, slot: u32, round: u64) {
        self.slots[slot as usize].round = round;
        if self.newest != slot {
            self.unlink(slot);
            self.link(slot);
        }
    }

    /// Makes a slot the most recently used one.
    fn link(&mut self, slot: u32) {
        let after = std::mem::replace(&mut self.newest, slot);
        self.slots[slot as usize].before = NONE;
        self.slots[slot as usize].after = after;
        match self.slots.get_mut(after as usize) {
            Some(after) => after.before = slot,
            None => self.oldest = slot,
        }
    }

    fn unlink(&mut self, slot: u32) {
        let Slot { before, after, .. } = self.slots[slot as usize];
        match self.slots.get_mut(before as usize) {
            Some(before) => before.after = after,
            None => self.newest = after,
        }
        match self.slots.get_mut(after as usize) {
            Some(after) => after.before = before,
            None => self.oldest = before,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_has_changed_is_brought_again_to_its_slot() {
        let mut residency = Residency::new(3, 2);
        let Place::Missing(slot) = residency.take(1, 1) else { panic!() };
        residency.spoil(1);
        residency.spoil(2);
        assert_eq!(residency.find(1), None);
        assert_eq!(residency.take(1, 1), Place::Missing(slot));
        assert_eq!(residency.take(1, 1), Place::Resident(slot));
        assert_eq!(residency.find(1), Some(slot));
        // A slot that is given to another segment is not stale.
        residency.spoil(1);
        assert!(matches!(residency.take(0, 2), Place::Missing(_)));
        assert_eq!(residency.take(2, 3), Place::Missing(slot));
        assert_eq!(residency.take(2, 3), Place::Resident(slot));
    }

    proptest! {
        /// It does what a list does that is searched from one end to the other.
        #[test]
        fn the_least_recently_used_makes_room(
            uses in prop::collection::vec((0_u32..12, any::<bool>()), 0..200),
            slots in 1_usize..9,
        ) {
            let mut residency = Residency::new(12, slots);
            // Segments with their rounds, the most recent one first.
            let mut twin: Vec<(u32, u64)> = Vec::new();
            let mut round = 1;
            for (segment, is_new_round) in uses {
                round += u64::from(is_new_round);
                let known = twin.iter().position(|(other, _)| *other == segment);
                let place = residency.take(segment, round);
                match (place, known) {
                    (Place::Resident(slot), Some(known)) => {
                        twin.remove(known);
                        prop_assert_eq!(residency.find(segment), Some(slot));
                    }
                    (Place::Missing(slot), None) => {
                        if twin.len() == slots {
                            let (gone, used) = twin.pop().unwrap();
                            prop_assert!(used != round);
                            prop_assert_eq!(residency.find(gone), None);
                        }
                        prop_assert_eq!(residency.find(segment), Some(slot));
                    }
                    (Place::Full, None) => {
                        prop_assert!(twin.len() == slots && twin[slots - 1].1 == round);
                        continue;
                    }
                    other => prop_assert!(false, "{:?}", other),
                }
                twin.insert(0, (segment, round));
                let mut places: Vec<u32> =
                    (0..12).filter_map(|segment| residency.find(segment)).collect();
                prop_assert_eq!(places.len(), twin.len());
                places.sort_unstable();
                places.dedup();
                prop_assert_eq!(places.len(), twin.len());
                prop_assert!(places.iter().all(|&slot| (slot as usize) < slots));
            }
        }
    }
}
