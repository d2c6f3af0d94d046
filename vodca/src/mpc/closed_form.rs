//! Level 1 of the ladder: the optimum without rows, in closed form, O(N), nothing allocated.
//!
//! Set-point targets (paper, section III-B): per axis, with e = x - x_d and S_0 = 2Q,
//! `K_j = h S_{j-1} / (2W + h^2 S_{j-1})`, `S_j = 2Q + S_{j-1} 2W / (2W + h^2 S_{j-1})`,
//! `u_l = clamp(-K_{N-l} e_l, -u_max, u_max)`. Clamping stays exact because the free inputs of a
//! scalar integrator drawn to one point shrink monotonically: once free, never saturated again.
//! Feasible references are their own optimum: their cost is zero.

use super::problem::{Problem, Solution, TargetKind};
use crate::horizon::MAX_HORIZON;
use crate::{Input, Position};

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
    pub fn solve(&mut self, problem: &Problem<'_>, plan: &mut Solution, states: &mut [Position; MAX_HORIZON]) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::problem::Row;
    use crate::mpc::sample::{Family, Sample};
    use crate::mpc::stacked::Stacked;

    fn solved(problem: &Problem<'_>) -> (Solution, bool) {
        let mut plan = Solution::default();
        let mut states = [Position::zeros(); MAX_HORIZON];
        let satisfied = ClosedForm::new(0.2, 5.0, 10.0).solve(problem, &mut plan, &mut states);
        (plan, satisfied)
    }

    #[test]
    fn gains_follow_the_recursion_by_hand() {
        let gains = ClosedForm::new(0.2, 5.0, 10.0).gains;
        // S_0 = 10: K_1 = 2 / 20.4; S_1 = 10 + 200 / 20.4.
        assert!((gains[0] - 2.0 / 20.4).abs() < 1e-15);
        let second = 10.0 + 200.0 / 20.4;
        assert!((gains[1] - 0.2 * second / (20.0 + 0.04 * second)).abs() < 1e-15);
    }

    #[test]
    fn without_active_bounds_it_solves_the_stacked_normal_equations() {
        for n in [1, 7, 20, 49] {
            let sample = Sample::new(Family::Hard, Horizon::new(n).unwrap(), 0, 1, n);
            let problem = Problem { max_speed: 1e3, ..sample.problem() };
            let dense = Stacked::new(&problem);
            let exact = dense.hessian.cholesky().unwrap().solve(&-dense.gradient);
            let (plan, satisfied) = solved(&problem);
            assert!(satisfied);
            for l in 0..n as usize {
                assert!((plan.inputs[l].x - exact[2 * l]).abs() < 1e-11);
                assert!((plan.inputs[l].y - exact[2 * l + 1]).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn rows_are_judged_at_their_own_step() {
        let sample = Sample::new(Family::Hard, Horizon::new(10).unwrap(), 0, 1, 0);
        let problem = sample.problem();
        let (plan, _) = solved(&problem);
        let mut states = [Position::zeros(); MAX_HORIZON];
        plan.roll_out(&problem, &mut states);
        let normal = Position::new(0.6, 0.8);
        for (room, expected) in [(1e-3, true), (0.0, true), (-1e-9, false)] {
            let row = Row { step: 4, normal, offset: normal.dot(&states[3]) - room, hard: false };
            assert_eq!(solved(&Problem { rows: &[row], ..problem }).1, expected, "room {room}");
        }
        let undefined = Row { step: 4, normal, offset: f64::NAN, hard: false };
        assert!(!solved(&Problem { rows: &[undefined], ..problem }).1);
    }
}
