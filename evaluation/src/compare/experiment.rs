//! Which runs a comparison consists of. Everything that can be wrong is found before the first of them.

use super::best::in_short;
use super::controller::HorizonPart;
use super::{ControllerSpec, Entry};
use coordinator::policy::client::ClientError;
use coordinator::policy::found::{FindError, FoundPolicy};
use std::collections::BTreeMap;
use vodca::horizon_source::{HorizonSource, HorizonSourceError, HorizonSpec};
use vodca::params::{ControllerKind, Params};
use vodca::scenario::{Scenario, ScenarioError, SetupError, set_up};

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
    #[error("controller `{controller}` in {scenario}: {source}")]
    Horizon {
        /// As given.
        controller: String,
        /// Name of the scenario.
        scenario: String,
        /// What is wrong with it.
        source: HorizonSourceError,
    },
    /// A policy is not there.
    #[error(transparent)]
    Policy(#[from] FindError),
    /// A policy for another number of robots.
    #[error(transparent)]
    Client(#[from] ClientError),
}

/// What is compared.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// The scenarios, suites expanded.
    pub entries: Vec<Entry>,
    /// The controllers.
    pub controllers: Vec<ControllerSpec>,
    /// Seeds of whatever is random; what is not runs once, with the scenario's own seed.
    pub seeds: Vec<u64>,
    /// Every start moves by a seeded draw of up to so much per axis, m.
    pub start_jitter: f64,
    /// Changes of parameters for all, as for `--set`; a controller's own win.
    pub sets: Vec<String>,
    /// Last tick instead of the scenarios'.
    pub max_ticks: Option<u64>,
    /// Every QP is solved a second time with Clarabel.
    pub check_solver: bool,
}

/// One run to do.
#[derive(Clone, Debug)]
pub struct Job {
    /// Index into [`Experiment::controllers`].
    pub controller: usize,
    /// Index into the controller's variants.
    pub variant: usize,
    /// Index into [`Experiment::entries`].
    pub entry: usize,
    /// The scenario with its starts moved and its seed set.
    pub scenario: Scenario,
    /// Where the horizons come from, for tables; `-` where there are none.
    pub horizon: String,
    pub(super) params: Params,
    pub(super) source: Source,
    pub(super) check_solver: bool,
}

/// Where the horizons of a job come from.
#[derive(Clone, Debug)]
pub(super) enum Source {
    /// Known before the run.
    Table(HorizonSource),
    /// Asked at every tick.
    Policy(FoundPolicy),
}

impl Experiment {
    /// All runs: scenario by scenario, controller by controller, variant by variant, horizon by horizon, seed by seed.
    ///
    /// # Errors
    /// The first scenario, parameter, start or horizon that cannot be used.
    pub fn jobs(&self) -> Result<Vec<Job>, CompareError> {
        let mut jobs = Vec::new();
        for entry in 0..self.entries.len() {
            for (controller, spec) in self.controllers.iter().enumerate() {
                for variant in 0..spec.variants.len() {
                    self.add_jobs(&mut jobs, entry, controller, variant)?;
                }
            }
        }
        Ok(jobs)
    }

    /// The runs of one row of one scenario: horizon by horizon, seed by seed.
    fn add_jobs(
        &self,
        jobs: &mut Vec<Job>,
        entry: usize,
        controller: usize,
        variant: usize,
    ) -> Result<(), CompareError> {
        let (Entry { spec, drawn, .. }, chosen) = (&self.entries[entry], &self.controllers[controller]);
        let sets: Vec<String> =
            self.sets.iter().chain(&chosen.sets).chain(&chosen.variants[variant]).cloned().collect();
        let (scenario, params) = set_up(Some(spec), None, chosen.profile, &sets)?;
        for part in &chosen.horizons {
            let once = *drawn || !self.is_random(&params, part);
            let own = [scenario.seed];
            for &seed in if once { &own[..] } else { &self.seeds } {
                let scenario = self.seeded(&scenario, &params, seed)?;
                let source = self.source(chosen, part, &scenario, &params)?;
                let horizon = match params.controller.kind {
                    ControllerKind::Vodca => part.to_string(),
                    ControllerKind::Orca => "-".into(),
                };
                let (params, check_solver) = (params.clone(), self.check_solver);
                jobs.push(Job { controller, variant, entry, scenario, horizon, params, source, check_solver });
            }
        }
        Ok(())
    }

