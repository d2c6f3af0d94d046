//! Who chooses the horizons of a run: a SPEC of the command line, numbers, or a Python function.

use crate::arrays::points;
use crate::error::{refused, wrong};
use pyo3::prelude::*;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSource, HorizonSpec, Horizons};
use vodca::params::Params;
use vodca::scenario::Scenario;

/// Chooses the horizons of a run.
pub(crate) enum Chosen {
    /// A table, as on the command line.
    Table(HorizonSource),
    /// A row for every tick; the last one holds for later ticks. Never jittered, as scripts are not.
    Rows(Vec<Vec<Horizon>>),
    /// `function(tick, measured)`.
    Function(Py<PyAny>),
}

/// How it is named in records.
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) chosen: Chosen,
}

impl Source {
    pub(crate) fn of(given: Option<&Bound<'_, PyAny>>, scenario: &Scenario, params: &Params) -> PyResult<Self> {
        let robots = scenario.robots.len();
        let table = |spec: HorizonSpec| {
            let table = HorizonSource::new(&spec, robots, scenario.seed, params.horizon.jitter).map_err(refused)?;
            Ok(Self { name: spec.to_string(), chosen: Chosen::Table(table) })
        };
        let Some(given) = given.filter(|given| !given.is_none()) else {
            return table("fixed:20".parse().map_err(refused)?);
        };
        if let Ok(spec) = given.extract::<String>() {
            return table(spec.parse().map_err(refused)?);
        }
        if given.is_callable() {
            return Ok(Self { name: "python".into(), chosen: Chosen::Function(given.clone().unbind()) });
        }
        if let Ok(steps) = given.extract::<u64>() {
            return table(format!("fixed:{steps}").parse().map_err(refused)?);
        }
        if let Ok(steps) = given.extract::<Vec<u64>>() {
            let list: Vec<String> = steps.iter().map(u64::to_string).collect();
            return table(format!("fixed:{}", list.join(",")).parse().map_err(refused)?);
        }
        if let Ok(rows) = given.extract::<Vec<Vec<u64>>>() {
            let rows: Vec<Vec<Horizon>> = rows
                .iter()
                .enumerate()
                .map(|(tick, row)| checked(row, robots, tick as u64))
                .collect::<PyResult<_>>()?;
            if rows.is_empty() {
                return Err(wrong("horizon has no rows; give a row of horizons for every tick"));
            }
            return Ok(Self { name: "script:python".into(), chosen: Chosen::Rows(rows) });
        }
        Err(wrong(format!(
            "horizon = {given} is not known; the forms are 20, [9, 40] (one per robot), an array [ticks, robots], \
             function(tick, positions) -> horizons, and those of --horizon: \"fixed:20\", \"random:3\", \"script:FILE\""
        )))
    }
}

/// A horizon for every robot.
fn checked(row: &[u64], robots: usize, tick: u64) -> PyResult<Vec<Horizon>> {
    if row.len() != robots {
        return Err(wrong(format!("{} horizons for {robots} robots at tick {tick}; give one per robot", row.len())));
    }
    row.iter().map(|&steps| Horizon::new(steps).map_err(|error| wrong(format!("at tick {tick}: {error}")))).collect()
}

impl Horizons for Chosen {
    type Error = PyErr;

    fn choose(&mut self, tick: u64, measured: &[Position], out: &mut [Horizon]) -> PyResult<()> {
        match self {
            Self::Table(table) => match table.choose(tick, measured, out) {
                Ok(()) => {}
                Err(never) => match never {},
            },
            Self::Rows(rows) => {
                let last = rows.len() - 1;
                out.copy_from_slice(&rows[usize::try_from(tick).map_or(last, |tick| tick.min(last))]);
            }
            Self::Function(function) => Python::attach(|py| {
                let positions = points(py, measured.iter().copied(), &[measured.len()])?;
                let answer = function.bind(py).call1((tick, positions))?;
                let row = match answer.extract::<u64>() {
                    Ok(steps) => vec![steps; out.len()],
                    Err(_) => answer.extract::<Vec<u64>>().map_err(|_| {
                        wrong(format!(
                            "horizon({tick}, positions) gave {answer}; give a whole number, or one per robot"
                        ))
                    })?,
                };
                out.copy_from_slice(&checked(&row, out.len(), tick)?);
                Ok::<(), PyErr>(())
            })?,
        }
        Ok(())
    }
}
