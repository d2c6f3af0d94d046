//! Which bounds and rows are active, and what a solution says about it.

use super::super::problem::{Problem, Solution};
use super::chain::Bounds;
use super::equality::Equality;
use super::small_factor::MAX_ACTIVE;
use crate::horizon::MAX_HORIZON;

/// A row in an active set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowState {
    /// Not active; multiplier 0.
    Open,
    /// Gap 0; multiplier between 0 and, if soft, the linear price.
    Tight,
    /// Soft with slack; multiplier at least the linear price.
    Violated,
}

/// Excess of an input beyond its bound that counts, m/s.
const INPUT_TOLERANCE: f64 = 1e-11;
/// Violation of a row that counts, m.
const GAP_TOLERANCE: f64 = 1e-12;
/// Wrong-signed multiplier that counts, as the change of an input, m/s, per unit of the largest.
const DUAL_TOLERANCE: f64 = 1e-12;

/// Rows that one block step adds at most: most of a crowd's rows are met once a few are.
const MAX_NEW_ROWS: usize = 16;

/// An active set.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ActiveSet {
    pub(super) bounds: Bounds,
    pub(super) rows: Vec<RowState>,
    /// Indices of the rows that are not open, in the order in which they became active: where rows
    /// depend on each other, the earlier ones stay.
    pub(super) order: Vec<usize>,
}

/// One constraint that a solution violates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Constraint {
    /// u[l] at `axis` beyond its bound at `sign`.
    Bound { l: usize, axis: usize, sign: i8 },
    /// The row of this index.
    Row(usize),
}

impl ActiveSet {
    pub(super) fn new(row_capacity: usize) -> Self {
        Self {
            bounds: [[0; 2]; MAX_HORIZON],
            rows: Vec::with_capacity(row_capacity),
            order: Vec::with_capacity(row_capacity),
        }
    }

    /// Nothing active, for the rows of `problem`.
    pub(super) fn reset(&mut self, problem: &Problem<'_>) {
        self.bounds = [[0; 2]; MAX_HORIZON];
        self.rows.clear();
        self.rows.resize(problem.rows.len(), RowState::Open);
        self.order.clear();
    }

    /// Copies `other` without allocating, given enough capacity.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.bounds = other.bounds;
        self.rows.clear();
        self.rows.extend_from_slice(&other.rows);
        self.order.clear();
        self.order.extend_from_slice(&other.order);
    }

    /// Adds the bounds that the inputs of `plan` touch.
    pub(super) fn touch_bounds(&mut self, problem: &Problem<'_>, plan: &Solution) {
        for (bounds, input) in self.bounds.iter_mut().zip(&plan.inputs[..problem.horizon.steps()]) {
            for axis in 0..2 {
                if input[axis].abs() >= problem.max_speed {
                    bounds[axis] = if input[axis] > 0.0 { 1 } else { -1 };
                }
            }
        }
    }

    /// Adds every constraint that the solution violates (of the rows, [`MAX_NEW_ROWS`] at most); returns the most violated one
    /// and by how much, m/s (rows: metres per sample time).
    pub(super) fn add_violated(&mut self, problem: &Problem<'_>, solution: &Equality) -> Option<(Constraint, f64)> {
        let mut worst = None;
        let mut most = 0.0;
        for l in 0..problem.horizon.steps() {
            for axis in 0..2 {
                let input = solution.chain.inputs[l][axis];
                let excess = input.abs() - problem.max_speed;
                if excess > INPUT_TOLERANCE && self.bounds[l][axis] == 0 {
                    let sign = if input > 0.0 { 1 } else { -1 };
                    self.bounds[l][axis] = sign;
                    if excess > most {
                        most = excess;
                        worst = Some(Constraint::Bound { l, axis, sign });
                    }
                }
            }
        }
        let full = MAX_ACTIVE.min(self.order.len() + MAX_NEW_ROWS);
        for (index, row) in problem.rows.iter().enumerate() {
            let excess = -row.gap(&solution.chain.states[row.step - 1]);
            if excess > GAP_TOLERANCE && self.rows[index] == RowState::Open {
                if self.order.len() < full {
                    self.rows[index] = RowState::Tight;
                    self.order.push(index);
                }
                if excess > most * problem.sample_time {
                    most = excess / problem.sample_time;
                    worst = Some(Constraint::Row(index));
                }
            }
        }
        worst.map(|constraint| (constraint, most))
    }

    /// Relaxes every constraint whose multiplier has the wrong sign, and moves soft rows to the
    /// side of the linear price that their multiplier is on. Returns whether anything changed.
    pub(super) fn drop_wrong(&mut self, problem: &Problem<'_>, solution: &Equality) -> bool {
        let mut changed = false;
        let curvature = 2.0 * problem.input_weight;
        let largest = solution.prices.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
        let small = DUAL_TOLERANCE * curvature * largest.max(curvature);
        for l in 0..problem.horizon.steps() {
            if self.bounds[l] == [0; 2] {
                continue;
            }
            let gradient = solution.chain.gradient(l, problem.target.inputs[l]);
            for axis in 0..2 {
                if f64::from(self.bounds[l][axis]) * gradient[axis] > small {
                    self.bounds[l][axis] = 0;
                    changed = true;
                }
            }
        }
        let linear = problem.slack.linear;
        for &index in &self.order {
            let price = solution.prices[index];
            let state = &mut self.rows[index];
            let right = match *state {
                _ if price < -small => RowState::Open,
                RowState::Tight if !problem.rows[index].hard && price > linear + small => RowState::Violated,
                RowState::Violated if price < linear - small => RowState::Tight,
                same => same,
            };
            changed |= right != *state;
            *state = right;
        }
        self.forget_open();
        changed
    }

    /// Makes `constraint`, which is not active, active.
    pub(super) fn add(&mut self, constraint: Constraint, row_state: RowState) {
        match constraint {
            Constraint::Bound { l, axis, sign } => self.bounds[l][axis] = sign,
            Constraint::Row(index) => {
                self.rows[index] = row_state;
                self.order.push(index);
            }
        }
    }

    /// Removes rows that were made open from the order.
    pub(super) fn forget_open(&mut self) {
        let rows = &self.rows;
        self.order.retain(|&index| rows[index] != RowState::Open);
    }
}
