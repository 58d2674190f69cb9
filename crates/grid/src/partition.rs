/*!
The parallel partition in place: rows are moved into a few hundred to a few thousand buckets.

The idea is that of PARADIS (Cho, Brand, Bordawekar, Finkler, Kulandaisamy, Puri: *PARADIS: an
efficient parallel algorithm for in-place radix sort*, VLDB 2015). Counting gives each bucket its run
of the array, its home. Every home is cut into as many parts as there are stripes, and a stripe owns
one part of each home. A stripe sorts what lies in its own parts, alone: a record is swapped to the
first unsorted place of its bucket's part, and what lay there is taken on. Where a part is full, its
records have to stay where they do not belong, at the end of the part at hand. There are few of them
if the data do not conspire. They are gathered at the end of each home, and the homes that are left,
much smaller, are sorted in the same way; at last with a single stripe, which leaves nothing over.

Two things make it fast. A swap has to wait for the record that lay at its place, some hundred
instructions if that is not in the cache. So [`HANDS`] records are on their way at once, and the
processor overlaps their waiting. And the places that will be needed next are prefetched.

The number of stripes depends on the number of rows alone, so the result does not depend on the
number of threads.
*/

#![expect(unsafe_code, reason = "stripes share the rows, but never a row")]

use crate::{
    codes::Coder,
    dispatch::{Kernel, widest},
    rows::{Lane, Rows},
};
use puncta_core::Record;
use rayon::prelude::*;
use std::{iter, marker::PhantomData, ops::Range, ptr};

/// How many records are on their way at once.
const HANDS: u32 = 32;

/// How many bytes ahead of the record at hand the next ones of its bucket are asked for.
const BUCKET_AHEAD: usize = 64;

/// How many rows a stripe should have.
const STRIPE_ROWS: usize = 1 << 19;

/// The largest number of stripes.
const STRIPES_MAX: usize = 32;

/// How many rounds are run by more than one stripe.
const ROUNDS: usize = 2;

/// A place where rows are unsorted: the first of them and the one after the last.
type Zone = Range<u32>;

/// Moves rows into buckets; `homes` are the runs of the buckets, one for each digit.
///
/// # Panics
///
/// When the homes do not suit the rows or the digits.
pub(crate) fn partition<R: Record>(rows: &mut Rows<'_, R>, coder: &Coder, homes: &[Zone]) {
    // What all that is unsafe below relies on.
    assert_eq!(homes.len(), coder.digit().values(), "there is not one home for each digit");
    let end = homes
        .iter()
        .try_fold(0, |end, home| (home.start == end && home.end >= end).then_some(home.end));
    assert_eq!(end.map(|end| end as usize), Some(rows.len()), "the homes are not all rows");
    assert!(rows.lanes.iter().all(|lane| lane.len() == rows.len()), "a column has other rows");
    let mut zones = homes.to_vec();
    for round in 0.. {
        let left: usize = zones.iter().map(Zone::len).sum();
        if left == 0 {
            return;
        }
        let is_last = round >= ROUNDS || left < STRIPE_ROWS / 16;
        let stripes = if is_last { 1 } else { (left / STRIPE_ROWS).clamp(4, STRIPES_MAX) };
        let shared = Shared::new(rows);
        let stuck: Vec<Vec<Zone>> = (0..stripes)
            .into_par_iter()
            .map(|stripe| {
                let mut parts: Vec<Zone> =
                    zones.iter().map(|zone| part(zone, stripe, stripes)).collect();
                // SAFETY: the parts of different stripes do not overlap, and each stripe is run once.
                unsafe { shared.sort_stripe(coder, &mut parts) };
                parts
            })
            .collect();
        if stripes == 1 {
            return;
        }
        zones.par_iter_mut().enumerate().for_each(|(bucket, zone)| {
            let stuck: Vec<Zone> = stuck.iter().map(|parts| parts[bucket].clone()).collect();
            // SAFETY: zones do not overlap, and the stuck rows of a bucket lie in its zone.
            *zone = unsafe { shared.gather(zone.clone(), &stuck) };
        });
    }
}

