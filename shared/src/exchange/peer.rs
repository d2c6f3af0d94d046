//! Plans from robot to robot.

use super::{Clock, Exchange, Hear, News, Order};
use crate::messages::{MAX_ROBOTS, Plan, Report, kind};
use crate::os;
use crate::services::{Receiver, Reporter, Sender, ServiceError};
use std::time::Duration;

pub(super) struct Peer {
    clock: Clock,
    reporter: Reporter,
    sender: Sender<Plan>,
    receiver: Receiver<Plan>,
    /// The newest plans of the tick that is being planned and of later ones, by robot and parity of the tick: a
    /// quicker neighbour's plan is read together with the plans of the tick before and must not be heard until the
    /// next tick. Who was late reads even those of ticks that went on without it; what is announced by then is the
    /// tick after the last but one of them.
    early: Vec<[Option<Plan>; 2]>,
    /// Which life of every robot counts.
    lives: [u32; MAX_ROBOTS],
}

impl Peer {
    pub(super) fn new(
        clock: Clock,
        reporter: Reporter,
        sender: Sender<Plan>,
        receiver: Receiver<Plan>,
        robots: usize,
    ) -> Self {
        Self { clock, reporter, sender, receiver, early: vec![[None; 2]; robots], lives: [0; MAX_ROBOTS] }
    }
}

impl Exchange for Peer {
    fn life(&self) -> u32 {
        self.clock.life
    }

    fn next_order(&mut self, limit: Duration, hear: &mut Hear<'_>) -> Result<Option<Order>, ServiceError> {
        let Self { clock, lives, .. } = self;
        let order = clock.next(limit, |announcement, _| *lives = announcement.lives)?;
        if order == Some(Order::Meet) {
            // Connections cost most of the start of a large team; the first tick shall not pay for them.
            self.sender.connect()?;
            self.receiver.receive()?;
        }
        if let Some(Order::Episode { .. }) = order {
            self.early.fill([None; 2]);
        }
        let Some(Order::Tick { tick, .. }) = order else { return Ok(order) };
        let mut tell = |plan: &Plan| {
            let sender = usize::from(plan.robot);
            let counts = self.lives.get(sender) == Some(&plan.life);
            if let Some(prediction) = counts.then(|| plan.prediction()).flatten() {
                hear(News::Plan { sender, tick: plan.tick, plan: &prediction });
            }
        };
        for early in self.early.iter_mut().flatten() {
            if let Some(plan) = early.take_if(|plan| plan.tick < tick)
                && plan.tick + 1 == tick
            {
                tell(&plan);
            }
        }
        while let Some(plan) = self.receiver.receive()? {
            let robot = usize::from(plan.robot);
            if plan.epoch != self.clock.epoch || robot == self.clock.robot || robot >= self.early.len() {
                continue;
            }
            if plan.tick + 1 == tick {
                tell(&plan);
            } else if plan.tick >= tick {
                let early = &mut self.early[robot][(plan.tick % 2) as usize];
                if early.is_none_or(|known| known.tick < plan.tick) {
                    *early = Some(*plan);
                }
            }
        }
        self.clock.tell_team(hear);
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
