//! When the next tick begins.

use shared::os;

/// The pace of a run.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Length of a tick, ns; `None`: the next tick begins as soon as everybody has answered.
    period: Option<u64>,
    due: Option<u64>,
    /// Ticks that began late.
    overruns: Overruns,
}

/// Ticks that began after their time because the one before took too long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overruns {
    /// How many.
    pub count: u64,
    /// The most any was late, ns.
    pub worst_ns: u64,
}

/// Later than this counts as an overrun, ns: a sleeper is never woken on the dot.
const TOLERANCE: u64 = 2_000_000;

impl Clock {
    /// As fast as everybody answers.
    pub fn lock_step() -> Self {
        Self { period: None, due: None, overruns: Overruns::default() }
    }

    /// One tick every `sample_time` seconds; a tick that takes longer delays the next, and the ticks
    /// after it return to the original times.
    pub fn real_time(sample_time: f64) -> Self {
        Self { period: Some((sample_time * 1e9) as u64), due: None, overruns: Overruns::default() }
    }

    /// Nanoseconds until the next tick may begin, 0: now.
    pub fn remaining(&self) -> u64 {
        self.remaining_at(os::now_ns())
    }

    fn remaining_at(&self, now: u64) -> u64 {
        self.due.map_or(0, |due| due.saturating_sub(now))
    }

    /// The next tick begins at `now` (ns). Gives how late that is, ns.
    pub fn begin(&mut self, now: u64) -> u64 {
        let Some(period) = self.period else { return 0 };
        let due = self.due.unwrap_or(now);
        let late = now.saturating_sub(due);
        if late > TOLERANCE {
            self.overruns.count += 1;
            self.overruns.worst_ns = self.overruns.worst_ns.max(late);
        }
        // Times that have passed altogether are left out rather than made up for in a rush.
        self.due = Some(due + period * (1 + late / period.max(1)));
        late
    }

    /// Ticks that began late so far.
    pub fn overruns(&self) -> Overruns {
        self.overruns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lock_step_never_waits() {
        let mut clock = Clock::lock_step();
        assert_eq!((clock.begin(5), clock.remaining_at(5), clock.overruns()), (0, 0, Overruns::default()));
    }

    #[test]
    fn real_time_keeps_its_times_after_an_overrun() {
        let ms = 1_000_000;
        let mut clock = Clock::real_time(0.2);
        assert_eq!(clock.begin(1000 * ms), 0);
        assert_eq!(clock.remaining_at(1050 * ms), 150 * ms);
        assert_eq!(clock.begin(1230 * ms), 30 * ms); // due at 1200
        assert_eq!(clock.remaining_at(1230 * ms), 170 * ms); // 1400, not 1430
        assert_eq!(clock.begin(1950 * ms), 550 * ms); // due at 1400; 1600 and 1800 have passed
        assert_eq!(clock.remaining_at(1950 * ms), 50 * ms);
        assert_eq!(clock.overruns(), Overruns { count: 2, worst_ns: 550 * ms });
    }
}
