//! Who takes part in a run, where everybody's body is, what became of those who do not take part, and who comes back.

use crate::run::OnLoss;
use serde::{Deserialize, Serialize};
use shared::messages::Report;
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::membership::{Membership, State, Verdict};
use vodca::scenario::Scenario;

/// Something that changed in a team: a line of `membership.csv`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// The first tick that the robot misses, or in which it takes part again.
    pub tick: u64,
    /// Its number.
    pub robot: usize,
    /// What it is from then on: late, lost or back.
    pub state: State,
    /// Which of its processes this is about, from 1.
    pub life: u32,
    /// How it came about, and the last thing that the robot said.
    pub why: String,
}

/// A process that was started in place of one that has ended, or by hand.
#[derive(Clone, Copy, Debug)]
struct Return {
    /// The first tick at which it may be there.
    due: u64,
    /// Which life it is; `None`: it has not been heard of.
    life: Option<u32>,
    /// The tick with which it begins: one later than it was there, so that it has everybody's plans.
    joins: Option<u64>,
}

/// The members of a run of processes.
#[derive(Debug)]
pub struct Members {
    membership: Membership,
    bodies: Vec<Position>,
    changes: Vec<Change>,
    /// How many of them are in their final order.
    ordered: usize,
    /// Since when a robot has answered nothing.
    silent_since: Vec<Option<Instant>>,
    /// When a robot that was stopped on purpose goes on; it is heard in that tick.
    paused_until: Vec<Option<u64>>,
    returns: Vec<Option<Return>>,
    restarts: Vec<u32>,
}

