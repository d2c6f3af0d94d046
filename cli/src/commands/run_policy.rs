//! The arguments of `run` that belong to `--policy`.

use crate::exit::Failure;
use coordinator::policy::found::locate;
use coordinator::policy::{PolicyOptions, server_program};
use policy::settings::PolicySettings;
use std::path::{Path, PathBuf};
use std::time::Duration;
use vodca::horizon::Horizon;
use vodca::scenario::Scenario;

/// How a run uses its policy.
#[derive(Debug, clap::Args)]
pub struct PolicyArgs {
    /// Sample the policy's actions (from the run's seed) instead of taking the mean
    #[arg(long, requires = "policy")]
    stochastic: bool,
    /// A second policy that sees the same and is only recorded and compared
    #[arg(long, value_name = "PATH", requires = "policy")]
    shadow: Option<PathBuf>,
    /// ONNX Runtime library (1.24 or later) instead of the embedded back-end
    #[arg(long, value_name = "FILE", requires = "policy")]
    onnxruntime: Option<PathBuf>,
    /// How long a tick waits for the policy's answer, ms
    #[arg(long, value_name = "MS", default_value_t = 500, requires = "policy",
        value_parser = clap::value_parser!(u64).range(1..=1000))]
    policy_wait: u64,
    /// Ticks in a row for which robots keep their last horizon when no answer comes
    #[arg(long, value_name = "TICKS", default_value_t = 10, requires = "policy")]
    policy_hold: u64,
    /// Horizon after that
    #[arg(long, value_name = "STEPS", default_value_t = 20, requires = "policy",
        value_parser = clap::value_parser!(u64).range(1..=49))]
    policy_default: u64,
    /// Time between two looks for a new version, ms
    #[arg(long, value_name = "MS", default_value_t = 250, requires = "policy",
        value_parser = clap::value_parser!(u64).range(1..=10_000))]
    policy_poll: u64,
}

impl PolicyArgs {
    /// The options of a run of `scenario` with `policy`.
    pub(super) fn options(&self, policy: &Path, scenario: &Scenario) -> Result<PolicyOptions, Failure> {
        let there = |path: &Path| {
            std::path::absolute(path)
                .and_then(|path| path.metadata().map(|_| path))
                .map_err(|error| Failure::usage(format!("cannot use the library {}: {error}", path.display())))
        };
        let found = |path: &Path| locate(path).map_err(Failure::usage);
        Ok(PolicyOptions {
            program: server_program().map_err(Failure::usage)?,
            settings: PolicySettings {
                version: 1,
                policy: found(policy)?,
                shadow: self.shadow.as_deref().map(found).transpose()?,
                sample_seed: self.stochastic.then_some(scenario.seed),
                onnxruntime: self.onnxruntime.as_deref().map(there).transpose()?,
                poll_ms: self.policy_poll,
            },
            record: true,
            wait: Duration::from_millis(self.policy_wait),
            hold: self.policy_hold,
            default: Horizon::new(self.policy_default).map_err(Failure::usage)?,
        })
    }
}
