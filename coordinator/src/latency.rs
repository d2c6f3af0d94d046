//! Distributions of durations. The only file that imports `hdrhistogram`.

use hdrhistogram::Histogram;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A distribution of durations from 1 ns to a minute, exact to 0.1 %; longer ones count as a minute.
#[derive(Clone, Debug)]
pub struct Latency(Histogram<u64>);

const LONGEST: u64 = 60_000_000_000; // ns
const LOWEST: u64 = 1; // ns
const DIGITS: u8 = 3;

/// The figures of a distribution, microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Percentiles {
    /// Number of durations.
    pub count: u64,
    /// Half are no longer than this, us.
    pub p50_us: f64,
    /// 90 % are no longer than this, us.
    #[serde(default)]
    pub p90_us: f64,
    /// 99 % are no longer than this, us.
    pub p99_us: f64,
    /// 99.9 % are no longer than this, us.
    #[serde(default)]
    pub p999_us: f64,
    /// The longest, us.
    pub max_us: f64,
}

/// A percentile is told when at least this many durations lie beyond it: p99 from 1,000 on, p99.9 from 10,000.
/// With fewer it would be little else than the longest under another name.
const BEYOND: u64 = 10;

impl Percentiles {
    /// 90 % are no longer than this, us; none where too few durations lie beyond to tell.
    pub fn p90(&self) -> Option<f64> {
        self.told(10, self.p90_us)
    }

    /// 99 % are no longer than this, us; none where too few durations lie beyond to tell.
    pub fn p99(&self) -> Option<f64> {
        self.told(100, self.p99_us)
    }

    /// 99.9 % are no longer than this, us; none where too few durations lie beyond to tell.
    pub fn p999(&self) -> Option<f64> {
        self.told(1_000, self.p999_us)
    }

    fn told(&self, one_in: u64, value: f64) -> Option<f64> {
        (self.count >= BEYOND * one_in).then_some(value)
    }
}

impl Latency {
    /// An empty distribution.
    pub fn new() -> Self {
        match Histogram::new_with_bounds(LOWEST, LONGEST, DIGITS) {
            Ok(histogram) => Self(histogram),
            Err(error) => unreachable!("the bounds are constants that the library accepts: {error}"),
        }
    }

    /// Adds one duration.
    pub fn record(&mut self, duration: Duration) {
        self.record_ns(u64::try_from(duration.as_nanos()).unwrap_or(LONGEST));
    }

    /// Adds one duration in ns.
    pub fn record_ns(&mut self, nanoseconds: u64) {
        self.0.saturating_record(nanoseconds.clamp(LOWEST, LONGEST));
    }

    /// Durations and how many of each, shortest first, in steps of one percent: for a plot or a file.
    pub fn buckets(&self) -> Vec<(u64, u64)> {
        let Ok(mut coarse) = Histogram::<u64>::new_with_bounds(LOWEST, LONGEST, 2) else { return Vec::new() };
        for value in self.0.iter_recorded() {
            coarse.saturating_record_n(value.value_iterated_to(), value.count_at_value());
        }
        coarse.iter_recorded().map(|value| (value.value_iterated_to(), value.count_at_value())).collect()
    }

    /// Adds all durations of `other`.
    pub fn add(&mut self, other: &Self) {
        for value in other.0.iter_recorded() {
            self.0.saturating_record_n(value.value_iterated_to(), value.count_at_value());
        }
    }

    /// Mean of the durations, us; 0 when nothing was recorded.
    pub fn mean_us(&self) -> f64 {
        self.0.mean() / 1e3
    }

    /// The figures so far; all 0 when nothing was recorded.
    pub fn percentiles(&self) -> Percentiles {
        if self.0.is_empty() {
            return Percentiles::default();
        }
        let at = |quantile| self.0.value_at_quantile(quantile) as f64 / 1e3;
        Percentiles {
            count: self.0.len(),
            p50_us: at(0.5),
            p90_us: at(0.9),
            p99_us: at(0.99),
            p999_us: at(0.999),
            max_us: self.0.max() as f64 / 1e3,
        }
    }
}

impl Default for Latency {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    #[test]
    fn percentiles_are_within_a_thousandth() {
        let mut latency = Latency::new();
        (1..=1000).for_each(|n| latency.record(Duration::from_micros(n)));
        let figures = latency.percentiles();
        assert_eq!(figures.count, 1000);
        assert!((figures.p50_us - 500.0).abs() <= 1.0, "{figures:?}");
        assert!((figures.p90_us - 900.0).abs() <= 1.0 && (figures.p999_us - 999.0).abs() <= 2.0, "{figures:?}");
        assert!((figures.p99_us - 990.0).abs() <= 2.0, "{figures:?}");
        assert!((figures.max_us - 1000.0).abs() <= 2.0, "{figures:?}");
    }

    #[test]
    fn a_percentile_is_told_when_ten_durations_lie_beyond_it() {
        let of = |count| Percentiles { count, ..Percentiles::default() };
        assert_eq!([of(99).p90(), of(999).p99(), of(9_999).p999()], [None; 3]);
        assert_eq!([of(100).p90(), of(1_000).p99(), of(10_000).p999()], [Some(0.0); 3]);
    }

    #[test]
    fn buckets_hold_every_duration_once() {
        let mut latency = Latency::new();
        (1..=1000).for_each(|n| latency.record(Duration::from_micros(n)));
        let buckets = latency.buckets();
        assert_eq!(buckets.iter().map(|(_, count)| count).sum::<u64>(), 1000);
        let mut sum = latency.clone();
        sum.add(&latency);
        assert_eq!(sum.percentiles().count, 2000);
        assert!((sum.mean_us() - 500.5).abs() < 1.0, "{}", sum.mean_us());
        assert!(buckets.len() < 600 && buckets.windows(2).all(|pair| pair[0].0 < pair[1].0), "{}", buckets.len());
    }

    #[test]
    fn nothing_recorded_gives_zeros_and_long_ones_count_as_a_minute() {
        let mut latency = Latency::new();
        assert_eq!(latency.percentiles(), Percentiles::default());
        latency.record(Duration::from_secs(3600));
        assert!((latency.percentiles().max_us / 60e6 - 1.0).abs() < 2e-3);
    }

    proptest! {
        #[test]
        fn percentiles_are_those_of_the_sorted_durations(mut durations in vec(1u64..100_000_000, 1..3_000)) {
            let mut latency = Latency::new();
            durations.iter().for_each(|duration| latency.record_ns(*duration));
            durations.sort_unstable();
            let figures = latency.percentiles();
            // The smallest duration that at least this share of all is no longer than.
            let sorted = |share: f64| {
                let rank = (share * durations.len() as f64).ceil() as usize;
                durations[rank.clamp(1, durations.len()) - 1] as f64 / 1e3
            };
            let pairs = [
                (figures.p50_us, sorted(0.5)),
                (figures.p90_us, sorted(0.9)),
                (figures.p99_us, sorted(0.99)),
                (figures.p999_us, sorted(0.999)),
                (figures.max_us, sorted(1.0)),
            ];
            prop_assert_eq!(figures.count, durations.len() as u64);
            for (found, exact) in pairs {
                prop_assert!((found / exact - 1.0).abs() <= 1e-3, "{} instead of {}", found, exact);
            }
        }
    }
}
