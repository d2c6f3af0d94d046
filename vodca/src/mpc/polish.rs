//! Turns a nearly optimal plan into the exact one: guesses which bounds and rows are active, solves
//! that equality-constrained problem with dense factors, and corrects the guess one by one.
//!
//! Interior points stop at a relative gap of the cost; at N = 49 that leaves 1e-5 m/s in `u`, while
//! an active set leaves rounding. Dense, allocating, O(N^3): meant for the rare QP that only the last
//! solver finished, and for tests.

use super::kkt;
use super::problem::{Problem, Solution};
use super::stacked::Stacked;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Rounds of correcting the active set.
const MAX_ROUNDS: u32 = 60;
/// Largest KKT residual of an accepted plan, m/s and m.
pub const ACCEPTED_RESIDUAL: f64 = 1e-10;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Bound {
    Free,
    Lower,
    Upper,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum RowState {
    Open,
    /// Gap 0.
    Tight,
    /// Soft row with slack > 0.
    Violated,
}

/// Replaces `plan` and `multipliers` (one per row) by the exact optimum and returns its KKT
/// residual. `None`: no exact optimum was found near the given one, which then stays untouched.
pub fn polish(problem: &Problem<'_>, plan: &mut Solution, multipliers: &mut [f64]) -> Option<kkt::Residual> {
    let dense = Stacked::new(problem);
    let size = 2 * problem.horizon.steps();
    let bound = problem.max_speed;
    let mut inputs = DVector::from_iterator(size, plan.inputs.iter().flat_map(|u| [u.x, u.y]).take(size));
    let mut prices = DVector::from_column_slice(multipliers);
    let mut guess = Guess::new(problem, &dense, &inputs, &prices);
    for _ in 0..MAX_ROUNDS {
        let (next, next_prices) = guess.solve(problem, &dense)?;
        (inputs, prices) = (next, next_prices);
        if !guess.correct(problem, &dense, &inputs, &prices) {
            break;
        }
    }
    let mut exact = Solution::default();
    for (l, input) in exact.inputs[..size / 2].iter_mut().enumerate() {
        *input = crate::Input::new(inputs[2 * l].clamp(-bound, bound), inputs[2 * l + 1].clamp(-bound, bound));
    }
    let residual = kkt::residual(problem, &exact, prices.as_slice());
    if residual.largest() <= ACCEPTED_RESIDUAL {
        *plan = exact;
        multipliers.copy_from_slice(prices.as_slice());
        Some(residual)
    } else {
        None
    }
}

struct Guess {
    bounds: Vec<Bound>,
    rows: Vec<RowState>,
}

impl Guess {
    /// Reads the active set off a nearly optimal point: the side that a projected gradient step
    /// would hit.
    fn new(problem: &Problem<'_>, dense: &Stacked, inputs: &DVector<f64>, prices: &DVector<f64>) -> Self {
        let gradient = &dense.hessian * inputs + &dense.gradient + dense.rows.tr_mul(prices);
        let step = inputs - gradient / (2.0 * problem.input_weight);
        let bounds = step
            .iter()
            .map(|&u| match u {
                u if u >= problem.max_speed => Bound::Upper,
                u if u <= -problem.max_speed => Bound::Lower,
                _ => Bound::Free,
            })
            .collect();
        let gaps = &dense.limits - &dense.rows * inputs;
        let rows = (0..prices.len())
            .map(|r| {
                // Multiplier against gap, both in the unit of a multiplier.
                let scale = 2.0 * problem.input_weight / (problem.sample_time * problem.sample_time);
                if prices[r] <= gaps[r] * scale {
                    RowState::Open
                } else if !problem.rows[r].hard && gaps[r] < -1e-7 && prices[r] > 0.99 * problem.slack.linear {
                    RowState::Violated
                } else {
                    RowState::Tight
                }
            })
            .collect();
        Self { bounds, rows }
    }

    /// Inputs and multipliers of the equality-constrained problem.
    fn solve(&self, problem: &Problem<'_>, dense: &Stacked) -> Option<(DVector<f64>, DVector<f64>)> {
        let size = self.bounds.len();
        let price = &problem.slack;
        let mut hessian = dense.hessian.clone();
        let mut gradient = dense.gradient.clone();
        for r in self.rows_in(RowState::Violated) {
            let line = dense.rows.row(r).transpose();
            hessian.ger(price.quadratic, &line, &line, 1.0);
            gradient += &line * (price.linear - price.quadratic * dense.limits[r]);
        }
        let fixed = DVector::from_iterator(
            size,
            self.bounds.iter().map(|b| match b {
                Bound::Free => 0.0,
                Bound::Lower => -problem.max_speed,
                Bound::Upper => problem.max_speed,
            }),
        );
        let free: Vec<usize> = (0..size).filter(|&i| self.bounds[i] == Bound::Free).collect();
        let tight: Vec<usize> = self.rows_in(RowState::Tight).collect();
        let pull = &gradient + &hessian * &fixed;
        let factor = Cholesky::new(hessian.select_rows(&free).select_columns(&free))?;
        let lines = dense.rows.select_rows(&tight).select_columns(&free);
        let unconstrained = -factor.solve(&pull.select_rows(&free));
        let missing =
            &lines * &unconstrained + &dense.rows.select_rows(&tight) * &fixed - dense.limits.select_rows(&tight);
        let mut prices = DVector::zeros(self.rows.len());
        let mut moved = unconstrained;
        if !tight.is_empty() {
            let response = factor.solve(&lines.transpose());
            let schur: DMatrix<f64> = &lines * &response;
            let scale = schur.amax();
            let tight_prices = schur.svd(true, true).solve(&missing, 1e-11 * scale).ok()?;
            moved -= response * &tight_prices;
            for (&r, price) in tight.iter().zip(tight_prices.iter()) {
                prices[r] = *price;
            }
        }
        let mut inputs = fixed;
        for (&i, value) in free.iter().zip(moved.iter()) {
            inputs[i] = *value;
        }
        for r in self.rows_in(RowState::Violated) {
            let violation = dense.rows.row(r).transpose().dot(&inputs) - dense.limits[r];
            prices[r] = price.linear + price.quadratic * violation;
        }
        Some((inputs, prices))
    }

    /// Changes the one entry of the guess that the solution contradicts most; `false`: none.
    fn correct(
        &mut self,
        problem: &Problem<'_>,
        dense: &Stacked,
        inputs: &DVector<f64>,
        prices: &DVector<f64>,
    ) -> bool {
        let curvature = 2.0 * problem.input_weight;
        let gradient = &dense.hessian * inputs + &dense.gradient + dense.rows.tr_mul(prices);
        let excess = &dense.rows * inputs - &dense.limits;
        let per_metre = problem.sample_time / curvature;
        let mut worst = 1e-12;
        let mut change = None;
        let mut consider = |amount: f64, index: usize, what: Change| {
            if amount > worst {
                worst = amount;
                change = Some((index, what));
            }
        };
        for (i, state) in self.bounds.iter().enumerate() {
            match state {
                Bound::Free => {
                    consider(inputs[i] - problem.max_speed, i, Change::Bound(Bound::Upper));
                    consider(-problem.max_speed - inputs[i], i, Change::Bound(Bound::Lower));
                }
                Bound::Upper => consider(gradient[i] / curvature, i, Change::Bound(Bound::Free)),
                Bound::Lower => consider(-gradient[i] / curvature, i, Change::Bound(Bound::Free)),
            }
        }
        for (r, state) in self.rows.iter().enumerate() {
            match state {
                RowState::Open => consider(excess[r] / problem.sample_time, r, Change::Row(RowState::Tight)),
                RowState::Tight => {
                    consider(-prices[r] * per_metre, r, Change::Row(RowState::Open));
                    if !problem.rows[r].hard {
                        consider((prices[r] - problem.slack.linear) * per_metre, r, Change::Row(RowState::Violated));
                    }
                }
                RowState::Violated => consider(-excess[r] / problem.sample_time, r, Change::Row(RowState::Tight)),
            }
        }
        match change {
            Some((i, Change::Bound(state))) => self.bounds[i] = state,
            Some((r, Change::Row(state))) => self.rows[r] = state,
            None => return false,
        }
        true
    }

    fn rows_in(&self, state: RowState) -> impl Iterator<Item = usize> + '_ {
        self.rows.iter().enumerate().filter(move |(_, s)| **s == state).map(|(r, _)| r)
    }
}