/// The part of a zone that a stripe owns.
fn part(zone: &Zone, stripe: usize, stripes: usize) -> Zone {
    let length = u64::from(zone.end - zone.start);
    #[expect(clippy::cast_possible_truncation, reason = "a part of a length that fits")]
    let at = |stripe: usize| zone.start + (length * stripe as u64 / stripes as u64) as u32;
    at(stripe)..at(stripe + 1)
}

/// Sorts the rows of a stripe; only made where that is safe.
struct SortParts<'s, 'a, R> {
    rows: &'s Shared<'a, R>,
    coder: &'s Coder,
    parts: &'s mut [Zone],
}

impl<R: Record> Kernel for SortParts<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        // SAFETY: as promised to the function that made this.
        unsafe {
            if self.rows.lanes.is_empty() {
                self.rows.sort_parts::<false>(self.coder, self.parts);
            } else {
                self.rows.sort_parts::<true>(self.coder, self.parts);
            }
        }
    }
}

/// Rows that several threads work on, each on rows of its own.
struct Shared<'a, R> {
    records: *mut R,
    lanes: Vec<SharedLane>,
    rows: PhantomData<&'a mut R>,
}

#[derive(Clone, Copy)]
enum SharedLane {
    Words(*mut [u8; 4]),
    Bytes(*mut u8),
}

// SAFETY: it stands for exclusive references to data that may be sent; all access is through unsafe
// functions, whose callers see to it that threads work on different rows.
unsafe impl<R: Send> Sync for Shared<'_, R> {}

