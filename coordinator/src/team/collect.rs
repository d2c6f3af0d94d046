//! Takes in what the robots of a team report.

use super::{Interrupt, LOOK_AROUND, ProcessTeam};
use crate::launch::Agents;
use crate::run::STALL;
use shared::messages::{Stamps, kind};
use shared::os;
use std::time::Instant;

/// What the reports are wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Everybody's process is there.
    Ready,
    /// Everybody is connected, or at the start of an episode.
    Met,
    /// What everybody did in this tick.
    Tick(u64),
}

impl Wanted {
    /// The tick that is under way.
    pub(super) fn tick(self) -> Option<u64> {
        match self {
            Self::Tick(tick) => Some(tick),
            Self::Ready | Self::Met => None,
        }
    }
}

impl ProcessTeam {
    /// Takes in every unread report; says how many there were.
    pub(super) fn listen(&mut self, wanted: Wanted) -> Result<usize, Interrupt> {
        let (mut taken, mut strange) = (0, None);
        let Self { roster, port, reported, stamps, measured, members, .. } = self;
        port.collect(|robot, report| {
            taken += 1;
            let life = report.plan.life;
            if report.kind == kind::READY {
                roster.seen(robot, report.pid);
            }
            let counts = match wanted {
                Wanted::Ready => report.kind == kind::READY && members.answers(robot, report),
                Wanted::Met => report.kind == kind::MET && members.answers(robot, report),
                Wanted::Tick(_) if report.kind == kind::READY => {
                    members.newcomer(robot, life);
                    false
                }
                Wanted::Tick(_) => {
                    let step = (report.kind == kind::STEP).then_some(report.plan.tick);
                    members.hear(robot, life, step)
                }
            };
            if !counts {
                return;
            }
            measured[robot] = report.next_measured.into();
            if wanted.tick().is_some() {
                stamps[robot] = Stamps { collected: os::now_ns(), ..report.stamps };
                reported[robot] = report.to_step();
                match &reported[robot] {
                    Some(step) => members.moved(robot, step.next_position),
                    None => strange = strange.or(Some(robot)),
                }
            }
        })?;
        match strange {
            None => Ok(taken),
            Some(robot) => {
                self.roster.kill(robot);
                let how = "sent a report that means nothing here; is its program of another version?";
                self.lose(robot, wanted.tick(), how.into()).map(|()| taken)
            }
        }
    }

    /// Takes in reports until no answer is missing.
    pub(super) fn collect(&mut self, wanted: Wanted, mut deadline: Instant) -> Result<(), Interrupt> {
        let by_hand = matches!(self.options.agents, Agents::ByHand);
        let stall = if by_hand { self.options.start_patience } else { STALL };
        let (start, until) = (Instant::now(), deadline);
        let mut looked = start;
        loop {
            let before = self.members.missing();
            let taken = self.listen(wanted)?;
            if self.members.missing() == 0 {
                return Ok(());
            }
            if self.stop.is_set() {
                return Err(Interrupt::Stopped);
            }
            // Looking costs a call per robot: only when nothing comes, or now and then.
            let now = Instant::now();
            if wanted == Wanted::Ready && self.members.missing() < before {
                deadline = until.min(now + stall);
            }
            if taken == 0 && now - looked >= LOOK_AROUND {
                looked = now;
                self.look_for_ended(wanted)?;
                if self.members.missing() == 0 {
                    return Ok(());
                }
            }
            if now >= deadline {
                return self.time_is_up(wanted, start);
            }
            self.port.wait(self.members.missing(), (deadline - now).min(LOOK_AROUND));
        }
    }
}