enum Change {
    Bound(Bound),
    Row(RowState),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::clarabel::Clarabel;
    use crate::mpc::problem::QpSolver;
    use crate::mpc::sample::{Family, Sample};

    #[test]
    fn a_rough_answer_becomes_exact() {
        for family in [Family::Hard, Family::Soft, Family::Safe, Family::Degenerate] {
            for index in 0..20 {
                let sample = Sample::new(family, Horizon::new(20).unwrap(), 4, 8, index);
                let problem = sample.problem();
                let mut solver = Clarabel::unpolished(1e-5);
                let mut plan = Solution::default();
                if solver.solve(&problem, &mut plan).is_err() {
                    continue;
                }
                let mut multipliers = solver.multipliers().to_vec();
                let before = kkt::residual(&problem, &plan, &multipliers).largest();
                let after = polish(&problem, &mut plan, &mut multipliers).unwrap();
                assert!(after.largest() <= ACCEPTED_RESIDUAL && before > 1e3 * after.largest());
                assert_eq!(after, kkt::residual(&problem, &plan, &multipliers));
            }
        }
    }

    #[test]
    fn a_plan_that_nothing_can_repair_stays_as_it_is() {
        let sample = Sample::new(Family::Opposed, Horizon::new(10).unwrap(), 1, 8, 0);
        let mut plan = Solution::default();
        plan.inputs[2].x = 0.25;
        let before = plan.clone();
        let mut multipliers = [3.0, 4.0];
        assert!(polish(&sample.problem(), &mut plan, &mut multipliers).is_none());
        assert_eq!((plan.inputs, multipliers), (before.inputs, [3.0, 4.0]));
    }
}