    /// What `job` changes as one variant of several, in short; empty where there is only one.
    pub(crate) fn variant(&self, job: &Job) -> String {
        in_short(&self.controllers[job.controller].variants[job.variant])
    }

    /// The names of the families, in the order in which they first appear, and the family of each entry.
    pub(crate) fn families(&self) -> (Vec<&str>, Vec<usize>) {
        let (mut names, mut places) = (Vec::new(), BTreeMap::new());
        let of_entry = self.entries.iter().map(|entry| {
            *places.entry(entry.family.as_str()).or_insert_with(|| {
                names.push(entry.family.as_str());
                names.len() - 1
            })
        });
        let of_entry = of_entry.collect();
        (names, of_entry)
    }

    fn source(
        &self,
        controller: &ControllerSpec,
        horizon: &HorizonPart,
        scenario: &Scenario,
        params: &Params,
    ) -> Result<Source, CompareError> {
        match horizon {
            HorizonPart::Policy(name) => {
                let policy = FoundPolicy::find(name)?;
                policy.must_fit(scenario)?;
                Ok(Source::Policy(policy))
            }
            HorizonPart::Table(spec) => {
                HorizonSource::new(spec, scenario.robots.len(), scenario.seed, params.horizon.jitter)
                    .map(Source::Table)
                    .map_err(|source| CompareError::Horizon {
                        controller: controller.to_string(),
                        scenario: scenario.name.clone(),
                        source,
                    })
            }
        }
    }

    /// Whether another seed gives another run.
    fn is_random(&self, params: &Params, horizon: &HorizonPart) -> bool {
        let disturbance = &params.disturbance;
        let own = match params.controller.kind {
            ControllerKind::Vodca => match horizon {
                HorizonPart::Table(HorizonSpec::Script(_)) => false, // never jittered
                _ => params.horizon.jitter > 0 || *horizon == HorizonPart::Table(HorizonSpec::Random(None)),
            },
            ControllerKind::Orca => params.orca.push > 0.0,
        };
        own || self.start_jitter > 0.0
            || disturbance.noise > 0.0
            || disturbance.plan_loss > 0.0
            || disturbance.position_loss > 0.0
    }