impl<'a, R: Record> Shared<'a, R> {
    fn new(rows: &'a mut Rows<'_, R>) -> Self {
        let lane = |lane: &mut Lane<'_>| match lane {
            Lane::Words(words) => SharedLane::Words(words.as_mut_ptr()),
            Lane::Bytes(bytes) => SharedLane::Bytes(bytes.as_mut_ptr()),
        };
        Self {
            records: rows.records.as_mut_ptr(),
            lanes: rows.lanes.iter_mut().map(lane).collect(),
            rows: PhantomData,
        }
    }

    /// Sorts the rows of these parts into these parts; those that are left are the stuck ones.
    ///
    /// # Safety
    ///
    /// The parts must lie within the rows and not overlap, and nobody else may access their rows.
    /// There must be a part for each bucket that a code can fall into.
    unsafe fn sort_stripe(&self, coder: &Coder, parts: &mut [Zone]) {
        let ends: Vec<u32> = parts.iter().map(|part| part.end).collect();
        widest(SortParts { rows: self, coder, parts });
        for (part, end) in parts.iter_mut().zip(ends) {
            *part = part.end..end;
        }
    }

    /// Sorts each part. At the end `start` and `end` of a part are equal, and what is stuck in it
    /// lies behind them.
    ///
    /// # Safety
    ///
    /// As [`Self::sort_stripe`].
    #[inline(always)]
    unsafe fn sort_parts<const LANES: bool>(&self, coder: &Coder, parts: &mut [Zone]) {
        let mut held_lanes = vec![[0; 4]; self.lanes.len() * HANDS as usize];
        let mut digits = [0; HANDS as usize];
        for here in 0..parts.len() {
            // The hands take their rows from the places `start..start + hands`, which are free.
            let Range { mut start, mut end } = parts[here];
            let mut hands = (end - start).min(HANDS);
            if hands == 0 {
                continue;
            }
            // SAFETY: all places below lie in parts: `start..end` and `parts[there]` only shrink,
            // and only places in them are accessed. There is a part for each digit.
            unsafe {
                let mut held = [*self.records.add(start as usize); HANDS as usize];
                for hand in 0..hands {
                    let (record, lanes) = self.hand::<LANES>(&mut held, &mut held_lanes, hand);
                    self.exchange(record, lanes, start + hand);
                }
                while hands > 0 {
                    coder.code(&held, &mut digits);
                    let mut hand = 0;
                    while hand < hands {
                        let (record, lanes) = self.hand::<LANES>(&mut held, &mut held_lanes, hand);
                        let there = digits[hand as usize] as usize;
                        let part = parts.get_unchecked_mut(there);
                        let at = part.start;
                        if there != here && at < part.end {
                            part.start = at + 1;
                            self.prefetch(at);
                            self.exchange(record, lanes, at);
                            hand += 1;
                            continue;
                        }
                        // The row stays: in front if it belongs here, else behind.
                        let next = start + hands;
                        let goes_on = if there == here {
                            self.exchange(record, lanes, start);
                            start += 1;
                            if next < end {
                                self.exchange(record, lanes, next);
                            }
                            next < end
                        } else {
                            end -= 1;
                            self.exchange(record, lanes, end);
                            next <= end
                        };
                        if goes_on {
                            hand += 1;
                        } else {
                            hands -= 1;
                            let (hand, last) = (hand as usize, hands as usize);
                            held[hand] = held[last];
                            digits[hand] = digits[last];
                            let lanes = self.lanes.len();
                            held_lanes.copy_within(last * lanes..(last + 1) * lanes, hand * lanes);
                        }
                    }
                }
            }
            parts[here] = start..end;
        }
    }

    /// The row in a hand.
    #[inline(always)]
    fn hand<'h, const LANES: bool>(
        &self,
        held: &'h mut [R; HANDS as usize],
        held_lanes: &'h mut [[u8; 4]],
        hand: u32,
    ) -> (&'h mut R, &'h mut [[u8; 4]]) {
        let (hand, lanes) = (hand as usize, self.lanes.len());
        let lanes = if LANES { &mut held_lanes[hand * lanes..(hand + 1) * lanes] } else { &mut [] };
        (&mut held[hand], lanes)
    }

    /// Exchanges a row in hand with the one at a place.
    ///
    /// # Safety
    ///
    /// There must be such a row, and nobody else may access it.
    #[inline(always)]
    unsafe fn exchange(&self, record: &mut R, lanes: &mut [[u8; 4]], at: u32) {
        // SAFETY: as promised to this function.
        unsafe {
            ptr::swap(record, self.records.add(at as usize));
            for (lane, value) in self.lanes.iter().zip(lanes) {
                match *lane {
                    SharedLane::Words(words) => ptr::swap(value, words.add(at as usize)),
                    SharedLane::Bytes(bytes) => {
                        ptr::swap(&raw mut value[0], bytes.add(at as usize));
                    }
                }
            }
        }
    }

    /// Asks for the record that will be wanted some swaps after the one at a place.
    #[inline(always)]
    fn prefetch(&self, at: u32) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
            let ahead = self.records.wrapping_add(at as usize).wrapping_byte_add(BUCKET_AHEAD);
            // SAFETY: a prefetch reads nothing, wherever it points.
            unsafe { _mm_prefetch::<_MM_HINT_T1>(ahead.cast()) };
        }
    }

    /// Moves the stuck rows of a zone to its end; returns where they are then.
    ///
    /// # Safety
    ///
    /// The zone must lie within the rows, the stuck rows within the zone and in ascending order,
    /// and nobody else may access its rows.
    unsafe fn gather(&self, zone: Zone, stuck: &[Zone]) -> Zone {
        let count: u32 = stuck.iter().map(|part| part.end - part.start).sum();
        let target = zone.end - count..zone.end;
        let movers = stuck.iter().cloned().flatten().take_while(|&at| at < target.start);
        let mut free = target.start;
        let mut gaps = stuck.iter().cloned().chain(iter::once(zone.end..zone.end));
        let mut gap = 0..0;
        for mover in movers {
            while gap.is_empty() {
                let Some(next) = gaps.next() else { return target };
                gap = free..next.start.max(free);
                free = free.max(next.end);
            }
            let Some(at) = gap.next() else { return target };
            // SAFETY: both places lie in the zone.
            unsafe { self.swap(mover as usize, at as usize) };
        }
        target
    }

    /// Exchanges two rows.
    ///
    /// # Safety
    ///
    /// There must be such rows, and nobody else may access them.
    unsafe fn swap(&self, a: usize, b: usize) {
        // SAFETY: as promised to this function.
        unsafe {
            self.records.add(a).swap(self.records.add(b));
            for lane in &self.lanes {
                match *lane {
                    SharedLane::Words(words) => words.add(a).swap(words.add(b)),
                    SharedLane::Bytes(bytes) => bytes.add(a).swap(bytes.add(b)),
                }
            }
        }
    }
}
