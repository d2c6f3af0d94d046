//! Everything that watches a run: record, metrics, timings. Whoever produces the ticks hands them in.

use crate::policy::PolicySummary;
use crate::record::latency::{self, LatencyWriter};
use crate::record::{About, RecordError, Recorder, RunFolder};
use crate::summary::{End, Summary, Timings};
use crate::tick_parts::TickTimes;
use std::path::{Path, PathBuf};
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// A run that is being watched.
pub struct Session {
    scenario: Scenario,
    params: Params,
    about: About,
    recorder: Recorder,
    latency: LatencyWriter,
    metrics: RunMetrics,
    timings: Timings,
}

impl Session {
    /// Writes what is known before the first tick into `folder`.
    pub fn start(folder: RunFolder, scenario: &Scenario, params: &Params, about: About) -> Result<Self, RecordError> {
        let latency = folder.file(latency::FILE);
        Ok(Self {
            recorder: Recorder::start(folder, scenario, params, &about)?,
            latency: LatencyWriter::create(latency, scenario.robots.len())?,
            metrics: RunMetrics::new(scenario, params),
            timings: Timings::new(scenario.robots.len()),
            scenario: scenario.clone(),
            params: params.clone(),
            about,
        })
    }

    /// Takes in tick `tick`, which took `times`; `steps[i]` is what robot i did. `true`: everybody has
    /// arrived, the run is over.
    pub fn tick(&mut self, tick: u64, steps: &[Step], times: &TickTimes<'_>) -> Result<bool, RecordError> {
        self.recorder.tick(tick, steps)?;
        self.latency.tick(tick, times, steps)?;
        self.metrics.observe(tick, steps);
        self.timings.observe(times, steps);
        Ok(self.metrics.arrived_all())
    }

    /// The figures so far.
    pub fn metrics(&self) -> &RunMetrics {
        &self.metrics
    }

    /// The run's folder.
    pub fn path(&self) -> &Path {
        self.recorder.path()
    }

    /// Ends the record with its summary, for failed and interrupted runs as well. Gives the summary and
    /// the folder. `policy`: what the policy did, in a run with one.
    pub fn finish(self, end: End, policy: Option<PolicySummary>) -> Result<(Summary, PathBuf), RecordError> {
        let names = (self.about.profile.as_str(), self.about.horizon.as_str());
        let mut summary = Summary::new(&self.scenario, &self.params, names, end, self.metrics.finish(), &self.timings);
        summary.policy = policy;
        summary.lateness = self.about.real_time.then(|| self.timings.lateness());
        let folder = self.recorder.finish(&summary)?;
        Ok((summary, folder))
    }
}
