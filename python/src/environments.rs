//! Environments in this process, many at once: what Gymnasium's and PettingZoo's classes in `package/vodca` hand over to.

use crate::arrays::{array, numbers, points};
use crate::error::{refused, wrong};
use crate::parameters::{Given, Setup, dictionary};
use crate::scenario::Scenario;
use crate::slot::{Again, Earn, See, Slot, figures};
use crate::workers::Workers;
use policy::contract::{Contract, Observation};
use policy::environment::Settings;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, PoisonError};
use vodca::horizon::Horizon;
use vodca::local_observation::{BOUND, MOST_SEEN, Seen};
use vodca::scenario::{MAX_COORDINATE, ScenarioError};

/// Several environments with the same scenario and parameters.
#[pyclass(module = "vodca")]
pub(crate) struct Environments {
    /// Never contended: only methods that own everything use it. (PyO3 asks for `Sync`; robots' bodies need not have it.)
    all: Mutex<Vec<Slot>>,
    contract: Contract,
    see: See,
    earn: Earn,
    again: Again,
    workers: Workers,
    count: usize,
    robots: usize,
    /// Observed numbers of one environment.
    width: usize,
    settings: Settings,
    profile: String,
}

/// The choice that a word stands for.
fn word<T: Copy>(what: &str, given: &str, allowed: &[(&str, T)]) -> PyResult<T> {
    let words: Vec<String> = allowed.iter().map(|(word, _)| format!("\"{word}\"")).collect();
    let found = allowed.iter().find(|(word, _)| *word == given).map(|(_, choice)| *choice);
    found.ok_or_else(|| wrong(format!("{what} = \"{given}\" is not known; allowed: {}", words.join(", "))))
}

