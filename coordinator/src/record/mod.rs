//! The record of a run: one folder that says what was asked, what happened and how it went.
//!
//! | file | holds | written |
//! |---|---|---|
//! | `scenario.toml`, `params.toml` | the effective scenario and parameters | at the start |
//! | `run.toml` | command line, horizon source, exchange, versions, machine | at the start |
//! | `trajectory.csv`, `horizons.csv` | what every robot did, its horizons | tick by tick |
//! | `run.mcap` | the same as a film, with predicted paths | tick by tick |
//! | `latency.csv` | how long ticks and plans took | tick by tick |
//! | `membership.csv` | who did not take part, when and why | when it happens |
//! | `set_points.csv` | set-points that changed | when it happens |
//! | `summary.json` | how it went | at the end |
//!
//! A run that is cut leaves everything up to its last tick and no `summary.json`.

pub mod about;
pub mod folder;
mod foxglove;
pub mod horizons;
pub mod latency;
pub mod mcap;
pub mod membership;
mod on_demand;
#[doc(hidden)]
pub mod samples;
mod scene;
pub(crate) mod scene_messages;
pub mod set_points;
pub mod trajectory;

pub use about::About;
pub use folder::{RecordError, RunFolder};
pub use shared::team::{PARAMS_FILE, SCENARIO_FILE};

use self::horizons::HorizonsWriter;
use self::mcap::LogWriter;
use self::trajectory::TrajectoryWriter;
use serde::Serialize;
use std::path::{Path, PathBuf};
use vodca::Position;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// Name of the summary in a run folder.
pub const SUMMARY_FILE: &str = "summary.json";

/// Writes `scenario.toml` and `params.toml` into `folder`: what robots read when they start, and everybody
/// who reads the run later.
///
/// # Errors
/// A scenario that has no form in TOML, or a file that cannot be written.
pub fn write_setup(folder: &RunFolder, scenario: &Scenario, params: &Params) -> Result<(), RecordError> {
    let text = scenario.to_toml().map_err(|error| RecordError::Encode {
        path: folder.file(SCENARIO_FILE),
        what: "the scenario",
        reason: error.to_string(),
    })?;
    folder.write(SCENARIO_FILE, text.as_bytes())?;
    folder.write(PARAMS_FILE, params.to_toml().as_bytes())
}

/// Records a run tick by tick.
pub struct Recorder {
    folder: RunFolder,
    scenario: Scenario,
    params: Params,
    trajectory: TrajectoryWriter,
    horizons: HorizonsWriter,
    log: LogWriter,
    positions: Vec<Position>,
    ticks: u64,
}

impl Recorder {
    /// Writes what is known before the first tick and opens the files that grow.
    pub fn start(folder: RunFolder, scenario: &Scenario, params: &Params, about: &About) -> Result<Self, RecordError> {
        let about = toml::to_string(about).map_err(|error| RecordError::Encode {
            path: folder.file(about::FILE),
            what: "the run's description",
            reason: error.to_string(),
        })?;
        write_setup(&folder, scenario, params)?;
        folder.write(about::FILE, about.as_bytes())?;
        Ok(Self {
            trajectory: TrajectoryWriter::create(folder.file(trajectory::FILE))?,
            horizons: HorizonsWriter::create(folder.file(horizons::FILE), scenario.robots.len())?,
            log: LogWriter::create(folder.file(self::mcap::FILE), scenario, params)?,
            positions: scenario.robots.iter().map(|robot| robot.start).collect(),
            ticks: 0,
            folder,
            scenario: scenario.clone(),
            params: params.clone(),
        })
    }

    /// Records tick `tick`: `steps[i]` is what robot i did. Ticks come in order from 0. After an error
    /// the files hold every tick before this one; the run should stop.
    pub fn tick(&mut self, tick: u64, steps: &[Step]) -> Result<(), RecordError> {
        self.trajectory.tick(tick, steps)?;
        self.horizons.tick(tick, steps.iter().map(|step| step.horizon))?;
        self.log.tick(&self.scenario, &self.params, tick, steps)?;
        for (position, step) in self.positions.iter_mut().zip(steps) {
            *position = step.next_position;
        }
        self.ticks = tick + 1;
        Ok(())
    }

    /// The run's folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Ends the record: final positions, the log's index, the summary. Returns the folder.
    /// Called for failed and interrupted runs as well.
    pub fn finish(self, summary: &impl Serialize) -> Result<PathBuf, RecordError> {
        self.trajectory.finish(self.ticks, &self.positions)?;
        self.horizons.finish()?;
        self.log.finish()?;
        let mut text = serde_json::to_string_pretty(summary).map_err(|error| RecordError::Encode {
            path: self.folder.file(SUMMARY_FILE),
            what: "the summary",
            reason: error.to_string(),
        })?;
        text.push('\n');
        self.folder.write(SUMMARY_FILE, text.as_bytes())?;
        Ok(self.folder.path().to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn about() -> About {
        About {
            version: 1,
            scenario: "sample".into(),
            robots: 2,
            profile: "paper".into(),
            horizon: "fixed:3".into(),
            seed: 5,
            exchange: "none".into(),
            real_time: false,
            chaos: None,
            command: vec!["coordinator".into()],
            versions: about::Versions::here(),
            machine: about::Machine::here(),
        }
    }

    #[test]
    fn a_run_leaves_its_seven_files() {
        let place = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(place.path()).unwrap();
        let mut recorder = Recorder::start(folder, &samples::scenario(2), &Params::paper(), &about()).unwrap();
        for tick in 0..3 {
            recorder.tick(tick, &samples::steps(2, tick)).unwrap();
        }
        recorder.finish(&serde_json::json!({ "success": true })).unwrap();
        let mut names: Vec<String> =
            fs::read_dir(place.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        let expected = ["horizons.csv", "params.toml", "run.mcap", "run.toml", "scenario.toml", "summary.json"];
        assert_eq!(names[..6], expected);
        assert_eq!(names[6..], ["trajectory.csv"]);
        let back: About = toml::from_str(&fs::read_to_string(place.path().join("run.toml")).unwrap()).unwrap();
        assert_eq!(back, about());
    }

    #[test]
    fn a_run_that_is_cut_stays_readable() {
        let place = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(place.path()).unwrap();
        let mut recorder = Recorder::start(folder, &samples::scenario(2), &Params::paper(), &about()).unwrap();
        recorder.tick(0, &samples::steps(2, 0)).unwrap();
        drop(recorder);
        let read = |name: &str| fs::read_to_string(place.path().join(name)).unwrap();
        assert_eq!(read("trajectory.csv").lines().count(), 3);
        assert_eq!(read("horizons.csv"), "tick,0,1\n0,3,3\n");
        assert!(!place.path().join("summary.json").exists());
    }
}
