//! Compares what the ladder decides with Clarabel, QP by QP (`--check-solver`).

use super::clarabel::Clarabel;
use super::problem::{Problem, QpSolver, Solution, SolveError};

/// What comparing found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Comparison {
    /// QPs solved twice.
    pub problems: u64,
    /// Largest difference of an input between the two, over QPs that both solved, m/s.
    pub largest_difference: f64,
    /// QPs with a plan from one and none, or another reason, from the other.
    pub verdicts_differ: u64,
    /// QPs that Clarabel did not finish: nothing to compare with.
    pub unchecked: u64,
}

impl Comparison {
    /// Adds the findings of `other`, for instance another robot's.
    pub fn absorb(&mut self, other: &Self) {
        self.problems += other.problems;
        self.largest_difference = self.largest_difference.max(other.largest_difference);
        self.verdicts_differ += other.verdicts_differ;
        self.unchecked += other.unchecked;
    }
}

/// Solves QPs again and keeps the largest difference. Allocates in every tick.
#[derive(Clone, Debug)]
pub struct CrossCheck {
    clarabel: Clarabel,
    plan: Solution,
    found: Comparison,
}

impl Default for CrossCheck {
    fn default() -> Self {
        Self { clarabel: Clarabel::reference(), plan: Solution::default(), found: Comparison::default() }
    }
}

impl CrossCheck {
    /// Compares `outcome` with Clarabel's: `Some` plan, or why there is none.
    pub fn compare(&mut self, problem: &Problem<'_>, outcome: Result<&Solution, SolveError>) {
        self.found.problems += 1;
        let reference = self.clarabel.solve(problem, &mut self.plan);
        match (outcome, reference) {
            (Ok(plan), Ok(_)) => {
                let difference = plan.largest_difference(&self.plan);
                // Not a number counts as infinitely different, never as equal.
                let difference = if difference.is_nan() { f64::INFINITY } else { difference };
                self.found.largest_difference = self.found.largest_difference.max(difference);
            }
            (Err(SolveError::Infeasible), Err(SolveError::Infeasible)) => {}
            (_, Err(SolveError::GaveUp { .. })) => self.found.unchecked += 1,
            _ => self.found.verdicts_differ += 1,
        }
    }

    /// What was found since this was built.
    pub fn found(&self) -> Comparison {
        self.found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::sample::{Family, Sample};
    use crate::mpc::structured::Structured;

    fn solved(sample: &Sample) -> Solution {
        let mut plan = Solution::default();
        Structured::default().solve(&sample.problem(), &mut plan).unwrap();
        plan
    }

    #[test]
    fn a_right_plan_differs_by_rounding_and_a_wrong_one_by_its_error() {
        let sample = Sample::new(Family::Safe, Horizon::new(20).unwrap(), 3, 1, 1);
        let mut check = CrossCheck::default();
        let mut plan = solved(&sample);
        check.compare(&sample.problem(), Ok(&plan));
        assert!(check.found().largest_difference < 1e-9, "{:?}", check.found());
        plan.inputs[4].y += 0.01;
        check.compare(&sample.problem(), Ok(&plan));
        assert!((check.found().largest_difference - 0.01).abs() < 1e-9, "{:?}", check.found());
        plan.inputs[4].y = f64::NAN;
        check.compare(&sample.problem(), Ok(&plan));
        assert_eq!(check.found().largest_difference, f64::INFINITY);
        assert_eq!((check.found().problems, check.found().verdicts_differ), (3, 0));
    }

    #[test]
    fn a_wrong_verdict_is_counted() {
        let feasible = Sample::new(Family::Soft, Horizon::new(5).unwrap(), 3, 1, 1);
        let infeasible = Sample::new(Family::Opposed, Horizon::new(5).unwrap(), 1, 1, 1);
        let mut check = CrossCheck::default();
        check.compare(&infeasible.problem(), Err(SolveError::Infeasible));
        assert_eq!(check.found().verdicts_differ, 0);
        check.compare(&feasible.problem(), Err(SolveError::Infeasible));
        check.compare(&infeasible.problem(), Ok(&Solution::default()));
        check.compare(&feasible.problem(), Err(SolveError::GaveUp { iterations: 1 }));
        assert_eq!(check.found().verdicts_differ, 3);
        let mut sum = check.found();
        sum.absorb(&check.found());
        assert_eq!((sum.problems, sum.verdicts_differ), (8, 6));
    }
}
