//! Clarabel: the reference, the cross-check and the last solver. The only file that imports it.
//!
//! States-only form: variables are the displacements `x[l] - x[0]`, l = 1..N, and one slack per soft
//! row; inputs are differences of neighbouring states. P is tridiagonal per axis, a bound has two
//! entries, a collision row two (and its slack).

use super::polish;
use super::problem::{Effort, Problem, QpSolver, Solution, SolveError};
use crate::Input;
use ::clarabel::algebra::CscMatrix;
use ::clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT};

/// Clarabel with the settings that suit this QP.
#[derive(Clone, Debug)]
pub struct Clarabel {
    tolerance: f64,
    polish: bool,
    multipliers: Vec<f64>,
}

impl Clarabel {
    /// Tolerances 1e-9, then polished to about 1e-12: what the ladder uses.
    pub fn run_time() -> Self {
        Self { tolerance: 1e-9, polish: true, multipliers: Vec::new() }
    }

    /// Tolerances 1e-10, polished: the oracle of tests.
    pub fn reference() -> Self {
        Self { tolerance: 1e-10, ..Self::run_time() }
    }

    /// The interior point alone at `tolerance`, for comparisons of speed and accuracy. Inputs are
    /// accurate to 1e-4 m/s at best.
    pub fn unpolished(tolerance: f64) -> Self {
        Self { tolerance, polish: false, multipliers: Vec::new() }
    }

    /// Multipliers of the rows at the last plan, in the rows' order, per metre.
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }

    fn settings(&self) -> DefaultSettings<f64> {
        DefaultSettings {
            verbose: false,
            max_iter: 60,
            max_threads: 1,
            direct_solve_method: "qdldl".into(),
            presolve_enable: false,
            equilibrate_enable: true, // without it soft rows take 17 to 28 iterations, not 10
            iterative_refinement_enable: false, // 1.5 times faster, nothing lost in accuracy
            // The gap is relative to the cost: the default 1e-8 leaves 2.6e-3 m/s in u.
            tol_gap_abs: self.tolerance,
            tol_gap_rel: self.tolerance,
            tol_feas: self.tolerance,
            tol_infeas_abs: self.tolerance,
            tol_infeas_rel: self.tolerance,
            ..DefaultSettings::default()
        }
    }
}

impl QpSolver for Clarabel {
    fn solve(&mut self, problem: &Problem<'_>, plan: &mut Solution) -> Result<Effort, SolveError> {
        let gave_up = |iterations| Err(SolveError::GaveUp { iterations });
        if !problem.is_well_posed() {
            return gave_up(0);
        }
        let form = StatesOnly::new(problem);
        let cones = [NonnegativeConeT(form.limits.len())];
        let cones: &[SupportedConeT<f64>] = &cones;
        let Ok(mut solver) =
            DefaultSolver::new(&form.cost, &form.gradient, &form.rows, &form.limits, cones, self.settings())
        else {
            return gave_up(0);
        };
        solver.solve();
        let solution = &solver.solution;
        let iterations = solution.iterations;
        // Short of Solved the point may still tell the active set; only a checked polish accepts it.
        let finished = match solution.status {
            SolverStatus::Solved => true,
            SolverStatus::PrimalInfeasible => return Err(SolveError::Infeasible),
            SolverStatus::AlmostSolved
            | SolverStatus::MaxIterations
            | SolverStatus::NumericalError
            | SolverStatus::InsufficientProgress => false,
            _ => return gave_up(iterations),
        };
        if !(finished || self.polish) || solution.x.iter().any(|x| !x.is_finite()) {
            return gave_up(iterations);
        }
        let steps = problem.horizon.steps();
        let bound = problem.max_speed;
        let mut before = [0.0; 2];
        for l in 0..steps {
            let state = [solution.x[2 * l], solution.x[2 * l + 1]];
            let input = |axis: usize| ((state[axis] - before[axis]) / problem.sample_time).clamp(-bound, bound);
            plan.inputs[l] = Input::new(input(0), input(1));
            before = state;
        }
        plan.inputs[steps..].fill(Input::zeros());
        self.multipliers.clear();
        self.multipliers.extend_from_slice(&solution.z[4 * steps..][..problem.rows.len()]);
        if self.polish && polish::polish(problem, plan, &mut self.multipliers).is_none() && !finished {
            return gave_up(iterations);
        }
        Ok(Effort { iterations })
    }
}

