//! All robots of a team in one process: the same controllers, the same exchange by tick number, no
//! processes. Golden tests, sweeps and replays stand on it; agent processes give the same bytes.

use crate::Position;
use crate::controller::Neighbour;
use crate::horizon::Horizon;
use crate::layout::Layout;
use crate::membership::State;
use crate::mpc::cross_check::Comparison;
use crate::neighbour_estimates::NeighbourEstimates;
use crate::params::{Disturbance, Model, Params};
use crate::play::Playable;
use crate::robot::Robot;
use crate::scenario::Scenario;
use crate::step::{Status, Step};
use crate::tasks::Assignment;
use std::convert::Infallible;
use std::sync::Arc;

/// A team in one process.
pub struct Team {
    robots: Vec<Robot>,
    /// One for all, or one each where messages get lost between some and not others.
    hearing: Vec<NeighbourEstimates>,
    steps: Vec<Step>,
    measured: Vec<Position>,
    tick: u64,
    scenario: Scenario,
    model: Model,
    /// Where lost robots stand as everybody's layout has it, m, by robot number; empty: nobody was ever lost.
    lost: Vec<Option<Position>>,
}

/// How a robot takes part in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attendance {
    /// What everybody is told of it when the tick begins.
    pub announced: State,
    /// `None`: it takes part. Otherwise why it does not: [`Status::Late`] or [`Status::Lost`].
    pub missing: Option<Status>,
}

impl Team {
    /// A team at its start positions, before tick 0. `seed` feeds the disturbances.
    pub fn new(scenario: &Scenario, params: &Params, seed: u64) -> Self {
        Self::built(Robot::new, scenario, params, seed)
    }

    /// The same team, solving every QP a second time with Clarabel (see [`Self::comparison`]).
    pub fn checked(scenario: &Scenario, params: &Params, seed: u64) -> Self {
        Self::built(Robot::checked, scenario, params, seed)
    }

    fn built(
        build: impl Fn(usize, &Scenario, &Params, &Arc<Layout>, u64) -> Robot,
        scenario: &Scenario,
        params: &Params,
        seed: u64,
    ) -> Self {
        let layout = Arc::new(Layout::of(scenario, &params.model));
        let robots = (0..scenario.robots.len()).map(|robot| build(robot, scenario, params, &layout, seed)).collect();
        Self::of(robots, scenario, params, seed)
    }

    /// A team of `robots` with bodies and controllers of any kind, by robot number, before tick 0; what they
    /// hear of each other is disturbed as `params` say.
    pub fn of(robots: Vec<Robot>, scenario: &Scenario, params: &Params, seed: u64) -> Self {
        let Disturbance { plan_loss, position_loss, .. } = params.disturbance;
        let listeners = if plan_loss + position_loss > 0.0 { robots.len() } else { 1 };
        Self {
            hearing: (0..listeners)
                .map(|robot| NeighbourEstimates::new(robot, scenario, &params.disturbance, seed))
                .collect(),
            steps: Vec::with_capacity(robots.len()),
            measured: robots.iter().map(Robot::measured).collect(),
            robots,
            tick: 0,
            scenario: scenario.clone(),
            model: params.model.clone(),
            lost: Vec::new(),
        }
    }

    /// Runs one tick with a horizon for every robot and tells what each did, by robot number.
    pub fn step(&mut self, horizons: &[Horizon]) -> &[Step] {
        self.steps.clear();
        for (index, (robot, &horizon)) in self.robots.iter_mut().zip(horizons).enumerate() {
            let hearing = self.hearing.get(index).unwrap_or(&self.hearing[0]);
            self.steps.push(robot.step(self.tick, horizon, hearing));
        }
        // Jacobi: only now, when everybody has planned, is anybody's plan heard.
        for (robot, step) in self.steps.iter().enumerate() {
            self.hearing.iter_mut().for_each(|hearing| hearing.hear(self.tick, robot, &step.plan));
            self.measured[robot] = step.next_measured;
        }
        self.tick += 1;
        &self.steps
    }

    /// [`Self::step`] of a team of which somebody misses the tick, or has missed the one before; `roll` is by robot
    /// number.
    pub fn step_without(&mut self, horizons: &[Horizon], roll: &[Attendance]) -> &[Step] {
        let robots = self.robots.len();
        if self.hearing.len() < robots {
            self.hearing = (0..robots).map(|robot| self.hearing[0].for_listener(robot)).collect();
        }
        self.begin(roll);
        self.steps.clear();
        for (robot, &horizon) in horizons.iter().enumerate().take(robots) {
            let missing = roll.get(robot).and_then(|attendance| attendance.missing);
            self.steps.push(match missing {
                None => self.robots[robot].step(self.tick, horizon, &self.hearing[robot]),
                Some(status) => {
                    self.robots[robot].stand(self.tick, horizon, self.scenario.robots[robot].set_point, status)
                }
            });
        }
        for (robot, step) in self.steps.iter().enumerate() {
            if step.status.took_part() {
                self.hearing.iter_mut().for_each(|hearing| hearing.hear(self.tick, robot, &step.plan));
            }
            self.measured[robot] = step.next_measured;
        }
        self.tick += 1;
        &self.steps
    }

    /// What is announced with this tick: who is back begins anew, everybody learns who stands where.
    fn begin(&mut self, roll: &[Attendance]) {
        let at: Vec<Position> = self.robots.iter().map(Robot::place).collect();
        let of = |robot: usize, state| roll.get(robot).is_some_and(|attendance| attendance.announced == state);
        let lost: Vec<_> = (0..at.len()).map(|robot| of(robot, State::Lost).then_some(at[robot])).collect();
        if lost != self.lost && (!self.lost.is_empty() || lost.iter().any(Option::is_some)) {
            self.lost = lost;
            self.lay_out();
        }
        for robot in (0..at.len()).filter(|&robot| of(robot, State::Back)) {
            self.hearing[robot].restart(self.tick);
            self.robots[robot].restart(self.tick, at[robot]);
        }
        for (robot, attendance) in roll.iter().enumerate().filter(|(_, attendance)| attendance.announced.has_stood()) {
            for hearing in &mut self.hearing {
                hearing.note_absent(self.tick, robot, attendance.announced, at[robot]);
            }
        }
    }

    /// From the next tick on the set-points of `assignments` hold.
    pub fn assign(&mut self, assignments: &[Assignment]) {
        for &Assignment { robot, set_point, .. } in assignments {
            self.scenario.robots[robot].set_point = set_point;
        }
        if !assignments.is_empty() {
            self.lay_out();
        }
    }

    /// Everybody learns the set-points of now, and where lost robots stand.
    fn lay_out(&mut self) {
        let layout = Arc::new(Layout::with_lost(&self.scenario, &self.model, &self.lost));
        self.robots.iter_mut().for_each(|robot| robot.lay_out(&layout));
    }

    /// Where every robot measures itself at the start of the next tick, m, by robot number.
    pub fn measured(&self) -> &[Position] {
        &self.measured
    }

    /// What `robot` has heard of everybody when the next tick begins, by robot number.
    pub fn heard_by(&self, robot: usize) -> &[Neighbour] {
        self.hearing.get(robot).unwrap_or(&self.hearing[0]).neighbours()
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

impl Playable for Team {
    type Error = Infallible;

    fn measured(&self) -> &[Position] {
        &self.measured
    }

    fn tick(&mut self, _: u64, horizons: &[Horizon]) -> Result<(), Infallible> {
        self.step(horizons);
        Ok(())
    }

    fn steps(&self) -> &[Step] {
        &self.steps
    }
}
