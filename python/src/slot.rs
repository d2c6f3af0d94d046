//! One environment of many: what is observed and earned in it, and when it begins again.

use crate::error::refused;
use policy::contract::Contract;
use policy::environment::{Environment, Settings};
use pyo3::prelude::*;
use vodca::horizon::Horizon;
use vodca::local_observation::{LocalObserver, Seen};
use vodca::params::Params;
use vodca::scenario::{Scenario, ScenarioError};

/// What is observed.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum See {
    /// Everybody's measured position, scaled as the contract says: one observation for all robots.
    Positions,
    /// What each robot sees for itself.
    Local(Seen),
}

/// What each robot earns, beside what the team does.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Earn {
    Nothing,
    Objective,
    Paper,
}

/// What happens when an episode has ended.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Again {
    /// The next step begins the next episode instead of playing.
    NextStep,
    /// The same step begins it.
    SameStep,
    /// Nothing.
    Asked,
}

/// One environment, and what came of its newest step.
pub(crate) struct Slot {
    pub(crate) environment: Environment,
    pub(crate) observer: LocalObserver,
    pub(crate) horizons: Vec<Horizon>,
    pub(crate) ended: bool,
    pub(crate) reward: f64,
    pub(crate) earned: Vec<f64>,
    pub(crate) terminated: bool,
    pub(crate) truncated: bool,
    /// Of an episode that ended in this step: what was seen last, and its figures.
    pub(crate) last: Option<(Vec<f32>, String)>,
}

impl Slot {
    /// The environment of `scenario` and the session with `seed`.
    pub(crate) fn new(
        scenario: &Scenario,
        params: &Params,
        settings: &Settings,
        see: See,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let environment = Environment::new(scenario.clone(), params.clone(), settings.clone(), seed)?;
        let robots = environment.measured().len();
        let seen = if let See::Local(seen) = see { seen } else { Seen::default() };
        Ok(Self {
            observer: LocalObserver::new(environment.scenario(), params, seen),
            environment,
            horizons: vec![Horizon::MAX; robots],
            ended: false,
            reward: 0.0,
            earned: vec![0.0; robots],
            terminated: false,
            truncated: false,
            last: None,
        })
    }

    /// Begins the first episode of the session with `seed`, or the next one of the present session.
    pub(crate) fn begin(&mut self, seed: Option<u64>, see: See) -> Result<(), ScenarioError> {
        match seed {
            Some(seed) => self.environment.restart(seed)?,
            None => self.environment.next_episode()?,
        }
        self.ended = false;
        // Layouts of a family differ.
        if let See::Local(seen) = see {
            self.observer = LocalObserver::new(self.environment.scenario(), self.environment.params(), seen);
        }
        Ok(())
    }

    /// Writes what is seen into `out`.
    pub(crate) fn observe(&self, contract: &Contract, see: See, out: &mut [f32]) {
        match see {
            See::Positions => contract.normalise(self.environment.measured(), out),
            See::Local(_) => self.environment.observe(&self.observer, out),
        }
    }

    /// One tick, or the beginning of the next episode.
    pub(crate) fn play(
        &mut self,
        contract: &Contract,
        (see, earn, again): (See, Earn, Again),
        out: &mut [f32],
    ) -> Result<(), ScenarioError> {
        if self.ended && again == Again::NextStep {
            self.begin(None, see)?;
            (self.reward, self.terminated, self.truncated) = (0.0, false, false);
            self.earned.fill(0.0);
            self.observe(contract, see, out);
            return Ok(());
        }
        let ended = self.environment.step(&mut self.horizons);
        if earn != Earn::Nothing {
            for (robot, earned) in self.earned.iter_mut().enumerate() {
                let share = self.environment.share(robot);
                *earned = if earn == Earn::Objective { share.objective() } else { share.total() };
            }
        }
        self.reward = match earn {
            Earn::Objective => self.earned.iter().sum(),
            Earn::Nothing | Earn::Paper => ended.judgement.terms.total(),
        };
        (self.terminated, self.truncated) = (ended.terminated, ended.truncated);
        self.observe(contract, see, out);
        self.ended = ended.terminated || ended.truncated;
        if self.ended {
            let figures = figures(&self.environment).unwrap_or_default();
            self.last = Some((out.to_vec(), figures));
            if again == Again::SameStep {
                self.begin(None, see)?;
                self.observe(contract, see, out);
            }
        }
        Ok(())
    }
}

/// The figures so far, JSON.
pub(crate) fn figures(environment: &Environment) -> PyResult<String> {
    serde_json::to_string(&environment.metrics().finish()).map_err(refused)
}
