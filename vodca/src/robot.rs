//! One robot from deciding to moving: the same in a team in one process and in a process of its own.

use crate::Position;
use crate::baseline::orca::OrcaController;
use crate::body::{Body, SimulatedBody};
use crate::controller::{Controller, View};
use crate::horizon::Horizon;
use crate::layout::Layout;
use crate::mpc::cross_check::Comparison;
use crate::neighbour_estimates::NeighbourEstimates;
use crate::params::{ControllerKind, Params};
use crate::scenario::Scenario;
use crate::step::{Status, Step};
use crate::vodca_controller::VodcaController;
use std::sync::Arc;
use std::time::Instant;

/// A body and the controller that drives it.
pub struct Robot {
    body: Box<dyn Body>,
    controller: Box<dyn Controller>,
    /// Where it measures itself at the start of the next tick, m.
    measured: Position,
}

impl Robot {
    /// Robot number `robot` of `scenario` with a simulated body at its start. `layout` is
    /// [`Layout::of`] the scenario, one for all robots of a team; `seed` feeds what is random: errors of
    /// measuring, ORCA's push.
    pub fn new(robot: usize, scenario: &Scenario, params: &Params, layout: &Arc<Layout>, seed: u64) -> Self {
        let controller: Box<dyn Controller> = match params.controller.kind {
            ControllerKind::Vodca => Box::new(VodcaController::new(robot, params, layout)),
            ControllerKind::Orca => Box::new(OrcaController::new(robot, params, layout, seed)),
        };
        Self::of(simulated(robot, scenario, params, seed), controller)
    }

    /// The same, with every QP solved a second time by Clarabel (see [`Self::comparison`]).
    pub fn checked(robot: usize, scenario: &Scenario, params: &Params, layout: &Arc<Layout>, seed: u64) -> Self {
        match params.controller.kind {
            ControllerKind::Vodca => {
                let controller = VodcaController::new(robot, params, layout).checked();
                Self::of(simulated(robot, scenario, params, seed), Box::new(controller))
            }
            ControllerKind::Orca => Self::new(robot, scenario, params, layout, seed),
        }
    }

    /// Any body with any controller, before tick 0.
    pub fn of(mut body: Box<dyn Body>, controller: Box<dyn Controller>) -> Self {
        let measured = body.measure(0);
        Self { body, controller, measured }
    }

    /// What solving every QP twice has found; `None` unless [`Self::checked`] built this robot.
    pub fn comparison(&self) -> Option<Comparison> {
        self.controller.comparison()
    }

    /// Where the robot measures itself at the start of the next tick, m.
    pub fn measured(&self) -> Position {
        self.measured
    }

    /// Begins anew with tick `tick`, standing at `at` (m): it did not take part in the tick before.
    pub fn restart(&mut self, tick: u64, at: Position) {
        self.body.place(at);
        self.measured = self.body.measure(tick);
        self.controller.restart();
    }

    /// From the next tick on `layout` holds.
    pub fn lay_out(&mut self, layout: &Arc<Layout>) {
        self.controller.lay_out(layout);
    }

    /// Does not take part in tick `tick`: its body stands, and only measures itself.
    pub fn stand(&mut self, tick: u64, horizon: Horizon, set_point: Position, status: Status) -> Step {
        let at = self.place();
        let before = self.measured;
        self.measured = self.body.measure(tick + 1);
        Step::absent(at, [before, self.measured], horizon, set_point, status)
    }

    /// Where a simulated body is, m; of a body in the world where it measures itself.
    pub fn place(&self) -> Position {
        self.body.truth().unwrap_or(self.measured)
    }