/// `min 1/2 z' cost z + gradient' z` subject to `limits - rows z >= 0`. Lines: 2N upper bounds, 2N
/// lower bounds, the collision rows, the signs of the slacks.
struct StatesOnly {
    cost: CscMatrix<f64>,
    gradient: Vec<f64>,
    rows: CscMatrix<f64>,
    limits: Vec<f64>,
}

impl StatesOnly {
    fn new(problem: &Problem<'_>) -> Self {
        let steps = problem.horizon.steps();
        let states = 2 * steps;
        let soft = problem.rows.iter().filter(|row| !row.hard).count();
        let (size, lines) = (states + soft, 2 * states + problem.rows.len() + soft);
        let (h, q, w) = (problem.sample_time, problem.state_weight, problem.input_weight);
        let link = 2.0 * w / (h * h);

        let mut cost = Triplets::default();
        let mut rows = Triplets::default();
        let mut gradient = vec![0.0; size];
        let mut limits = vec![problem.max_speed; lines];
        for l in 0..steps {
            for axis in 0..2 {
                let state = 2 * l + axis;
                let last = l + 1 == steps;
                // x[l + 1] ends u[l] and starts u[l + 1]. Only the upper triangle, no zeros.
                if l > 0 {
                    cost.push(state - 2, state, -link);
                }
                cost.push(state, state, 2.0 * q + if last { link } else { 2.0 * link });
                let target = &problem.target;
                let after = if last { 0.0 } else { target.inputs[l + 1][axis] };
                gradient[state] = 2.0 * q * (problem.position[axis] - target.states[l][axis])
                    - 2.0 * w / h * (target.inputs[l][axis] - after);
                for (first_line, sign) in [(0, 1.0 / h), (states, -1.0 / h)] {
                    rows.push(first_line + state, state, sign);
                    if !last {
                        rows.push(first_line + state + 2, state, -sign);
                    }
                }
            }
        }
        let mut slack = states;
        for (index, row) in problem.rows.iter().enumerate() {
            let line = 2 * states + index;
            let state = 2 * (row.step - 1);
            rows.push(line, state, -row.normal.x);
            rows.push(line, state + 1, -row.normal.y);
            limits[line] = row.gap(&problem.position);
            if !row.hard {
                let sign_line = 2 * states + problem.rows.len() + slack - states;
                rows.push(line, slack, -1.0);
                rows.push(sign_line, slack, -1.0);
                limits[sign_line] = 0.0;
                if problem.slack.quadratic > 0.0 {
                    cost.push(slack, slack, problem.slack.quadratic);
                }
                gradient[slack] = problem.slack.linear;
                slack += 1;
            }
        }
        Self { cost: cost.matrix(size, size), gradient, rows: rows.matrix(lines, size), limits }
    }
}

#[derive(Default)]
struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::kkt;
    use crate::mpc::sample::{Family, Sample};

    fn sample(family: Family) -> Sample {
        Sample::new(family, Horizon::new(20).unwrap(), 3, 4, 1)
    }

    #[test]
    fn answers_are_exact_with_polish_and_rough_without() {
        let sample = sample(Family::Safe);
        let (mut exact, mut rough) = (Solution::default(), Solution::default());
        let mut solver = Clarabel::run_time();
        solver.solve(&sample.problem(), &mut exact).unwrap();
        assert!(kkt::residual(&sample.problem(), &exact, solver.multipliers()).largest() < 1e-11);
        let effort = Clarabel::unpolished(1e-9).solve(&sample.problem(), &mut rough).unwrap();
        assert!(rough.largest_difference(&exact) < 1e-3 && (3..40).contains(&effort.iterations));
    }

    #[test]
    fn an_infeasible_problem_is_named_so() {
        let outcome = Clarabel::run_time().solve(&sample(Family::Opposed).problem(), &mut Solution::default());
        assert_eq!(outcome, Err(SolveError::Infeasible));
    }

    #[test]
    fn an_ill_posed_problem_is_given_up() {
        let mut sample = sample(Family::Soft);
        sample.rows[0].normal.x = f64::NAN;
        let outcome = Clarabel::run_time().solve(&sample.problem(), &mut Solution::default());
        assert_eq!(outcome, Err(SolveError::GaveUp { iterations: 0 }));
    }
}
