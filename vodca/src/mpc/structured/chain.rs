//! Two scalar chains with some inputs fixed: the linear algebra of the structured solver.
//!
//! Per axis, with the inputs of a set fixed and forces on the states, the optimum follows from one
//! Riccati sweep backward and one roll-out forward. Forces act on states through
//! `G(p, s) = response_p a_p a_{p+1} ... a_{s-1}` for p <= s, where `a_l` is the closed-loop factor of
//! step l: the matrix of the rows' equations needs O(1) per entry. Both axes run side by side.

use super::super::problem::Problem;
use crate::horizon::MAX_HORIZON;
use nalgebra::Vector2;

/// A value per step, both axes.
pub(super) type Track = [Vector2<f64>; MAX_HORIZON];
/// Per step and axis: -1 fixed at the lower bound, 0 free, 1 fixed at the upper bound.
pub(super) type Bounds = [[i8; 2]; MAX_HORIZON];

const ZERO: Track = [Vector2::new(0.0, 0.0); MAX_HORIZON];

/// The factors of one set of fixed inputs, and its solution.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    steps: usize,
    sample_time: f64,
    state_weight: f64,
    input_weight: f64,
    /// The set that the factors belong to.
    fixed: Bounds,
    /// S_{l+1} at l: curvature of the cost-to-go at x[l + 1].
    cost_to_go: Track,
    /// a_l = 2W / (2W + h^2 S_{l+1}) where u[l] is free, 1 where it is fixed.
    closed_loop: Track,
    /// h / (2W + h^2 S_{l+1}) where u[l] is free, 0 where it is fixed.
    gain: Track,
    /// G(l+1, l+1) at l: what a unit force on x[l + 1] moves x[l + 1].
    response: Track,
    /// a_1 ... a_l at l.
    decay: Track,
    /// m_{l+1} at l: linear part of the cost-to-go at x[l + 1].
    pull: Track,
    /// x[l + 1] at l.
    pub(super) states: Track,
    /// u[l] at l.
    pub(super) inputs: Track,
}

impl Chain {
    pub(super) fn new() -> Self {
        Self {
            steps: 0,
            sample_time: 1.0,
            state_weight: 1.0,
            input_weight: 1.0,
            fixed: [[0; 2]; MAX_HORIZON],
            cost_to_go: ZERO,
            closed_loop: ZERO,
            gain: ZERO,
            response: ZERO,
            decay: ZERO,
            pull: ZERO,
            states: ZERO,
            inputs: ZERO,
        }
    }

    /// Prepares the chain for the weights and horizon of `problem`, all inputs free.
    pub(super) fn reset(&mut self, problem: &Problem<'_>) {
        self.steps = problem.horizon.steps();
        self.sample_time = problem.sample_time;
        self.state_weight = problem.state_weight;
        self.input_weight = problem.input_weight;
        self.fixed = [[0; 2]; MAX_HORIZON];
        self.factor_from(self.steps - 1);
    }

    /// Brings the factors to `fixed`. Only steps up to the last changed one are done again.
    pub(super) fn factor(&mut self, fixed: &Bounds) {
        let changed = (0..self.steps).rev().find(|&l| self.is_free(l) != [fixed[l][0] == 0, fixed[l][1] == 0]);
        if let Some(last) = changed {
            self.fixed = *fixed;
            self.factor_from(last);
        }
    }

    fn is_free(&self, l: usize) -> [bool; 2] {
        [self.fixed[l][0] == 0, self.fixed[l][1] == 0]
    }

    fn factor_from(&mut self, last: usize) {
        let (h, q2, w2) = (self.sample_time, 2.0 * self.state_weight, 2.0 * self.input_weight);
        let mut curvature = if last + 1 == self.steps { Vector2::new(q2, q2) } else { self.cost_to_go[last] };
        for l in (0..=last).rev() {
            self.cost_to_go[l] = curvature;
            let free = self.is_free(l);
            for axis in 0..2 {
                let inverse = 1.0 / (w2 + h * h * curvature[axis]);
                let (a, gain) = if free[axis] { (w2 * inverse, h * inverse) } else { (1.0, 0.0) };
                self.closed_loop[l][axis] = a;
                self.gain[l][axis] = gain;
                curvature[axis] = q2 + a * curvature[axis];
            }
        }
        let mut response = Vector2::zeros();
        let mut decay = Vector2::new(1.0, 1.0);
        for l in 0..self.steps {
            let a = self.closed_loop[l];
            response = a.component_mul(&a).component_mul(&response) + self.gain[l] * h;
            self.response[l] = response;
            if l > 0 {
                decay = decay.component_mul(&a);
            }
            self.decay[l] = decay;
        }
    }

    /// G(p, s) per axis: metres that a unit force on x[s] moves x[p]; steps 1..=N, symmetric.
    pub(super) fn influence(&self, p: usize, s: usize) -> Vector2<f64> {
        let (first, last) = (p.min(s) - 1, p.max(s) - 1);
        self.response[first].component_mul(&self.decay[last].component_div(&self.decay[first]))
    }

    /// What a unit force on u[l] moves x[p], per axis, s.
    pub(super) fn input_influence(&self, p: usize, l: usize) -> Vector2<f64> {
        let before = if l == 0 { Vector2::zeros() } else { self.influence(p, l) };
        (self.influence(p, l + 1) - before) / self.sample_time
    }