    /// Decides, moves and measures itself anew: one tick. `hearing` holds the others' plans of tick k - 1.
    pub fn step(&mut self, tick: u64, horizon: Horizon, hearing: &NeighbourEstimates) -> Step {
        let started = Instant::now();
        let measured = self.measured;
        let position = self.body.truth().unwrap_or(measured);
        let view = View { tick, horizon, position: measured, neighbours: hearing.neighbours() };
        let decision = self.controller.tick(&view);
        let step_ns = started.elapsed().as_nanos() as u64;
        self.body.apply(decision.input);
        self.measured = self.body.measure(tick + 1);
        Step {
            position,
            measured,
            input: decision.input,
            next_position: self.body.truth().unwrap_or(self.measured),
            next_measured: self.measured,
            horizon,
            rows: decision.rows,
            level: decision.level,
            status: decision.status,
            filtered: decision.filtered,
            plan: decision.plan,
            detect_ns: decision.detect_ns,
            solve_ns: decision.solve_ns,
            step_ns,
        }
    }
}

fn simulated(robot: usize, scenario: &Scenario, params: &Params, seed: u64) -> Box<dyn Body> {
    Box::new(SimulatedBody::new(robot, scenario.robots[robot].start, params, seed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Profile;
    use crate::scenario::set_up;
    use crate::team::Team;
    use crate::{Input, horizon_source::HorizonSource};

    #[test]
    fn the_time_of_the_qp_is_a_part_of_the_time_of_the_step() {
        for (profile, has_qp) in [(Profile::Safe, true), (Profile::Orca, false)] {
            let (scenario, params) = set_up(Some("two_setpoint"), None, profile, &[]).unwrap();
            let layout = Arc::new(Layout::of(&scenario, &params.model));
            let hearing = NeighbourEstimates::new(0, &scenario, &params.disturbance, 0);
            let step = Robot::new(0, &scenario, &params, &layout, 0).step(0, Horizon::MAX, &hearing);
            assert_eq!((step.detect_ns > 0, step.solve_ns > 0), (has_qp, has_qp), "{profile}");
            let parts = step.detect_ns + step.solve_ns;
            assert!(parts < step.step_ns, "{profile}: {parts} of {} ns", step.step_ns);
        }
    }

    #[test]
    fn what_a_robot_measures_next_is_what_it_plans_from_next() {
        let noise = "disturbance.noise=0.02".to_string();
        let (scenario, params) = set_up(Some("ex14_d"), None, Profile::Safe, &[noise]).unwrap();
        let source = HorizonSource::new(&"random:1".parse().unwrap(), 14, 0, 0).unwrap();
        let mut team = Team::new(&scenario, &params, 7);
        let mut expected = team.measured().to_vec();
        for tick in 0..20 {
            let horizons: Vec<Horizon> = (0..14).map(|robot| source.horizon(robot, tick)).collect();
            for (step, expected) in team.step(&horizons).iter().zip(&mut expected) {
                assert_eq!((step.measured, step.plan.state(0)), (*expected, *expected));
                assert!(step.measured != step.position && (step.measured - step.position).norm() <= 0.02);
                *expected = step.next_measured;
            }
            assert_eq!(team.measured(), expected);
        }
    }

    #[test]
    fn of_a_body_without_a_truth_measurements_are_recorded() {
        struct Real(Position);
        impl Body for Real {
            fn measure(&mut self, tick: u64) -> Position {
                self.0 + Position::new(0.001 * tick as f64, 0.0)
            }
            fn apply(&mut self, input: Input) {
                self.0 += input * 0.2;
            }
        }
        let (scenario, params) = set_up(Some("two_setpoint"), None, Profile::Safe, &[]).unwrap();
        let layout = Arc::new(Layout::of(&scenario, &params.model));
        let controller = Box::new(VodcaController::new(0, &params, &layout));
        let mut robot = Robot::of(Box::new(Real(scenario.robots[0].start)), controller);
        let step = robot.step(0, Horizon::MAX, &NeighbourEstimates::new(0, &scenario, &params.disturbance, 0));
        assert_eq!((step.position, step.next_position), (step.measured, step.next_measured));
        assert_eq!(robot.measured(), step.next_measured);
    }
}
