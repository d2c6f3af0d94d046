//! How robots and the coordinator exchange plans: two forms behind one trait, byte-identical runs.
//!
//! * [`Kind::Peer`]: every robot publishes its plan to every other robot; announcements and reports
//!   are only the clock. Truly decentralised; connections grow with the square of the team.
//! * [`Kind::Relay`]: robots send their plan to the coordinator only (it is part of the report), and
//!   the next announcement brings all plans in one frame.
//!
//! *Invariant*: plans are selected by tick number, never "the latest": with 14 robots half of all
//! latest plans already belong to the current tick.

mod coordinator_port;
mod peer;
mod relay;

pub use coordinator_port::{CoordinatorPort, TeamNow};

use crate::messages::{Announcement, Report, order};
use crate::os;
use crate::runtime_dir::RuntimeDir;
use crate::services::{ServiceError, Services};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::membership::State;
use vodca::prediction::Prediction;

/// The form of the exchange.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Every robot to every robot.
    Peer,
    /// Through the coordinator, one frame per tick.
    Relay,
}

impl Kind {
    /// The default for a team of `robots`: up to 20 robots the connections between all pairs cost little.
    pub fn default_for(robots: usize) -> Self {
        if robots <= 20 { Kind::Peer } else { Kind::Relay }
    }
}

/// What the coordinator wants next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Plan tick `tick`; all plans of `tick - 1` that exist have been heard.
    Tick {
        /// k.
        tick: u64,
        /// N_i^k; `None`: what came is no horizon.
        horizon: Option<Horizon>,
        /// When it was announced, ns.
        announced: u64,
        /// When this robot saw it, ns.
        woken: u64,
    },
    /// Everybody is there and connected now: say so.
    Meet,
    /// A new episode: go back to its start and say so.
    Episode {
        /// Its epoch.
        epoch: u64,
    },
    /// Nobody waits for this robot in the tick that begins, for it has missed one: say that it is there.
    Speak,
    /// The run goes on without this process: it has not been admitted yet.
    NotYet {
        /// Another process drives the robot.
        taken: bool,
    },
    /// Another process drives this robot, or it was given up: end.
    Superseded,
    /// End normally.
    Stop,
}

/// What is told before an [`Order::Tick`] is given.
#[derive(Clone, Copy, Debug)]
pub enum News<'a> {
    /// The plan that robot `sender` computed at `tick`.
    Plan {
        /// Whose.
        sender: usize,
        /// k - 1.
        tick: u64,
        /// What it plans.
        plan: &'a Prediction,
    },
    /// Robot `robot` stood during the tick before, whatever was heard of it. This comes after all plans, and of this
    /// robot itself, too: it begins anew then.
    Absent {
        /// Which robot.
        robot: usize,
        /// How it takes part now.
        state: State,
        /// Where it stands, m.
        at: Position,
    },
    /// The set-points that hold from this tick on, m, by robot number. Not told while all are the scenario's.
    SetPoints(&'a [Position]),
}

/// What is told the news.
pub type Hear<'a> = dyn FnMut(News<'_>) + 'a;

/// A robot's side of the exchange.
pub trait Exchange {
    /// Which life this process is ([`crate::messages::Author::life`]).
    fn life(&self) -> u32;

