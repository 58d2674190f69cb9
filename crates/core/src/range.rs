//! Ranges of values that a few strays do not stretch.

/// The number of bins: what is cut off is cut at the edge of one of them.
const BINS: usize = 4096;

/// The range of values without a share of `outside` at either end, or nearly so: at both ends it
/// goes to the next 4096th of the whole range. Values that are not finite do not count.
///
/// It depends on the values alone, not on their order. If there are none, it is 0 to 1.
///
/// # Examples
///
/// ```
/// use puncta_core::inner_range;
///
/// let values = || (0..1000).map(f64::from).chain([2500.0]);
/// let [low, high] = inner_range(values, 0.002);
/// assert!(low >= 0.0 && low < 5.0 && high > 990.0 && high < 1000.0);
/// ```
pub fn inner_range<I: Iterator<Item = f64>>(values: impl Fn() -> I, outside: f64) -> [f64; 2] {
    let finite = || values().filter(|value| value.is_finite());
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in finite() {
        low = if value < low { value } else { low };
        high = if value > high { value } else { high };
    }
    let mut bins = RangeBins::new([low, high]);
    finite().for_each(|value| bins.add(value));
    bins.range(outside)
}

/// [`inner_range`] of values that come one by one, once it is known from where to where they go.
///
/// # Examples
///
/// ```
/// use puncta_core::{RangeBins, inner_range};
///
/// let values = || (0..1000).map(f64::from);
/// let mut bins = RangeBins::new([0.0, 999.0]);
/// values().for_each(|value| bins.add(value));
/// assert_eq!(bins.range(0.01), inner_range(values, 0.01));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RangeBins {
    low: f64,
    high: f64,
    scale: f64,
    /// Empty where the range is too narrow to be cut.
    bins: Vec<u64>,
}

impl RangeBins {
    /// Bins for values whose least and largest finite ones are these; if there are none, the first
    /// is the larger one.
    #[must_use]
    pub fn new([low, high]: [f64; 2]) -> Self {
        let width = (high - low) / BINS as f64;
        let bins = if width.is_normal() && width > 0.0 { vec![0; BINS] } else { vec![] };
        Self { low, high, scale: 1.0 / width, bins }
    }

    /// Counts a value; one that is not finite does not count.
    #[inline]
    pub fn add(&mut self, value: f64) {
        if value.is_finite() && !self.bins.is_empty() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "saturates"
            )]
            let bin = ((value - self.low) * self.scale) as usize;
            self.bins[bin.min(BINS - 1)] += 1;
        }
    }

    /// Counts what was counted in other bins of the same range.
    pub fn join(&mut self, other: &Self) {
        self.bins.iter_mut().zip(&other.bins).for_each(|(bin, more)| *bin += more);
    }

    /// The range without a share of `outside` at either end, as [`inner_range`] says.
    #[must_use]
    pub fn range(&self, outside: f64) -> [f64; 2] {
        let Self { low, high, ref bins, .. } = *self;
        if bins.is_empty() {
            return if low <= high { [low, high] } else { [0.0, 1.0] };
        }
        let width = (high - low) / BINS as f64;
        let allowed = bins.iter().sum::<u64>() as f64 * outside;
        let first = passed(bins.iter(), allowed);
        let last = passed(bins.iter().rev(), allowed);
        // Everything may be outside: then there is no inner range.
        if first + last >= BINS {
            return [low, high];
        }
        let at = |bin: usize| low + bin as f64 * width;
        [if first == 0 { low } else { at(first) }, if last == 0 { high } else { at(BINS - last) }]
    }
}

/// How many bins hold no more than `allowed` values together.
fn passed<'a>(bins: impl Iterator<Item = &'a u64>, allowed: f64) -> usize {
    let sums = bins.scan(0, |sum, &bin| {
        *sum += bin;
        Some(*sum)
    });
    sums.take_while(|&sum| sum as f64 <= allowed).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strays_do_not_stretch_the_range() {
        let values = || (0..10_000).map(f64::from).chain([1e6, -1e6, f64::NAN]);
        let [low, high] = inner_range(values, 0.002);
        assert!((-1000.0..50.0).contains(&low) && (9900.0..11_000.0).contains(&high));
    }

    #[test]
    fn odd_values_have_a_range() {
        let range = |values: &[f64], outside| inner_range(|| values.iter().copied(), outside);
        assert_eq!(range(&[3.0, 3.0], 0.002), [3.0, 3.0]);
        assert_eq!(range(&[f64::NAN], 0.002), [0.0, 1.0]);
        assert_eq!(range(&[], 0.5), [0.0, 1.0]);
        assert_eq!(range(&[-1.0, 2.0], 1.0), [-1.0, 2.0]);
        assert_eq!(range(&[-1e308, 1e308], 0.0), [-1e308, 1e308]);
    }
}
