//! `run.toml`: what was asked for, by whom it was answered, and where.

use serde::{Deserialize, Serialize};

/// Name of the file in a run folder.
pub const FILE: &str = "run.toml";

/// How a run came about. Nothing in it changes the trajectory beyond what scenario and parameters say,
/// except `horizon`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Version of this format.
    pub version: u32,
    /// Name of the scenario; its full text is in `scenario.toml`.
    pub scenario: String,
    /// Number of robots.
    pub robots: usize,
    /// Name of the profile; the effective values are in `params.toml`.
    pub profile: String,
    /// The horizon's source as given; what it chose is in `horizons.csv`.
    pub horizon: String,
    /// Seed of everything random in the run.
    pub seed: u64,
    /// How plans were exchanged: `peer`, `relay`, or `none` for a team in one process.
    pub exchange: String,
    /// Whether ticks lasted one sample time each.
    pub real_time: bool,
    /// Faults on purpose, as `--chaos` said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chaos: Option<String>,
    /// The command line.
    pub command: Vec<String>,
    /// What ran.
    pub versions: Versions,
    /// Where it ran.
    pub machine: Machine,
}

/// What ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Versions {
    /// Version of vodca.
    pub vodca: String,
    /// `debug` or `release`.
    pub build: String,
}

/// Where it ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Operating system.
    pub system: String,
    /// Processor family.
    pub processor: String,
    /// Processors that this process may use.
    pub processors: usize,
}

impl Versions {
    /// Of this program.
    pub fn here() -> Self {
        let build = if cfg!(debug_assertions) { "debug" } else { "release" };
        Self { vodca: env!("CARGO_PKG_VERSION").into(), build: build.into() }
    }
}

impl Machine {
    /// This machine.
    pub fn here() -> Self {
        Self {
            system: std::env::consts::OS.into(),
            processor: std::env::consts::ARCH.into(),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}
