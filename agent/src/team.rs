//! All robots of a team in one process: the same controllers, the same exchange by tick number, no
//! processes. Golden tests, sweeps and replays stand on it; agent processes give the same bytes.

use crate::controller::{Controller, Neighbour, View};
use crate::layout::Layout;
use crate::vodca_controller::VodcaController;
use shared::Position;
use shared::horizon::Horizon;
use shared::params::Params;
use shared::prediction::Prediction;
use shared::scenario::Scenario;
use shared::step::{Level, Status, Step};
use std::time::Instant;

/// The controller of `robot` that `params` ask for.
pub fn build_controller(robot: usize, params: &Params, layout: &Layout) -> Box<dyn Controller> {
    Box::new(VodcaController::new(robot, params, layout))
}

/// A team in one process.
pub struct Team {
    sample_time: f64,
    controllers: Vec<Box<dyn Controller>>,
    /// What everybody heard of everybody.
    neighbours: Vec<Neighbour>,
    positions: Vec<Position>,
    steps: Vec<Step>,
    tick: u64,
}

impl Team {
    /// A team at its start positions, before tick 0.
    pub fn new(scenario: &Scenario, params: &Params) -> Self {
        let layout = Layout::of(scenario, params.model.min_separation);
        let robots = &scenario.robots;
        Self {
            sample_time: params.model.sample_time,
            controllers: (0..robots.len()).map(|robot| build_controller(robot, params, &layout)).collect(),
            neighbours: robots.iter().map(|robot| Neighbour::at_start(robot.start, robot.set_point)).collect(),
            positions: robots.iter().map(|robot| robot.start).collect(),
            steps: robots.iter().map(|robot| at_rest(robot.start, robot.set_point)).collect(),
            tick: 0,
        }
    }

    /// Runs one tick with a horizon for every robot and tells what each did, by robot number.
    pub fn step(&mut self, horizons: impl Fn(usize) -> Horizon) -> &[Step] {
        for (robot, controller) in self.controllers.iter_mut().enumerate() {
            let position = self.positions[robot];
            let view = View { tick: self.tick, horizon: horizons(robot), position, neighbours: &self.neighbours };
            let started = Instant::now();
            let decision = controller.tick(&view);
            let solve_ns = started.elapsed().as_nanos() as u64;
            self.steps[robot] = Step {
                position,
                input: decision.input,
                next_position: position + decision.input * self.sample_time,
                horizon: view.horizon,
                rows: decision.rows,
                level: decision.level,
                status: decision.status,
                shielded: decision.shielded,
                plan: decision.plan,
                solve_ns,
            };
        }
        // Jacobi: only now, when everybody has planned, is anybody's plan heard.
        for (robot, step) in self.steps.iter().enumerate() {
            self.neighbours[robot].hear(self.tick, &step.plan);
            self.positions[robot] = step.next_position;
        }
        self.tick += 1;
        &self.steps
    }

    /// The next tick to run.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Where the robots are now, m.
    pub fn positions(&self) -> &[Position] {
        &self.positions
    }
}

fn at_rest(position: Position, set_point: Position) -> Step {
    Step {
        position,
        input: Position::zeros(),
        next_position: position,
        horizon: Horizon::MIN,
        rows: 0,
        level: Level::ClosedForm,
        status: Status::Solved,
        shielded: false,
        plan: Prediction::from_states(&[position, position], set_point),
        solve_ns: 0,
    }
}
