//! What else the machine does: its load before and after a benchmark.

use std::fs;

/// A machine whose load was above this before a benchmark began is called busy.
const QUIET: f64 = 0.5;

/// The system's load averages, as `/proc/loadavg` has them; empty where it cannot be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadAverage(String);

impl LoadAverage {
    /// The present ones.
    pub fn now() -> Self {
        Self(fs::read_to_string("/proc/loadavg").unwrap_or_default().trim().to_owned())
    }

    /// Processes that ran or wanted to, a mean over about the last minute.
    pub fn last_minute(&self) -> Option<f64> {
        self.0.split_whitespace().next()?.parse().ok()
    }

    /// All figures, as text.
    pub fn text(&self) -> &str {
        if self.0.is_empty() { "unknown" } else { &self.0 }
    }

    /// Whether, before a benchmark, so much else was running that its figures are not those of the machine
    /// alone. An unknown load has to be taken for a busy machine.
    pub fn is_busy(&self) -> bool {
        self.last_minute().is_none_or(|load| load > QUIET)
    }

    /// What tables call a machine with this load before a benchmark.
    pub fn verdict(&self) -> &'static str {
        if self.is_busy() { "busy" } else { "quiet" }
    }
}

impl From<&str> for LoadAverage {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_is_busy_above_a_half_and_where_nobody_knows() {
        let verdicts = ["0.50 2.00 9.00 1/79 1", "0.51 0.00 0.00 1/79 1", "", "nonsense"]
            .map(|text| LoadAverage::from(text).verdict());
        assert_eq!(verdicts, ["quiet", "busy", "busy", "busy"]);
    }

    #[test]
    fn this_machine_has_a_load() {
        assert!(LoadAverage::now().last_minute().is_some_and(|load| load >= 0.0), "{:?}", LoadAverage::now());
    }
}
