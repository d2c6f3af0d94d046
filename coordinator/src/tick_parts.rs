//! Where the time of a tick goes: the stamps of every robot's report, as durations of named parts.

use crate::latency::{Latency, Percentiles};
use crate::team::{Moments, ProcessTeam};
use shared::messages::Stamps;
use std::collections::BTreeMap;
use vodca::step::Step;

/// The parts of one robot's tick, in their order. They add up to the time from the announcement until
/// the coordinator has the robot's report.
pub const PARTS: [&str; 7] = ["wake", "read", "detect", "solve", "check", "publish", "collect"];

/// When what happened in a tick; times are of one host's monotonic clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct TickTimes<'a> {
    /// From the announcement to the last report, ns.
    pub duration_ns: u64,
    /// Publishing the announcement and waking everybody, ns; runs beside the robots' parts.
    pub announce_ns: u64,
    /// How late it was announced (real time only), ns.
    pub late_ns: u64,
    /// By robot number; empty in a team without processes.
    pub stamps: &'a [Stamps],
}

impl<'a> From<&'a ProcessTeam> for TickTimes<'a> {
    fn from(team: &'a ProcessTeam) -> Self {
        let Moments { announced, rung, collected, late, .. } = team.moments();
        Self {
            duration_ns: collected.saturating_sub(announced),
            announce_ns: rung.saturating_sub(announced),
            late_ns: late,
            stamps: team.stamps(),
        }
    }
}

impl TickTimes<'_> {
    /// The robot whose report came last, and its parts: they make up the tick. `None` without processes.
    pub fn last(&self, steps: &[Step]) -> Option<(usize, [u64; PARTS.len()])> {
        let (robot, stamps) = self.stamps.iter().enumerate().max_by_key(|(_, stamps)| stamps.collected)?;
        Some((robot, parts(stamps, steps.get(robot)?)))
    }
}

/// Durations of [`PARTS`], ns.
///
/// * wake: announced until the robot runs and has seen it;
/// * read: until it has all plans of tick k - 1;
/// * detect: conflicts, rows, reference and cell;
/// * solve: the QP's solvers (both 0 for a controller without a QP);
/// * check: everything else of the step, the safety filter above all;
/// * publish: packing the report and, in a peer exchange, handing the plan to all others;
/// * collect: until the coordinator has taken the report.
pub fn parts(stamps: &Stamps, step: &Step) -> [u64; PARTS.len()] {
    let between = |from: u64, to: u64| to.saturating_sub(from);
    let planning = between(stamps.read, stamps.planned);
    [
        between(stamps.announced, stamps.woken),
        between(stamps.woken, stamps.read),
        step.detect_ns,
        step.solve_ns,
        planning.saturating_sub(step.detect_ns + step.solve_ns),
        between(stamps.planned, stamps.reported),
        between(stamps.reported, stamps.collected),
    ]
}

/// Distributions of the parts over all robots and ticks of a run.
#[derive(Clone, Debug, Default)]
pub struct TickParts {
    announce: Latency,
    parts: [Latency; PARTS.len()],
}

impl TickParts {
    /// Takes in a tick.
    pub fn observe(&mut self, times: &TickTimes<'_>, steps: &[Step]) {
        if times.stamps.is_empty() {
            return;
        }
        self.announce.record_ns(times.announce_ns);
        for (stamps, step) in times.stamps.iter().zip(steps).filter(|(_, step)| step.status.took_part()) {
            for (latency, duration) in self.parts.iter_mut().zip(parts(stamps, step)) {
                latency.record_ns(duration);
            }
        }
    }

    /// The figures by name, `announce` among them; empty when no process has reported.
    pub fn percentiles(&self) -> BTreeMap<String, Percentiles> {
        let named = std::iter::once(("announce", &self.announce)).chain(PARTS.into_iter().zip(&self.parts));
        let figures = named.map(|(name, latency)| (name.to_owned(), latency.percentiles()));
        figures.filter(|(_, figures)| figures.count > 0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples;

    const STAMPS: Stamps =
        Stamps { announced: 1_000, woken: 1_040, read: 1_050, planned: 2_050, reported: 2_057, collected: 2_100 };

    #[test]
    fn the_parts_of_a_robot_add_up_to_its_tick() {
        let step = &samples::steps(1, 0)[0];
        let found = parts(&STAMPS, step);
        assert_eq!(found, [40, 10, 300, 400, 300, 7, 43]);
        assert_eq!(found.iter().sum::<u64>(), STAMPS.collected - STAMPS.announced);
    }

    #[test]
    fn the_last_robot_is_the_one_the_tick_waited_for() {
        let stamps = [STAMPS, Stamps { woken: 1_500, collected: 2_500, ..STAMPS }, STAMPS];
        let times = TickTimes { stamps: &stamps, ..TickTimes::default() };
        let (robot, found) = times.last(&samples::steps(3, 0)).unwrap();
        assert_eq!((robot, found[0]), (1, 500));
        assert!(TickTimes::default().last(&samples::steps(3, 0)).is_none());
    }

    #[test]
    fn every_robot_of_every_tick_counts() {
        let mut parts = TickParts::default();
        assert!(parts.percentiles().is_empty());
        let stamps = [STAMPS; 2];
        let times = TickTimes { stamps: &stamps, announce_ns: 70, ..TickTimes::default() };
        for tick in 0..3 {
            parts.observe(&times, &samples::steps(2, tick));
        }
        let figures = parts.percentiles();
        assert_eq!(figures.len(), 1 + PARTS.len());
        assert_eq!((figures["announce"].count, figures["wake"].count), (3, 6));
        assert_eq!(figures["wake"].p50_us, 0.04);
    }
}
