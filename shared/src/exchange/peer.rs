//! Plans from robot to robot.

use super::{Clock, Exchange, Hear, Order};
use crate::messages::{Plan, Report, kind};
use crate::os;
use crate::services::{Receiver, Reporter, Sender, ServiceError};
use std::time::Duration;

pub(super) struct Peer {
    clock: Clock,
    reporter: Reporter,
    sender: Sender<Plan>,
    receiver: Receiver<Plan>,
    /// Plans of the tick that is being planned, by robot: a quicker neighbour's plan is read together
    /// with the plans of the tick before and must not be heard until the next tick.
    early: Vec<Option<Plan>>,
}

impl Peer {
    pub(super) fn new(
        clock: Clock,
        reporter: Reporter,
        sender: Sender<Plan>,
        receiver: Receiver<Plan>,
        robots: usize,
    ) -> Self {
        Self { clock, reporter, sender, receiver, early: vec![None; robots] }
    }
}

impl Exchange for Peer {
    fn next_order(&mut self, limit: Duration, hear: &mut Hear<'_>) -> Result<Option<Order>, ServiceError> {
        let order = self.clock.next(limit, |_, _| {})?;
        if order == Some(Order::Meet) {
            // Connections cost most of the start of a large team; the first tick shall not pay for them.
            self.sender.connect()?;
            self.receiver.receive()?;
        }
        if let Some(Order::Episode { .. }) = order {
            self.early.fill(None);
        }
        let Some(Order::Tick { tick, .. }) = order else { return Ok(order) };
        let mut tell = |plan: &Plan| {
            if let Some(prediction) = plan.prediction() {
                hear(plan.robot as usize, plan.tick, &prediction);
            }
        };
        for early in &mut self.early {
            if let Some(plan) = early.take_if(|plan| plan.tick < tick)
                && plan.tick + 1 == tick
            {
                tell(&plan);
            }
        }
        while let Some(plan) = self.receiver.receive()? {
            let robot = plan.robot as usize;
            if plan.epoch != self.clock.epoch || robot == self.clock.robot || robot >= self.early.len() {
                continue;
            }
            if plan.tick + 1 == tick {
                tell(&plan);
            } else if plan.tick == tick {
                self.early[robot] = Some(*plan);
            }
        }
        Ok(order)
    }

    fn publish(&mut self, mut report: Report) -> Result<(), ServiceError> {
        if report.kind == kind::STEP {
            self.sender.send(report.plan)?;
        }
        report.stamps.reported = os::now_ns();
        self.reporter.report(report)
    }
}
