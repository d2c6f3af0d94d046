//! The QP with a given active set as equations: the chains give inputs for any forces, a small
//! dense system gives the forces (multipliers) that close the gaps of the active rows.

use super::super::problem::{Problem, SolveError};
use super::active::{ActiveSet, RowState};
use super::chain::{Chain, Track};
use super::small_factor::{MAX_ACTIVE, SmallFactor};
use crate::horizon::MAX_HORIZON;
use nalgebra::Vector2;

/// Pivots below this share of what a row could have with q = 0 and free inputs count as zero.
pub(super) const DEPENDENT: f64 = 1e-11;

/// Solver and last solution of an equality-constrained problem.
#[derive(Clone, Debug)]
pub(super) struct Equality {
    pub(super) chain: Chain,
    /// Multiplier per row of the problem; 0 for open rows.
    pub(super) prices: Vec<f64>,
    /// Indices of the rows in the equations.
    pub(super) members: Vec<usize>,
    /// Factor of their matrix.
    pub(super) factor: SmallFactor,
    right: Vec<f64>,
    /// 2Q x_d at every step.
    draw: Track,
    source: Track,
    drift: Track,
}

/// Equation systems that may still be solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    pub(super) spent: u32,
    pub(super) limit: u32,
}

impl Budget {
    /// Counts one system.
    pub(super) fn spend(&mut self) -> Result<(), SolveError> {
        if self.spent >= self.limit {
            return Err(self.gave_up());
        }
        self.spent += 1;
        Ok(())
    }

    pub(super) fn gave_up(self) -> SolveError {
        SolveError::GaveUp { iterations: self.spent }
    }
}

impl Equality {
    pub(super) fn new(row_capacity: usize) -> Self {
        let zero = [Vector2::zeros(); MAX_HORIZON];
        Self {
            chain: Chain::new(),
            prices: Vec::with_capacity(row_capacity),
            members: Vec::with_capacity(MAX_ACTIVE),
            factor: SmallFactor::new(),
            right: Vec::with_capacity(MAX_ACTIVE),
            draw: zero,
            source: zero,
            drift: zero,
        }
    }

    pub(super) fn reset(&mut self, problem: &Problem<'_>) {
        self.chain.reset(problem);
        self.prices.clear();
        self.prices.resize(problem.rows.len(), 0.0);
        for l in 0..problem.horizon.steps() {
            self.draw[l] = problem.target.states[l] * (2.0 * problem.state_weight);
        }
    }

    /// Solves with the bounds and rows of `set` as equations. A row that depends on the others is
    /// made open in `set`. Fails where the budget is spent or the rows are more than there is room for.
    pub(super) fn solve(
        &mut self,
        problem: &Problem<'_>,
        set: &mut ActiveSet,
        budget: &mut Budget,
    ) -> Result<(), SolveError> {
        let steps = problem.horizon.steps();
        for l in 0..steps {
            self.source[l] = self.draw[l];
            self.drift[l] = problem.target.inputs[l];
            for axis in 0..2 {
                match set.bounds[l][axis] {
                    0 => {}
                    sign => self.drift[l][axis] = f64::from(sign) * problem.max_speed,
                }
            }
        }
        self.prices.fill(0.0);
        self.assemble(problem, set, budget)?;
        self.chain.solve(problem.position, &self.source, &self.drift);
        if self.members.is_empty() {
            return Ok(());
        }
        self.right.clear();
        for &index in &self.members {
            let row = &problem.rows[index];
            let offset = if set.rows[index] == RowState::Violated {
                problem.slack.linear / problem.slack.quadratic
            } else {
                0.0
            };
            self.right.push(offset - row.gap(&self.chain.states[row.step - 1]));
        }
        self.factor.solve(&mut self.right);
        for (&index, &price) in self.members.iter().zip(&self.right) {
            let row = &problem.rows[index];
            self.prices[index] = price;
            self.source[row.step - 1] += row.normal * price;
        }
        self.chain.solve(problem.position, &self.source, &self.drift);
        Ok(())
    }

    /// Factors the chains and the rows' matrix for `set`; a dependent row is made open in `set`.
    pub(super) fn assemble(
        &mut self,
        problem: &Problem<'_>,
        set: &mut ActiveSet,
        budget: &mut Budget,
    ) -> Result<(), SolveError> {
        budget.spend()?;
        self.chain.factor(&set.bounds);
        self.members.clear();
        self.factor.clear();
        for &index in &set.order {
            let state = &mut set.rows[index];
            if self.members.len() == MAX_ACTIVE {
                return Err(budget.gave_up());
            }
            let row = &problem.rows[index];
            let entries = self.factor.next_row();
            for (entry, &other) in entries.iter_mut().zip(&self.members) {
                *entry = coupling(&self.chain, problem, index, other);
            }
            let slack = if *state == RowState::Violated { 1.0 / problem.slack.quadratic } else { 0.0 };
            if let Some(diagonal) = entries.last_mut() {
                *diagonal = coupling(&self.chain, problem, index, index) + slack;
            }
            if self.factor.push(DEPENDENT * freest(problem, row.step)) {
                self.members.push(index);
            } else {
                *state = RowState::Open;
            }
        }
        if self.members.len() < set.order.len() {
            set.forget_open();
        }
        Ok(())
    }

    /// Cost of the last solution, slack of `set`'s violated rows included.
    pub(super) fn cost(&self, problem: &Problem<'_>, set: &ActiveSet) -> f64 {
        let mut state_cost = 0.0;
        let mut input_cost = 0.0;
        for l in 0..problem.horizon.steps() {
            state_cost += (self.chain.states[l] - problem.target.states[l]).norm_squared();
            input_cost += (self.chain.inputs[l] - problem.target.inputs[l]).norm_squared();
        }
        let mut cost = problem.state_weight * state_cost + problem.input_weight * input_cost;
        for &index in &set.order {
            if set.rows[index] == RowState::Violated {
                let row = &problem.rows[index];
                let excess = -row.gap(&self.chain.states[row.step - 1]);
                cost += excess * (problem.slack.linear + 0.5 * problem.slack.quadratic * excess);
            }
        }
        cost
    }
}

/// Metres by which a unit force along the normal of row `a` opens row `b`.
pub(super) fn coupling(chain: &Chain, problem: &Problem<'_>, a: usize, b: usize) -> f64 {
    let (a, b) = (&problem.rows[a], &problem.rows[b]);
    chain.influence(a.step, b.step).dot(&a.normal.component_mul(&b.normal))
}

/// The influence of a force at `step` on itself with free inputs and no state cost: h^2 step / 2W.
pub(super) fn freest(problem: &Problem<'_>, step: usize) -> f64 {
    problem.sample_time * problem.sample_time * step as f64 / (2.0 * problem.input_weight)
}
