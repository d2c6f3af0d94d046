//! All robots of a team in one process: the same controllers, the same exchange by tick number, no
//! processes. Golden tests, sweeps and replays stand on it; agent processes give the same bytes.

use crate::hearing::Hearing;
use crate::layout::Layout;
use crate::mpc::cross_check::Comparison;
use crate::robot::Robot;
use shared::horizon::Horizon;
use shared::params::{Disturbance, Params};
use shared::scenario::Scenario;
use shared::step::Step;

/// A team in one process.
pub struct Team {
    robots: Vec<Robot>,
    /// One for all, or one each where messages get lost between some and not others.
    hearing: Vec<Hearing>,
    steps: Vec<Step>,
    tick: u64,
}

impl Team {
    /// A team at its start positions, before tick 0. `seed` feeds the disturbances.
    pub fn new(scenario: &Scenario, params: &Params, seed: u64) -> Self {
        let layout = Layout::of(scenario, params.model.min_separation);
        Self::of(
            |robot, scenario, params, seed| Robot::among(&layout, robot, scenario, params, seed),
            scenario,
            params,
            seed,
        )
    }

    /// The same team, solving every QP a second time with Clarabel (see [`Self::comparison`]).
    pub fn checked(scenario: &Scenario, params: &Params, seed: u64) -> Self {
        Self::of(Robot::checked, scenario, params, seed)
    }

    fn of(
        build: impl Fn(usize, &Scenario, &Params, u64) -> Robot,
        scenario: &Scenario,
        params: &Params,
        seed: u64,
    ) -> Self {
        let robots = scenario.robots.len();
        let Disturbance { plan_loss, position_loss, .. } = params.disturbance;
        let ears = if plan_loss + position_loss > 0.0 { robots } else { 1 };
        Self {
            robots: (0..robots).map(|robot| build(robot, scenario, params, seed)).collect(),
            hearing: (0..ears).map(|robot| Hearing::new(robot, scenario, &params.disturbance, seed)).collect(),
            steps: Vec::with_capacity(robots),
            tick: 0,
        }
    }

    /// Runs one tick with a horizon for every robot and tells what each did, by robot number.
    pub fn step(&mut self, horizons: impl Fn(usize) -> Horizon) -> &[Step] {
        self.steps.clear();
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let ears = self.hearing.get(index).unwrap_or(&self.hearing[0]);
            self.steps.push(robot.step(self.tick, horizons(index), ears));
        }
        // Jacobi: only now, when everybody has planned, is anybody's plan heard.
        for (robot, step) in self.steps.iter().enumerate() {
            self.hearing.iter_mut().for_each(|ears| ears.hear(self.tick, robot, &step.plan));
        }
        self.tick += 1;
        &self.steps
    }

    /// What solving every QP twice has found, over all robots; `None` unless [`Self::checked`] built this
    /// team, or its controllers have no QP.
    pub fn comparison(&self) -> Option<Comparison> {
        self.robots.iter().filter_map(Robot::comparison).reduce(|mut sum, found| {
            sum.absorb(&found);
            sum
        })
    }

    /// The next tick to run.
    pub fn tick(&self) -> u64 {
        self.tick
    }
}