#[pymethods]
impl Environments {
    #[new]
    #[pyo3(signature = (
        scenario, count, *, observation, rewards, autoreset, threads = 0, profile = "safe", seed = None, max_ticks = None,
        start_jitter = 0.0, family = None, after_arrival = 0, neighbours = 4, obstacles = 2, params = None, keywords = None,
    ))]
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn new(
        py: Python<'_>,
        scenario: &Bound<'_, PyAny>,
        count: usize,
        observation: &str,
        rewards: &str,
        autoreset: &str,
        threads: usize,
        profile: &str,
        seed: Option<u64>,
        max_ticks: Option<u64>,
        start_jitter: f64,
        family: Option<String>,
        after_arrival: Option<u64>,
        neighbours: usize,
        obstacles: usize,
        params: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        if count == 0 {
            return Err(wrong("num_envs = 0 is not allowed; allowed: 1 or more"));
        }
        if neighbours.max(obstacles) > MOST_SEEN {
            return Err(wrong(format!("at most {MOST_SEEN} neighbours and {MOST_SEEN} obstacles can be seen")));
        }
        if !(start_jitter >= 0.0 && start_jitter.is_finite()) {
            return Err(wrong(format!("start_jitter = {start_jitter} m is not allowed; allowed: 0 or more")));
        }
        let seen = Seen { neighbours, obstacles };
        let see = word("observation", observation, &[("positions", See::Positions), ("local", See::Local(seen))])?;
        let earn = word(
            "rewards",
            rewards,
            &[("objective", Earn::Objective), ("paper", Earn::Paper), ("team", Earn::Nothing)],
        )?;
        let again = word(
            "autoreset",
            autoreset,
            &[("next_step", Again::NextStep), ("same_step", Again::SameStep), ("disabled", Again::Asked)],
        )?;
        let setup = Given { scenario, profile, seed, max_ticks, params, keywords }.set_up()?;
        py.detach(|| {
            Self::build(setup, count, Settings { start_jitter, family, after_arrival }, (see, earn, again), threads)
        })
    }

    /// Begins the first episode of a session with each of `seeds`, or the next one where that is None.
    fn reset<'py>(&mut self, py: Python<'py>, seeds: Vec<Option<u64>>) -> PyResult<Bound<'py, PyAny>> {
        let (see, shape) = (self.see, self.shape());
        let Self { all, contract, width, count, .. } = self;
        let all = all.get_mut().unwrap_or_else(PoisonError::into_inner);
        if seeds.len() != all.len() {
            return Err(wrong(format!("{} seeds for {count} environments; give one each", seeds.len())));
        }
        let mut seen = vec![0.0; *width * all.len()];
        for ((slot, seed), out) in all.iter_mut().zip(seeds).zip(seen.chunks_exact_mut(*width)) {
            slot.begin(seed, see).map_err(refused)?;
            slot.observe(contract, see, out);
        }
        array(py, seen, &shape)
    }

    /// One tick of every environment. `actions` are [environments, robots]: float32 in -1..=1, or int64 horizons in 1..=49.
    fn step<'py>(&mut self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Stepped<'py>> {
        self.take(actions)?;
        let Self { all, contract, see, earn, again, workers, width, .. } = self;
        let all = all.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut seen = vec![0.0; *width * all.len()];
        let play = |slot: &mut Slot, out: &mut [f32]| slot.play(contract, (*see, *earn, *again), out);
        let played = if let [only] = all.as_mut_slice() {
            Ok(play(only, &mut seen))
        } else {
            py.detach(|| workers.each(all, &mut seen, *width, play))
        };
        played?.map_err(refused)?;
        let (count, robots, shape) = (self.count, self.robots, self.shape());
        let earns = self.earn != Earn::Nothing;
        let all = self.all();
        let rewards: Vec<f64> = all.iter().map(|slot| slot.reward).collect();
        let earned: Vec<f64> = all.iter().flat_map(|slot| slot.earned.iter().copied()).collect();
        let earned = if earns { Some(array(py, earned, &[count, robots])?) } else { None };
        let mut ended = Vec::new();
        for (index, slot) in all.iter_mut().enumerate() {
            if let Some((seen, figures)) = slot.last.take() {
                ended.push((index, array(py, seen, &shape[1..])?, figures));
            }
        }
        Ok((
            array(py, seen, &shape)?,
            array(py, rewards, &[count])?,
            earned,
            array(py, all.iter().map(|slot| slot.terminated).collect(), &[count])?,
            array(py, all.iter().map(|slot| slot.truncated).collect(), &[count])?,
            ended,
        ))
    }

    /// Everybody's measured position in environment `index`, m.
    fn measured<'py>(&mut self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let measured = self.slot(index)?.environment.measured();
        points(py, measured.iter().copied(), &[measured.len()])
    }

    /// The horizons of the newest tick of environment `index`, jitter included.
    fn horizons<'py>(&mut self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let steps = self.slot(index)?.environment.steps();
        let all: Vec<u8> = steps.iter().map(|step| step.horizon.steps() as u8).collect();
        let shape = [all.len()];
        array(py, all, &shape)
    }

    /// The layout of the episode in environment `index`; its seed is the episode's.
    fn scenario(&mut self, index: usize) -> PyResult<Scenario> {
        Ok(Scenario { layout: self.slot(index)?.environment.scenario().clone() })
    }

    /// Ticks played in the episode in environment `index`.
    fn tick(&mut self, index: usize) -> PyResult<u64> {
        Ok(self.slot(index)?.environment.tick())
    }

    /// The figures so far of the episode in environment `index`, JSON.
    fn summary(&mut self, index: usize) -> PyResult<String> {
        figures(&self.slot(index)?.environment)
    }

    fn params<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, self.slot(0)?.environment.params())
    }

    /// Smallest and largest number of each kind that can be observed, of one environment.
    fn bounds<'py>(&mut self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        if self.see == See::Positions {
            return self.state_bounds(py);
        }
        let all = |bound: f32| array(py, vec![bound; self.width], &self.shape()[1..]);
        Ok((all(-BOUND)?, all(BOUND)?))
    }

    /// Everybody's measured position in environment `index`, scaled: [2 robots].
    fn state<'py>(&mut self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let mut state = vec![0.0; 2 * self.robots];
        let Self { all, contract, .. } = self;
        let slot = all.get_mut().unwrap_or_else(PoisonError::into_inner).get(index);
        let slot = slot.ok_or_else(|| wrong(format!("there is no environment {index}")))?;
        slot.observe(contract, See::Positions, &mut state);
        let shape = [state.len()];
        array(py, state, &shape)
    }

    /// Between what numbers `state` stays.
    fn state_bounds<'py>(&mut self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let [low, high] = self.reach();
        let width = 2 * self.robots;
        let of = |corner: [f64; 2]| {
            let scaled = (0..width).map(|at| self.contract.observation.scaled(at % 2, corner[at % 2]));
            array(py, scaled.collect::<Vec<f32>>(), &[width])
        };
        Ok((of(low)?, of(high)?))
    }

    /// [x, y] that is subtracted from positions, m, and what they are then multiplied by, 1/m.
    fn scaling(&self) -> ([f64; 2], [f64; 2]) {
        (self.contract.observation.offset, self.contract.observation.scale)
    }

    #[getter]
    fn robots(&self) -> usize {
        self.robots
    }

    #[getter]
    fn count(&self) -> usize {
        self.count
    }

    /// What is observed: "positions" or "local".
    #[getter]
    fn observation(&self) -> &'static str {
        if self.see == See::Positions { "positions" } else { "local" }
    }

    #[getter]
    fn profile(&self) -> &str {
        &self.profile
    }
}

