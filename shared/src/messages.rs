//! Every payload that crosses a process border. Plain memory (`repr(C)`, no pointers): the reader
//! sees the writer's bytes. Only a type's name and size are compared when a service is opened, so
//! any change of a field needs a new number in its `type_name`.
//!
//! Stamps are nanoseconds of the host's monotonic clock, comparable between its processes.

use iceoryx2::prelude::ZeroCopySend;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::membership::State;
use vodca::prediction::Prediction;
use vodca::step::{Level, Status, Step};
use vodca::{Input, Position};

/// The most robots a team can have (the exchange is measured up to this number).
pub const MAX_ROBOTS: usize = 200;

/// What an [`Announcement`] tells the robots to do. A number rather than an enum: a reader must
/// survive any byte pattern.
pub mod order {
    /// Plan this tick.
    pub const TICK: u32 = 1;
    /// End normally; no report is expected.
    pub const STOP: u32 = 2;
    /// Everybody is there: connect to everybody, then say so.
    pub const MEET: u32 = 3;
    /// A new episode: everybody goes back to its start; `epoch` is the new one.
    pub const EPISODE: u32 = 4;
}

/// What a [`Report`] says.
pub mod kind {
    /// The robot has opened every service. Only `robot`, `pid`, `plan.epoch` and `next_measured` count.
    pub const READY: u32 = 1;
    /// The robot has planned `plan.tick`.
    pub const STEP: u32 = 2;
    /// The robot is connected to every other robot, or at the start of a new episode.
    pub const MET: u32 = 3;
    /// A robot that nobody waits for is there: it can be counted on again.
    pub const HERE: u32 = 4;
}

/// The start of a tick, or the end of the run. Published by the coordinator; valid for `tick` only.
/// In a relayed exchange `plans` plans of tick `tick - 1` follow it. A robot that misses it does
/// nothing: the coordinator will miss its report.
#[repr(C)]
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[type_name("vodca/Announcement/4")]
pub struct Announcement {
    /// Which episode of this run it belongs to, from [`crate::team::FIRST_EPOCH`]; robots ignore older ones.
    pub epoch: u64,
    /// k.
    pub tick: u64,
    /// When it was published, ns.
    pub stamp: u64,
    /// One of [`order`].
    pub order: u32,
    /// How many plans follow (0 in a peer exchange).
    pub plans: u16,
    /// How many robots did not take part in the tick before.
    pub absent: u16,
    /// How many set-points are told here; 0: they are the scenario's.
    pub told_set_points: u64,
    /// Where the absent ones stand, m, by robot; the others' entries mean nothing.
    pub bodies: [[f64; 2]; MAX_ROBOTS],
    /// Set-points, m, by robot; the entries mean nothing while none is told.
    pub set_points: [[f64; 2]; MAX_ROBOTS],
    /// Which life of every robot counts ([`Author::life`]).
    pub lives: [u32; MAX_ROBOTS],
    /// How every robot takes part, a [`State`] as its number.
    pub states: [u8; MAX_ROBOTS],
    /// N_i^k by robot in the announcement of a tick.
    pub horizons: [u8; MAX_ROBOTS],
}

/// Who says something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Author {
    /// Run identity, as in [`Announcement::epoch`].
    pub epoch: u64,
    /// Robot number.
    pub robot: usize,
    /// Which of the processes that have driven this robot, from 1: what an earlier one says does not count.
    pub life: u32,
}

/// A robot's plan of one tick. Published by the robot: in a peer exchange to every other robot, in
/// a relayed one inside its [`Report`]. Valid for the tick after `tick`; a reader without it keeps
/// the older one together with its tick and lets the controller decide.
#[repr(C)]
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[type_name("vodca/Plan/2")]
pub struct Plan {
    /// Run identity, as in [`Announcement::epoch`].
    pub epoch: u64,
    /// k, the tick at which it was computed.
    pub tick: u64,
    /// When it was published, ns.
    pub stamp: u64,
    /// Whose plan, 0-based.
    pub robot: u16,
    /// N_i^k.
    pub horizon: u16,
    /// As in [`Author::life`].
    pub life: u32,
    /// x_i^d as the robot aims at it, m.
    pub set_point: [f64; 2],
    /// Where it looks on its way there, m.
    pub toward: [f64; 2],
    /// x^_i[0..=N|k], m; the rest is meaningless.
    pub states: [[f64; 2]; MAX_HORIZON + 1],
}