    fn seeded(&self, scenario: &Scenario, params: &Params, seed: u64) -> Result<Scenario, ScenarioError> {
        let mut scenario = match self.start_jitter {
            0.0 => scenario.clone(),
            spread => scenario.jittered(spread, params.model.min_separation, seed)?,
        };
        scenario.seed = seed;
        scenario.max_ticks = self.max_ticks.unwrap_or(scenario.max_ticks);
        Ok(scenario)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{ControllerSpecs, expand};
    use policy::contract::Contract;
    use policy::onnx::{Activation, ActorGraph, Dense};

    fn runs(controller: &str, scenario: &str, change: impl Fn(&mut Experiment)) -> Result<Vec<(String, u64)>, String> {
        let mut experiment = Experiment {
            entries: expand(scenario).unwrap(),
            controllers: controller.parse::<ControllerSpecs>().unwrap().0,
            seeds: vec![0, 1, 2],
            start_jitter: 0.0,
            sets: vec![],
            max_ticks: None,
            check_solver: false,
        };
        change(&mut experiment);
        let jobs = experiment.jobs().map_err(|error| error.to_string())?;
        Ok(jobs.into_iter().map(|job| (job.horizon, job.scenario.seed)).collect())
    }

    #[test]
    fn only_what_is_random_runs_with_every_seed() {
        let count = |controller: &str, set: &str| {
            let sets: Vec<String> = set.split_whitespace().map(String::from).collect();
            runs(controller, "two_setpoint", |experiment| experiment.sets = sets.clone()).unwrap().len()
        };
        assert_eq!(count("paper:fixed:20", ""), 1);
        assert_eq!(count("paper:random", ""), 3);
        assert_eq!(count("paper:each:10,20,random", ""), 5);
        assert_eq!(count("paper:fixed:20", "horizon.jitter=2"), 3);
        assert_eq!(count("paper:fixed:20", "disturbance.plan_delay=2"), 1);
        assert_eq!(count("paper:fixed:20", "disturbance.plan_loss=0.1"), 3);
        assert_eq!((count("orca", ""), count("orca", "orca.push=0.3"), count("orca", "horizon.jitter=2")), (1, 3, 1));
        assert_eq!(runs("orca", "two_setpoint", |experiment| experiment.start_jitter = 0.1).unwrap().len(), 3);
    }

    #[test]
    fn drawn_layouts_run_once_with_their_own_seed() {
        let all = runs("safe:random", "random-boxes:4", |_| ()).unwrap();
        assert_eq!(all.iter().map(|(_, seed)| *seed).collect::<Vec<_>>(), [0, 1, 2, 3]);
    }

    #[test]
    fn a_contenders_own_settings_win() {
        let experiment = Experiment {
            entries: expand("two_setpoint").unwrap(),
            controllers: ["safe[vodca.turn=0.1]", "safe"]
                .iter()
                .flat_map(|c| c.parse::<ControllerSpecs>().unwrap().0)
                .collect(),
            seeds: vec![0],
            start_jitter: 0.0,
            sets: vec!["vodca.turn=0.2".into()],
            max_ticks: Some(7),
            check_solver: false,
        };
        let jobs = experiment.jobs().unwrap();
        assert_eq!((jobs[0].params.vodca.turn, jobs[1].params.vodca.turn), (0.1, 0.2));
        assert!(jobs.iter().all(|job| job.scenario.max_ticks == 7));
    }

    #[test]
    fn a_script_that_does_not_fit_and_a_policy_that_is_not_there_are_named() {
        let place = tempfile::tempdir().unwrap();
        let script = place.path().join("three.csv");
        std::fs::write(&script, "0,9,9,9\n").unwrap();
        let controller = format!("safe:script:{}", script.display());
        let message = runs(&controller, "two_setpoint", |_| ()).unwrap_err();
        assert!(message.starts_with(&format!("controller `{controller}` in two_setpoint:")), "{message}");
        let message = runs("paper:policy:nowhere", "two_setpoint", |_| ()).unwrap_err();
        assert!(message.starts_with("there is no policy nowhere"), "{message}");
    }

    #[test]
    fn a_policy_must_be_for_the_number_of_robots() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("fourteen.onnx");
        let layer = |inputs: usize, outputs: usize| Dense {
            inputs,
            outputs,
            weight: vec![0.0; inputs * outputs],
            bias: vec![0.0; outputs],
        };
        let graph = ActorGraph {
            hidden: vec![layer(28, 8)],
            activation: Activation::Relu,
            mean: layer(8, 14),
            log_std: None,
            log_std_bounds: (-20.0, 2.0),
            metadata: std::collections::BTreeMap::new(),
        };
        std::fs::write(&file, graph.write()).unwrap();
        std::fs::write(file.with_extension("json"), Contract::standard(14, false).to_json()).unwrap();
        let controller = format!("paper:policy:{}", file.display());
        assert_eq!(runs(&controller, "ex14_d", |_| ()).unwrap(), [(controller.replace("paper:", ""), 0)]);
        let message = runs(&controller, "two_setpoint", |_| ()).unwrap_err();
        assert!(message.contains("is for 14 robots and two_setpoint has 2"), "{message}");
    }
}