    /// Solves the chain from `start` with the given `source` (2Q x_d plus forces, index l for
    /// x[l + 1]) and `drift` (target of a free input, value of a fixed one).
    pub(super) fn solve(&mut self, start: Vector2<f64>, source: &Track, drift: &Track) {
        let h = self.sample_time;
        let mut pull = source[self.steps - 1];
        self.pull[self.steps - 1] = pull;
        for l in (1..self.steps).rev() {
            let moved = pull - self.cost_to_go[l].component_mul(&drift[l]) * h;
            pull = source[l - 1] + self.closed_loop[l].component_mul(&moved);
            self.pull[l - 1] = pull;
        }
        let mut state = start;
        for (l, drift) in drift.iter().enumerate().take(self.steps) {
            let lack = self.pull[l] - self.cost_to_go[l].component_mul(&state);
            // With the drift ahead: u = a drift + gain (m - S x), whether free or fixed.
            let input = self.closed_loop[l].component_mul(drift) + self.gain[l].component_mul(&lack);
            state += input * h;
            self.inputs[l] = input;
            self.states[l] = state;
        }
    }

    /// Derivative of the Lagrangian by u[l] at the last solution, given the input target; zero
    /// where u[l] is free.
    pub(super) fn gradient(&self, l: usize, target: Vector2<f64>) -> Vector2<f64> {
        (self.inputs[l] - target) * (2.0 * self.input_weight)
            + (self.cost_to_go[l].component_mul(&self.states[l]) - self.pull[l]) * self.sample_time
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::mpc::sample::{Family, Sample};
    use crate::mpc::stacked::Stacked;
    use nalgebra::DVector;

    const STEPS: usize = 15;

    fn fixed() -> Bounds {
        let mut fixed = [[0; 2]; MAX_HORIZON];
        for l in [0, 1, 2, 7, 14] {
            fixed[l][l % 2] = if l % 3 == 0 { 1 } else { -1 };
        }
        fixed[7] = [1, -1];
        fixed
    }

    /// Chain of a sample with some inputs fixed, its source and its drift.
    fn chain(sample: &Sample) -> (Chain, Track, Track) {
        let problem = sample.problem();
        let mut chain = Chain::new();
        chain.reset(&problem);
        chain.factor(&fixed());
        let source = problem.target.states.map(|target| target * (2.0 * problem.state_weight));
        let mut drift = problem.target.inputs;
        for (drift, fixed) in drift.iter_mut().zip(fixed()) {
            for (drift, fixed) in drift.iter_mut().zip(fixed).filter(|(_, fixed)| *fixed != 0) {
                *drift = f64::from(fixed) * problem.max_speed;
            }
        }
        (chain, source, drift)
    }

    fn sample() -> Sample {
        Sample::new(Family::Safe, Horizon::new(STEPS as u64).unwrap(), 0, 6, 0)
    }

    #[test]
    fn fixed_inputs_keep_their_value_and_free_ones_have_no_gradient() {
        let sample = sample();
        let problem = sample.problem();
        let (mut chain, mut source, drift) = chain(&sample);
        source[4] += Vector2::new(30.0, -20.0); // a force, or nothing would be to do
        chain.solve(problem.position, &source, &drift);
        let dense = Stacked::new(&problem);
        let inputs = DVector::from_iterator(2 * STEPS, chain.inputs[..STEPS].iter().flat_map(|u| [u.x, u.y]));
        let mut gradient = &dense.hessian * &inputs + &dense.gradient;
        for l in 0..=4 {
            gradient[2 * l] -= 30.0 * problem.sample_time;
            gradient[2 * l + 1] += 20.0 * problem.sample_time;
        }
        for l in 0..STEPS {
            for axis in 0..2 {
                let expected = gradient[2 * l + axis];
                if fixed()[l][axis] == 0 {
                    assert!(expected.abs() < 1e-10, "step {l}: {expected}");
                } else {
                    assert_eq!(inputs[2 * l + axis], f64::from(fixed()[l][axis]) * problem.max_speed);
                    let found = chain.gradient(l, problem.target.inputs[l])[axis];
                    assert!((found - expected).abs() < 1e-9, "step {l}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn influences_are_what_unit_forces_do() {
        let sample = sample();
        let (mut chain, ..) = chain(&sample);
        let zero = [Vector2::zeros(); MAX_HORIZON];
        for s in 1..=STEPS {
            let mut force = zero;
            force[s - 1] = Vector2::new(1.0, 1.0);
            chain.solve(Vector2::zeros(), &force, &zero);
            for p in 1..=STEPS {
                assert!((chain.states[p - 1] - chain.influence(p, s)).amax() < 1e-15);
            }
            let mut push = zero;
            push[s - 1] = Vector2::new(1.0, 1.0) / (2.0 * sample.problem().input_weight);
            chain.solve(Vector2::zeros(), &zero, &push);
            for p in 1..=STEPS {
                for axis in 0..2 {
                    if fixed()[s - 1][axis] == 0 {
                        let expected = chain.input_influence(p, s - 1)[axis];
                        assert!((chain.states[p - 1][axis] - expected).abs() < 1e-14);
                    }
                }
            }
        }
    }

    #[test]
    fn factors_changed_step_by_step_are_those_made_at_once() {
        let sample = sample();
        let (mut fresh, ..) = chain(&sample);
        let mut changed = Chain::new();
        changed.reset(&sample.problem());
        let mut bounds = [[0; 2]; MAX_HORIZON];
        for l in [14, 3, 7, 0, 1, 2] {
            bounds[l] = [1, 1];
            changed.factor(&bounds);
        }
        changed.factor(&fixed());
        fresh.factor(&fixed());
        assert_eq!(changed.response, fresh.response);
        assert_eq!(changed.decay, fresh.decay);
    }
}
