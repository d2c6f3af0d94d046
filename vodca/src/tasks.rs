//! Set-points at run time: who drives where next, once it has arrived.
//!
//! [`Tasks`] decides at the start of a tick from where everybody measures itself then, and from nothing else: the same
//! seed and the same orders give the same run. Separation does not depend on set-points (the cells keep it), so a new one
//! may be given at any tick.

use crate::Position;
use crate::params::Params;
use crate::random::{self, Use};
use crate::scenario::{Scenario, ScenarioError};
use std::collections::VecDeque;

/// How often a random set-point is drawn before its robot waits for the next tick.
const DRAWS: u64 = 100;
/// Random set-points are this many separations apart, so that robots that stand there can be passed.
const SPACING: f64 = 2.0;

/// One drive of one robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Which robot, 0-based.
    pub robot: usize,
    /// Where it shall go, m.
    pub set_point: Position,
    /// The first tick at which it may set out.
    pub after: u64,
}

/// A set-point that holds from a tick on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assignment {
    /// The first tick that is planned with it.
    pub tick: u64,
    /// Whose, 0-based.
    pub robot: usize,
    /// Where it is, m.
    pub set_point: Position,
}

/// What a robot does that has arrived and has no task left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    /// It stays; when all do, the run is over.
    Stay,
    /// It stays, and the run goes on: somebody may send it elsewhere.
    Wait,
    /// It drives to a place drawn from this seed, without end: within the rectangle round all starts and set-points, two
    /// separations from all other set-points.
    Random(u64),
}

/// Gives every robot that has arrived its next set-point.
#[derive(Clone, Debug)]
pub struct Tasks {
    /// The layout with the set-points of now.
    scenario: Scenario,
    min_separation: f64,
    arrival_tolerance: f64,
    /// What every robot has still to do, by robot number.
    waiting: Vec<VecDeque<Task>>,
    then: Then,
}

impl Tasks {
    /// The team of `scenario` with nothing to do but what the scenario says. `params` give the separation and when a
    /// robot has arrived.
    pub fn new(scenario: &Scenario, params: &Params) -> Self {
        let robots = scenario.robots.len();
        Self {
            scenario: scenario.clone(),
            min_separation: params.model.min_separation,
            arrival_tolerance: params.episode.arrival_tolerance,
            waiting: vec![VecDeque::new(); robots],
            then: Then::Stay,
        }
    }

    /// The same, but that who has no task left does as `then` says.
    #[must_use]
    pub fn then(self, then: Then) -> Self {
        Self { then, ..self }
    }

    /// Whether the run is never over by itself.
    pub fn is_endless(&self) -> bool {
        self.then != Then::Stay
    }

    /// Adds what `robot` does when it has done everything else.
    pub fn add(&mut self, task: Task) {
        self.waiting[task.robot].push_back(task);
    }

    /// Whether somebody has something left to do; `takes_part` says who counts.
    pub fn is_pending(&self, takes_part: impl Fn(usize) -> bool) -> bool {
        let left = |robot: usize| self.is_endless() || !self.waiting[robot].is_empty();
        (0..self.waiting.len()).any(|robot| takes_part(robot) && left(robot))
    }

    /// The layout with the set-points of now.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Sends `robot` to `set_point` (m) at once, wherever it is; what it had still to do comes afterwards.
    ///
    /// # Errors
    /// A place that is too near to another set-point or to something that stands, or that cannot be reached.
    pub fn redirect(&mut self, robot: usize, set_point: Position) -> Result<(), ScenarioError> {
        self.scenario = self.scenario.with_set_points(&[(robot, set_point)], self.min_separation)?;
        Ok(())
    }

    /// Who drives where from tick `tick` on. `measured`: where everybody is then, m, by robot number; `takes_part` says
    /// who counts. All who are due set out together if their new places go together, as in an exchange of two places;
    /// otherwise one after the other, and whose place another one still holds waits.
    pub fn assign(&mut self, tick: u64, measured: &[Position], takes_part: impl Fn(usize) -> bool) -> Vec<Assignment> {
        let has_arrived =
            |robot: usize| (self.scenario.robots[robot].set_point - measured[robot]).norm() < self.arrival_tolerance;
        let free: Vec<usize> = (0..measured.len()).filter(|&robot| takes_part(robot) && has_arrived(robot)).collect();
        let is_due = |task: &&Task| task.after <= tick;
        let due: Vec<(usize, Position)> = free
            .iter()
            .filter_map(|&robot| self.waiting[robot].front().filter(is_due).map(|task| (robot, task.set_point)))
            .collect();
        let mut given = Vec::new();
        if let Some(together) = self.fitting(&due) {
            self.scenario = together;
            given.clone_from(&due);
        } else {
            for one in due {
                if let Some(alone) = self.fitting(&[one]) {
                    self.scenario = alone;
                    given.push(one);
                }
            }
        }
        for (robot, _) in &given {
            self.waiting[*robot].pop_front();
        }
        for robot in free {
            if let Then::Random(seed) = self.then
                && self.waiting[robot].is_empty()
                && given.iter().all(|(other, _)| *other != robot)
                && let Some((place, scenario)) = self.draw(seed, tick, robot)
            {
                self.scenario = scenario;
                given.push((robot, place));
            }
        }
        given.into_iter().map(|(robot, set_point)| Assignment { tick, robot, set_point }).collect()
    }

