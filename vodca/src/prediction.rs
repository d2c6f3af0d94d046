//! A robot's plan as the others see it.

use crate::horizon::{Horizon, MAX_HORIZON};
use crate::{Input, Position};

/// Predicted states of one robot, computed at one tick: x^[l|k] for l = 0..=N, metres, world frame.
///
/// `state(0)` is where the robot was when it planned, `state(1)` where it will be at the next tick
/// (the *present* position for whoever reads this plan at tick `k + 1`).
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    horizon: Horizon,
    states: [Position; MAX_HORIZON + 1],
    /// Where the robot wants to go; neighbours need it to give way (ARCHITECTURE, rule 3).
    pub set_point: Position,
    /// Where it looks on its way there, as far off as that way is long; its set-point where nothing is between.
    pub toward: Position,
}

impl Prediction {
    /// Rolls the model `x[l+1] = x[l] + h u[l]` out from `position` over all `inputs` (1..=49 of them,
    /// more are ignored).
    pub fn roll_out(position: Position, set_point: Position, sample_time: f64, inputs: &[Input]) -> Self {
        let horizon = Horizon::saturating(inputs.len() as i64);
        let mut states = [position; MAX_HORIZON + 1];
        for (l, input) in inputs.iter().take(horizon.steps()).enumerate() {
            states[l + 1] = states[l] + input * sample_time;
        }
        Self { horizon, states, set_point, toward: set_point }
    }

    /// A plan from its own states x^[0..=N]; `states` holds 2..=50 points.
    pub fn from_states(states: &[Position], set_point: Position) -> Self {
        let horizon = Horizon::saturating(states.len() as i64 - 1);
        let last = states.last().copied().unwrap_or_default();
        let mut all = [last; MAX_HORIZON + 1];
        for (to, from) in all.iter_mut().zip(states) {
            *to = *from;
        }
        Self { horizon, states: all, set_point, toward: set_point }
    }

    /// A plan of `horizon` steps whose `x^[l]` is `state(l)`, l = 0..=N.
    pub fn from_fn(horizon: Horizon, state: impl Fn(usize) -> Position, set_point: Position) -> Self {
        let last = horizon.steps();
        Self { horizon, states: std::array::from_fn(|step| state(step.min(last))), set_point, toward: set_point }
    }

    /// The plan of a robot that stands at `at` (m).
    pub fn standing(at: Position, set_point: Position) -> Self {
        Self { horizon: Horizon::MAX, states: [at; MAX_HORIZON + 1], set_point, toward: set_point }
    }

    /// The same plan of a robot that looks `toward` there (m) on its way.
    pub fn looking(mut self, toward: Position) -> Self {
        self.toward = toward;
        self
    }

    /// N of this plan.
    pub fn horizon(&self) -> Horizon {
        self.horizon
    }

    /// x^[l|k] for `step` l in 0..=N.
    pub fn state(&self, step: usize) -> Position {
        self.states[step]
    }

    /// x^[0..=N|k], N + 1 points.
    pub fn states(&self) -> &[Position] {
        &self.states[..=self.horizon.steps()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roll_out_follows_the_model() {
        let inputs = [Input::new(1.0, 0.0), Input::new(0.0, -1.5)];
        let plan = Prediction::roll_out(Position::new(1.0, 1.0), Position::zeros(), 0.2, &inputs);
        assert_eq!(plan.horizon().steps(), 2);
        assert_eq!(plan.states(), [Position::new(1.0, 1.0), Position::new(1.2, 1.0), Position::new(1.2, 0.7)]);
    }
}
