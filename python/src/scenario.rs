//! Layouts: built-in, generated, from a file, or put together in Python.

use crate::arrays::{array, points};
use crate::error::refused;
use crate::values::{extend, value};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use toml::{Table, Value};

/// A layout of robots, set-points and obstacles.
///
/// robots: a list of `Robot`, or of dictionaries with start and set_point ([x, y], m) and perhaps name and radius (m).
/// obstacles: a list of `Obstacle`, or of dictionaries with position ([x, y], m) and perhaps name and radius (m).
/// name: as it is called in tables.
/// further: what else a scenario file may have: max_ticks, seed, allow_close_start, params={"vodca": {"turn": 0.2}}.
///
/// Raises `Error` where a layout cannot be run, with the place and what is allowed.
#[pyclass(module = "vodca", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct Scenario {
    pub(crate) layout: vodca::scenario::Scenario,
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (robots, obstacles = None, *, name = "scenario", **further))]
    fn new(
        robots: &Bound<'_, PyAny>,
        obstacles: Option<&Bound<'_, PyAny>>,
        name: &str,
        further: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let mut table = Table::new();
        table.insert("version".into(), Value::Integer(1));
        table.insert("name".into(), Value::String(name.into()));
        extend(&mut table, further)?;
        table.insert("robot".into(), value(robots, "robots")?);
        if let Some(obstacles) = obstacles {
            table.insert("obstacle".into(), value(obstacles, "obstacles")?);
        }
        let text = toml::to_string(&table).map_err(refused)?;
        Self::from_toml(&text, name)
    }

    /// The layout in the text of a scenario file.
    #[staticmethod]
    #[pyo3(signature = (text, name = "scenario"))]
    fn from_toml(text: &str, name: &str) -> PyResult<Self> {
        let layout = vodca::scenario::Scenario::from_toml(text, name, name).map_err(refused)?;
        Ok(Self { layout })
    }

    /// The layout of a name ("ex14_d", "ring:16"), a file or a number of robots.
    #[staticmethod]
    fn find(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self { layout: Asked::from(given)?.layout()? })
    }

    /// The layout as a scenario file, which reads back to the same bits.
    fn to_toml(&self) -> PyResult<String> {
        self.layout.to_toml().map_err(refused)
    }

    /// The layout with every start moved by a uniform draw of up to `spread` m per axis; the same `seed`, the same starts.
    #[pyo3(signature = (spread, seed, min_separation = 1.5))]
    fn jittered(&self, spread: f64, seed: u64, min_separation: f64) -> PyResult<Self> {
        Ok(Self { layout: self.layout.jittered(spread, min_separation, seed).map_err(refused)? })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.layout.name
    }

    /// The robots' names, by number.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.layout.robots.iter().map(|robot| robot.name.as_str()).collect()
    }

    /// Where the robots start, m, [robots, 2].
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.layout.robots.iter().map(|robot| robot.start), &[self.layout.robots.len()])
    }

    /// Where they want to be, m, [robots, 2].
    #[getter]
    fn set_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.layout.robots.iter().map(|robot| robot.set_point), &[self.layout.robots.len()])
    }

    /// The centres of the obstacles, m, [obstacles, 2].
    #[getter]
    fn obstacles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.layout.obstacles.iter().map(|obstacle| obstacle.position), &[self.layout.obstacles.len()])
    }

    /// The radii of the robots, m, [robots]; nan where none was given: half of model.min_separation.
    #[getter]
    fn radii<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let radii: Vec<f64> = self.layout.robots.iter().map(|robot| robot.radius.unwrap_or(f64::NAN)).collect();
        array(py, radii, &[self.layout.robots.len()])
    }

    /// The radii of the obstacles, m, [obstacles]; nan where none was given: half of model.min_separation.
    #[getter]
    fn obstacle_radii<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let radii = self.layout.obstacles.iter().map(|obstacle| obstacle.radius.unwrap_or(f64::NAN));
        array(py, radii.collect::<Vec<f64>>(), &[self.layout.obstacles.len()])
    }

    /// K, the most ticks of a run.
    #[getter]
    fn max_ticks(&self) -> u64 {
        self.layout.max_ticks
    }

    /// Seed of everything random in a run.
    #[getter]
    fn seed(&self) -> u64 {
        self.layout.seed
    }

    fn __len__(&self) -> usize {
        self.layout.robots.len()
    }

    fn __repr__(&self) -> String {
        let (robots, obstacles) = (self.layout.robots.len(), self.layout.obstacles.len());
        format!("<vodca.Scenario {}: {robots} robots, {obstacles} obstacles>", self.layout.name)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let this = slf.get();
        Ok((slf.getattr("from_toml")?, (this.to_toml()?, this.layout.name.clone())))
    }
}

/// The built-in layouts, by name.
#[pyfunction]
pub(crate) fn names() -> Vec<&'static str> {
    vodca::scenario::names().collect()
}

/// What may stand for a layout.
pub(crate) enum Asked {
    /// A name, a generated layout, a file.
    Spec(String),
    /// So many robots.
    Robots(usize),
    /// A layout.
    Layout(Box<vodca::scenario::Scenario>),
}

impl Asked {
    pub(crate) fn from(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(scenario) = given.cast::<Scenario>() {
            return Ok(Self::Layout(Box::new(scenario.get().layout.clone())));
        }
        if let Ok(spec) = given.extract::<String>() {
            return Ok(Self::Spec(spec));
        }
        if let Ok(robots) = given.extract::<usize>() {
            return Ok(Self::Robots(robots));
        }
        if let Ok(path) = given.extract::<PathBuf>() {
            // A path is a file, also without a `/` in it.
            let path = if path.components().count() > 1 { path } else { PathBuf::from(".").join(path) };
            return Ok(Self::Spec(path.to_string_lossy().into_owned()));
        }
        let kind = given.get_type().qualname()?;
        Err(PyTypeError::new_err(format!(
            "a scenario is a vodca.Scenario, a name (\"ex14_d\", \"ring:16\"), a file or a number of robots, not a {kind}"
        )))
    }

    fn layout(self) -> PyResult<vodca::scenario::Scenario> {
        match self {
            Self::Spec(spec) => vodca::scenario::Scenario::resolve(Some(&spec), None).map_err(refused),
            Self::Robots(robots) => vodca::scenario::Scenario::resolve(None, Some(robots)).map_err(refused),
            Self::Layout(layout) => Ok(*layout),
        }
    }
}
