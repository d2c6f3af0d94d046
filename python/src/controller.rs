//! One robot's controller, called tick by tick from a simulator of the user's own.

use crate::arrays::{point, points};
use crate::error::{refused, wrong};
use crate::parameters::{Given, Setup, dictionary};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use vodca::Position;
use vodca::baseline::orca::OrcaController;
use vodca::controller::{Controller as OneRobot, Decision as Decided, Neighbour, View};
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::layout::Layout;
use vodca::params::{ControllerKind, Params};
use vodca::prediction::Prediction;
use vodca::vodca_controller::VodcaController;

/// A robot's plan, as the others hear it.
///
/// tick: when it was made.  states: 2..=50 places, m, [horizon + 1, 2]; the first one: where the robot planned, the next
/// one: where it will be at the next tick.  set_point: where it wants to be, [x, y], m.
#[pyclass(module = "vodca", frozen)]
#[derive(Clone)]
pub(crate) struct Plan {
    tick: u64,
    prediction: Prediction,
}

#[pymethods]
impl Plan {
    #[new]
    #[pyo3(signature = (tick, states, set_point))]
    fn new(tick: u64, states: Vec<Bound<'_, PyAny>>, set_point: &Bound<'_, PyAny>) -> PyResult<Self> {
        if !(2..=MAX_HORIZON + 1).contains(&states.len()) {
            return Err(wrong(format!("a plan of {} states; allowed: 2..={}", states.len(), MAX_HORIZON + 1)));
        }
        let states: Vec<Position> = states.iter().map(|state| point(state, "a state")).collect::<PyResult<_>>()?;
        Ok(Self { tick, prediction: Prediction::from_states(&states, point(set_point, "set_point")?) })
    }

    /// The tick at which it was made.
    #[getter]
    fn tick(&self) -> u64 {
        self.tick
    }

    /// Its number of steps.
    #[getter]
    fn horizon(&self) -> usize {
        self.prediction.horizon().steps()
    }

    /// Its places, m, [horizon + 1, 2].
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let states = self.prediction.states();
        points(py, states.iter().copied(), &[states.len()])
    }

    /// Where the robot wants to be, m, [2].
    #[getter]
    fn set_point<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, [self.prediction.set_point], &[])
    }

    fn __repr__(&self) -> String {
        format!("<vodca.Plan of tick {}: {} steps>", self.tick, self.prediction.horizon())
    }
}

/// What a robot decided in a tick.
#[pyclass(module = "vodca", frozen)]
pub(crate) struct Decision {
    tick: u64,
    decided: Decided,
}

#[pymethods]
impl Decision {
    /// The velocity to drive with during this tick, m/s, world frame, [2].
    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, [self.decided.input], &[])
    }

    /// What the other robots have to hear before the next tick.
    #[getter]
    fn plan(&self) -> Plan {
        Plan { tick: self.tick, prediction: self.decided.plan.clone() }
    }

    /// Collision rows of the QP.
    #[getter]
    fn rows(&self) -> u32 {
        self.decided.rows
    }

    /// Which solver gave the plan: "closed_form", "structured", "clarabel", "fallback"; "baseline": no MPC.
    #[getter]
    fn level(&self) -> &'static str {
        self.decided.level.word()
    }

    /// How the plan came about: "solved", "relaxed", "held", "shifted", "stopped".
    #[getter]
    fn status(&self) -> &'static str {
        self.decided.status.word()
    }

    /// Whether the safety filter changed the input.
    #[getter]
    fn filtered(&self) -> bool {
        self.decided.filtered
    }

    /// Time in the QP's solvers, ns.
    #[getter]
    fn solve_ns(&self) -> u64 {
        self.decided.solve_ns
    }

    fn __repr__(&self) -> String {
        let Decided { input, rows, status, .. } = &self.decided;
        format!("<vodca.Decision: [{:.3}, {:.3}] m/s, {rows} rows, {}>", input.x, input.y, status.word())
    }
}

/// One robot's controller, tick by tick, for a simulator or robots of your own.
///
/// A tick: `tick` of every robot's controller, then `hear` of every other robot's plan, then everybody drives with its input
/// for model.sample_time. A plan that is not heard is lost; robots without plans are `see`n.
///
/// scenario: set-points, radii and obstacles (as of `vodca.run`).  robot: its number in it, from 0.
/// profile, params, keywords: as of `vodca.run`.  seed: of ORCA's pushes.
#[pyclass(module = "vodca")]
pub(crate) struct Controller {
    controller: Box<dyn OneRobot + Sync>,
    params: Params,
    robot: usize,
    tick: u64,
    neighbours: Vec<Neighbour>,
}

