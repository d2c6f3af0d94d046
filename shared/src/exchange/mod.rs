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

pub use coordinator_port::CoordinatorPort;

use crate::messages::{Announcement, Report, order};
use crate::os;
use crate::runtime_dir::RuntimeDir;
use crate::services::{ServiceError, Services};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use vodca::horizon::Horizon;
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
    /// End normally.
    Stop,
}

/// What is told whose plan of which tick was heard.
pub type Hear<'a> = dyn FnMut(usize, u64, &Prediction) + 'a;

/// A robot's side of the exchange.
pub trait Exchange {
    /// Waits up to `limit` for the next order and hands every plan of the tick before to `hear`.
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
    let clock = Clock { announcements: services.announcements()?, robot, epoch, next_tick: 0 };
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
    next_tick: u64,
}

impl Clock {
    /// Waits up to `limit` for the next announcement that counts and lets `frame` see its plans.
    fn next(
        &mut self,
        limit: Duration,
        mut frame: impl FnMut(&Announcement, &[crate::messages::Plan]),
    ) -> Result<Option<Order>, ServiceError> {
        let mut waited = false;
        loop {
            let (robot, epoch, next_tick) = (self.robot, self.epoch, self.next_tick);
            let received = self.announcements.receive(|announcement, plans| {
                if announcement.epoch < epoch {
                    return None;
                }
                let woken = os::now_ns();
                match announcement.order {
                    order::TICK if announcement.tick >= next_tick => {
                        frame(announcement, plans);
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
                        Order::Meet | Order::Stop => {}
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
