//! Medians and what they are worth: a bootstrap interval.

use serde::Serialize;
use vodca::random::{self, Use};

/// Sorted numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample(Vec<f64>);

/// A median with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Median {
    /// The median of the sample.
    pub median: f64,
    /// 2.5 % of the medians of resamples are lower.
    pub low: f64,
    /// 2.5 % of the medians of resamples are higher.
    pub high: f64,
    /// The largest number of the sample.
    pub most: f64,
}

/// Resamples of a bootstrap: the interval's ends then move by less than a hundredth of its width with the seed.
const RESAMPLES: usize = 2000;

impl Sample {
    /// The finite ones of `values`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    /// The smallest number.
    pub fn least(&self) -> Option<f64> {
        self.0.first().copied()
    }

    /// The middle, or the mean of the two in the middle; `None` of nothing.
    pub fn middle(&self) -> Option<f64> {
        let (low, high) = middle_ranks(self.0.len())?;
        Some((self.0[low] + self.0[high]) / 2.0)
    }

    /// The median with its percentile bootstrap interval (Efron 1979), seeded: the same numbers give the
    /// same interval. Equal to the median where there is only one number.
    pub fn median(&self) -> Option<Median> {
        let count = self.0.len();
        let (low, high) = middle_ranks(count)?;
        let mut generator = random::stream(0, Use::Resample, count as u64, 0);
        let mut ranks = vec![0usize; count];
        let mut medians: Vec<f64> = (0..RESAMPLES)
            .map(|_| {
                ranks.fill_with(|| random::below(&mut generator, count as u64) as usize);
                let (below, &mut upper, _) = ranks.select_nth_unstable(high);
                let lower = if low == high { upper } else { below.iter().copied().max().unwrap_or(upper) };
                (self.0[lower] + self.0[upper]) / 2.0
            })
            .collect();
        medians.sort_by(f64::total_cmp);
        let cut = RESAMPLES / 40;
        Some(Median {
            median: (self.0[low] + self.0[high]) / 2.0,
            low: medians[cut],
            high: medians[RESAMPLES - 1 - cut],
            most: self.0[count - 1],
        })
    }
}

/// The two ranks whose mean is the median of `count` sorted numbers; the same one twice where it is odd.
fn middle_ranks(count: usize) -> Option<(usize, usize)> {
    (count > 0).then(|| ((count - 1) / 2, count / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_is_the_mean_of_the_middle_two() {
        assert_eq!(Sample::of([3.0, 1.0, 2.0, 10.0]).middle(), Some(2.5));
        assert_eq!(Sample::of([3.0, 1.0, 2.0]).median().unwrap().median, 2.0);
        assert_eq!((Sample::of([]).middle(), Sample::of([]).median()), (None, None));
        assert_eq!(Sample::of([4.0]).median(), Some(Median { median: 4.0, low: 4.0, high: 4.0, most: 4.0 }));
    }

    #[test]
    fn the_interval_is_that_of_the_binomial_law() {
        // The median of a resample of 1..=101 lies below rank r with P(Binomial(101, r/101) > 50): the
        // 2.5 % and 97.5 % points are ranks 41 and 61.
        let median = Sample::of((1..=101).map(f64::from)).median().unwrap();
        assert_eq!(median.median, 51.0);
        assert!((median.low - 41.0).abs() <= 1.0 && (median.high - 61.0).abs() <= 1.0, "{median:?}");
    }

    #[test]
    fn equal_numbers_leave_no_doubt_and_the_order_does_not_matter() {
        let even = Sample::of(vec![7.0; 20]).median().unwrap();
        assert_eq!((even.low, even.high), (7.0, 7.0));
        assert_eq!(Sample::of([1.0, 2.0, 5.0, 9.0]).median(), Sample::of([9.0, 1.0, 5.0, 2.0]).median());
    }
}