/// Stamps of one robot's tick, ns, in the order in which they happen.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ZeroCopySend)]
pub struct Stamps {
    /// The coordinator published the announcement.
    pub announced: u64,
    /// The robot saw it.
    pub woken: u64,
    /// The robot had all plans.
    pub read: u64,
    /// The robot had its own plan.
    pub planned: u64,
    /// The robot published its report; in a peer exchange the others have its plan by then.
    pub reported: u64,
    /// The coordinator took the report; it writes this one itself.
    pub collected: u64,
}

/// What a robot did in a tick. Published by the robot to the coordinator; without it the tick has
/// no end and, past the deadline, the run has none of this robot.
#[repr(C)]
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[type_name("vodca/Report/4")]
pub struct Report {
    /// The plan (its tick and robot are the report's too).
    pub plan: Plan,
    /// One of [`kind`].
    pub kind: u32,
    /// Process that sends it.
    pub pid: u32,
    /// Position at the start of the tick, m, as in [`Step::position`].
    pub position: [f64; 2],
    /// Where the robot measured itself at the start of the tick, m.
    pub measured: [f64; 2],
    /// Input applied, m/s.
    pub input: [f64; 2],
    /// Position at the end of the tick, m, as in [`Step::next_position`].
    pub next_position: [f64; 2],
    /// Where the robot measures itself at the start of the next tick, m; it counts in every kind of report.
    pub next_measured: [f64; 2],
    /// Time before the QP's solvers, ns.
    pub detect_ns: u64,
    /// Time in the QP's solvers, ns.
    pub solve_ns: u64,
    /// Time of the whole step, from having all messages to having moved, ns.
    pub step_ns: u64,
    /// When what happened.
    pub stamps: Stamps,
    /// Collision rows of the QP.
    pub rows: u32,
    /// [`Level`] as its number.
    pub level: u8,
    /// [`Status`] as its number.
    pub status: u8,
    /// 1: the safety filter changed the input.
    pub filtered: u8,
    /// N_i^k as it was asked for; the plan of a fallback may have another.
    pub horizon: u8,
}

/// What a policy is asked at a tick. Published by the coordinator before it announces `tick`; valid
/// for that tick only. A server that misses it misses the tick.
#[repr(C)]
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[type_name("vodca/Observation/1")]
pub struct Observation {
    /// Run identity, as in [`Announcement::epoch`].
    pub epoch: u64,
    /// k, the tick the horizons are wanted for.
    pub tick: u64,
    /// When it was published, ns.
    pub stamp: u64,
    /// Number of robots, n.
    pub robots: u64,
    /// Measured positions at the start of the tick, m; entries beyond n mean nothing.
    pub positions: [[f64; 2]; MAX_ROBOTS],
}

/// What a policy answers. Published by the policy server; valid for `tick` only. The coordinator
/// hands the horizons on with its [`Announcement`]; without them it takes older ones.
#[repr(C)]
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[type_name("vodca/PolicyAnswer/2")]
pub struct PolicyAnswer {
    /// As in the [`Observation`].
    pub epoch: u64,
    /// k, as in the [`Observation`].
    pub tick: u64,
    /// Stamp of the observation that is answered, ns.
    pub asked: u64,
    /// When the server had read it, ns.
    pub read: u64,
    /// When it was answered, ns.
    pub stamp: u64,
    /// One of [`answer`].
    pub kind: u32,
    /// Number of the version that acts, 17 for v000017.
    pub version: u32,
    /// SHA-256 of its file.
    pub sha256: [u8; 32],
    /// N_i^k by robot.
    pub horizons: [u8; MAX_ROBOTS],
    /// The action they were made of, in [-1, 1], by robot: what a learner learns from.
    pub actions: [f32; MAX_ROBOTS],
}

/// What a [`PolicyAnswer`] is.
pub mod answer {
    /// A server has come; no horizons.
    pub const HELLO: u32 = 1;
    /// The horizons of `tick`.
    pub const HORIZONS: u32 = 2;
    /// No model can answer at `tick`.
    pub const NONE: u32 = 3;
    /// What the shadow would have chosen at `tick`.
    pub const SHADOW: u32 = 4;
}

impl Default for Announcement {
    fn default() -> Self {
        Self {
            epoch: 0,
            tick: 0,
            stamp: 0,
            order: 0,
            plans: 0,
            absent: 0,
            told_set_points: 0,
            bodies: [[0.0; 2]; MAX_ROBOTS],
            set_points: [[0.0; 2]; MAX_ROBOTS],
            lives: [0; MAX_ROBOTS],
            states: [0; MAX_ROBOTS],
            horizons: [0; MAX_ROBOTS],
        }
    }
}