impl Members {
    /// The team of `scenario`, of which nobody is there yet.
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let robots = scenario.robots.len();
        Self {
            membership: Membership::new(robots),
            bodies: scenario.robots.iter().map(|robot| robot.start).collect(),
            changes: Vec::new(),
            ordered: 0,
            silent_since: vec![None; robots],
            paused_until: vec![None; robots],
            returns: vec![None; robots],
            restarts: vec![0; robots],
        }
    }

    /// Who takes part.
    pub fn membership(&self) -> &Membership {
        &self.membership
    }

    /// All that has changed so far.
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }

    /// Where everybody's body is at the start of the tick that comes, m, by robot number.
    pub fn bodies(&self) -> &[Position] {
        &self.bodies
    }

    /// From now on everybody has to answer once more.
    pub(crate) fn expect_all(&mut self) {
        self.membership.expect_all();
    }

    /// Takes note that everybody's process is there for the first time (`report` says so), or of an answer between two
    /// episodes; `false`: it had answered.
    pub(crate) fn answers(&mut self, robot: usize, report: &Report) -> bool {
        if self.membership.state(robot) == State::Expected {
            self.membership.join(robot, report.plan.life, 0);
        }
        report.plan.life == self.membership.members()[robot].life && self.membership.answer(robot)
    }

    /// How many answers are missing, those included that are waited for because they were held up on purpose.
    pub(crate) fn missing(&self) -> usize {
        self.membership.missing() + self.held_up().count()
    }

    /// Robots that come out of a fault on purpose in this tick: when they are heard again does not depend on time.
    fn held_up(&self) -> impl Iterator<Item = usize> + '_ {
        let due = |until: &Option<u64>| until.is_some_and(|until| until <= self.membership.tick());
        let late = |robot: &usize| self.membership.state(*robot) == State::Late;
        (0..self.bodies.len()).filter(move |robot| late(robot) && due(&self.paused_until[*robot]))
    }

    /// The first robot whose answer is missing.
    pub(crate) fn first_missing(&self) -> Option<usize> {
        self.membership.first_missing()
    }

    /// Tick `tick` is about to be announced.
    pub(crate) fn begin(&mut self, tick: u64) {
        self.membership.begin(tick);
    }

    /// `robot` says something in a tick: what it did (`step` is its tick), or that it is there. `true`: it counts.
    pub(crate) fn hear(&mut self, robot: usize, life: u32, step: Option<u64>) -> bool {
        // Something said long ago must not end a fault on purpose before its time.
        if self.paused_until[robot].is_some_and(|until| self.membership.tick() < until) {
            return false;
        }
        match self.membership.hear(robot, life, step) {
            Verdict::Counts => true,
            Verdict::SignOfLife => {
                self.silent_since[robot] = None;
                self.paused_until[robot] = None;
                self.push(robot, State::Back, "was heard again".into());
                false
            }
            Verdict::Nothing => false,
        }
    }

    /// A process says that it is life `life` of `robot`.
    pub(crate) fn newcomer(&mut self, robot: usize, life: u32) {
        let member = self.membership.members()[robot];
        if member.state != State::Lost || life <= member.life {
            return;
        }
        let due = self.membership.tick();
        let coming = self.returns[robot].get_or_insert(Return { due, life: None, joins: None });
        coming.life.get_or_insert(life);
    }

    /// `robot` has not answered in time, or will not; `until`: the tick at which a fault on purpose ends.
    pub(crate) fn miss(&mut self, robot: usize, until: Option<u64>, why: &str) {
        if self.membership.miss(robot) {
            self.silent_since[robot] = Some(Instant::now());
            self.paused_until[robot] = until;
            self.push(robot, State::Late, why.into());
        }
    }

    /// The process of `robot` has ended; `tick` is the first one that it misses.
    pub(crate) fn lose(&mut self, robot: usize, tick: u64, why: String) {
        self.silent_since[robot] = None;
        self.paused_until[robot] = None;
        self.returns[robot] = None;
        // It was heard, but did not live to begin again.
        if let Some(last) = self.changes.iter().rposition(|change| change.robot == robot)
            && self.changes[last].state == State::Back
            && self.changes[last].tick > tick
        {
            self.changes.remove(last);
        }
        if self.membership.lose(robot, tick) {
            self.push(robot, State::Lost, why);
        }
    }

    /// Whether `robot`, which was lost at `tick`, is started anew; then it is due some ticks later, twice as many every
    /// time.
    pub(crate) fn restart(&mut self, robot: usize, tick: u64, on_loss: OnLoss) -> bool {
        let OnLoss::Continue { respawn } = on_loss else { return false };
        let again = self.restarts[robot] < respawn;
        if again {
            let back_off = 1 << self.restarts[robot].min(16);
            self.returns[robot] = Some(Return { due: tick + back_off, life: None, joins: None });
            self.restarts[robot] += 1;
        }
        again
    }

    /// Robots that are due before tick `tick` is announced, and have not been heard of.
    pub(crate) fn overdue(&self, tick: u64) -> Option<usize> {
        let is_overdue = |coming: &Return| coming.due <= tick && coming.life.is_none();
        self.returns.iter().position(|coming| coming.as_ref().is_some_and(is_overdue))
    }

    /// Admits those who begin with tick `tick`, and lets those who are there begin with the next one.
    pub(crate) fn admit(&mut self, tick: u64) {
        for robot in 0..self.bodies.len() {
            let Some(Return { due, life: Some(life), joins }) = self.returns[robot] else { continue };
            if joins.is_some_and(|joins| joins <= tick) {
                self.returns[robot] = None;
                if self.membership.join(robot, life, tick) {
                    self.push(robot, State::Back, format!("was started anew, life {life}"));
                }
            } else if joins.is_none() && due <= tick {
                self.returns[robot] = Some(Return { due, life: Some(life), joins: Some(tick + 1) });
            }
        }
    }

    /// A robot that has been silent for longer than `limit`, and for how long.
    pub(crate) fn silent_for(&self, limit: Duration) -> Option<(usize, Duration)> {
        let silent = |robot: usize| self.silent_since[robot].filter(|_| self.paused_until[robot].is_none());
        (0..self.bodies.len()).find_map(|robot| {
            let silence = silent(robot)?.elapsed();
            (silence > limit).then_some((robot, silence))
        })
    }

    /// Whether somebody is late, and not on purpose.
    pub(crate) fn somebody_is_late(&self) -> bool {
        let late = |robot: usize| self.membership.state(robot) == State::Late && self.paused_until[robot].is_none();
        (0..self.bodies.len()).any(late)
    }

    /// Whether somebody is lost and comes back.
    pub(crate) fn awaits_somebody(&self) -> bool {
        self.returns.iter().any(Option::is_some) || self.membership.count(State::Back) > 0
    }

    /// A robot that was held up on purpose has not been heard: it is late like any other.
    pub(crate) fn give_up_waiting(&mut self) {
        let held_up: Vec<usize> = self.held_up().collect();
        held_up.into_iter().for_each(|robot| self.paused_until[robot] = None);
    }

    /// Robots whose pause ends with tick `tick`.
    pub(crate) fn resumes(&self, tick: u64) -> impl Iterator<Item = usize> + '_ {
        (0..self.bodies.len()).filter(move |&robot| self.paused_until[robot] == Some(tick))
    }

    /// Robots that are stopped or held up on purpose.
    pub(crate) fn paused(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.bodies.len()).filter(|&robot| self.paused_until[robot].is_some())
    }

    /// Where the body of `robot` is after this tick, m.
    pub(crate) fn moved(&mut self, robot: usize, to: Position) {
        self.bodies[robot] = to;
    }

    /// The tick is over.
    pub(crate) fn end(&mut self) {
        self.membership.end();
        // In which order things happened within a tick depends on time.
        self.changes[self.ordered..].sort_by_key(|change| change.robot);
        self.ordered = self.changes.len();
    }

    fn push(&mut self, robot: usize, state: State, why: String) {
        let member = self.membership.members()[robot];
        self.changes.push(Change { tick: member.since, robot, state, life: member.life, why });
    }
}
