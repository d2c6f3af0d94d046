//! Optimality of a plan, checked from the problem alone, whatever solver produced it.
//!
//! With multipliers `lambda_r >= 0` of the rows (price per metre), the derivative of the Lagrangian
//! by `u[l]` runs backwards along the chain: `p[N+1] = 0`,
//! `p[l] = p[l+1] + 2Q (x[l] - x_d[l]) - sum_{rows r at l} lambda_r normal_r`,
//! `g[l] = 2W (u[l] - u_d[l]) + h p[l+1]`. A plan is optimal if and only if
//! `u = clamp(u - g / 2W)` at every step and axis, and every row's gap fits its multiplier.

use super::problem::{Problem, Row, SlackPrice, Solution};
use crate::horizon::MAX_HORIZON;
use crate::{Input, Position};

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
pub fn residual(problem: &Problem<'_>, plan: &Solution, multipliers: &[f64]) -> Residual {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::problem::QpSolver;
    use crate::mpc::sample::{Family, Sample};
    use crate::mpc::structured::Structured;

    fn optimum(sample: &Sample) -> (Solution, Vec<f64>) {
        let (mut solver, mut plan) = (Structured::default(), Solution::default());
        solver.solve(&sample.problem(), &mut plan).unwrap();
        (plan, solver.multipliers().to_vec())
    }

    #[test]
    fn an_error_of_an_input_shows_in_its_own_size() {
        for family in [Family::Soft, Family::Safe] {
            let sample = Sample::new(family, Horizon::new(20).unwrap(), 4, 1, 2);
            let (mut plan, multipliers) = optimum(&sample);
            assert!(residual(&sample.problem(), &plan, &multipliers).largest() < 1e-11);
            for error in [1e-8, 1e-4] {
                plan.inputs[3].x -= error;
                let found = residual(&sample.problem(), &plan, &multipliers).largest();
                assert!(found > 0.1 * error && found < 20.0 * error, "{family:?} {error}: {found}");
                plan.inputs[3].x += error;
            }
        }
    }

    #[test]
    fn wrong_multipliers_show() {
        let sample = Sample::new(Family::Soft, Horizon::new(20).unwrap(), 3, 1, 2);
        let (plan, multipliers) = optimum(&sample);
        let active = (0..3).max_by(|&a, &b| multipliers[a].total_cmp(&multipliers[b])).unwrap();
        let with = |value: f64| {
            let mut wrong = multipliers.clone();
            wrong[active] = value;
            residual(&sample.problem(), &plan, &wrong).largest()
        };
        assert!(with(0.0) > 1e-3 && with(multipliers[active] * 1.01) > 1e-5);
        assert!(with(-1.0) > 1e-4 && with(f64::NAN).is_nan());
    }

    #[test]
    fn each_kind_of_row_has_its_own_graph_of_gap_and_multiplier() {
        let sample = Sample::new(Family::Soft, Horizon::new(5).unwrap(), 1, 1, 0);
        let problem = sample.problem();
        let at = |hard: bool, gap: f64, multiplier: f64| {
            row_residual(&Row { hard, ..problem.rows[0] }, &problem.slack, gap, multiplier, &problem)
        };
        for hard in [false, true] {
            assert_eq!(at(hard, 0.3, 0.0), 0.0);
            assert_eq!(at(hard, 0.0, 40.0), 0.0);
            assert_eq!(at(hard, -0.3, 0.0), 0.3);
            assert!(at(hard, 0.3, 400.0) > 0.2);
            assert!(at(hard, f64::NAN, 0.0).is_nan());
        }
        // Beyond the linear price of 1e5 a soft row gives way by 1 mm per unit of 1e3 / m.
        assert_eq!(at(true, 0.0, 2e5), 0.0);
        assert!((at(false, 0.0, 1e5 + 2.0) - 2e-3).abs() < 1e-9);
        assert!(at(false, -2e-3, 1e5 + 2.0) < 1e-9);
    }
}