    /// Waits up to `limit` for the next order and hands the news of the tick before to `hear`.
    /// `None`: nothing was announced (a signal ends the wait early).
    fn next_order(&mut self, limit: Duration, hear: &mut Hear<'_>) -> Result<Option<Order>, ServiceError>;

    /// Publishes what this robot did; in a peer exchange its plan goes to the others first, so that
    /// every plan of a tick is there before the tick has ended for anybody. Sets
    /// [`crate::messages::Stamps::reported`].
    fn publish(&mut self, report: Report) -> Result<(), ServiceError>;
}

/// Opens robot `robot`'s side of the exchange of a run.
pub fn open(
    kind: Kind,
    place: &RuntimeDir,
    robots: usize,
    robot: usize,
    epoch: u64,
) -> Result<Box<dyn Exchange>, ServiceError> {
    let services = Services::open(place, robots, kind == Kind::Peer)?;
    let life = services.next_life(robot);
    let clock = Clock {
        announcements: services.announcements()?,
        robot,
        epoch,
        life,
        next_tick: 0,
        absent: Vec::new(),
        set_points: Vec::new(),
    };
    let reporter = services.reporter()?;
    Ok(match services.plans()? {
        Some((sender, receiver)) => Box::new(peer::Peer::new(clock, reporter, sender, receiver, robots)),
        None => Box::new(relay::Relay::new(clock, reporter)),
    })
}

/// What both forms share: announcements in order, each tick once.
struct Clock {
    announcements: crate::services::Announcements,
    robot: usize,
    epoch: u64,
    life: u32,
    next_tick: u64,
    /// Who stood during the tick before the announced one.
    absent: Vec<(usize, State, Position)>,
    /// The set-points that were announced, m; none: they are the scenario's.
    set_points: Vec<Position>,
}

impl Clock {
    /// Tells `hear` who stood, and where everybody goes.
    fn tell_team(&self, hear: &mut Hear<'_>) {
        if !self.set_points.is_empty() {
            hear(News::SetPoints(&self.set_points));
        }
        for &(robot, state, at) in &self.absent {
            hear(News::Absent { robot, state, at });
        }
    }

    /// Waits up to `limit` for the next announcement that counts and lets `frame` see its plans.
    fn next(
        &mut self,
        limit: Duration,
        mut frame: impl FnMut(&Announcement, &[crate::messages::Plan]),
    ) -> Result<Option<Order>, ServiceError> {
        let mut waited = false;
        loop {
            let (robot, epoch, life, next_tick) = (self.robot, self.epoch, self.life, self.next_tick);
            let (absent, set_points) = (&mut self.absent, &mut self.set_points);
            let received = self.announcements.receive(|announcement, plans| {
                if announcement.epoch < epoch {
                    return None;
                }
                let counts = announcement.lives[robot];
                let woken = os::now_ns();
                match announcement.order {
                    order::TICK if counts < life => {
                        let taken = announcement.states[robot] != State::Lost.number();
                        Some(Order::NotYet { taken })
                    }
                    order::TICK if counts > life => Some(Order::Superseded),
                    order::TICK if announcement.tick >= next_tick => {
                        match State::from_number(announcement.states[robot]) {
                            Some(State::Late) => return Some(Order::Speak),
                            Some(State::Lost) => return Some(Order::Superseded),
                            _ => {}
                        }
                        frame(announcement, plans);
                        absent.clear();
                        absent.extend(announcement.absent());
                        set_points.clear();
                        set_points.extend(announcement.set_points());
                        let horizon = announcement.horizons.get(robot).copied().unwrap_or(0);
                        Some(Order::Tick {
                            tick: announcement.tick,
                            horizon: Horizon::new(u64::from(horizon)).ok(),
                            announced: announcement.stamp,
                            woken,
                        })
                    }
                    order::MEET => Some(Order::Meet),
                    order::EPISODE if announcement.epoch > epoch => Some(Order::Episode { epoch: announcement.epoch }),
                    order::STOP => Some(Order::Stop),
                    _ => None,
                }
            })?;
            match received {
                Some(Some(order)) => {
                    match order {
                        Order::Tick { tick, .. } => self.next_tick = tick + 1,
                        Order::Episode { epoch } => (self.epoch, self.next_tick) = (epoch, 0),
                        _ => {}
                    }
                    return Ok(Some(order));
                }
                Some(None) => {} // an old one
                None if waited => return Ok(None),
                None => {
                    self.announcements.wait(limit);
                    waited = true;
                }
            }
        }
    }
}
