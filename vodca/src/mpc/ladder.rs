//! The ladder of solvers: each level takes what the one before did not finish, and is counted.

use super::clarabel::Clarabel;
use super::closed_form::ClosedForm;
use super::cross_check::{Comparison, CrossCheck};
use super::problem::{Problem, QpSolver, Solution, SolveError};
use super::structured::Structured;
use crate::Position;
use crate::horizon::MAX_HORIZON;
use crate::step::Level;

/// How many QPs ended how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// The optimum without rows satisfied all of them.
    pub closed_form: u64,
    /// A plan of our structured solver.
    pub structured: u64,
    /// A plan of Clarabel.
    pub clarabel: u64,
    /// The hard rows admit no plan.
    pub infeasible: u64,
    /// Of all of these: the structured solver gave up and Clarabel was asked.
    pub given_up: u64,
    /// Nobody finished.
    pub unsolved: u64,
}

/// Closed form, then the structured solver, then Clarabel. Built once per robot; only Clarabel
/// allocates in a tick.
#[derive(Clone, Debug)]
pub struct Ladder {
    closed_form: ClosedForm,
    structured: Structured,
    clarabel: Clarabel,
    states: [Position; MAX_HORIZON],
    counts: Counts,
    check: Option<CrossCheck>,
}

impl Default for Ladder {
    fn default() -> Self {
        Self {
            closed_form: ClosedForm::new(1.0, 1.0, 1.0), // adapts to the first problem's weights
            structured: Structured::default(),
            clarabel: Clarabel::run_time(),
            states: [Position::zeros(); MAX_HORIZON],
            counts: Counts::default(),
            check: None,
        }
    }
}

impl Ladder {
    /// A ladder that solves every QP a second time with Clarabel and compares.
    pub fn checked() -> Self {
        Self { check: Some(CrossCheck::default()), ..Self::default() }
    }

    /// Writes the optimal inputs to `plan` and says which level found them. `Infeasible` and `GaveUp`
    /// are the verdict of the last level that was asked; `plan` then holds nothing of use.
    pub fn solve(&mut self, problem: &Problem<'_>, plan: &mut Solution) -> Result<Level, SolveError> {
        let outcome = self.climb(problem, plan);
        match outcome {
            Ok(Level::ClosedForm) => self.counts.closed_form += 1,
            Ok(Level::Structured) => self.counts.structured += 1,
            Ok(_) => self.counts.clarabel += 1,
            Err(SolveError::Infeasible) => self.counts.infeasible += 1,
            Err(SolveError::GaveUp { .. }) => self.counts.unsolved += 1,
        }
        if let Some(check) = &mut self.check {
            check.compare(problem, outcome.map(|_| &*plan));
        }
        outcome
    }

    fn climb(&mut self, problem: &Problem<'_>, plan: &mut Solution) -> Result<Level, SolveError> {
        if !problem.is_well_posed() {
            return Err(SolveError::GaveUp { iterations: 0 });
        }
        if self.closed_form.solve(problem, plan, &mut self.states) {
            return Ok(Level::ClosedForm);
        }
        match self.structured.solve(problem, plan) {
            Ok(_) => Ok(Level::Structured),
            Err(SolveError::Infeasible) => Err(SolveError::Infeasible),
            Err(SolveError::GaveUp { .. }) => {
                self.counts.given_up += 1;
                self.clarabel.solve(problem, plan).map(|_| Level::Clarabel)
            }
        }
    }

    /// Counters since this ladder was built.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// What comparing found, of a ladder built by [`Self::checked`].
    pub fn comparison(&self) -> Option<Comparison> {
        self.check.as_ref().map(CrossCheck::found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::problem::SlackPrice;
    use crate::mpc::sample::{Family, Sample};

    fn sample(family: Family, rows: usize) -> Sample {
        Sample::new(family, Horizon::new(20).unwrap(), rows, 3, 0)
    }

    #[test]
    fn each_level_takes_what_the_one_before_leaves() {
        let mut ladder = Ladder::checked();
        let mut plan = Solution::default();
        assert_eq!(ladder.solve(&sample(Family::Hard, 0).problem(), &mut plan), Ok(Level::ClosedForm));
        assert_eq!(ladder.solve(&sample(Family::Safe, 3).problem(), &mut plan), Ok(Level::Structured));
        // Without a quadratic price the structured solver has no compliance to work with.
        let soft = sample(Family::Soft, 3);
        let problem = Problem { slack: SlackPrice { linear: 1e5, quadratic: 0.0 }, ..soft.problem() };
        assert_eq!(ladder.solve(&problem, &mut plan), Ok(Level::Clarabel));
        let opposed = sample(Family::Opposed, 1);
        assert_eq!(ladder.solve(&opposed.problem(), &mut plan), Err(SolveError::Infeasible));
        let counts = Counts { closed_form: 1, structured: 1, clarabel: 1, infeasible: 1, given_up: 1, unsolved: 0 };
        assert_eq!(ladder.counts(), counts);
        let found = ladder.comparison().unwrap();
        assert_eq!((found.problems, found.verdicts_differ, found.unchecked), (4, 0, 0));
        assert!(found.largest_difference < 1e-9, "{found:?}");
    }

    #[test]
    fn numbers_that_are_none_are_refused_at_every_place() {
        let mut ladder = Ladder::default();
        let mut plan = Solution::default();
        let mut broken = sample(Family::Safe, 3);
        broken.rows[1].offset = f64::NAN;
        assert_eq!(ladder.solve(&broken.problem(), &mut plan), Err(SolveError::GaveUp { iterations: 0 }));
        broken.rows[1].offset = 0.0;
        broken.rows[1].step = 21;
        assert_eq!(ladder.solve(&broken.problem(), &mut plan), Err(SolveError::GaveUp { iterations: 0 }));
        broken.rows[1].step = 1;
        let problem = Problem { position: Position::new(0.0, f64::INFINITY), ..broken.problem() };
        assert_eq!(ladder.solve(&problem, &mut plan), Err(SolveError::GaveUp { iterations: 0 }));
        assert_eq!(ladder.counts().unsolved, 3);
    }

    #[test]
    fn weights_may_change_from_one_problem_to_the_next() {
        let sample = sample(Family::Safe, 3);
        let (mut used, mut plan, mut fresh) = (Ladder::default(), Solution::default(), Solution::default());
        for weight in [1.0, 10.0, 100.0] {
            let problem = Problem { input_weight: weight, ..sample.problem() };
            used.solve(&problem, &mut plan).unwrap();
            Ladder::default().solve(&problem, &mut fresh).unwrap();
            assert_eq!(plan.inputs, fresh.inputs);
        }
    }
}