impl Announcement {
    /// Who did not take part in the tick before, how, and where it stands, m.
    pub fn absent(&self) -> impl Iterator<Item = (usize, State, Position)> + '_ {
        let all = if self.absent == 0 { 0 } else { MAX_ROBOTS };
        self.states[..all].iter().enumerate().filter_map(|(robot, &number)| {
            let state = State::from_number(number).filter(|state| state.has_stood())?;
            Some((robot, state, Position::from(self.bodies[robot])))
        })
    }
}

impl Announcement {
    /// The set-points that hold from this tick on, m, by robot; none while all are the scenario's.
    pub fn set_points(&self) -> impl Iterator<Item = Position> + '_ {
        let told = self.told_set_points.min(MAX_ROBOTS as u64) as usize;
        self.set_points[..told].iter().map(|&at| Position::from(at))
    }
}

impl PolicyAnswer {
    /// An answer that says nothing yet.
    pub const EMPTY: PolicyAnswer = PolicyAnswer {
        epoch: 0,
        tick: 0,
        asked: 0,
        read: 0,
        stamp: 0,
        kind: 0,
        version: 0,
        sha256: [0; 32],
        horizons: [0; MAX_ROBOTS],
        actions: [0.0; MAX_ROBOTS],
    };

    /// The horizons of `robots` robots; `None` when one is outside 1..=49 (a message is never trusted).
    pub fn horizons(&self, robots: usize) -> Option<Vec<Horizon>> {
        self.horizons.get(..robots)?.iter().map(|&steps| Horizon::new(u64::from(steps)).ok()).collect()
    }
}

impl Plan {
    /// A plan that says nothing.
    pub const EMPTY: Plan = Plan {
        epoch: 0,
        tick: 0,
        stamp: 0,
        robot: 0,
        horizon: 0,
        life: 0,
        set_point: [0.0; 2],
        toward: [0.0; 2],
        states: [[0.0; 2]; MAX_HORIZON + 1],
    };

    /// Puts a prediction into its message.
    pub fn new(author: Author, tick: u64, prediction: &Prediction) -> Self {
        let mut plan = Plan { tick, ..Self::by(author) };
        plan.horizon = prediction.horizon().steps() as u16;
        plan.set_point = prediction.set_point.into();
        plan.toward = prediction.toward.into();
        for (to, from) in plan.states.iter_mut().zip(prediction.states()) {
            *to = (*from).into();
        }
        plan
    }

    /// A plan of `author` that says nothing.
    const fn by(author: Author) -> Self {
        let Author { epoch, robot, life } = author;
        Plan { epoch, robot: robot as u16, life, ..Plan::EMPTY }
    }

    /// The prediction in it; `None` when its horizon is not one (a message is never trusted).
    pub fn prediction(&self) -> Option<Prediction> {
        let horizon = Horizon::new(u64::from(self.horizon)).ok()?;
        let states = |step: usize| Position::from(self.states[step]);
        let prediction = Prediction::from_fn(horizon, states, Position::from(self.set_point));
        Some(prediction.looking(Position::from(self.toward)))
    }
}

impl Report {
    /// A report of nothing but being there ([`kind::READY`], [`kind::MET`], [`kind::HERE`]); `measured` is where the
    /// robot measures itself, m.
    pub fn presence(author: Author, kind: u32, measured: Position) -> Self {
        Report {
            plan: Plan::by(author),
            kind,
            pid: std::process::id(),
            position: [0.0; 2],
            measured: [0.0; 2],
            input: [0.0; 2],
            next_position: [0.0; 2],
            next_measured: measured.into(),
            detect_ns: 0,
            solve_ns: 0,
            step_ns: 0,
            stamps: Stamps::default(),
            rows: 0,
            level: 0,
            status: 0,
            filtered: 0,
            horizon: 0,
        }
    }

    /// Puts what a robot did into its message.
    pub fn step(author: Author, tick: u64, step: &Step) -> Self {
        Report {
            plan: Plan::new(author, tick, &step.plan),
            position: step.position.into(),
            measured: step.measured.into(),
            input: step.input.into(),
            next_position: step.next_position.into(),
            detect_ns: step.detect_ns,
            solve_ns: step.solve_ns,
            step_ns: step.step_ns,
            rows: step.rows,
            level: step.level.number(),
            status: step.status.number(),
            filtered: u8::from(step.filtered),
            horizon: step.horizon.steps() as u8,
            ..Report::presence(author, kind::STEP, step.next_measured)
        }
    }

