//! Runs whose every tick is kept, for figures.

use crate::in_process::{run_team, run_whole};
use coordinator::policy::client::PolicyClient;
use coordinator::policy::found::FoundPolicy;
use shared::stop::StopFlag;
use std::convert::Infallible;
use std::error::Error;
use std::path::Path;
use vodca::horizon_source::HorizonSource;
use vodca::metrics::RunSummary;
use vodca::params::{Params, Profile};
use vodca::play::Halt;
use vodca::scenario::{Scenario, SetupError, set_up};
use vodca::step::Step;

/// Where policies lie.
const POLICIES: &str = "policies";

/// What a figure runs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    pub(super) scenario: &'static str,
    pub(super) profile: Profile,
    pub(super) set: Option<&'static str>,
    /// Folder in `policies` of the policy that was trained for it.
    pub(super) policy: Option<&'static str>,
}

/// A run, tick by tick.
pub(super) struct KeptRun {
    pub(super) horizon: String,
    pub(super) scenario: Scenario,
    pub(super) params: Params,
    pub(super) ticks: Vec<Vec<Step>>,
    pub(super) summary: RunSummary,
}

impl Setting {
    /// Runs it with `horizon`, a SPEC of `--horizon`.
    pub(super) fn run(&self, horizon: &str) -> Result<KeptRun, Box<dyn Error + Send + Sync>> {
        let (scenario, params) = self.set_up()?;
        let source =
            HorizonSource::new(&horizon.parse()?, scenario.robots.len(), scenario.seed, params.horizon.jitter)?;
        let mut ticks = Vec::new();
        let summary = run_whole(&scenario, &params, &source, |steps| ticks.push(steps.to_vec()));
        Ok(KeptRun { horizon: horizon.into(), scenario, params, ticks, summary })
    }

    /// The run with variable horizons: those of its policy where that is there, otherwise
    /// [`Setting::best_random`].
    pub(super) fn variable(&self, seeds: u64) -> Result<KeptRun, Box<dyn Error + Send + Sync>> {
        let there = |name: &&str| Path::new(POLICIES).join(name).is_dir();
        let Some(name) = self.policy.filter(there) else { return self.best_random(seeds) };
        let (scenario, params) = self.set_up()?;
        let mut client = PolicyClient::start(&FoundPolicy::find(name)?, &scenario, &params, &StopFlag::default())?;
        let mut ticks = Vec::new();
        let ended = run_team(&scenario, &params, &mut client.horizons(&params, scenario.seed), |_, steps| {
            ticks.push(steps.to_vec());
            Ok::<(), Infallible>(())
        });
        let metrics = match ended {
            Ok(metrics) => metrics,
            Err(Halt::Horizons(error)) => return Err(error.into()),
            Err(Halt::Team(never) | Halt::Observer(never)) => match never {},
        };
        Ok(KeptRun { horizon: format!("policy:{name}"), scenario, params, ticks, summary: metrics.finish() })
    }

    fn set_up(&self) -> Result<(Scenario, Params), SetupError> {
        let sets: Vec<String> = self.set.into_iter().map(String::from).collect();
        set_up(Some(self.scenario), None, self.profile, &sets)
    }

    /// The shortest successful run of `seeds` with random horizons; the first one when none succeeds.
    pub(super) fn best_random(&self, seeds: u64) -> Result<KeptRun, Box<dyn Error + Send + Sync>> {
        let mut best = self.run("random:0")?;
        for seed in 1..seeds {
            let next = self.run(&format!("random:{seed}"))?;
            let shorter = next.summary.path_cost < best.summary.path_cost || !best.summary.success;
            if next.summary.success && shorter {
                best = next;
            }
        }
        Ok(best)
    }

    /// The command that repeats a run with `horizon`.
    pub(super) fn command(&self, horizon: &str) -> String {
        let Self { scenario, profile, .. } = self;
        let set = self.set.map_or(String::new(), |set| format!(" --set {set}"));
        let horizons = match horizon.strip_prefix("policy:") {
            Some(name) => format!("--policy {POLICIES}/{name}"),
            None => format!("--horizon {horizon}"),
        };
        format!("./run.sh run --scenario {scenario} --profile {profile} {horizons}{set}")
    }
}

impl KeptRun {
    /// Mean planning time of a robot in a tick, us.
    pub(super) fn mean_step_us(&self) -> f64 {
        let count = self.ticks.iter().flatten().count().max(1);
        self.ticks.iter().flatten().map(|step| step.step_ns as f64).sum::<f64>() / count as f64 / 1e3
    }

    /// Name of its bar.
    pub(super) fn name(&self) -> String {
        match self.horizon.strip_prefix("fixed:") {
            Some(steps) => format!("FH{steps}"),
            None => "VH".into(),
        }
    }
}
