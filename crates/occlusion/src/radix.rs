/*!
Sorting bricks in play by a key, then by depth, then by their index.

Keys are numbers of 32 bits; an `f32` becomes one that is in the same order. What is sorted is a key
and a place in the list, 8 bytes; at the end each brick is moved once. A radix sort from the lowest
digit on keeps the order that was there, which is that of the index as a rule. Only the bits in
which keys differ take part, and they are split into digits of equal length. Then each run of equal
keys is sorted by depth in the same way, or by comparing if it is short: a level of the occlusion
graph fits into the cache, and sums are hardly ever equal. Buffers are kept.
*/

use puncta_core::VisibleBrick;
use std::ops::Range;

/// The most bits of a digit: its counts should stay in the first cache.
const DIGIT_BITS: u32 = 11;

/// Lists shorter than that have digits of 8 bits: less is to be counted then.
const MIDDLING: usize = 1 << 12;

/// Runs shorter than that are sorted by comparing.
const SHORT: usize = 128;

/// A key, and which brick of the list it belongs to.
type Pair = (u32, u32);

/// Sorts bricks, and keeps the memory for it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Radix {
    pairs: Vec<Pair>,
    spare: Vec<Pair>,
    sorted: Vec<VisibleBrick>,
}

impl Radix {
    /// Sorts by the key of a brick, given its place in the list; then by near depth and index.
    pub(crate) fn sort(&mut self, bricks: &mut Vec<VisibleBrick>, key: impl Fn(usize) -> u32) {
        self.spare.resize(bricks.len(), (0, 0));
        self.pairs.clear();
        if bricks.is_sorted_by_key(VisibleBrick::index) {
            self.pairs.extend((0_u32..).zip(0..bricks.len()).map(|(place, i)| (key(i), place)));
        } else {
            self.pairs.extend((0_u32..).zip(&*bricks).map(|(place, brick)| (brick.index(), place)));
            by_keys(&mut self.pairs, &mut self.spare);
            rekey(&mut self.pairs, key);
        }
        by_keys(&mut self.pairs, &mut self.spare);
        let mut start = 0;
        while let Some(next) = ties(&self.pairs, start) {
            let run = &mut self.pairs[next.clone()];
            rekey(run, |place| ascending(bricks[place].near()));
            by_keys(run, &mut self.spare[next.clone()]);
            start = next.end;
        }
        self.sorted.clear();
        self.sorted.extend(self.pairs.iter().map(|&(_, place)| bricks[place as usize]));
        std::mem::swap(bricks, &mut self.sorted);
    }
}

/// The next run of pairs with one key, of at least two, from a place on.
fn ties(pairs: &[Pair], start: usize) -> Option<Range<usize>> {
    let rest = pairs.get(start..)?;
    let first = rest.windows(2).position(|pair| pair[0].0 == pair[1].0)?;
    let key = rest[first].0;
    let count = rest[first..].iter().take_while(|&&(other, _)| other == key).count();
    Some(start + first..start + first + count)
}

/// Gives other keys to pairs.
fn rekey(pairs: &mut [Pair], key: impl Fn(usize) -> u32) {
    for (of_brick, place) in pairs {
        *of_brick = key(*place as usize);
    }
}

/// Sorts pairs by their keys; equal ones stay in their order.
fn by_keys(pairs: &mut [Pair], spare: &mut [Pair]) {
    if pairs.len() < SHORT {
        return pairs.sort_by_key(|&(key, _)| key);
    }
    let range = |(min, max): (u32, u32), &(key, _): &Pair| (min.min(key), max.max(key));
    let (min, max) = pairs.iter().fold((u32::MAX, 0), range);
    let bits = u32::BITS - (max - min).leading_zeros();
    let digits = bits.div_ceil(if pairs.len() < MIDDLING { 8 } else { DIGIT_BITS });
    let (mut from, mut to) = (&mut *pairs, spare);
    for digit in 0..digits {
        let width = bits.div_ceil(digits);
        by_digit(from, to, width, |key| (key - min) >> (width * digit));
        std::mem::swap(&mut from, &mut to);
    }
    if digits % 2 == 1 {
        to.copy_from_slice(from);
    }
}

/// Sorts pairs by the lowest bits of what `digit` makes of their keys, from one place to another.
fn by_digit(from: &[Pair], to: &mut [Pair], bits: u32, digit: impl Fn(u32) -> u32) {
    let mut counts = [0_u32; 1 << DIGIT_BITS];
    let counts = &mut counts[..1 << bits];
    let digit = |key: u32| (digit(key) & ((1 << bits) - 1)) as usize;
    for &(key, _) in from {
        counts[digit(key)] += 1;
    }
    let mut start = 0;
    for count in &mut *counts {
        start += std::mem::replace(count, start);
    }
    for &pair in from {
        let next = &mut counts[digit(pair.0)];
        to[*next as usize] = pair;
        *next += 1;
    }
}

/// A key in the order of numbers; both zeros are one.
#[inline]
pub(crate) fn ascending(number: f32) -> u32 {
    let bits = (number + 0.0).to_bits();
    // Of negative numbers, all bits; of others, the sign.
    bits ^ ((bits.cast_signed() >> 31).cast_unsigned() | 1 << 31)
}

/// A key in the opposite order of numbers.
#[inline]
pub(crate) fn descending(number: f32) -> u32 {
    !ascending(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use proptest::prelude::*;
    use puncta_core::{Aabb, Brick, View, Visible};

    #[test]
    fn keys_are_in_the_order_of_numbers() {
        let numbers = [f32::NEG_INFINITY, -1e30, -1.0, -1e-45, 0.0, 1e-45, 0.5, 2.0, f32::INFINITY];
        assert!(numbers.is_sorted_by(|&a, &b| ascending(a) < ascending(b)));
        assert!(numbers.is_sorted_by(|&a, &b| descending(a) > descending(b)));
        assert_eq!(ascending(-0.0), ascending(0.0));
    }

    proptest! {
        #[test]
        fn bricks_are_sorted_as_by_comparing(
            places in prop::collection::vec((-40_i8..40, any::<u32>(), 0_u32..3), 0..300),
            kind in 0_usize..4,
            turn in 0_usize..300,
        ) {
            let view = View::look_at(DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
            let brick = |&(x, ..): &(i8, u32, u32)| -> Brick {
                let at = Vec3::splat(f32::from(x) / 3.0);
                let bounds = Aabb { min: at, max: at };
                Brick { records: 0..0, bounds, radius_max: 0.0, density: 0.0 }
            };
            let bricks: Vec<Brick> = places.iter().map(brick).collect();
            let mut list = Visible::all(&bricks, DVec3::ZERO, &view).bricks;
            list.rotate_left(turn % places.len().max(1));
            let key = |brick: &VisibleBrick| -> u32 {
                let (_, any, few) = places[brick.index() as usize];
                [0, few, any, u32::MAX - few][kind]
            };
            let mut expected = list.clone();
            expected.sort_by(|a, b| {
                let by_depth = (a.near(), a.index()).partial_cmp(&(b.near(), b.index())).unwrap();
                key(a).cmp(&key(b)).then(by_depth)
            });
            let keys: Vec<u32> = list.iter().map(key).collect();
            let mut radix = Radix::default();
            radix.sort(&mut Vec::from(&list[list.len() / 2..]), |_| 7);
            radix.sort(&mut list, |place| keys[place]);
            prop_assert_eq!(list, expected);
        }
    }
}
