//! What a team of processes does about robots that end, fall silent, or come back, and about faults on purpose.
//!
//! *Invariant*: what is found out during a tick is announced with the next one, never earlier. So the announcement of a
//! tick does not depend on when within the tick before a process ended, and a run with faults can be repeated.

use super::collect::Wanted;
use super::{Interrupt, LOOK_AROUND, ProcessTeam};
use crate::launch::{self, Agents};
use crate::run::OnLoss;
use shared::chaos::ProcessFault;
use shared::os;
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::body::{Body, SimulatedBody};
use vodca::horizon::Horizon;
use vodca::membership::State;
use vodca::step::{Status, Step};

/// How long a lock-step tick waits for a robot that was started anew.
const RETURN_PATIENCE: Duration = Duration::from_secs(5);

impl ProcessTeam {
    /// Kills, stops and continues processes on purpose before tick `tick`; `true`: somebody was killed.
    pub(super) fn strike(&mut self, tick: u64) -> bool {
        if self.options.chaos.is_none() {
            return false;
        }
        let mut killed = false;
        self.members.resumes(tick).filter_map(|robot| self.roster.pid(robot)).for_each(os::resume);
        for robot in 0..self.measured.len() {
            let Some(pid) = self.taking_part(robot).then(|| self.roster.pid(robot)).flatten() else { continue };
            match self.options.chaos.process(robot, tick) {
                Some(ProcessFault::Kill) => {
                    self.roster.kill(robot);
                    killed = true;
                }
                Some(ProcessFault::Stop { .. }) => os::pause(pid),
                None => {}
            }
        }
        killed
    }

    /// Whoever misses tick `tick` on purpose need not be waited for.
    pub(super) fn miss_on_purpose(&mut self, tick: u64) {
        for robot in (0..self.measured.len()).filter(|_| !self.options.chaos.is_none()) {
            let message = self.options.chaos.message(robot, tick).filter(|fault| fault.misses());
            let (until, why) = match (self.options.chaos.process(robot, tick), message) {
                (Some(ProcessFault::Stop { ticks }), _) => (tick + ticks, "was stopped on purpose"),
                (None, Some(_)) => (tick + 1, "was not heard, on purpose"),
                _ => continue,
            };
            self.members.miss(robot, Some(until), why);
        }
    }

    fn taking_part(&self, robot: usize) -> bool {
        self.members.membership().state(robot).takes_part()
    }

    /// Admits processes that have been started in place of others. Without a clock a tick waits for those who are due: when
    /// they come back does not depend on time.
    pub(super) fn welcome(&mut self, tick: u64) -> Result<(), Interrupt> {
        let start = Instant::now();
        while let Some(robot) = self.members.overdue(tick).filter(|_| !self.options.real_time) {
            if self.stop.is_set() {
                return Err(Interrupt::Stopped);
            }
            self.listen(Wanted::Tick(tick))?;
            if self.members.overdue(tick) != Some(robot) {
                continue;
            }
            if start.elapsed() > RETURN_PATIENCE {
                self.roster.kill(robot);
            }
            if let Some(how) = self.roster.ended(robot) {
                self.lose(robot, Some(tick), how)?;
            }
            self.port.wait(1, LOOK_AROUND / 10);
        }
        self.members.admit(tick);
        Ok(())
    }

    /// Finds processes that have ended.
    pub(super) fn look_for_ended(&mut self, wanted: Wanted) -> Result<(), Interrupt> {
        for robot in 0..self.measured.len() {
            if let Some(how) = self.roster.ended(robot) {
                self.lose(robot, wanted.tick(), how)?;
            }
        }
        Ok(())
    }

    /// Nobody waits any longer in this tick; `start`: since when.
    pub(super) fn time_is_up(&mut self, wanted: Wanted, start: Instant) -> Result<(), Interrupt> {
        let how = format!("gave no answer for {:.1} s", start.elapsed().as_secs_f64());
        self.members.give_up_waiting();
        while let Some(robot) = self.members.first_missing() {
            if wanted.tick().is_none() || self.options.on_loss == OnLoss::Stop {
                return Err(Interrupt::Lost(self.roster.lost(robot, wanted.tick(), how)));
            }
            self.members.miss(robot, None, &how);
        }
        Ok(())
    }

    /// Kills robots that have been silent for too long: they must not come back as ghosts.
    pub(super) fn end_silent(&mut self, tick: u64) -> Result<(), Interrupt> {
        while let Some((robot, silence)) = self.members.silent_for(self.options.lost_after) {
            self.roster.kill(robot);
            self.lose(robot, Some(tick), format!("gave no answer for {:.1} s and was ended", silence.as_secs_f64()))?;
        }
        Ok(())
    }

    /// The process of `robot` has ended: the run does as well, or goes on without it, and perhaps another one is started.
    pub(super) fn lose(&mut self, robot: usize, tick: Option<u64>, how: String) -> Result<(), Interrupt> {
        let lost = self.roster.lost(robot, tick, how);
        let Some(tick) = tick.filter(|_| self.options.on_loss != OnLoss::Stop) else {
            return Err(Interrupt::Lost(lost));
        };
        let words = lost.last_line.map(|line| format!(", saying \"{line}\"")).unwrap_or_default();
        self.members.lose(robot, tick, format!("{}{words}", lost.how));
        self.port.clean_up_after_dead();
        if let Agents::Launch(program) = &self.options.agents
            && self.members.restart(robot, tick, self.options.on_loss)
        {
            let child = launch::start(program, &self.options.run, robot)?;
            self.roster.started(robot, child);
        }
        Ok(())
    }

    /// As long as somebody is late, ticks without a clock last a sample time like others: it shall be able to catch up.
    pub(super) fn wait_for_late(&mut self, tick: u64) -> Result<(), Interrupt> {
        if self.options.real_time || !self.members.somebody_is_late() {
            return Ok(());
        }
        let end = Instant::now() + Duration::from_secs_f64(self.setup.params.model.sample_time);
        while self.members.somebody_is_late() && Instant::now() < end && !self.stop.is_set() {
            self.listen(Wanted::Tick(tick))?;
            self.port.wait(1, LOOK_AROUND.min(end.saturating_duration_since(Instant::now())));
        }
        Ok(())
    }

    /// Puts together what everybody did in tick `tick`: whoever did not take part stood.
    pub(super) fn finish(&mut self, tick: u64, horizons: &[Horizon]) {
        self.finished.clear();
        for (robot, reported) in self.reported.iter_mut().enumerate() {
            let step = reported.take().unwrap_or_else(|| {
                let lost = self.members.membership().state(robot) == State::Lost;
                let at = self.members.bodies()[robot];
                let before = self.measured[robot];
                let after = measured(robot, at, tick + 1, &self.setup);
                (self.measured[robot], self.stamps[robot]) = (after, Default::default());
                let (status, set_point) =
                    (if lost { Status::Lost } else { Status::Late }, self.setup.scenario.robots[robot].set_point);
                Step::absent(at, [before, after], horizons[robot], set_point, status)
            });
            self.finished.push(step);
        }
    }
}

/// Where a body that stands at `at` measures itself at the start of `tick`, m.
fn measured(robot: usize, at: Position, tick: u64, setup: &shared::team::Setup) -> Position {
    SimulatedBody::new(robot, at, &setup.params, setup.team.seed).measure(tick)
}
