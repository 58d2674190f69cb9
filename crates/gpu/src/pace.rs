/*!
How much is drawn before what is left is tested again.

A test finds bricks that are hidden by what is drawn: they are neither drawn nor brought. It costs a look
at all tiles of the picture and the way back of its answer, which is worth some bricks. So there are some
dozen tests where they find something, more if bricks are large, and ever fewer where they do not.
*/

/// The share of the bricks that are drawn before those that are left are tested for the first time, and
/// the smallest number.
const FIRST_SHARE: usize = 128;
const FIRST_MIN: usize = 64;

/// The share of the bricks that are left by then, of which more than that is drawn at once later: what
/// is hidden is neither drawn nor brought, and testing takes few turns.
const LATER_SHARE: usize = 64;

/// If less than this share of what is left turns out to be hidden, twice as much is drawn until the next
/// test.
const HIDDEN_SHARE: usize = 16;

/// How much of some bricks is drawn at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    first: usize,
    /// How many times as much as at first.
    times: usize,
}

impl Pace {
    /// The pace of so many bricks.
    pub(crate) fn new(bricks: usize) -> Self {
        Self { first: bricks.div_ceil(FIRST_SHARE).max(FIRST_MIN), times: 1 }
    }

    /// Of so many bricks so many turned out to be hidden.
    pub(crate) fn adapt(&mut self, hidden: usize, of: usize) {
        let is_open = hidden < of.div_ceil(HIDDEN_SHARE);
        self.times = if is_open { self.times.saturating_mul(2) } else { 1 };
    }

    /// How many bricks are next, of which each may cover so many pixels of a picture: at least one, if
    /// there is any. Few if they are large, as those in front may hide all others.
    pub(crate) fn next(&self, picture: u64, bricks: impl ExactSizeIterator<Item = u64>) -> usize {
        let most = self.first.saturating_mul(self.times).max(bricks.len() / LATER_SHARE);
        let mut room = picture.saturating_mul(self.times as u64).max(1);
        let fits = |pixels: &u64| {
            let is_room = room > 0;
            room = room.saturating_sub(*pixels);
            is_room
        };
        bricks.take(most).take_while(fits).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn large_bricks_are_drawn_in_small_numbers() {
        let pace = Pace::new(1000);
        assert_eq!(pace.next(100, [60_u64; 1000].into_iter()), 2);
        assert_eq!(pace.next(100, [1000; 1000].into_iter()), 1);
        assert_eq!(pace.next(100, [1; 1000].into_iter()), 64);
        assert_eq!(pace.next(100, [0; 1000].into_iter()), 64);
        assert_eq!(Pace::new(12_800).next(1000, [1; 12_800].into_iter()), 200);
    }

    #[test]
    fn tests_are_fewer_where_nothing_is_hidden() {
        let mut pace = Pace::new(1000);
        pace.adapt(0, 936);
        assert_eq!(pace.next(100, [1; 872].into_iter()), 128);
        assert_eq!(pace.next(100, [60; 872].into_iter()), 4);
        pace.adapt(54, 872);
        assert_eq!(pace.next(100, [1; 818].into_iter()), 256);
        pace.adapt(52, 818);
        assert_eq!(pace.next(100, [1; 858].into_iter()), 64);
    }

    proptest! {
        /// Whatever is found on the way, it comes to an end.
        #[test]
        fn everything_is_drawn(
            mut left in 0_usize..5000,
            picture in 0_u64..10_000,
            pixels in prop_oneof![0_u64..100, any::<u64>()],
            hidden in prop::collection::vec(0.0..1.0_f64, 20),
        ) {
            let mut pace = Pace::new(left);
            for turn in 0_usize.. {
                let count = pace.next(picture, vec![pixels; left].into_iter());
                prop_assert!(count <= left && (count > 0 || left == 0));
                left -= count;
                if left == 0 {
                    break;
                }
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
                let found = (left as f64 * hidden[turn % 20]) as usize;
                pace.adapt(found, left);
                left -= found;
            }
        }
    }
}
