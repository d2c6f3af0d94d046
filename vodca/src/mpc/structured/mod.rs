//! Level 2 of the ladder: our own solver for this QP, exact, O(N) per iteration.
//!
//! A dual active-set method. The accepted active set always has multipliers of the right sign, so
//! its cost is a lower bound of the optimum, and every accepted step raises it: no set returns.
//! - Block step: add everything the solution violates, then relax what gets a wrong multiplier
//!   until none is left; accepted if the cost did not fall.
//! - Single step (Goldfarb and Idnani): where a block step fails, add one constraint exactly; it
//!   also detects infeasibility, with a proof that is checked.
//!
//! Soft rows are tight up to their linear price and have slack beyond it. Every answer passes the
//! KKT check of [`super::kkt`] or counts as given up.

mod active;
mod chain;
mod equality;
mod single_step;
mod small_factor;

use super::kkt;
use super::problem::{Effort, Problem, QpSolver, Solution, SolveError, TargetKind};
use crate::Input;
use active::ActiveSet;
use equality::{Budget, Equality};
use single_step::SingleStep;

/// Rows that fit without allocating in a tick.
const ROW_CAPACITY: usize = 512;
/// Equation systems solved before giving up. Random problems with 10 rows need 120 at most.
const MAX_ITERATIONS: u32 = 200;
/// Relaxations within a block step.
const MAX_RELAXATIONS: u32 = 8;
/// After the n-th block step that fails in a row, 2^(n - 1) single steps follow; n up to this.
const MAX_FAILURES: u32 = 4;
/// Violations up to this, m/s, are not worth a single step: what block steps leave of them is
/// rounding, and the KKT check has the last word.
const SETTLED: f64 = 1e-10;
/// A single step that loses this share of the cost has lost its numbers.
const LOST_COST: f64 = 1e-6;
/// Share of the cost that a block step may lose to rounding.
const COST_ROUNDING: f64 = 1e-12;
/// Largest KKT residual of an answer, m/s and m.
const ACCEPTED_RESIDUAL: f64 = 1e-9;

/// The structured solver; allocates when built, and for more than 512 rows.
#[derive(Clone, Debug)]
pub struct Structured {
    equality: Equality,
    accepted: ActiveSet,
    trial: ActiveSet,
    single_step: SingleStep,
}

impl Default for Structured {
    fn default() -> Self {
        Self {
            equality: Equality::new(ROW_CAPACITY),
            accepted: ActiveSet::new(ROW_CAPACITY),
            trial: ActiveSet::new(ROW_CAPACITY),
            single_step: SingleStep::new(ROW_CAPACITY),
        }
    }
}

impl Structured {
    /// Multipliers of the rows at the last plan, in the rows' order, per metre.
    pub fn multipliers(&self) -> &[f64] {
        &self.equality.prices
    }

    /// Leaves the optimum in `equality`.
    fn run(&mut self, problem: &Problem<'_>, guess: &Solution, budget: &mut Budget) -> Result<(), SolveError> {
        self.start(problem, guess, budget)?;
        let mut cost = self.equality.cost(problem, &self.accepted);
        let (mut failures, mut singles) = (0, 0);
        loop {
            self.trial.copy_from(&self.accepted);
            let Some((worst, excess)) = self.trial.add_violated(problem, &self.equality) else { return Ok(()) };
            if singles == 0 {
                if let Some(next) = self.block_step(problem, cost, budget)? {
                    std::mem::swap(&mut self.accepted, &mut self.trial);
                    (cost, failures) = (next, 0);
                    continue;
                }
                failures = (failures + 1).min(MAX_FAILURES);
                singles = 1 << (failures - 1);
                self.equality.solve(problem, &mut self.accepted, budget)?;
            }
            if excess <= SETTLED {
                return Ok(());
            }
            singles -= 1;
            self.single_step.run(problem, &mut self.equality, &mut self.accepted, worst, budget)?;
            self.equality.solve(problem, &mut self.accepted, budget)?;
            let next = self.equality.cost(problem, &self.accepted);
            if next < cost - LOST_COST * cost {
                return Err(budget.gave_up());
            }
            cost = next;
        }
    }

    /// The first accepted set: the bounds that `guess` touches, less those with a wrong multiplier.
    fn start(&mut self, problem: &Problem<'_>, guess: &Solution, budget: &mut Budget) -> Result<(), SolveError> {
        self.equality.reset(problem);
        self.accepted.reset(problem);
        // A feasible reference lies on its bounds without being held there.
        if problem.target.kind == TargetKind::SetPoint {
            self.accepted.touch_bounds(problem, guess);
        }
        loop {
            self.equality.solve(problem, &mut self.accepted, budget)?;
            if !self.accepted.drop_wrong(problem, &self.equality) {
                return Ok(());
            }
        }
    }

    /// Relaxes `trial` until its multipliers have the right signs. `Some`: its cost, not below
    /// `cost`.
    fn block_step(&mut self, problem: &Problem<'_>, cost: f64, budget: &mut Budget) -> Result<Option<f64>, SolveError> {
        for _ in 0..MAX_RELAXATIONS {
            self.equality.solve(problem, &mut self.trial, budget)?;
            if !self.trial.drop_wrong(problem, &self.equality) {
                let next = self.equality.cost(problem, &self.trial);
                let rises = next >= cost - COST_ROUNDING * cost && self.trial != self.accepted;
                return Ok(rises.then_some(next));
            }
        }
        Ok(None)
    }
}

impl QpSolver for Structured {
    /// On entry `plan` may hold the optimum without rows, from which the solver starts; any other
    /// content costs time only. The iterations count systems of equations.
    fn solve(&mut self, problem: &Problem<'_>, plan: &mut Solution) -> Result<Effort, SolveError> {
        let soft = problem.rows.iter().any(|row| !row.hard);
        let mut budget = Budget { spent: 0, limit: MAX_ITERATIONS };
        if !problem.is_well_posed() || (soft && problem.slack.quadratic <= 0.0) {
            return Err(budget.gave_up());
        }
        self.run(problem, plan, &mut budget)?;
        let (steps, bound) = (problem.horizon.steps(), problem.max_speed);
        for (input, exact) in plan.inputs[..steps].iter_mut().zip(&self.equality.chain.inputs) {
            *input = Input::new(exact.x.clamp(-bound, bound), exact.y.clamp(-bound, bound));
        }
        plan.inputs[steps..].fill(Input::zeros());
        let residual = kkt::residual(problem, plan, &self.equality.prices).largest();
        if residual <= ACCEPTED_RESIDUAL { Ok(Effort { iterations: budget.spent }) } else { Err(budget.gave_up()) }
    }
}
