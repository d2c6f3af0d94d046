//! Links through iceoryx2, in the ways in which the product uses it.

use super::BenchError;
use super::links::{Link, Message, PATIENCE, spin_until};
use shared::messages::{Announcement, Author, MAX_ROBOTS, Observation, Plan, PolicyAnswer, Report, kind, order};
use shared::services::{
    Announcements, Announcer, PolicyAsker, PolicyPort, Receiver, Reporter, Reports, Sender, Services,
};
use std::time::Instant;

/// A message in a plan, and back.
fn plan_of(message: Message, me: u16) -> Plan {
    Plan { stamp: message.stamp, tick: message.one_way, epoch: message.last, robot: me, ..Plan::EMPTY }
}

fn message_of(plan: &Plan) -> Message {
    Message { stamp: plan.stamp, one_way: plan.tick, last: plan.epoch }
}

/// Both ends look without pause.
pub(super) struct Busy {
    ports: (Sender<Plan>, Receiver<Plan>),
    me: u16,
    _services: Services,
}

impl Busy {
    /// The end number `me`; the services live as long as their ports.
    pub(super) fn new(ports: (Sender<Plan>, Receiver<Plan>), me: u16, services: Services) -> Self {
        Self { ports, me, _services: services }
    }
}

impl Link for Busy {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        Ok(self.ports.0.send(plan_of(message, self.me))?)
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let (receiver, me) = (&self.ports.1, self.me);
        // Who publishes hears himself as well.
        let look = || match receiver.receive() {
            Ok(Some(plan)) if plan.robot != me => Some(Ok(message_of(&plan))),
            Ok(_) => None,
            Err(error) => Some(Err(error)),
        };
        Ok(spin_until(look).ok_or(BenchError::Silent { who: "the other end of a link" })??)
    }
}

/// The end that announces, as the coordinator.
pub(super) struct TeamFirst {
    to: Announcer,
    from: Reports,
    _services: Services,
}

impl TeamFirst {
    /// The services live as long as their ports.
    pub(super) fn new(to: Announcer, from: Reports, services: Services) -> Self {
        Self { to, from, _services: services }
    }
}

impl Link for TeamFirst {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        let announcement = Announcement { order: order::TICK, plans: 1, ..Default::default() };
        Ok(self.to.announce(&announcement, &[plan_of(message, 0)])?)
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            // As the coordinator does: without the look every report so far would end the wait at once, and
            // this end would spin.
            self.from.look();
            if let Some(report) = self.from.receive()? {
                return Ok(message_of(&report.plan));
            }
            self.from.wait(1, PATIENCE);
        }
        Err(BenchError::Silent { who: "the other end of a link" })
    }
}

/// The end that reports, as a robot.
pub(super) struct TeamSecond {
    to: Reporter,
    from: Announcements,
}

impl TeamSecond {
    /// With the ports of a robot.
    pub(super) fn new(to: Reporter, from: Announcements) -> Self {
        Self { to, from }
    }
}

impl Link for TeamSecond {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        Ok(self.to.report(Report {
            plan: plan_of(message, 1),
            ..Report::presence(Author { robot: 1, ..Author::default() }, kind::STEP, vodca::Position::zeros())
        })?)
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            let received = self.from.receive(|_, plans| plans.first().map(message_of).unwrap_or_default())?;
            if let Some(message) = received {
                return Ok(message);
            }
            self.from.wait(PATIENCE);
        }
        Err(BenchError::Silent { who: "the other end of a link" })
    }
}

/// The end that asks, as the coordinator asks a policy server.
pub(super) struct EventFirst(pub(super) PolicyAsker);

impl Link for EventFirst {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        let Message { stamp, one_way, last } = message;
        let positions = [[0.0; 2]; MAX_ROBOTS];
        Ok(self.0.ask(Observation { epoch: last, tick: one_way, stamp, robots: 0, positions })?)
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(PolicyAnswer { stamp, tick, epoch, .. }) = self.0.receive()? {
                return Ok(Message { stamp, one_way: tick, last: epoch });
            }
            self.0.wait(PATIENCE)?;
        }
        Err(BenchError::Silent { who: "the other end of a link" })
    }
}

/// The end that answers.
pub(super) struct EventSecond(pub(super) PolicyPort);

impl Link for EventSecond {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        let Message { stamp, one_way, last } = message;
        Ok(self.0.answer(PolicyAnswer { epoch: last, tick: one_way, stamp, ..PolicyAnswer::EMPTY })?)
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(Observation { stamp, tick, epoch, .. }) = self.0.newest()? {
                return Ok(Message { stamp, one_way: tick, last: epoch });
            }
            self.0.wait(PATIENCE)?;
        }
        Err(BenchError::Silent { who: "the other end of a link" })
    }
}
