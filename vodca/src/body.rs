//! What a controller drives: a body that says where it is and takes an input.
//!
//! [`SimulatedBody`] is the paper's model. A real robot implements [`Body`] on its driver; nothing else of the
//! system knows which of the two it has.

use crate::geometry::in_disc;
use crate::params::Params;
use crate::random::Use;
use crate::{Input, Position};

/// A robot's body: one that moves in the world, or [`SimulatedBody`].
///
/// The order of calls is `measure(0)`, then for every tick k `apply(u)`, `measure(k + 1)`.
pub trait Body: Send {
    /// Where the robot will be at the start of tick `tick`, as well as it knows, m, world frame.
    ///
    /// It is asked right after [`Self::apply`] of the tick before, so that everybody (a policy, the record) sees
    /// the very position that the robot plans from. A body that the world moves answers with its newest pose
    /// carried on by the input it was just given.
    fn measure(&mut self, tick: u64) -> Position;

    /// Takes the input of the present tick, m/s per axis. It is good for this tick and no longer: a driver stands by
    /// itself when the next one does not come in time (command watchdog; ARCHITECTURE, the guarantee).
    fn apply(&mut self, input: Input);

    /// The robot begins anew, and whoever kept its body says that it stands at `at` (m). A body in the world is where
    /// it is.
    fn place(&mut self, _at: Position) {}

    /// Where the robot truly is, m; `None` for a body in the world, of which only measurements are known.
    fn truth(&self) -> Option<Position> {
        None
    }
}

/// The paper's single integrator `x[k+1] = x[k] + h u[k]`, measured with `disturbance.noise`.
#[derive(Clone, Debug)]
pub struct SimulatedBody {
    robot: usize,
    seed: u64,
    sample_time: f64,
    noise: f64,
    position: Position,
}

impl SimulatedBody {
    /// The body of robot number `robot` at `start` (m); `seed` feeds the errors of measuring.
    pub fn new(robot: usize, start: Position, params: &Params, seed: u64) -> Self {
        let (sample_time, noise) = (params.model.sample_time, params.disturbance.noise);
        Self { robot, seed, sample_time, noise, position: start }
    }
}

impl Body for SimulatedBody {
    /// The true position plus a draw from a disc of radius `disturbance.noise`.
    fn measure(&mut self, tick: u64) -> Position {
        self.position + in_disc(self.noise, self.seed, Use::Noise, self.robot, tick)
    }

    fn apply(&mut self, input: Input) {
        self.position += input * self.sample_time;
    }

    fn place(&mut self, at: Position) {
        self.position = at;
    }

    fn truth(&self) -> Option<Position> {
        Some(self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(noise: f64) -> SimulatedBody {
        let mut params = Params::safe();
        params.disturbance.noise = noise;
        SimulatedBody::new(1, Position::new(1.0, 2.0), &params, 3)
    }

    #[test]
    fn errors_of_measuring_stay_within_their_bound() {
        let mut body = body(0.02);
        let errors: Vec<f64> = (0..500).map(|tick| (body.measure(tick) - Position::new(1.0, 2.0)).norm()).collect();
        assert!(errors.iter().all(|&error| error <= 0.02) && errors.iter().any(|&error| error > 0.015));
    }

    #[test]
    fn without_noise_the_measured_position_is_the_true_one() {
        let mut body = body(0.0);
        body.apply(Input::new(1.5, -0.5));
        assert_eq!(body.measure(1), Position::new(1.0 + 0.2 * 1.5, 2.0 - 0.2 * 0.5));
        assert_eq!(body.truth(), Some(body.measure(1)));
    }
}