/// Observations, rewards of the team and of its robots, terminated, truncated, and of each episode that has ended the
/// environment, what was seen last and its figures.
type Stepped<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Option<Bound<'py, PyAny>>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Vec<(usize, Bound<'py, PyAny>, String)>,
);

impl Environments {
    fn build(
        setup: Setup,
        count: usize,
        settings: Settings,
        (see, earn, again): (See, Earn, Again),
        threads: usize,
    ) -> PyResult<Self> {
        let Setup { scenario, params, profile } = setup;
        let robots = scenario.robots.len();
        let mut contract = Contract::standard(robots, false);
        contract.observation = Observation::over_layouts(std::slice::from_ref(&scenario));
        let width = if let See::Local(seen) = see { robots * seen.width() } else { 2 * robots };
        let slot =
            |index: usize| Slot::new(&scenario, &params, &settings, see, scenario.seed.wrapping_add(index as u64));
        let all: Vec<Slot> = (0..count).map(slot).collect::<Result<_, ScenarioError>>().map_err(refused)?;
        if let Some(other) = all.iter().find(|slot| slot.environment.measured().len() != robots) {
            return Err(wrong(format!(
                "layouts of the family have {} robots, the scenario {robots}; give a scenario of the family",
                other.environment.measured().len()
            )));
        }
        let workers = Workers::new(threads);
        Ok(Self {
            all: Mutex::new(all),
            count,
            contract,
            see,
            earn,
            again,
            workers,
            robots,
            width,
            settings,
            profile: profile.to_string(),
        })
    }

    fn slot(&mut self, index: usize) -> PyResult<&Slot> {
        let count = self.count;
        self.all().get(index).ok_or_else(|| wrong(format!("there is no environment {index}; there are {count}")))
    }

    fn all(&mut self) -> &mut [Slot] {
        self.all.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shape of the observations of all environments.
    fn shape(&self) -> Vec<usize> {
        match self.see {
            See::Positions => vec![self.count, self.width],
            See::Local(seen) => vec![self.count, self.robots, seen.width()],
        }
    }

    /// The corners between which everybody measures itself whatever happens, m.
    fn reach(&mut self) -> [[f64; 2]; 2] {
        if self.settings.family.is_some() {
            return [[-MAX_COORDINATE; 2], [MAX_COORDINATE; 2]];
        }
        let jitter = self.settings.start_jitter;
        let environment = &self.all()[0].environment;
        let (scenario, params) = (environment.scenario(), environment.params());
        let walked = scenario.max_ticks as f64 * params.model.sample_time * params.model.max_speed;
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for robot in &scenario.robots {
            for axis in 0..2 {
                low[axis] = low[axis].min(robot.start[axis]);
                high[axis] = high[axis].max(robot.start[axis]);
            }
        }
        let margin = walked + 2.0 * jitter + params.disturbance.noise;
        [low.map(|at| at - margin), high.map(|at| at + margin)]
    }

    /// Takes the actions of all environments.
    fn take(&mut self, actions: &Bound<'_, PyAny>) -> PyResult<()> {
        let shape = [self.count, self.robots];
        if self.again == Again::Asked && self.all().iter().any(|slot| slot.ended) {
            return Err(wrong("the episode has ended; call reset() before the next step"));
        }
        let horizons = match numbers::<f32>(actions, "action", &shape) {
            Ok(actions) => actions
                .into_iter()
                .enumerate()
                .map(|(at, action)| {
                    Horizon::from_action(f64::from(action)).ok_or_else(|| {
                        wrong(format!("the action {action} of robot {} is not a finite number", at % shape[1]))
                    })
                })
                .collect::<PyResult<Vec<_>>>()?,
            Err(refused) => match numbers::<i64>(actions, "action", &shape) {
                Ok(steps) => steps
                    .into_iter()
                    .map(|steps| Horizon::new(u64::try_from(steps).unwrap_or(0)).map_err(crate::error::refused))
                    .collect::<PyResult<Vec<_>>>()?,
                Err(_) => return Err(refused),
            },
        };
        for (slot, horizons) in self.all().iter_mut().zip(horizons.chunks_exact(shape[1])) {
            slot.horizons.copy_from_slice(horizons);
        }
        Ok(())
    }
}