    /// The layout with these set-points, if it is one.
    fn fitting(&self, set_points: &[(usize, Position)]) -> Option<Scenario> {
        if set_points.is_empty() {
            return None;
        }
        self.scenario.with_set_points(set_points, self.min_separation).ok()
    }

    fn draw(&self, seed: u64, tick: u64, robot: usize) -> Option<(Position, Scenario)> {
        let half = Position::repeat(self.min_separation / 2.0);
        let [low, high] = self.scenario.bounds(self.min_separation);
        let room = (high - half) - (low + half);
        let mut generator = random::stream(seed, Use::Task, robot as u64, tick);
        let others = || self.scenario.robots.iter().enumerate().filter(|(other, _)| *other != robot);
        (0..DRAWS).find_map(|_| {
            let share = Position::new(random::unit(&mut generator), random::unit(&mut generator));
            let place = low + half + room.component_mul(&share);
            let spaced = |at: Position| (at - place).norm() >= SPACING * self.min_separation;
            if !others().all(|(_, other)| spaced(other.set_point)) {
                return None;
            }
            Some((place, self.fitting(&[(robot, place)])?))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn team() -> (Scenario, Params) {
        (Scenario::resolve(Some("ring:6"), None).unwrap(), Params::safe())
    }

    fn at_set_points(tasks: &Tasks) -> Vec<Position> {
        tasks.scenario().robots.iter().map(|robot| robot.set_point).collect()
    }

    #[test]
    fn nobody_is_sent_on_before_it_has_arrived_and_its_time_has_come() {
        let (scenario, params) = team();
        let mut tasks = Tasks::new(&scenario, &params);
        let set_point = Position::new(0.5, -0.25);
        tasks.add(Task { robot: 2, set_point, after: 7 });
        let starts: Vec<Position> = scenario.robots.iter().map(|robot| robot.start).collect();
        assert!(tasks.is_pending(|_| true) && !tasks.is_pending(|robot| robot != 2));
        assert_eq!(tasks.assign(9, &starts, |_| true), []);
        let there = at_set_points(&tasks);
        assert_eq!(tasks.assign(6, &there, |_| true), []);
        assert_eq!(tasks.assign(7, &there, |robot| robot != 2), []);
        assert_eq!(tasks.assign(7, &there, |_| true), [Assignment { tick: 7, robot: 2, set_point }]);
        assert!(!tasks.is_pending(|_| true));
        assert_eq!(at_set_points(&tasks)[2], set_point);
    }

    #[test]
    fn two_exchange_their_places_at_once_and_a_taken_place_is_waited_for() {
        let (scenario, params) = team();
        let mut tasks = Tasks::new(&scenario, &params);
        let there = at_set_points(&tasks);
        tasks.add(Task { robot: 0, set_point: there[1], after: 0 });
        assert_eq!(tasks.assign(0, &there, |_| true), [], "robot 1 stands there");
        tasks.add(Task { robot: 1, set_point: there[0], after: 3 });
        assert_eq!(tasks.assign(2, &there, |_| true), []);
        let robots: Vec<usize> = tasks.assign(3, &there, |_| true).iter().map(|given| given.robot).collect();
        assert_eq!(robots, [0, 1]);
        assert_eq!(at_set_points(&tasks)[..2], [there[1], there[0]]);
    }

    #[test]
    fn random_tasks_never_end_repeat_with_their_seed_and_leave_room() {
        let (scenario, params) = team();
        let play = |seed| {
            let mut tasks = Tasks::new(&scenario, &params).then(Then::Random(seed));
            let mut all = Vec::new();
            for tick in 0..50 {
                let there = at_set_points(&tasks);
                all.extend(tasks.assign(tick, &there, |robot| robot != 4));
                let now = at_set_points(&tasks);
                for (i, a) in now.iter().enumerate() {
                    assert!(now[..i].iter().all(|b| (a - b).norm() >= params.model.min_separation), "{now:?}");
                }
            }
            assert!(tasks.is_pending(|_| true));
            all
        };
        let once = play(3);
        assert!(once.len() > 200 && once.iter().all(|given| given.robot != 4), "{}", once.len());
        assert_eq!(once, play(3));
        assert_ne!(once, play(4));
    }

    #[test]
    fn a_place_that_nobody_can_have_is_refused_with_its_reason() {
        let (scenario, params) = team();
        let mut tasks = Tasks::new(&scenario, &params);
        let there = at_set_points(&tasks);
        let message = tasks.redirect(0, there[1] + Position::new(0.2, 0.0)).unwrap_err().to_string();
        assert!(message.contains("set-point of") && message.contains("0.2000 m"), "{message}");
        assert_eq!(at_set_points(&tasks), there);
        tasks.redirect(0, Position::new(0.0, 0.0)).unwrap();
        assert_eq!(at_set_points(&tasks)[0], Position::new(0.0, 0.0));
    }
}
