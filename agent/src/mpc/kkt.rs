//! Optimality of a plan, checked from the problem alone, whatever solver produced it.
//!
//! With multipliers `lambda_r >= 0` of the rows (price per metre), the derivative of the Lagrangian
//! by `u[l]` runs backwards along the chain: `p[N+1] = 0`,
//! `p[l] = p[l+1] + 2Q (x[l] - x_d[l]) - sum_{rows r at l} lambda_r normal_r`,
//! `g[l] = 2W (u[l] - u_d[l]) + h p[l+1]`. A plan is optimal if and only if
//! `u = clamp(u - g / 2W)` at every step and axis, and every row's gap fits its multiplier.

use super::problem::{Plan, Problem, Row, SlackPrice};
use shared::horizon::MAX_HORIZON;
use shared::{Input, Position};

/// How far a plan and its multipliers are from optimal; all zero at the optimum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Largest change of an input by one projected gradient step, m/s. Bounds count: an input
    /// outside them has at least its excess here.
    pub stationarity: f64,
    /// Largest distance of a row's gap from the set that its multiplier allows, m.
    pub rows: f64,
}

impl Residual {
    /// The larger part, in its own unit. Not a number stays not a number.
    pub fn largest(&self) -> f64 {
        worse(self.stationarity, self.rows)
    }
}

/// Residual of `plan` with one multiplier per row of `problem`, in the rows' order.
pub fn residual(problem: &Problem<'_>, plan: &Plan, multipliers: &[f64]) -> Residual {
    let mut states = [Position::zeros(); MAX_HORIZON];
    plan.roll_out(problem, &mut states);
    let mut pull = [Input::zeros(); MAX_HORIZON];
    let mut rows = 0.0;
    for (row, &multiplier) in problem.rows.iter().zip(multipliers) {
        pull[row.step - 1] += row.normal * multiplier;
        rows = worse(rows, row_residual(row, &problem.slack, row.gap(&states[row.step - 1]), multiplier, problem));
    }
    let curvature = 2.0 * problem.input_weight;
    let mut costate = Input::zeros();
    let mut stationarity = 0.0;
    for l in (0..problem.horizon.steps()).rev() {
        costate += (states[l] - problem.target.states[l]) * (2.0 * problem.state_weight) - pull[l];
        let gradient = (plan.inputs[l] - problem.target.inputs[l]) * curvature + costate * problem.sample_time;
        for axis in 0..2 {
            let input = plan.inputs[l][axis];
            let better = (input - gradient[axis] / curvature).clamp(-problem.max_speed, problem.max_speed);
            stationarity = worse(stationarity, (input - better).abs());
        }
    }
    Residual { stationarity, rows }
}

/// Distance of `gap` from what `multiplier` allows, m: a zero multiplier allows any gap >= 0, a
/// positive one only 0; a soft row's is at most the linear price until it is violated and then
/// grows with the violation. A small multiplier on an open row counts by the input it can move.
fn row_residual(row: &Row, price: &SlackPrice, gap: f64, multiplier: f64, problem: &Problem<'_>) -> f64 {
    let per_metre = problem.sample_time * problem.sample_time / (2.0 * problem.input_weight);
    let as_inactive = worse((-gap).max(0.0), multiplier.abs() * per_metre);
    if multiplier < 0.0 || multiplier.is_nan() || gap.is_nan() {
        return as_inactive + (multiplier + gap) * 0.0;
    }
    let allowed = if row.hard || multiplier <= price.linear {
        0.0
    } else if price.quadratic > 0.0 {
        -(multiplier - price.linear) / price.quadratic
    } else {
        // Without a quadratic price the multiplier is the linear price at every violation.
        return worse((multiplier - price.linear) * per_metre, gap.max(0.0));
    };
    (gap - allowed).abs().min(as_inactive)
}

/// The larger of two, keeping not-a-number.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
