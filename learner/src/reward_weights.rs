//! What of the paper's reward is learnt from.

use policy::reward::Terms;
use serde::{Deserialize, Serialize};

/// Weights of the paper's reward terms: 1 each, as printed, is the default; everything else is a deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RewardWeights {
    /// Of R_p.
    pub progress: f64,
    /// Of R_h.
    pub horizon: f64,
    /// Of R_c.
    pub collision: f64,
    /// Of R_term.
    pub arrival: f64,
    /// Of R_v.
    pub variance: f64,
    /// Taken off per robot and tick: 175 makes standing at the set-point worth nothing, so that values
    /// stay small. Ends of episodes by collision become attractive unless `collision` grows with it.
    pub baseline: f64,
    /// Taken off per metre driven by all robots: the paper's reward knows ticks, not metres.
    pub per_metre: f64,
}

impl Default for RewardWeights {
    fn default() -> Self {
        Self { progress: 1.0, horizon: 1.0, collision: 1.0, arrival: 1.0, variance: 1.0, baseline: 0.0, per_metre: 0.0 }
    }
}

impl RewardWeights {
    /// What is learnt from for a tick of `robots` robots with `terms`, in which they drove `metres`.
    pub fn reward(&self, terms: &Terms, robots: usize, metres: f64) -> f64 {
        self.progress * terms.progress - self.horizon * terms.horizon - self.collision * terms.collision
            + self.arrival * terms.arrival
            - self.variance * terms.variance
            - self.baseline * robots as f64
            - self.per_metre * metres
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_weights_give_the_paper_s_reward() {
        let terms = Terms { progress: 9.0, horizon: 2.0, collision: 4.0, arrival: 3.0, variance: 1.5 };
        let weights = RewardWeights::default();
        assert_eq!(weights.reward(&terms, 7, 2.0), terms.total());
        let other = RewardWeights { baseline: 10.0, per_metre: 3.0, variance: 0.0, ..weights };
        assert_eq!(other.reward(&terms, 7, 2.0), terms.total() + 1.5 - 70.0 - 6.0);
    }
}
