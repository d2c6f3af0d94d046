//! `summary.json`: how a run went. Versioned; fields are only added within a version.

use crate::guarantee;
use crate::latency::{Latency, Percentiles};
use crate::members::Change;
use crate::policy::PolicySummary;
use crate::record::{RecordError, SUMMARY_FILE};
use crate::solver_check::SolverCheck;
use crate::tick_parts::{TickParts, TickTimes};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use vodca::membership::State;
use vodca::metrics::RunSummary;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;
use vodca::way::LowerBound;

/// Version of the format.
pub const VERSION: u32 = 2; // 1 said `shielded` where this says `filtered`
/// Teams of more robots are not held against a lower bound: crowds, not ways, decide how long they take.
const BOUNDED: usize = 16;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Everybody arrived.
    Arrived,
    /// The last tick passed before everybody had arrived.
    OutOfTicks,
    /// It was asked to stop.
    Interrupted,
    /// A robot's process was lost.
    PeerLost,
}

/// The content of `summary.json`: the figures of [`RunSummary`] and these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`VERSION`].
    pub version: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the profile.
    pub profile: String,
    /// The horizon's source as given.
    pub horizon: String,
    /// How it ended.
    pub end: End,
    /// Which guarantee held, and why not where it did not.
    pub guarantee: String,
    /// Whether somebody came nearer than was guaranteed; then the run was no success.
    #[serde(default)]
    pub guarantee_broken: bool,
    /// The figures that depend on the trajectory alone.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Who did not take part all the time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub absences: Vec<Absence>,
    /// What robots that meet nobody need, for teams of up to 16 robots whose set-points do not change.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<LowerBound>,
    /// Duration of a tick as the coordinator sees it.
    pub tick_latency: Percentiles,
    /// Where its time goes ([`crate::tick_parts::PARTS`], and `announce`), over all robots and ticks.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tick_parts: BTreeMap<String, Percentiles>,
    /// How late ticks were announced, in real time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lateness: Option<Percentiles>,
    /// Time in the QP's solvers, by robot.
    pub solve_latency: Vec<Percentiles>,
    /// What the policy did, in a run with one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub policy: Option<PolicySummary>,
    /// What solving every QP twice found, where that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver_check: Option<SolverCheck>,
}

impl Summary {
    /// Puts the parts together.
    pub fn new(
        scenario: &Scenario,
        params: &Params,
        (profile, horizon): (&str, &str),
        end: End,
        mut run: RunSummary,
        timings: &Timings,
    ) -> Self {
        let guarantee = guarantee::judge(scenario, params, &run);
        run.success &= !guarantee.broken;
        Self {
            version: VERSION,
            scenario: scenario.name.clone(),
            profile: profile.into(),
            horizon: horizon.into(),
            end,
            guarantee: guarantee.statement,
            guarantee_broken: guarantee.broken,
            absences: Vec::new(),
            lower_bound: (scenario.robots.len() <= BOUNDED && run.tasks.is_none())
                .then(|| LowerBound::of(scenario, params)),
            run,
            tick_latency: timings.tick.percentiles(),
            tick_parts: timings.parts.percentiles(),
            lateness: None,
            solve_latency: timings.solve.iter().map(Latency::percentiles).collect(),
            policy: None,
            solver_check: None,
        }
    }

    /// Adds what a check of the solvers found to the summary of the run recorded in `folder`.
    pub fn add_solver_check(folder: &Path, check: SolverCheck) -> Result<(), RecordError> {
        let path = folder.join(SUMMARY_FILE);
        let failed = |reason: String| RecordError::Encode { path: path.clone(), what: "the solver check", reason };
        let text = std::fs::read_to_string(&path).map_err(|error| failed(error.to_string()))?;
        let mut summary: Self = serde_json::from_str(&text).map_err(|error| failed(error.to_string()))?;
        summary.solver_check = Some(check);
        let text = serde_json::to_string_pretty(&summary).map_err(|error| failed(error.to_string()))?;
        std::fs::write(&path, text + "\n").map_err(|source| RecordError::Write { path: path.clone(), source })
    }
}

/// A robot did not take part for some time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Absence {
    /// Its number.
    pub robot: usize,
    /// Its name.
    pub name: String,
    /// Late: it was not heard in time. Lost: its process ended.
    pub state: State,
    /// The first tick that it missed.
    pub tick: u64,
    /// How it came about, and the last thing that it said.
    pub why: String,
    /// The tick with which it took part again; `None`: it did not.
    pub until: Option<u64>,
}

impl fmt::Display for Absence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, state, tick, why, until, .. } = self;
        let what = if *state == State::Lost { "lost" } else { "late" };
        write!(f, "{name} {what} at tick {tick}: it {why}")?;
        until.map_or(Ok(()), |tick| write!(f, "; back at tick {tick}"))
    }
}

impl Absence {
    /// All of a run, in the order in which they began; who is late and then lost is told as lost since it was late.
    pub fn all(changes: &[Change], scenario: &Scenario) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for Change { tick, robot, state, why, .. } in changes {
            let open = all.iter_mut().find(|absence| absence.robot == *robot && absence.until.is_none());
            match (state, open) {
                (State::Late | State::Lost, Some(absence)) => (absence.state, absence.why) = (*state, why.clone()),
                (State::Late | State::Lost, None) => {
                    let name = scenario.robots.get(*robot).map_or_else(String::new, |robot| robot.name.clone());
                    let (robot, state, tick, why) = (*robot, *state, *tick, why.clone());
                    all.push(Self { robot, name, state, tick, why, until: None });
                }
                (_, Some(absence)) => absence.until = Some(*tick),
                (_, None) => {}
            }
        }
        all
    }
}

/// Collects durations during a run; they go into the summary only, never into what is compared.
#[derive(Clone, Debug)]
pub struct Timings {
    tick: Latency,
    late: Latency,
    parts: TickParts,
    solve: Vec<Latency>,
}

impl Timings {
    /// For a team of `robots`.
    pub fn new(robots: usize) -> Self {
        Self {
            tick: Latency::new(),
            late: Latency::new(),
            parts: TickParts::default(),
            solve: vec![Latency::new(); robots],
        }
    }

    /// Takes in a tick.
    pub fn observe(&mut self, times: &TickTimes<'_>, steps: &[Step]) {
        self.tick.record_ns(times.duration_ns);
        self.late.record_ns(times.late_ns);
        self.parts.observe(times, steps);
        for (latency, step) in self.solve.iter_mut().zip(steps).filter(|(_, step)| step.status.took_part()) {
            latency.record_ns(step.solve_ns);
        }
    }

    /// How late ticks were announced.
    pub fn lateness(&self) -> Percentiles {
        self.late.percentiles()
    }
}
