//! Everything that watches a run: record and timings.

use crate::horizons::RunHorizons;
use crate::members::Change;
use crate::policy::PolicySummary;
use crate::record::latency::{self, LatencyWriter};
use crate::record::membership::{self, MembershipWriter};
use crate::record::set_points::{self, SetPointsWriter};
use crate::record::{About, RecordError, Recorder, RunFolder};
use crate::run::RunTick;
use crate::summary::{Absence, End, Summary, Timings};
use crate::team::ProcessTeam;
use crate::tick_parts::TickTimes;
use std::path::{Path, PathBuf};
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::play::{Observer, Playable, Verdict};
use vodca::scenario::Scenario;
use vodca::step::Step;

/// A run that is being watched.
pub struct Session {
    scenario: Scenario,
    params: Params,
    about: About,
    recorder: Recorder,
    latency: LatencyWriter,
    timings: Timings,
    membership: MembershipWriter,
    set_points: SetPointsWriter,
    changes: Vec<Change>,
}

impl Session {
    /// Writes what is known before the first tick into `folder`.
    pub fn start(folder: RunFolder, scenario: &Scenario, params: &Params, about: About) -> Result<Self, RecordError> {
        let (latency, members) = (folder.file(latency::FILE), folder.file(membership::FILE));
        let set_points = SetPointsWriter::new(folder.file(set_points::FILE));
        Ok(Self {
            recorder: Recorder::start(folder, scenario, params, &about)?,
            latency: LatencyWriter::create(latency, scenario.robots.len())?,
            timings: Timings::new(scenario.robots.len()),
            membership: MembershipWriter::new(members),
            set_points,
            changes: Vec::new(),
            scenario: scenario.clone(),
            params: params.clone(),
            about,
        })
    }

    /// Takes in tick `tick`, which took `times`; `steps[i]` is what robot i did.
    ///
    /// # Errors
    /// It cannot be written down.
    pub fn record(&mut self, tick: u64, steps: &[Step], times: &TickTimes<'_>) -> Result<(), RecordError> {
        self.recorder.tick(tick, steps)?;
        self.latency.tick(tick, times, steps)?;
        self.timings.observe(times, steps);
        Ok(())
    }

    /// The run's folder.
    pub fn path(&self) -> &Path {
        self.recorder.path()
    }

    /// Ends the record with its summary, for failed and interrupted runs as well. Gives the summary and
    /// the folder. `metrics` are the run's figures, `policy` is what the policy did, in a run with one.
    pub fn finish(
        self,
        end: End,
        metrics: &RunMetrics,
        policy: Option<PolicySummary>,
    ) -> Result<(Summary, PathBuf), RecordError> {
        let names = (self.about.profile.as_str(), self.about.horizon.as_str());
        let mut summary = Summary::new(&self.scenario, &self.params, names, end, metrics.finish(), &self.timings);
        summary.policy = policy;
        summary.absences = Absence::all(&self.changes, &self.scenario);
        summary.lateness = self.about.real_time.then(|| self.timings.lateness());
        let folder = self.recorder.finish(&summary)?;
        Ok((summary, folder))
    }
}

impl Observer<ProcessTeam, RunHorizons> for Session {
    type Error = RecordError;

    fn tick(&mut self, seen: &RunTick<'_>) -> Result<Verdict, RecordError> {
        let changes = seen.team.members().changes();
        if changes.len() != self.changes.len() {
            self.membership.write(changes)?; // before the tick that it explains
            self.changes = changes.to_vec();
        }
        self.set_points.write(seen.team.assigned())?;
        self.record(seen.tick, seen.steps, &TickTimes::from(seen.team))?;
        Ok(Verdict::Continue)
    }
}
