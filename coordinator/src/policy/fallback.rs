//! What robots plan with while no answer comes: their last horizons for a bounded number of ticks, then
//! the default.

use super::Source;
use vodca::horizon::Horizon;

/// Bridges missing answers.
#[derive(Clone, Debug)]
pub(super) struct Bridge {
    horizons: Vec<Horizon>,
    default: Horizon,
    hold: u64,
    /// Ticks since the newest answer; `None`: there never was one.
    age: Option<u64>,
}

impl Bridge {
    /// Before the first answer everything is `default`.
    pub(super) fn new(robots: usize, hold: u64, default: Horizon) -> Self {
        Self { horizons: vec![default; robots], default, hold, age: None }
    }

    /// Takes what came for this tick and says what is used.
    pub(super) fn take(&mut self, answer: Option<Vec<Horizon>>) -> Source {
        if let Some(horizons) = answer {
            self.horizons = horizons;
            self.age = Some(0);
            return Source::Policy;
        }
        self.age = self.age.map(|age| age + 1);
        match self.age {
            Some(age) if age <= self.hold => Source::Held,
            _ => {
                self.horizons.fill(self.default);
                Source::Default
            }
        }
    }

    /// The horizons of this tick, by robot.
    pub(super) fn horizons(&self) -> &[Horizon] {
        &self.horizons
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_answer_is_held_for_the_bounded_time_and_then_the_default_is_used() {
        let horizon = |steps| Horizon::new(steps).unwrap();
        let mut bridge = Bridge::new(1, 2, horizon(20));
        assert_eq!((bridge.take(None), bridge.horizons()[0]), (Source::Default, horizon(20)));
        assert_eq!((bridge.take(Some(vec![horizon(7)])), bridge.horizons()[0]), (Source::Policy, horizon(7)));
        assert_eq!((bridge.take(None), bridge.horizons()[0]), (Source::Held, horizon(7)));
        assert_eq!((bridge.take(None), bridge.horizons()[0]), (Source::Held, horizon(7)));
        assert_eq!((bridge.take(None), bridge.horizons()[0]), (Source::Default, horizon(20)));
        assert_eq!((bridge.take(None), bridge.horizons()[0]), (Source::Default, horizon(20)));
        assert_eq!((bridge.take(Some(vec![horizon(9)])), bridge.horizons()[0]), (Source::Policy, horizon(9)));
    }
}
