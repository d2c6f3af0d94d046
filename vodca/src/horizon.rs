//! Prediction horizons and where they come from.

use crate::random::{self, Use};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The longest prediction horizon, N_i^max of the paper.
pub const MAX_HORIZON: usize = 49;

/// A prediction horizon N_i^k: 1..=49 steps, chosen anew for every robot and tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u64", into = "u64")]
pub struct Horizon(u8);

/// A horizon outside 1..=49.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("horizon {0} is outside 1..=49")]
pub struct HorizonError(pub u64);

impl Horizon {
    /// One step.
    pub const MIN: Horizon = Horizon(1);
    /// [`MAX_HORIZON`] steps.
    pub const MAX: Horizon = Horizon(MAX_HORIZON as u8);

    /// Checks `steps`.
    pub fn new(steps: u64) -> Result<Self, HorizonError> {
        if (1..=MAX_HORIZON as u64).contains(&steps) { Ok(Self(steps as u8)) } else { Err(HorizonError(steps)) }
    }

    /// The number of steps, 1..=49.
    pub fn steps(self) -> usize {
        self.0 as usize
    }

    /// Nearest horizon to `steps`.
    pub fn saturating(steps: i64) -> Self {
        Self(steps.clamp(1, MAX_HORIZON as i64) as u8)
    }

    /// Maps a raw policy output in [-1, 1] to a horizon: ceil(1 + (a + 1)/2 * 48), clipped.
    /// Only `a = -1` exactly gives 1; a non-finite action gives `None`.
    pub fn from_action(action: f64) -> Option<Self> {
        action.is_finite().then(|| Self::saturating((1.0 + (action + 1.0) * 24.0).ceil() as i64))
    }

    /// An action that gives this horizon, in the middle of all that do.
    pub fn action(self) -> f64 {
        if self == Self::MIN { -1.0 } else { (f64::from(self.0) - 1.5) / 24.0 - 1.0 }
    }

    /// The draw of `random:SEED` for one robot and tick: uniform over 1..=49.
    pub fn random(seed: u64, robot: usize, tick: u64) -> Self {
        let mut generator = random::stream(seed, Use::Horizon, robot as u64, tick);
        Self(1 + random::below(&mut generator, MAX_HORIZON as u64) as u8)
    }

    /// This horizon moved by a seeded draw from `-spread..=spread`, clipped to 1..=49.
    pub fn jittered(self, spread: u64, seed: u64, robot: usize, tick: u64) -> Self {
        if spread == 0 {
            return self;
        }
        let mut generator = random::stream(seed, Use::HorizonJitter, robot as u64, tick);
        let offset = random::below(&mut generator, 2 * spread + 1) as i64 - spread as i64;
        Self::saturating(i64::from(self.0) + offset)
    }
}

impl TryFrom<u64> for Horizon {
    type Error = HorizonError;
    fn try_from(steps: u64) -> Result<Self, HorizonError> {
        Self::new(steps)
    }
}

impl From<Horizon> for u64 {
    fn from(horizon: Horizon) -> u64 {
        u64::from(horizon.0)
    }
}

impl fmt::Display for Horizon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_horizon_has_an_action_that_gives_it() {
        for steps in 1..=49 {
            let horizon = Horizon::new(steps).unwrap();
            assert_eq!(Horizon::from_action(horizon.action()), Some(horizon));
            assert!((-1.0..=1.0).contains(&horizon.action()));
        }
    }

    #[test]
    fn actions_map_to_horizons_as_the_paper_rounds_them() {
        let horizon = |a: f64| Horizon::from_action(a).map(Horizon::steps);
        assert_eq!(horizon(-1.0), Some(1));
        assert_eq!(horizon(-0.9999), Some(2));
        assert_eq!(horizon(0.0), Some(25));
        assert_eq!(horizon(0.001), Some(26));
        assert_eq!(horizon(1.0), Some(49));
        assert_eq!(horizon(7.0), Some(49));
        assert_eq!(horizon(f64::NAN), None);
    }

    #[test]
    fn horizons_outside_the_range_are_refused() {
        assert_eq!(Horizon::new(0), Err(HorizonError(0)));
        assert_eq!(Horizon::new(50), Err(HorizonError(50)));
        assert_eq!(Horizon::new(49), Ok(Horizon::MAX));
    }

    #[test]
    fn jitter_stays_near_and_in_range() {
        for tick in 0..200 {
            let near = Horizon(20).jittered(2, 5, 0, tick).steps();
            assert!((18..=22).contains(&near));
            assert!(Horizon::MIN.jittered(2, 5, 0, tick).steps() <= 3);
        }
        assert_eq!(Horizon(20).jittered(0, 5, 0, 0), Horizon(20));
    }
}
