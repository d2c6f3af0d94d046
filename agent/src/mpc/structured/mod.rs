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
use super::problem::{Effort, Plan, Problem, QpSolver, SolveError, TargetKind};
use active::ActiveSet;
use equality::Equality;
use shared::Input;
use single_step::{Outcome, SingleStep};

/// Rows that fit without allocating in a tick.
const ROW_CAPACITY: usize = 512;
/// Equation systems solved before giving up; the 99.9th percentile of dense problems is below half.
const MAX_ITERATIONS: u32 = 200;
/// Relaxations within a block step.
const MAX_RELAXATIONS: u32 = 8;
/// After the n-th block step that fails in a row, 2^(n - 1) single steps follow; n up to this.
const MAX_FAILURES: u32 = 4;
/// Largest KKT residual of an answer, m/s and m.
const ACCEPTED_RESIDUAL: f64 = 1e-9;
/// Violations up to this, m/s, are not worth a single step: what block steps leave of them is
/// rounding, and the KKT check has the last word.
const SETTLED: f64 = 1e-10;
/// A single step that loses this share of the cost has lost its numbers.
const LOST_COST: f64 = 1e-6;
/// Share of the cost that a block step may lose to rounding.
const COST_ROUNDING: f64 = 1e-12;

/// The structured solver; allocates when built, and for more than 512 rows.
#[derive(Clone, Debug)]
pub struct Structured {
    equality: Equality,
    accepted: ActiveSet,
    trial: ActiveSet,
    single_step: SingleStep,
    pub stats: [u64; 4],
}

impl Default for Structured {
    fn default() -> Self {
        Self {
            equality: Equality::new(ROW_CAPACITY),
            accepted: ActiveSet::new(ROW_CAPACITY),
            trial: ActiveSet::new(ROW_CAPACITY),
            single_step: SingleStep::new(ROW_CAPACITY),
            stats: [0; 4],
        }
    }
}

impl Structured {
    /// Multipliers of the rows at the last plan, in the rows' order, per metre.
    pub fn multipliers(&self) -> &[f64] {
        &self.equality.prices
    }

    /// Solves, starting from the inputs of `guess` that touch their bounds (the closed form's).
    fn run(&mut self, problem: &Problem<'_>, guess: &Plan, iterations: &mut u32) -> Result<(), SolveError> {
        let too_many = |iterations: &u32| SolveError::GaveUp { iterations: *iterations };
        self.equality.reset(problem);
        self.accepted.reset(problem);
        if problem.target.kind == TargetKind::SetPoint {
            for l in 0..problem.horizon.steps() {
                for axis in 0..2 {
                    let input = guess.inputs[l][axis];
                    if input.abs() >= problem.max_speed {
                        self.accepted.bounds[l][axis] = if input > 0.0 { 1 } else { -1 };
                    }
                }
            }
        }
        // The first set only has to have multipliers of the right sign.
        loop {
            *iterations += 1;
            self.equality.solve(problem, &mut self.accepted).map_err(|_| too_many(iterations))?;
            if !self.accepted.drop_wrong(problem, &self.equality) {
                break;
            }
        }
        let mut cost = self.equality.cost(problem, &self.accepted);
        let (mut failures, mut singles) = (0u32, 0u32);
        loop {
            self.trial.copy_from(&self.accepted);
            let Some((worst, excess)) = self.trial.add_violated(problem, &self.equality) else { return Ok(()) };
            if singles == 0 {
                if let Some(next) = self.block_step(problem, cost, iterations)? {
                    std::mem::swap(&mut self.accepted, &mut self.trial);
                    self.stats[0] += 1;
                    cost = next;
                    failures = 0;
                    continue;
                }
                failures = (failures + 1).min(MAX_FAILURES);
                singles = 1 << (failures - 1);
                *iterations += 1;
                self.equality.solve(problem, &mut self.accepted).map_err(|_| too_many(iterations))?;
            }
            singles -= 1;
            self.stats[1] += 1;
            if excess <= SETTLED {
                return Ok(());
            }
            let outcome = self
                .single_step
                .run(problem, &mut self.equality, &mut self.accepted, worst, iterations, MAX_ITERATIONS)
                .map_err(|_| too_many(iterations))?;
            match outcome {
                Outcome::Added => {}
                Outcome::Infeasible => return Err(SolveError::Infeasible),
                Outcome::Stuck => return Err(too_many(iterations)),
            }
            self.equality.solve(problem, &mut self.accepted).map_err(|_| too_many(iterations))?;
            *iterations += 1;
            let next = self.equality.cost(problem, &self.accepted);
            if next < cost - LOST_COST * cost.abs() {
                return Err(too_many(iterations));
            }
            cost = next;
        }
    }

    /// Relaxes `trial` until its multipliers have the right signs. `Some`: its cost, not below
    /// `cost`.
    fn block_step(
        &mut self,
        problem: &Problem<'_>,
        cost: f64,
        iterations: &mut u32,
    ) -> Result<Option<f64>, SolveError> {
        for _ in 0..MAX_RELAXATIONS {
            *iterations += 1;
            if *iterations > MAX_ITERATIONS || self.equality.solve(problem, &mut self.trial).is_err() {
                return Err(SolveError::GaveUp { iterations: *iterations });
            }
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
    /// `plan` holds a guess on entry: the optimum without rows where the target is a set-point.
    fn solve(&mut self, problem: &Problem<'_>, plan: &mut Plan) -> Result<Effort, SolveError> {
        let soft = problem.rows.iter().any(|row| !row.hard);
        if !problem.is_well_posed() || (soft && problem.slack.quadratic <= 0.0) {
            return Err(SolveError::GaveUp { iterations: 0 });
        }
        let mut iterations = 0;
        self.run(problem, plan, &mut iterations)?;
        let (steps, bound) = (problem.horizon.steps(), problem.max_speed);
        for (input, exact) in plan.inputs[..steps].iter_mut().zip(&self.equality.chain.inputs) {
            *input = Input::new(exact.x.clamp(-bound, bound), exact.y.clamp(-bound, bound));
        }
        plan.inputs[steps..].fill(Input::zeros());
        let residual = kkt::residual(problem, plan, &self.equality.prices).largest();
        if residual <= ACCEPTED_RESIDUAL { Ok(Effort { iterations }) } else { Err(SolveError::GaveUp { iterations }) }
    }
}
