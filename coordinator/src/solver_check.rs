//! What `--check-solver` found: every QP of a run solved by the ladder and by Clarabel.

use serde::{Deserialize, Serialize};
use std::fmt;
use vodca::mpc::cross_check::Comparison;

/// An input that differs by more is a mistake of one of the two, m/s.
pub const TOLERANCE: f64 = 1e-6;

/// The findings over all robots and ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverCheck {
    /// QPs solved twice.
    pub problems: u64,
    /// Largest difference of an input between the two, m/s; of a plan that is not a number the largest
    /// finite one.
    pub largest_difference: f64,
    /// QPs with a plan from one and none, or another reason, from the other.
    pub verdicts_differ: u64,
    /// QPs that Clarabel did not finish: nothing to compare with.
    pub unchecked: u64,
}

impl From<Comparison> for SolverCheck {
    fn from(found: Comparison) -> Self {
        let Comparison { problems, largest_difference, verdicts_differ, unchecked } = found;
        // JSON has no infinity.
        Self { problems, largest_difference: largest_difference.min(f64::MAX), verdicts_differ, unchecked }
    }
}

impl SolverCheck {
    /// These findings and those of another run.
    pub fn with(self, other: Self) -> Self {
        Self {
            problems: self.problems + other.problems,
            largest_difference: self.largest_difference.max(other.largest_difference),
            verdicts_differ: self.verdicts_differ + other.verdicts_differ,
            unchecked: self.unchecked + other.unchecked,
        }
    }

    /// Whether both agree on every QP that could be compared.
    pub fn passed(&self) -> bool {
        self.largest_difference <= TOLERANCE && self.verdicts_differ == 0
    }
}

impl fmt::Display for SolverCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} QPs solved twice, largest |du| {:.1e} m/s", self.problems, self.largest_difference)?;
        write!(f, ", {} verdicts differ, {} unchecked", self.verdicts_differ, self.unchecked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_input_or_verdict_fails_and_can_be_written_as_json() {
        let good = Comparison { problems: 9, largest_difference: 1e-9, verdicts_differ: 0, unchecked: 1 };
        assert!(SolverCheck::from(good).passed());
        assert!(!SolverCheck::from(Comparison { verdicts_differ: 1, ..good }).passed());
        let broken = SolverCheck::from(Comparison { largest_difference: f64::INFINITY, ..good });
        assert!(!broken.passed());
        let back: SolverCheck = serde_json::from_str(&serde_json::to_string(&broken).unwrap()).unwrap();
        assert_eq!(back, broken);
    }
}
