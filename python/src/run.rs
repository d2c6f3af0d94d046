//! Runs: played in this process, or read from the folder of a recorded one.

use crate::arrays::{array, points};
use crate::error::{refused, wrong};
use crate::horizons::{Chosen, Source};
use crate::parameters::{Given, Setup, dictionary};
use crate::scenario::Scenario;
use coordinator::record::about::{About, Machine, Versions};
use coordinator::record::{RunFolder, trajectory};
use coordinator::session::Session;
use coordinator::summary::{End, Summary, Timings};
use coordinator::tick_parts::TickTimes;
use evaluation::in_process::run_team;
use evaluation::page::recorded::Recorded;
use evaluation::page::{report, run_data};
use policy::reward::Reward;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use vodca::Position;
use vodca::metrics::RunMetrics;
use vodca::play::Halt;
use vodca::step::{Level, Status, Step};

/// Ticks between two looks for Ctrl-C.
const LOOK_AROUND: u64 = 8;

/// A run, tick by tick.
#[pyclass(module = "vodca", frozen)]
pub(crate) struct Run {
    recorded: Recorded,
    /// How it came about and ended, of a run that was played here.
    played: Option<(About, End)>,
}

/// Plays a run in this process.
#[pyfunction]
#[pyo3(signature = (scenario, *, profile = "safe", horizon = None, seed = None, max_ticks = None, params = None, **keywords))]
#[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn run(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    profile: &str,
    horizon: Option<&Bound<'_, PyAny>>,
    seed: Option<u64>,
    max_ticks: Option<u64>,
    params: Option<&Bound<'_, PyAny>>,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<Run> {
    let setup = Given { scenario, profile, seed, max_ticks, params, keywords }.set_up()?;
    let source = Source::of(horizon, &setup.scenario, &setup.params)?;
    py.detach(|| play(setup, source))
}

fn play(setup: Setup, Source { name, mut chosen }: Source) -> PyResult<Run> {
    let Setup { scenario, params, profile } = setup;
    let mut ticks: Vec<Vec<Step>> = Vec::new();
    let mut timings = Timings::new(scenario.robots.len());
    let on_tick = |tick: u64, steps: &[Step]| {
        timings.observe(&TickTimes::default(), steps);
        ticks.push(steps.to_vec());
        if tick.is_multiple_of(LOOK_AROUND) { Python::attach(|py| py.check_signals()) } else { Ok(()) }
    };
    let metrics = match run_team::<Chosen, PyErr>(&scenario, &params, &mut chosen, on_tick) {
        Ok(metrics) => metrics,
        Err(Halt::Horizons(error) | Halt::Observer(error)) => return Err(error),
        Err(Halt::Team(never)) => match never {},
    };
    let about = About {
        version: 1,
        scenario: scenario.name.clone(),
        robots: scenario.robots.len(),
        profile: profile.to_string(),
        horizon: name,
        seed: scenario.seed,
        exchange: "none".into(),
        real_time: false,
        chaos: None,
        command: vec!["vodca.run".into(), scenario.name.clone()],
        versions: Versions::here(),
        machine: Machine::here(),
    };
    let end = if metrics.arrived_all() { End::Arrived } else { End::OutOfTicks };
    let names = (about.profile.as_str(), about.horizon.as_str());
    let summary = Summary::new(&scenario, &params, names, end, metrics.finish(), &timings);
    let recorded = Recorded {
        folder: PathBuf::new(),
        scenario,
        params,
        about: serde_json::to_value(&about).map_err(refused)?,
        summary: serde_json::to_value(&summary).map_err(refused)?,
        ticks,
        tick_ns: Vec::new(),
    };
    Ok(Run { recorded, played: Some((about, end)) })
}

/// Reads the folder of a recorded run.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, folder: PathBuf) -> PyResult<Run> {
    let recorded = py.detach(|| Recorded::read(&folder)).map_err(refused)?;
    Ok(Run { recorded, played: None })
}

impl Run {
    fn robots(&self) -> usize {
        self.recorded.scenario.robots.len()
    }

    fn shape(&self) -> [usize; 2] {
        [self.recorded.ticks.len(), self.robots()]
    }

    fn steps(&self) -> impl Iterator<Item = &Step> {
        self.recorded.ticks.iter().flatten()
    }

    /// Where everybody was at the end, m.
    fn last(&self) -> Vec<Position> {
        match self.recorded.ticks.last() {
            Some(steps) => steps.iter().map(|step| step.next_position).collect(),
            None => self.recorded.scenario.robots.iter().map(|robot| robot.start).collect(),
        }
    }

