//! The first look at all records: are they valid, which box holds them, how many fall into each
//! bucket.

use crate::{
    Error,
    codes::{Coder, RUN},
    dispatch::{Kernel, STREAM_AHEAD, lanes_of, prefetch, widest},
};
use glam::Vec3;
use puncta_core::{Aabb, Record};
use rayon::prelude::*;
use wide::f32x4;

/// What a look at records finds.
#[derive(Clone, Debug)]
pub(crate) struct Census {
    /// The smallest box around the positions.
    pub(crate) bounds: Aabb,
    /// The number of records in each bucket; empty if they were not counted.
    pub(crate) counts: Vec<u32>,
}

/// The extremes of positions and radii.
#[derive(Clone, Copy)]
struct Extremes {
    least: f32x4,
    most: f32x4,
    /// The sum of all: NaN if one was NaN, and hardly ever else.
    sum: f32x4,
}

impl Extremes {
    const NONE: Self = Self {
        least: f32x4::new([f32::INFINITY; 4]),
        most: f32x4::new([f32::NEG_INFINITY; 4]),
        sum: f32x4::ZERO,
    };

    #[inline(always)]
    fn add(&mut self, lanes: f32x4) {
        self.least = lanes.fast_min(self.least);
        self.most = lanes.fast_max(self.most);
        self.sum += lanes;
    }

    fn join(self, other: Self) -> Self {
        Self {
            least: self.least.fast_min(other.least),
            most: self.most.fast_max(other.most),
            sum: self.sum + other.sum,
        }
    }

    /// Whether it is sure that all records are ones that a grid can hold.
    fn are_valid(self) -> bool {
        let (least, most) = (self.least.to_array(), self.most.to_array());
        let finite = least.iter().chain(&most).all(|x| x.is_finite());
        finite && least[3] >= 0.0 && !self.sum.is_nan().any()
    }
}

/// Looks at all records: their box, and how many there are of each value of the coder's digit.
pub(crate) fn take<R: Record>(records: &[R], coder: &Coder) -> Result<Census, Error> {
    let (extremes, counts) = look_at_all(records, coder);
    Ok(Census { bounds: check(records, extremes)?, counts })
}

/// How many of these records, which are valid, there are of each value of the coder's digit.
pub(crate) fn count<R: Record>(records: &[R], coder: &Coder) -> Vec<u32> {
    look_at_all(records, coder).1
}

fn look_at_all<R: Record>(records: &[R], coder: &Coder) -> (Extremes, Vec<u32>) {
    let none = || (Extremes::NONE, vec![0; coder.digit().values()]);
    records
        .par_chunks(chunk(records.len()))
        .fold(none, |(mut extremes, mut counts), records| {
            widest(Look { records, coder, extremes: &mut extremes, counts: &mut counts });
            (extremes, counts)
        })
        .reduce_with(|a, b| (a.0.join(b.0), add(a.1, &b.1)))
        .unwrap_or_else(none)
}

/// The box around all records, each of which must be one that a grid can hold.
pub(crate) fn bounds<R: Record>(records: &[R]) -> Result<Aabb, Error> {
    let chunks = records.par_chunks(chunk(records.len()));
    let extremes = chunks.map(|records| widest(Span(records)));
    check(records, extremes.reduce(|| Extremes::NONE, Extremes::join))
}

/// Few enough chunks that joining what was found in them costs nothing.
fn chunk(records: usize) -> usize {
    records.div_ceil(16 * rayon::current_num_threads()).max(1 << 14)
}

fn add(mut a: Vec<u32>, b: &[u32]) -> Vec<u32> {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
    a
}

/// Counts records.
struct Look<'a, R> {
    records: &'a [R],
    coder: &'a Coder,
    extremes: &'a mut Extremes,
    counts: &'a mut [u32],
}

impl<R: Record> Kernel for Look<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut digits = [0; RUN];
        let mut extremes = *self.extremes;
        for records in self.records.chunks(RUN) {
            self.coder.code(records, &mut digits);
            for (records, digits) in records.chunks(4).zip(digits.chunks(4)) {
                prefetch(records, STREAM_AHEAD);
                for (record, &digit) in records.iter().zip(digits) {
                    extremes.add(lanes_of(record));
                    self.counts[digit as usize] += 1;
                }
            }
        }
        *self.extremes = extremes;
    }
}

/// Finds the extremes of records.
struct Span<'a, R>(&'a [R]);

impl<R: Record> Kernel for Span<'_, R> {
    type Output = Extremes;

    #[inline(always)]
    fn run(self) -> Extremes {
        let mut extremes = Extremes::NONE;
        for records in self.0.chunks(4) {
            prefetch(records, STREAM_AHEAD);
            records.iter().for_each(|record| extremes.add(lanes_of(record)));
        }
        extremes
    }
}

/// The box that the extremes tell, or which record spoils them.
fn check<R: Record>(records: &[R], extremes: Extremes) -> Result<Aabb, Error> {
    if !records.is_empty() && !extremes.are_valid() {
        for (index, record) in records.iter().enumerate() {
            let (position, radius) = (record.position(), record.radius());
            if !position.is_finite() {
                return Err(Error::Position { index, position });
            }
            if !(0.0..f32::INFINITY).contains(&radius) {
                return Err(Error::Radius { index, radius });
            }
        }
    }
    // Of two zeros, which one is met first hangs on the threads; adding zero makes both positive.
    let corner = |lanes: f32x4| Vec3::from_slice(&lanes.to_array()) + 0.0;
    Ok(Aabb { min: corner(extremes.least), max: corner(extremes.most) })
}
