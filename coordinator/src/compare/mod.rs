//! Comparisons of controllers over scenarios and seeds, all in this process.

mod contender;
mod tables;

pub use contender::{Contender, ContenderError};
pub use tables::{by_family, by_run};

use crate::in_process::run_team;
use shared::horizon_source::{HorizonSource, HorizonSourceError};
use shared::metrics::RunSummary;
use shared::params::Params;
use shared::scenario::{Scenario, ScenarioError, SetupError, set_up};
use std::convert::Infallible;

/// Why a comparison cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A scenario or a parameter.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A start could not be moved.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A horizon.
    #[error(transparent)]
    Horizon(#[from] HorizonSourceError),
}

/// What is compared.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Names of scenarios, suites resolved.
    pub scenarios: Vec<String>,
    /// The controllers.
    pub contenders: Vec<Contender>,
    /// Runs of each, by seed.
    pub seeds: Vec<u64>,
    /// Every start moves by a seeded draw of up to so much per axis, m.
    pub spread: f64,
    /// Changes of parameters for all, as for `--set`.
    pub sets: Vec<String>,
    /// Last tick instead of the scenarios'.
    pub max_ticks: Option<u64>,
}

/// One run to do.
#[derive(Clone, Debug)]
pub struct Job {
    /// Index into [`Plan::contenders`].
    pub contender: usize,
    /// The scenario with its starts moved and its seed set.
    pub scenario: Scenario,
    params: Params,
    horizons: HorizonSource,
}

/// How one run went.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its figures.
    pub summary: RunSummary,
    /// Mean time from having all messages to having a plan, us.
    pub step_us: f64,
}

impl Plan {
    /// All runs, scenario by scenario, contender by contender, seed by seed; everything that can be wrong
    /// is found here, before the first of them.
    pub fn jobs(&self) -> Result<Vec<Job>, CompareError> {
        let mut jobs = Vec::new();
        for name in &self.scenarios {
            for (index, contender) in self.contenders.iter().enumerate() {
                let sets: Vec<String> = contender.sets.iter().chain(&self.sets).cloned().collect();
                let (scenario, params) = set_up(Some(name), None, contender.profile, &sets)?;
                for &seed in &self.seeds {
                    let mut scenario = match self.spread {
                        0.0 => scenario.clone(),
                        spread => scenario.jittered(spread, params.model.min_separation, seed)?,
                    };
                    scenario.seed = seed;
                    scenario.max_ticks = self.max_ticks.unwrap_or(scenario.max_ticks);
                    let robots = scenario.robots.len();
                    let horizons = HorizonSource::new(&contender.horizon, robots, seed, params.horizon.jitter)?;
                    jobs.push(Job { contender: index, scenario, params: params.clone(), horizons });
                }
            }
        }
        Ok(jobs)
    }
}

impl Job {
    /// Does the run.
    pub fn run(&self) -> Run {
        let (mut nanoseconds, mut steps_taken) = (0u64, 0u64);
        let outcome = run_team(
            &self.scenario,
            &self.params,
            |robot, tick| self.horizons.horizon(robot, tick),
            |_, steps| {
                nanoseconds += steps.iter().map(|step| step.solve_ns).sum::<u64>();
                steps_taken += steps.len() as u64;
                Ok::<(), Infallible>(())
            },
        );
        let metrics = match outcome {
            Ok(metrics) => metrics,
            Err(never) => match never {},
        };
        Run { summary: metrics.finish(), step_us: nanoseconds as f64 / steps_taken.max(1) as f64 / 1e3 }
    }
}
