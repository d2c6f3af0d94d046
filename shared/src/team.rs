//! What every process of a run must know and no scenario or parameter says: `team.toml` in the
//! folder of the run, written by the coordinator before it starts anybody.

use crate::chaos::Chaos;
use crate::exchange::Kind;
use crate::messages::MAX_ROBOTS;
use crate::runtime_dir::RuntimeDir;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use vodca::params::{Params, ParamsFileError};
use vodca::random;
use vodca::scenario::{Scenario, ScenarioError};

/// Name of the team's file in the folder of a run.
pub const TEAM_FILE: &str = "team.toml";
/// Name of the scenario's file.
pub const SCENARIO_FILE: &str = "scenario.toml";
/// Name of the file of effective parameters.
pub const PARAMS_FILE: &str = "params.toml";

/// Epoch of the first episode of a run; every further one has the next number.
pub const FIRST_EPOCH: u64 = 1;

/// Version of the team's file.
pub const VERSION: u32 = 3;

/// How the processes of a run find and treat each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TeamFile {
    /// [`VERSION`].
    pub version: u32,
    /// n, the number of robots.
    pub robots: usize,
    /// The form of the exchange.
    pub exchange: Kind,
    /// Seed of everything random in the first episode; [`random::episode_seed`] gives the others'.
    pub seed: u64,
    /// What differs between the episodes of this run.
    #[serde(default)]
    pub episodes: Episodes,
    /// How long a robot waits for tick 0, s.
    pub start_patience: f64,
    /// How long a robot waits between two ticks before it takes the coordinator for dead, s.
    pub silence_limit: f64,
    /// Faults on purpose.
    #[serde(default, skip_serializing_if = "Chaos::is_none")]
    pub chaos: Chaos,
    /// Where the shared files are.
    pub place: RuntimeDir,
}

/// What differs between the episodes of a run, besides their seeds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Episodes {
    /// Every start is moved by up to this much per axis, m.
    #[serde(default)]
    pub start_jitter: f64,
    /// Number of the first episode: a session can go on where another one stopped.
    #[serde(default)]
    pub first: u64,
    /// After so many episodes they begin again with the first: an evaluation repeats itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycle: Option<u64>,
    /// A generated layout less its seed (`box:8:3`): every episode has a layout of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
}

impl Episodes {
    /// Number of the episode with `epoch` ([`FIRST_EPOCH`] and on).
    pub fn number(&self, epoch: u64) -> u64 {
        let played = epoch.saturating_sub(FIRST_EPOCH);
        self.first + self.cycle.map_or(played, |cycle| played % cycle.max(1))
    }

    /// The layout of the episode with `seed`; `scenario` is that of a run without a family.
    ///
    /// # Errors
    /// A layout that cannot be made, or that has no room for moved starts.
    pub fn scenario(&self, scenario: &Scenario, params: &Params, seed: u64) -> Result<Scenario, ScenarioError> {
        scenario.of_episode(self.family.as_deref(), self.start_jitter, params.model.min_separation, seed)
    }
}

/// The folder of a run does not say what a robot needs to know.
#[derive(Debug, thiserror::Error)]
pub enum TeamError {
    /// A file cannot be read or written.
    #[error("cannot access {}: {source}; is this the folder of a run that is being started?", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is not one of ours.
    #[error("{}: {message}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        message: String,
    },
    /// The team file and the scenario disagree.
    #[error("{}: a team of {robots} robots, but 1..={MAX_ROBOTS} are possible and the scenario has {scenario}", path.display())]
    Robots {
        /// The team file.
        path: PathBuf,
        /// What it says.
        robots: usize,
        /// What the scenario says.
        scenario: usize,
    },
    /// The scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The parameters.
    #[error(transparent)]
    Params(#[from] ParamsFileError),
}

/// Everything static about a run, as read from its folder.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The team.
    pub team: TeamFile,
    /// The layout.
    pub scenario: Scenario,
    /// The effective parameters.
    pub params: Params,
}

impl TeamFile {
    /// Writes it into the folder `run`.
    pub fn write(&self, run: &Path) -> Result<(), TeamError> {
        let path = run.join(TEAM_FILE);
        let text = toml::to_string(self)
            .map_err(|error| TeamError::Malformed { path: path.clone(), message: error.to_string() })?;
        std::fs::write(&path, text).map_err(|source| TeamError::File { path, source })
    }

    /// How long a robot waits for its next order.
    pub fn patience(&self, started: bool) -> Duration {
        let seconds = if started { self.silence_limit } else { self.start_patience };
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::from_secs(60))
    }
}

impl Setup {
    /// The same for one episode: its layout and its seed. `epoch` counts from [`FIRST_EPOCH`].
    pub fn of_episode(&self, epoch: u64) -> Result<Self, ScenarioError> {
        let seed = random::episode_seed(self.team.seed, self.team.episodes.number(epoch));
        let scenario = self.team.episodes.scenario(&self.scenario, &self.params, seed)?;
        Ok(Self { team: TeamFile { seed, ..self.team.clone() }, scenario, params: self.params.clone() })
    }

    /// Reads the folder `run`.
    pub fn load(run: &Path) -> Result<Self, TeamError> {
        let path = run.join(TEAM_FILE);
        let team: TeamFile = toml::from_str(&read(&path)?)
            .map_err(|error| TeamError::Malformed { path: path.clone(), message: error.to_string() })?;
        if team.version != VERSION {
            let message = format!("version = {} is not {VERSION}: written by another release of vodca", team.version);
            return Err(TeamError::Malformed { path, message });
        }
        let scenario = Scenario::load(&run.join(SCENARIO_FILE))?;
        if team.robots != scenario.robots.len() || !(1..=MAX_ROBOTS).contains(&team.robots) {
            return Err(TeamError::Robots { path, robots: team.robots, scenario: scenario.robots.len() });
        }
        let params_path = run.join(PARAMS_FILE);
        let params = Params::from_toml(&read(&params_path)?, &params_path.to_string_lossy())?;
        Ok(Self { team, scenario, params })
    }
}

fn read(path: &Path) -> Result<String, TeamError> {
    std::fs::read_to_string(path).map_err(|source| TeamError::File { path: path.to_owned(), source })
}
