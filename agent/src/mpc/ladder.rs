//! The ladder of solvers: each level takes what the one before did not finish, and is counted.

use super::clarabel::Clarabel;
use super::closed_form::ClosedForm;
use super::problem::{Plan, Problem, QpSolver, SolveError};
use super::structured::Structured;
use shared::Position;
use shared::horizon::MAX_HORIZON;
use shared::step::Level;

/// How many QPs ended at which level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// The optimum without rows satisfied all of them.
    pub closed_form: u64,
    /// Our structured solver finished, with a plan or the verdict infeasible.
    pub structured: u64,
    /// Clarabel finished, with a plan or the verdict infeasible.
    pub clarabel: u64,
    /// Nobody finished.
    pub unsolved: u64,
    /// Of all of them: infeasible.
    pub infeasible: u64,
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
}

impl Default for Ladder {
    fn default() -> Self {
        Self {
            closed_form: ClosedForm::new(1.0, 1.0, 1.0), // adapts to the first problem's weights
            structured: Structured::default(),
            clarabel: Clarabel::run_time(),
            states: [Position::zeros(); MAX_HORIZON],
            counts: Counts::default(),
        }
    }
}

impl Ladder {
    /// Writes the optimal inputs to `plan` and says which level found them.
    pub fn solve(&mut self, problem: &Problem<'_>, plan: &mut Plan) -> Result<Level, SolveError> {
        if !problem.is_well_posed() {
            self.counts.unsolved += 1;
            return Err(SolveError::GaveUp { iterations: 0 });
        }
        if self.closed_form.solve(problem, plan, &mut self.states) {
            self.counts.closed_form += 1;
            return Ok(Level::ClosedForm);
        }
        match self.structured.solve(problem, plan) {
            Ok(_) => {
                self.counts.structured += 1;
                return Ok(Level::Structured);
            }
            Err(SolveError::Infeasible) => {
                self.counts.structured += 1;
                self.counts.infeasible += 1;
                return Err(SolveError::Infeasible);
            }
            Err(SolveError::GaveUp { .. }) => {}
        }
        match self.clarabel.solve(problem, plan) {
            Ok(_) => {
                self.counts.clarabel += 1;
                Ok(Level::Clarabel)
            }
            Err(SolveError::Infeasible) => {
                self.counts.clarabel += 1;
                self.counts.infeasible += 1;
                Err(SolveError::Infeasible)
            }
            Err(error) => {
                self.counts.unsolved += 1;
                Err(error)
            }
        }
    }

    /// Counters since this ladder was built.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}
