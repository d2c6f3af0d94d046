//! The coordinator's side of the exchange.

use super::Kind;
use crate::messages::{Announcement, MAX_ROBOTS, Plan, Report, kind, order};
use crate::os;
use crate::runtime_dir::RuntimeDir;
use crate::services::{Announcer, Reports, ServiceError, Services};
use std::time::Duration;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::membership::Member;

/// What everybody is told of the team when a tick begins, by robot number.
#[derive(Clone, Copy, Debug)]
pub struct TeamNow<'a> {
    /// Who takes part.
    pub members: &'a [Member],
    /// Where everybody's body is, m.
    pub bodies: &'a [Position],
    /// Everybody's set-point, m; empty: they are the scenario's.
    pub set_points: &'a [Position],
}

/// Announces ticks and collects reports.
#[derive(Debug)]
pub struct CoordinatorPort {
    announcer: Announcer,
    reports: Reports,
    kind: Kind,
    epoch: u64,
    /// The newest plan of every robot, by robot number.
    plans: Vec<Plan>,
    /// Robots open them at any time: those that come back, too.
    services: Services,
}

impl CoordinatorPort {
    /// Makes all services of a run.
    pub fn create(kind: Kind, place: &RuntimeDir, robots: usize, epoch: u64) -> Result<Self, ServiceError> {
        let services = Services::create(place, robots, kind == Kind::Peer)?;
        let frame = if kind == Kind::Relay { robots } else { 0 };
        Ok(Self {
            announcer: services.announcer(frame)?,
            reports: services.reports()?,
            kind,
            epoch,
            plans: vec![Plan::EMPTY; robots],
            services,
        })
    }

    /// Announces tick `tick` to every robot, in a relayed exchange with all plans of `tick - 1`.
    /// `horizons`: N_i^k by robot. Gives the stamp of the announcement, ns.
    pub fn announce(&mut self, tick: u64, horizons: &[Horizon], team: &TeamNow<'_>) -> Result<u64, ServiceError> {
        let TeamNow { members, bodies, set_points } = *team;
        let mut announcement = Announcement { epoch: self.epoch, tick, order: order::TICK, ..Default::default() };
        for (robot, member) in members.iter().enumerate().take(MAX_ROBOTS) {
            announcement.lives[robot] = member.life;
            announcement.states[robot] = member.state.number();
            if member.state.has_stood() {
                announcement.absent += 1;
                announcement.bodies[robot] = bodies[robot].into();
            }
        }
        announcement.told_set_points = set_points.len() as u64;
        for (to, set_point) in announcement.set_points.iter_mut().zip(set_points) {
            *to = (*set_point).into();
        }
        for (to, horizon) in announcement.horizons.iter_mut().zip(horizons) {
            *to = horizon.steps() as u8;
        }
        let plans: &[Plan] = if self.kind == Kind::Relay && tick > 0 { &self.plans } else { &[] };
        announcement.plans = plans.len() as u16;
        self.reports.look();
        self.reports.expect(members.iter().filter(|member| member.state.takes_part()).count());
        announcement.stamp = os::now_ns();
        self.announcer.announce(&announcement, plans)?;
        Ok(announcement.stamp)
    }

    /// Tells every robot to connect to every other one.
    pub fn meet(&mut self) -> Result<(), ServiceError> {
        self.order(order::MEET)
    }

    /// Begins the next episode: every robot goes back to its start. Gives the new epoch.
    pub fn next_episode(&mut self) -> Result<u64, ServiceError> {
        self.epoch += 1;
        self.order(order::EPISODE)?;
        Ok(self.epoch)
    }

    /// Tells every robot to end.
    pub fn stop(&mut self) -> Result<(), ServiceError> {
        self.order(order::STOP)
    }

    fn order(&mut self, order: u32) -> Result<(), ServiceError> {
        let announcement = Announcement { epoch: self.epoch, order, stamp: os::now_ns(), ..Default::default() };
        self.announcer.announce(&announcement, &[])
    }

    /// Hands every unread report of this run to `take`; does not wait.
    pub fn collect(&mut self, mut take: impl FnMut(usize, &Report)) -> Result<(), ServiceError> {
        self.reports.look();
        while let Some(report) = self.reports.receive()? {
            let robot = report.plan.robot as usize;
            if report.plan.epoch != self.epoch || robot >= self.plans.len() {
                continue;
            }
            if report.kind == kind::STEP {
                self.plans[robot] = report.plan;
            }
            take(robot, &report);
        }
        Ok(())
    }

    /// Frees what dead processes held.
    pub fn clean_up_after_dead(&self) {
        self.services.clean_up_after_dead();
    }

    /// Waits until `reports` more have come since the last [`Self::collect`], a signal came, or `limit` has
    /// passed.
    pub fn wait(&self, reports: usize, limit: Duration) {
        self.reports.wait(reports, limit);
    }
}