    fn step(&self, tick: usize, robot: usize) -> PyResult<&Step> {
        let [ticks, robots] = self.shape();
        let step = self.recorded.ticks.get(tick).and_then(|steps| steps.get(robot));
        step.ok_or_else(|| {
            wrong(format!("there is no tick {tick} of robot {robot}: the run has {ticks} ticks and {robots} robots"))
        })
    }
}

#[pymethods]
impl Run {
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [ticks, robots] = self.shape();
        points(py, self.steps().map(|step| step.position).chain(self.last()), &[ticks + 1, robots])
    }

    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.steps().map(|step| step.input), &self.shape())
    }

    fn horizons<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.steps().map(|step| step.horizon.steps() as u8).collect(), &self.shape())
    }

    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.steps().map(|step| step.rows).collect(), &self.shape())
    }

    fn levels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.steps().map(|step| step.level.number()).collect(), &self.shape())
    }

    fn statuses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.steps().map(|step| step.status.number()).collect(), &self.shape())
    }

    fn separations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Recorded { scenario, params, ticks, .. } = &self.recorded;
        let alone = |least: f64| if least < 0.0 { f64::INFINITY } else { least };
        let all = run_data::separations(scenario, params, ticks).into_iter().map(alone).collect();
        array(py, all, &self.shape())
    }

    fn rewards<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let reward = Reward::new(&self.recorded.scenario, &self.recorded.params);
        let ticks = self.recorded.ticks.iter().enumerate();
        let all: Vec<f64> = ticks.map(|(tick, steps)| reward.tick(tick as u64, steps).terms.total()).collect();
        let shape = [all.len()];
        array(py, all, &shape)
    }

    fn robot_rewards<'py>(&self, py: Python<'py>, objective: bool) -> PyResult<Bound<'py, PyAny>> {
        let reward = Reward::new(&self.recorded.scenario, &self.recorded.params);
        let mut all = Vec::new();
        for (tick, steps) in self.recorded.ticks.iter().enumerate() {
            let shares = (0..steps.len()).map(|robot| reward.share(tick as u64, robot, steps));
            all.extend(shares.map(|share| if objective { share.objective() } else { share.total() }));
        }
        array(py, all, &self.shape())
    }

    fn plan<'py>(&self, py: Python<'py>, tick: usize, robot: usize) -> PyResult<Bound<'py, PyAny>> {
        let states = self.step(tick, robot)?.plan.states();
        points(py, states.iter().copied(), &[states.len()])
    }

    #[getter]
    fn ticks(&self) -> usize {
        self.recorded.ticks.len()
    }

    #[getter]
    fn scenario(&self) -> Scenario {
        Scenario { layout: self.recorded.scenario.clone() }
    }

    fn params<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, &self.recorded.params)
    }

    fn summary(&self) -> String {
        self.recorded.summary.to_string()
    }

    fn about(&self) -> String {
        self.recorded.about.to_string()
    }

    #[getter]
    fn folder(&self) -> Option<&Path> {
        Some(self.recorded.folder.as_path()).filter(|folder| !folder.as_os_str().is_empty())
    }

    fn trajectory(&self) -> String {
        let mut text = format!("{}\n", trajectory::HEADER);
        for (tick, steps) in self.recorded.ticks.iter().enumerate() {
            trajectory::push_tick(&mut text, tick as u64, steps);
        }
        trajectory::push_end(&mut text, self.recorded.ticks.len() as u64, &self.last());
        text
    }

    fn report(&self, py: Python<'_>) -> String {
        py.detach(|| report(std::slice::from_ref(&self.recorded)))
    }

    fn save(&self, py: Python<'_>, folder: Option<PathBuf>) -> PyResult<PathBuf> {
        let Recorded { scenario, params, ticks, folder: recorded, .. } = &self.recorded;
        let Some((about, end)) = &self.played else {
            return Err(wrong(format!("this run is recorded already, in {}; copy that folder", recorded.display())));
        };
        py.detach(|| {
            let folder = RunFolder::create(folder.as_deref(), &scenario.name, scenario.robots.len())?;
            let mut session = Session::start(folder, scenario, params, about.clone())?;
            let mut metrics = RunMetrics::new(scenario, params);
            for (tick, steps) in ticks.iter().enumerate() {
                metrics.observe(tick as u64, steps);
                session.record(tick as u64, steps, &TickTimes::default())?;
            }
            session.finish(*end, &metrics, None).map(|(_, folder)| folder)
        })
        .map_err(refused)
    }

    #[classattr]
    #[pyo3(name = "LEVELS")]
    fn level_words() -> Vec<&'static str> {
        Level::ALL.into_iter().map(Level::word).collect()
    }

    #[classattr]
    #[pyo3(name = "STATUSES")]
    fn status_words() -> Vec<&'static str> {
        Status::ALL.into_iter().map(Status::word).collect()
    }
}
