//! One robot from measuring to moving: the same in a team and in an agent process.

use crate::baseline::orca::OrcaController;
use crate::controller::{Controller, View};
use crate::hearing::{Hearing, measured};
use crate::layout::Layout;
use crate::mpc::cross_check::Comparison;
use crate::vodca_controller::VodcaController;
use shared::Position;
use shared::horizon::Horizon;
use shared::params::{ControllerKind, Params};
use shared::scenario::Scenario;
use shared::step::Step;
use std::time::Instant;

/// A simulated body and the controller that drives it.
pub struct Robot {
    robot: usize,
    seed: u64,
    sample_time: f64,
    noise: f64,
    position: Position,
    controller: Box<dyn Controller>,
}

impl Robot {
    /// Robot number `robot` at its start. `seed` feeds what is random: measuring noise, ORCA's push.
    pub fn new(robot: usize, scenario: &Scenario, params: &Params, seed: u64) -> Self {
        Self::among(&Layout::of(scenario, params.model.min_separation), robot, scenario, params, seed)
    }

    /// The same, with the layout that the whole team shares.
    pub fn among(layout: &Layout, robot: usize, scenario: &Scenario, params: &Params, seed: u64) -> Self {
        let controller: Box<dyn Controller> = match params.controller.kind {
            ControllerKind::Vodca => Box::new(VodcaController::new(robot, params, layout)),
            ControllerKind::Orca => Box::new(OrcaController::new(robot, params, layout, seed)),
        };
        Self::driven_by(controller, robot, scenario, params, seed)
    }

    /// The same, with every QP solved a second time by Clarabel (see [`Self::comparison`]).
    pub fn checked(robot: usize, scenario: &Scenario, params: &Params, seed: u64) -> Self {
        let layout = Layout::of(scenario, params.model.min_separation);
        match params.controller.kind {
            ControllerKind::Vodca => {
                let controller = VodcaController::new(robot, params, &layout).checked();
                Self::driven_by(Box::new(controller), robot, scenario, params, seed)
            }
            ControllerKind::Orca => Self::new(robot, scenario, params, seed),
        }
    }

    fn driven_by(
        controller: Box<dyn Controller>,
        robot: usize,
        scenario: &Scenario,
        params: &Params,
        seed: u64,
    ) -> Self {
        Self {
            robot,
            seed,
            sample_time: params.model.sample_time,
            noise: params.disturbance.noise,
            position: scenario.robots[robot].start,
            controller,
        }
    }

    /// What solving every QP twice has found; `None` unless [`Self::checked`] built this robot.
    pub fn comparison(&self) -> Option<Comparison> {
        self.controller.comparison()
    }

    /// Where the robot is, m.
    pub fn position(&self) -> Position {
        self.position
    }

    /// Measures, decides and moves: one tick. `hearing` holds the others' plans of tick k - 1.
    pub fn step(&mut self, tick: u64, horizon: Horizon, hearing: &Hearing) -> Step {
        let started = Instant::now();
        let seen = measured(self.position, self.noise, self.seed, self.robot, tick);
        let view = View { tick, horizon, position: seen, neighbours: hearing.neighbours() };
        let decision = self.controller.tick(&view);
        let step_ns = started.elapsed().as_nanos() as u64;
        let position = self.position;
        self.position = position + decision.input * self.sample_time;
        Step {
            position,
            input: decision.input,
            next_position: self.position,
            horizon,
            rows: decision.rows,
            level: decision.level,
            status: decision.status,
            shielded: decision.shielded,
            plan: decision.plan,
            detect_ns: decision.detect_ns,
            solve_ns: decision.solve_ns,
            step_ns,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::params::Profile;
    use shared::scenario::set_up;

    #[test]
    fn the_time_of_the_qp_is_a_part_of_the_time_of_the_step() {
        for (profile, has_qp) in [(Profile::Safe, true), (Profile::Orca, false)] {
            let (scenario, params) = set_up(Some("two_setpoint"), None, profile, &[]).unwrap();
            let hearing = Hearing::new(0, &scenario, &params.disturbance, 0);
            let step = Robot::new(0, &scenario, &params, 0).step(0, Horizon::MAX, &hearing);
            assert_eq!((step.detect_ns > 0, step.solve_ns > 0), (has_qp, has_qp), "{profile}");
            let parts = step.detect_ns + step.solve_ns;
            assert!(parts < step.step_ns, "{profile}: {parts} of {} ns", step.step_ns);
        }
    }
}
