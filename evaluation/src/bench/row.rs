//! What was measured: distributions and single figures.

use super::load::LoadAverage;
use coordinator::latency::Latency;

/// Part of the rows that say where the time of a tick goes.
pub const TICK_PARTS: &str = "tick parts";

/// What a distribution is compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// What: a floor of the system, which waits in the same way (spinning or sleeping), or a peer.
    pub name: String,
    /// Its p50, us, measured in turns with the row.
    pub p50_us: f64,
}

/// A distribution of durations.
#[derive(Clone, Debug)]
pub struct Row {
    /// The benchmark's part, `hop` for instance.
    pub part: &'static str,
    /// What was measured.
    pub name: String,
    /// Number of robots, or the horizon, where it has one.
    pub size: Option<usize>,
    /// The durations.
    pub latency: Latency,
    /// What they are compared with.
    pub floor: Option<Floor>,
}

/// A single number.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The benchmark's part.
    pub part: &'static str,
    /// What it is.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// All that was measured.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Distributions, in the order of measurement.
    pub rows: Vec<Row>,
    /// Single numbers.
    pub figures: Vec<Figure>,
    /// The machine's load before anything was measured.
    pub load_before: LoadAverage,
    /// And when all was done: the benchmark's own processes are in it.
    pub load_after: LoadAverage,
    /// How long it took, s.
    pub seconds: f64,
}

impl Row {
    /// A distribution.
    pub fn new(part: &'static str, name: impl Into<String>, size: Option<usize>, latency: Latency) -> Self {
        Self { part, name: name.into(), size, latency, floor: None }
    }

    /// The same, compared with `name`, whose distribution is `floor`.
    pub fn over(self, name: impl Into<String>, floor: &Latency) -> Self {
        let p50_us = floor.percentiles().p50_us;
        Self { floor: (p50_us > 0.0).then(|| Floor { name: name.into(), p50_us }), ..self }
    }

    /// The same, a floor itself.
    pub fn as_floor(self) -> Self {
        let (name, latency) = (self.name.clone(), self.latency.clone());
        self.over(name, &latency)
    }

    /// p50 over that of what it is compared with.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.latency.percentiles().p50_us / self.floor.as_ref()?.p50_us)
    }

    /// p50, p90, p99, p99.9 and the longest, us; `None`: too few samples to tell.
    pub fn told(&self) -> [Option<f64>; 5] {
        let figures = self.latency.percentiles();
        [Some(figures.p50_us), figures.p90(), figures.p99(), figures.p999(), Some(figures.max_us)]
    }
}

impl Results {
    /// Adds a distribution.
    pub fn row(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// Adds a number.
    pub fn figure(&mut self, part: &'static str, name: impl Into<String>, value: f64, unit: &'static str) {
        self.figures.push(Figure { part, name: name.into(), value, unit });
    }

    /// The parts that have rows, each once, in order.
    pub fn parts(&self) -> Vec<&'static str> {
        let mut parts = Vec::new();
        for row in &self.rows {
            if !parts.contains(&row.part) {
                parts.push(row.part);
            }
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(samples: u64) -> Row {
        let mut latency = Latency::new();
        (1..=samples).for_each(|n| latency.record_ns(n * 100));
        Row::new("hop", "futex", None, latency)
    }

    #[test]
    fn a_percentile_is_told_from_ten_samples_beyond_it_on() {
        let known = |samples| row(samples).told().map(|figure| figure.is_some());
        assert_eq!(known(99), [true, false, false, false, true]);
        assert_eq!(known(100), [true, true, false, false, true]);
        assert_eq!(known(999), [true, true, false, false, true]);
        assert_eq!(known(1_000), [true, true, true, false, true]);
        assert_eq!(known(9_999), [true, true, true, false, true]);
        assert_eq!(known(10_000), [true; 5]);
    }

    #[test]
    fn a_row_is_its_p50_over_that_of_its_floor_and_a_floor_is_one() {
        let (floor, twice) = (row(100), row(200));
        assert_eq!(floor.ratio(), None);
        let ratio = twice.over("futex", &floor.latency).ratio().unwrap();
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
        assert_eq!(floor.as_floor().ratio(), Some(1.0));
        assert_eq!(row(1).over("nothing", &Latency::new()).floor, None);
    }
}
