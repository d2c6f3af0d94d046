//! Plans through the coordinator: sent inside the report, received in one frame.

use super::{Clock, Exchange, Hear, News, Order};
use crate::messages::Report;
use crate::os;
use crate::services::{Reporter, ServiceError};
use std::time::Duration;

pub(super) struct Relay {
    clock: Clock,
    reporter: Reporter,
}

impl Relay {
    pub(super) fn new(clock: Clock, reporter: Reporter) -> Self {
        Self { clock, reporter }
    }
}

impl Exchange for Relay {
    fn life(&self) -> u32 {
        self.clock.life
    }

    fn next_order(&mut self, limit: Duration, hear: &mut Hear<'_>) -> Result<Option<Order>, ServiceError> {
        let (robot, epoch) = (self.clock.robot, self.clock.epoch);
        let order = self.clock.next(limit, |announcement, plans| {
            for plan in plans {
                let sender = usize::from(plan.robot);
                let counts = announcement.lives.get(sender) == Some(&plan.life);
                let wanted = plan.epoch == epoch && plan.tick + 1 == announcement.tick && sender != robot && counts;
                if let Some(prediction) = wanted.then(|| plan.prediction()).flatten() {
                    hear(News::Plan { sender, tick: plan.tick, plan: &prediction });
                }
            }
        })?;
        if let Some(Order::Tick { .. }) = order {
            self.clock.tell_team(hear);
        }
        Ok(order)
    }

    fn publish(&mut self, mut report: Report) -> Result<(), ServiceError> {
        report.stamps.reported = os::now_ns();
        self.reporter.report(report)
    }
}
