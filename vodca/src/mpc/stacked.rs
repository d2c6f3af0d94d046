//! The paper's stacked form of the QP, dense: the reference that other formulations are tested
//! against, and the polish of Clarabel's answers.
//!
//! `X = F x + Phi U` with `X = (x[1], ..., x[N])` and `U = (u[0], ..., u[N-1])` stacked, axes
//! interleaved (paper, section III-A); collision rows are `A_coll U <= b_coll` (paper, equation
//! "collision avoidance constraints").

use super::problem::{Problem, Row};
use nalgebra::{DMatrix, DVector, Matrix2};

/// `min 1/2 U' hessian U + gradient' U` subject to |U| <= u_max and `rows U <= limits`.
#[derive(Clone, Debug)]
pub struct Stacked {
    /// 2 (Phi' Q Phi + W), 2N x 2N.
    pub hessian: DMatrix<f64>,
    /// 2 (Phi' Q (F x - X^d) - W U^d), 2N.
    pub gradient: DVector<f64>,
    /// A_coll, one line per row of the problem, m x 2N.
    pub rows: DMatrix<f64>,
    /// b_coll, m.
    pub limits: DVector<f64>,
}

/// F of `X = F x + Phi U`: `steps` identities stacked, 2N x 2.
pub fn free_response(steps: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2 * steps, 2, |row, column| if row % 2 == column { 1.0 } else { 0.0 })
}

/// Phi of `X = F x + Phi U`: h I in every block on and below the diagonal, 2N x 2N.
pub fn forced_response(steps: usize, sample_time: f64) -> DMatrix<f64> {
    DMatrix::from_fn(2 * steps, 2 * steps, |row, column| {
        if row % 2 == column % 2 && column / 2 <= row / 2 { sample_time } else { 0.0 }
    })
}

impl Stacked {
    /// Builds the dense matrices of `problem`.
    pub fn new(problem: &Problem<'_>) -> Self {
        let steps = problem.horizon.steps();
        let (q, w) = (problem.state_weight, problem.input_weight);
        let free = free_response(steps);
        let forced = forced_response(steps, problem.sample_time);
        let position = DVector::from_column_slice(problem.position.as_slice());
        let stack = |points: &[nalgebra::Vector2<f64>]| {
            DVector::from_iterator(2 * steps, points[..steps].iter().flat_map(|p| [p.x, p.y]))
        };
        let state_error = &free * &position - stack(&problem.target.states);
        let hessian = (forced.tr_mul(&forced) * q + DMatrix::identity(2 * steps, 2 * steps) * w) * 2.0;
        let gradient = (forced.tr_mul(&state_error) * q - stack(&problem.target.inputs) * w) * 2.0;
        let mut rows = DMatrix::zeros(problem.rows.len(), 2 * steps);
        let mut limits = DVector::zeros(problem.rows.len());
        for (index, row) in problem.rows.iter().enumerate() {
            let (line, limit) = Self::row(row, &free, &forced, &position);
            rows.set_row(index, &line.transpose());
            limits[index] = limit;
        }
        Self { hessian, gradient, rows, limits }
    }

    /// `normal' x[step] >= offset` as `-normal' Phi_step U <= normal' F_step x - offset`.
    fn row(row: &Row, free: &DMatrix<f64>, forced: &DMatrix<f64>, position: &DVector<f64>) -> (DVector<f64>, f64) {
        let block = 2 * (row.step - 1);
        let line = -forced.rows(block, 2).tr_mul(&row.normal);
        let present: Matrix2<f64> = free.fixed_view::<2, 2>(block, 0).into_owned();
        let limit = row.normal.dot(&(present * nalgebra::Vector2::new(position[0], position[1]))) - row.offset;
        (line, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::{Horizon, MAX_HORIZON};
    use crate::mpc::problem::Solution;
    use crate::mpc::sample::{Family, Sample};
    use crate::{Input, Position};

    fn example() -> (Sample, Solution) {
        let mut plan = Solution::default();
        for (l, input) in plan.inputs[..12].iter_mut().enumerate() {
            *input = Input::new((l as f64).sin(), (l as f64 * 2.0).cos());
        }
        (Sample::new(Family::Safe, Horizon::new(12).unwrap(), 5, 2, 0), plan)
    }

    fn stacked(plan: &Solution) -> DVector<f64> {
        DVector::from_iterator(24, plan.inputs[..12].iter().flat_map(|u| [u.x, u.y]))
    }

    #[test]
    fn free_and_forced_response_add_up_to_the_model() {
        let (sample, plan) = example();
        let problem = sample.problem();
        let mut states = [Position::zeros(); MAX_HORIZON];
        plan.roll_out(&problem, &mut states);
        let position = DVector::from_column_slice(problem.position.as_slice());
        let predicted = free_response(12) * position + forced_response(12, problem.sample_time) * stacked(&plan);
        for l in 0..12 {
            assert!((predicted[2 * l] - states[l].x).abs() < 1e-12);
            assert!((predicted[2 * l + 1] - states[l].y).abs() < 1e-12);
        }
    }

    #[test]
    fn the_dense_cost_and_rows_are_those_of_the_problem() {
        let (sample, plan) = example();
        let problem = sample.problem();
        let dense = Stacked::new(&problem);
        let mut states = [Position::zeros(); MAX_HORIZON];
        plan.roll_out(&problem, &mut states);
        let excess = &dense.rows * stacked(&plan) - &dense.limits;
        for (row, excess) in problem.rows.iter().zip(excess.iter()) {
            assert!((row.gap(&states[row.step - 1]) + excess).abs() < 1e-12);
        }
        // Up to the constant, which cancels in a difference.
        let no_rows = Problem { rows: &[], ..problem };
        let quadratic = |u: &DVector<f64>| 0.5 * u.dot(&(&dense.hessian * u)) + dense.gradient.dot(u);
        let still = Solution::default();
        let dense_difference = quadratic(&stacked(&plan)) - quadratic(&stacked(&still));
        let difference = plan.cost(&no_rows) - still.cost(&no_rows);
        assert!((dense_difference - difference).abs() < 1e-9 * difference.abs().max(1.0));
    }
}
