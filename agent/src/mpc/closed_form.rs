//! Level 1 of the ladder: the optimum without rows, in closed form, O(N), nothing allocated.
//!
//! Set-point targets (paper, section III-B): per axis, with e = x - x_d and S_0 = 2Q,
//! `K_j = h S_{j-1} / (2W + h^2 S_{j-1})`, `S_j = 2Q + S_{j-1} 2W / (2W + h^2 S_{j-1})`,
//! `u_l = clamp(-K_{N-l} e_l, -u_max, u_max)`. Clamping stays exact because the free inputs of a
//! scalar integrator drawn to one point shrink monotonically: once free, never saturated again.
//! Feasible references are their own optimum: their cost is zero.

use super::problem::{Plan, Problem, TargetKind};
use shared::horizon::MAX_HORIZON;
use shared::{Input, Position};

/// A row counts as satisfied down to this gap, m. Rounding of `x[l]` within 100 m stays below
/// 3.5e-13 (49 additions, each half a unit in the last place), so a plan that touches a row passes;
/// the plan of a QP with the row differs by at most about the gap divided by h.
pub const ROW_TOLERANCE: f64 = 1e-12;

/// The feedback gains of one set of weights; K_j depends on the steps to go `j`, not on N.
#[derive(Clone, Debug)]
pub struct ClosedForm {
    sample_time: f64,
    state_weight: f64,
    input_weight: f64,
    /// K_j at index j - 1, 1/s.
    gains: [f64; MAX_HORIZON],
}

impl ClosedForm {
    /// Gains of h, Q = q I and W = w I.
    pub fn new(sample_time: f64, state_weight: f64, input_weight: f64) -> Self {
        let mut gains = [0.0; MAX_HORIZON];
        let mut cost_to_go = 2.0 * state_weight;
        for gain in &mut gains {
            let curvature = 2.0 * input_weight + sample_time * sample_time * cost_to_go;
            *gain = sample_time * cost_to_go / curvature;
            cost_to_go = 2.0 * state_weight + cost_to_go * 2.0 * input_weight / curvature;
        }
        Self { sample_time, state_weight, input_weight, gains }
    }

    /// Writes the optimum without rows to `plan` and the states it leads to, `x[l + 1]` at index
    /// `l`, to `states`. Returns whether they satisfy every row: then the plan solves the whole QP,
    /// hard or soft.
    pub fn solve(&mut self, problem: &Problem<'_>, plan: &mut Plan, states: &mut [Position; MAX_HORIZON]) -> bool {
        if (self.sample_time, self.state_weight, self.input_weight)
            != (problem.sample_time, problem.state_weight, problem.input_weight)
        {
            *self = Self::new(problem.sample_time, problem.state_weight, problem.input_weight);
        }
        let steps = problem.horizon.steps();
        let (h, bound) = (problem.sample_time, problem.max_speed);
        let mut state = problem.position;
        for (l, next) in states.iter_mut().enumerate().take(steps) {
            let wish = match problem.target.kind {
                TargetKind::SetPoint => (problem.target.states[l] - state) * self.gains[steps - 1 - l],
                TargetKind::Feasible => problem.target.inputs[l],
            };
            let input = Input::new(wish.x.clamp(-bound, bound), wish.y.clamp(-bound, bound));
            state += input * h;
            plan.inputs[l] = input;
            *next = state;
        }
        plan.inputs[steps..].fill(Input::zeros());
        satisfies_rows(problem, states)
    }
}

/// Whether `states` (`x[l + 1]` at index `l`) satisfy every row to [`ROW_TOLERANCE`]. Not a number
/// satisfies nothing.
pub fn satisfies_rows(problem: &Problem<'_>, states: &[Position; MAX_HORIZON]) -> bool {
    problem.rows.iter().all(|row| row.gap(&states[row.step - 1]) >= -ROW_TOLERANCE)
}