    /// What the robot did; `None` when the bytes mean nothing (another version, a broken writer).
    pub fn to_step(&self) -> Option<Step> {
        let plan = self.plan.prediction()?;
        Some(Step {
            position: Position::from(self.position),
            measured: Position::from(self.measured),
            input: Input::from(self.input),
            next_position: Position::from(self.next_position),
            next_measured: Position::from(self.next_measured),
            horizon: Horizon::new(u64::from(self.horizon)).ok()?,
            rows: self.rows,
            level: Level::from_number(self.level)?,
            status: Status::from_number(self.status)?,
            filtered: self.filtered == 1,
            plan,
            detect_ns: self.detect_ns,
            solve_ns: self.solve_ns,
            step_ns: self.step_ns,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AUTHOR: Author = Author { epoch: 7, robot: 13, life: 2 };

    fn some_step() -> Step {
        let states = [Position::new(1.0, -0.1), Position::new(1.1, 0.2), Position::new(1.0 / 3.0, 0.7)];
        Step {
            position: states[0],
            measured: states[0] * 1.001,
            input: Input::new(0.5, 1.5),
            next_position: states[1],
            next_measured: states[1] * 0.999,
            horizon: Horizon::saturating(30), // a fallback's plan is shorter than what was asked for
            rows: 3,
            level: Level::Clarabel,
            status: Status::Relaxed,
            filtered: true,
            plan: Prediction::from_states(&states, Position::new(9.0, -9.0)),
            detect_ns: 987,
            solve_ns: 1234,
            step_ns: 5678,
        }
    }

    #[test]
    fn a_step_survives_the_journey_unchanged() {
        let step = some_step();
        let report = Report::step(AUTHOR, 42, &step);
        let Plan { epoch, tick, robot, life, .. } = report.plan;
        assert_eq!((epoch, tick, robot, life), (7, 42, 13, 2));
        assert_eq!(report.to_step(), Some(step));
    }

    #[test]
    fn bytes_that_mean_nothing_are_refused() {
        let good = Report::step(AUTHOR, 2, &some_step());
        let spoilt = |spoil: fn(&mut Report)| {
            let mut report = good;
            spoil(&mut report);
            report.to_step()
        };
        assert_eq!(spoilt(|r| r.plan.horizon = 0), None);
        assert_eq!(spoilt(|r| r.plan.horizon = 50), None);
        assert_eq!(spoilt(|r| r.horizon = 0), None);
        assert_eq!(spoilt(|r| r.level = 9), None);
        assert_eq!(spoilt(|r| r.status = 7), None);
    }

    #[test]
    fn who_is_absent_is_told_and_numbers_that_mean_nothing_are_not() {
        let mut announcement = Announcement { absent: 2, ..Announcement::default() };
        announcement.states[..4].copy_from_slice(&[
            State::Driving.number(),
            State::Lost.number(),
            77,
            State::Back.number(),
        ]);
        announcement.bodies[1] = [1.0, -2.0];
        let told: Vec<_> = announcement.absent().collect();
        assert_eq!(told, [(1, State::Lost, Position::new(1.0, -2.0)), (3, State::Back, Position::zeros())]);
        assert_eq!(announcement.set_points().count(), 0);
        announcement.set_points[1] = [3.0, 4.0];
        for (told, expected) in [(2, 2), (u64::MAX, MAX_ROBOTS)] {
            announcement.told_set_points = told;
            assert_eq!(announcement.set_points().count(), expected);
            assert_eq!(announcement.set_points().nth(1), Some(Position::new(3.0, 4.0)));
        }
        announcement.absent = 0;
        assert_eq!(announcement.absent().count(), 0);
    }

    #[test]
    fn payloads_have_no_hidden_padding() {
        assert_eq!(size_of::<Announcement>(), 3 * 8 + 8 + 8 + MAX_ROBOTS * (16 + 16 + 4 + 1 + 1));
        assert_eq!(size_of::<Observation>(), 4 * 8 + MAX_ROBOTS * 16);
        assert_eq!(size_of::<PolicyAnswer>(), 5 * 8 + 2 * 4 + 32 + 5 * MAX_ROBOTS);
        assert_eq!(size_of::<Plan>(), 3 * 8 + 2 * 4 + 2 * 16 + 50 * 16);
        assert_eq!(size_of::<Report>(), size_of::<Plan>() + 8 + 80 + 3 * 8 + 6 * 8 + 8);
    }
}
