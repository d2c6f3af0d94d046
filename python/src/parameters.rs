//! Parameters: what is known about each, and the effective ones of a run from a profile and what was given in Python.

use crate::error::{refused, wrong};
use crate::scenario::Asked;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};
use vodca::params::{Params, Profile, table};
use vodca::scenario::{Scenario, set_up};

/// Scenario and parameters of a run, checked together.
pub(crate) struct Setup {
    pub(crate) scenario: Scenario,
    pub(crate) params: Params,
    pub(crate) profile: Profile,
}

/// What runs, environments and controllers are told in common.
pub(crate) struct Given<'a, 'py> {
    pub(crate) scenario: &'a Bound<'py, PyAny>,
    pub(crate) profile: &'a str,
    pub(crate) seed: Option<u64>,
    pub(crate) max_ticks: Option<u64>,
    pub(crate) params: Option<&'a Bound<'py, PyAny>>,
    pub(crate) keywords: Option<&'a Bound<'py, PyDict>>,
}

impl Given<'_, '_> {
    /// The scenario and its effective parameters.
    pub(crate) fn set_up(&self) -> PyResult<Setup> {
        let profile: Profile = self.profile.parse().map_err(refused)?;
        let sets = sets(self.params, self.keywords)?;
        let (mut scenario, params) = match Asked::from(self.scenario)? {
            Asked::Spec(spec) => set_up(Some(&spec), None, profile, &sets).map_err(refused)?,
            Asked::Robots(robots) => set_up(None, Some(robots), profile, &sets).map_err(refused)?,
            Asked::Layout(layout) => {
                let params = Params::resolve(profile, &layout.name, &layout.params, &sets).map_err(refused)?;
                layout.validate_distances(params.model.min_separation).map_err(refused)?;
                (*layout, params)
            }
        };
        scenario.seed = self.seed.unwrap_or(scenario.seed);
        scenario.max_ticks = self.max_ticks.unwrap_or(scenario.max_ticks);
        scenario.validate().map_err(refused)?;
        Ok(Setup { scenario, params, profile })
    }
}

/// What was given as `--set` takes it: `{"vodca.turn": 0.2}`, `{"vodca": {"turn": 0.2}}` and `vodca_turn=0.2`.
fn sets(params: Option<&Bound<'_, PyAny>>, keywords: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<String>> {
    let mut sets = Vec::new();
    if let Some(params) = params.filter(|params| !params.is_none()) {
        let mapping = params
            .cast::<PyMapping>()
            .map_err(|_| wrong(format!("params = {params} is no dictionary; write params={{\"vodca.turn\": 0.2}}")))?;
        for item in mapping.items()?.iter() {
            let (key, value): (String, Bound<'_, PyAny>) = item.extract()?;
            match value.cast::<PyDict>() {
                Ok(fields) => {
                    for (field, value) in fields.iter() {
                        sets.push(format!("{key}.{field}={}", written(&value)?));
                    }
                }
                Err(_) => sets.push(format!("{key}={}", written(&value)?)),
            }
        }
    }
    for (keyword, value) in keywords.into_iter().flat_map(|keywords| keywords.iter()) {
        let keyword: String = keyword.extract()?;
        let entry = table::ENTRIES.iter().find(|entry| entry.key.replace('.', "_") == keyword);
        sets.push(format!("{}={}", entry.map_or(keyword.as_str(), |entry| entry.key), written(&value)?));
    }
    Ok(sets)
}

/// A value as people write it in TOML.
fn written(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_instance_of::<PyString>() {
        return value.extract();
    }
    let value = if value.hasattr("tolist")? { value.call_method0("tolist")? } else { value.clone() };
    Ok(match value.extract::<bool>() {
        Ok(switch) => switch.to_string(),
        Err(_) => value.repr()?.extract()?,
    })
}

/// A parameter: key, value, unit, what is allowed, source, effect.
type Known = (&'static str, Py<PyAny>, &'static str, String, &'static str, &'static str);

/// Every parameter: key, value in `profile`, unit, what is allowed, source, effect.
#[pyfunction]
#[pyo3(signature = (profile = "safe"))]
pub(crate) fn parameters(py: Python<'_>, profile: &str) -> PyResult<Vec<Known>> {
    let params = Params::of(profile.parse().map_err(refused)?);
    table::values(&params)
        .map(|(entry, value)| {
            let allowed = entry.allowed.to_string();
            Ok((entry.key, python(py, &value)?, entry.unit, allowed, entry.source, entry.effect))
        })
        .collect()
}

/// The effective parameters of a run as a dictionary, key by key.
#[pyfunction]
#[pyo3(signature = (scenario, *, profile = "safe", params = None, **keywords))]
pub(crate) fn effective<'py>(
    py: Python<'py>,
    scenario: &Bound<'py, PyAny>,
    profile: &str,
    params: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let setup = Given { scenario, profile, seed: None, max_ticks: None, params, keywords }.set_up()?;
    dictionary(py, &setup.params)
}

/// `params` as a dictionary, key by key.
pub(crate) fn dictionary<'py>(py: Python<'py>, params: &Params) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for (entry, value) in table::values(params) {
        all.set_item(entry.key, python(py, &value)?)?;
    }
    Ok(all)
}

/// A parameter's value: a number, a switch or a word.
fn python(py: Python<'_>, value: &toml::Value) -> PyResult<Py<PyAny>> {
    Ok(match value {
        toml::Value::Boolean(switch) => switch.into_pyobject(py)?.to_owned().into_any().unbind(),
        toml::Value::Integer(number) => number.into_pyobject(py)?.into_any().unbind(),
        toml::Value::Float(number) => number.into_pyobject(py)?.into_any().unbind(),
        toml::Value::String(word) => word.into_pyobject(py)?.into_any().unbind(),
        other => other.to_string().into_pyobject(py)?.into_any().unbind(),
    })
}