#[pymethods]
impl Controller {
    #[new]
    #[pyo3(signature = (scenario, robot, *, profile = "safe", seed = None, params = None, **keywords))]
    fn new(
        scenario: &Bound<'_, PyAny>,
        robot: usize,
        profile: &str,
        seed: Option<u64>,
        params: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let given = Given { scenario, profile, seed, max_ticks: None, params, keywords };
        let Setup { scenario, params, .. } = given.set_up()?;
        let robots = scenario.robots.len();
        if robot >= robots {
            return Err(wrong(format!("robot = {robot} is not allowed; allowed: 0..={}", robots - 1)));
        }
        let layout = Arc::new(Layout::of(&scenario, &params.model));
        let controller: Box<dyn OneRobot + Sync> = match params.controller.kind {
            ControllerKind::Vodca => Box::new(VodcaController::new(robot, &params, &layout)),
            ControllerKind::Orca => Box::new(OrcaController::new(robot, &params, &layout, scenario.seed)),
        };
        let neighbours =
            scenario.robots.iter().map(|robot| Neighbour::at_start(robot.start, robot.set_point)).collect();
        Ok(Self { controller, params, robot, tick: 0, neighbours })
    }

    /// Decides the next tick of the robot that measures itself at `position` ([x, y], m) over `horizon` steps, 1..49.
    #[pyo3(signature = (position, horizon = 20))]
    fn tick(&mut self, position: &Bound<'_, PyAny>, horizon: u64) -> PyResult<Decision> {
        let position = point(position, "position")?;
        let horizon = Horizon::new(horizon).map_err(refused)?;
        let view = View { tick: self.tick, horizon, position, neighbours: &self.neighbours };
        let decided = self.controller.tick(&view);
        let tick = self.tick;
        self.tick += 1;
        Ok(Decision { tick, decided })
    }

    /// Hears the newest `plan` of another robot. It must be of a tick that has been decided here already.
    fn hear(&mut self, robot: usize, plan: &Plan) -> PyResult<()> {
        let now = self.tick;
        if plan.tick >= now {
            return Err(wrong(format!(
                "the plan of robot {robot} is of tick {}, but tick {now} has not been planned here yet: everybody plans a \
                 tick from the plans of the one before; call tick() of all robots first, then hear()",
                plan.tick
            )));
        }
        let neighbour = self.neighbour(robot)?;
        // What comes late is not newer than what is known already.
        if neighbour.plan.as_ref().is_none_or(|(known, _)| *known < plan.tick) {
            neighbour.plan = Some((plan.tick, plan.prediction.clone()));
            neighbour.set_point = plan.prediction.set_point;
            neighbour.toward = plan.prediction.toward;
        }
        if neighbour.present.is_none_or(|(known, _)| known < plan.tick + 1) {
            neighbour.present = Some((plan.tick + 1, plan.prediction.state(1)));
        }
        Ok(())
    }

    /// Sees another robot at `position` ([x, y], m) at the start of the next tick; `set_point`: where it seems to want to be.
    #[pyo3(signature = (robot, position, set_point = None))]
    fn see(&mut self, robot: usize, position: &Bound<'_, PyAny>, set_point: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let (now, position) = (self.tick, point(position, "position")?);
        let set_point = set_point.map(|given| point(given, "set_point")).transpose()?;
        let neighbour = self.neighbour(robot)?;
        neighbour.present = Some((now, position));
        if let Some(set_point) = set_point {
            (neighbour.set_point, neighbour.toward) = (set_point, set_point);
        }
        Ok(())
    }

    /// The robot's number.
    #[getter]
    fn robot(&self) -> usize {
        self.robot
    }

    /// The tick that is decided next.
    #[getter]
    fn next_tick(&self) -> u64 {
        self.tick
    }

    /// How long an input is held, s.
    #[getter]
    fn sample_time(&self) -> f64 {
        self.params.model.sample_time
    }

    /// The effective parameters, by key.
    fn params<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, &self.params)
    }
}

impl Controller {
    fn neighbour(&mut self, robot: usize) -> PyResult<&mut Neighbour> {
        let robots = self.neighbours.len();
        let known = self.neighbours.get_mut(robot);
        known.ok_or_else(|| wrong(format!("there is no robot {robot}; the scenario has {robots}, counted from 0")))
    }
}
