//! Python's numbers, words, lists and dictionaries as TOML, in which scenarios and parameters are read.

use crate::error::wrong;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use toml::{Table, Value};

/// `given` as TOML; `place` is named in errors. What is `None` in a dictionary is left out.
pub(crate) fn value(given: &Bound<'_, PyAny>, place: &str) -> PyResult<Value> {
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyInt>() {
        let number = given.extract().map_err(|_| wrong(format!("{place} = {given} is too large a number")))?;
        return Ok(Value::Integer(number));
    }
    if given.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(given.extract()?));
    }
    if given.is_instance_of::<PyString>() {
        return Ok(Value::String(given.extract()?));
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        let items = given.try_iter()?.enumerate();
        return items
            .map(|(index, item)| value(&item?, &format!("{place}[{index}]")))
            .collect::<PyResult<_>>()
            .map(Value::Array);
    }
    if let Ok(mapping) = given.cast::<PyMapping>() {
        return table(mapping, place).map(Value::Table);
    }
    // NumPy's arrays and numbers.
    if given.hasattr("tolist")? {
        return value(&given.call_method0("tolist")?, place);
    }
    if given.hasattr("__dataclass_fields__")? {
        let fields = given.getattr("__dict__")?;
        return table(fields.cast::<PyMapping>()?, place).map(Value::Table);
    }
    let kind = given.get_type().qualname()?;
    Err(wrong(format!("{place} is a {kind}; write numbers, words, lists or dictionaries")))
}

/// A dictionary as a table.
pub(crate) fn table(given: &Bound<'_, PyMapping>, place: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for item in given.items()?.iter() {
        let (key, given): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        if !given.is_none() {
            let key: String = key.extract().map_err(|_| wrong(format!("{place}: the key {key} is no text")))?;
            let inside = value(&given, &format!("{place}.{key}"))?;
            table.insert(key, inside);
        }
    }
    Ok(table)
}

/// The entries of `further` into `table`.
pub(crate) fn extend(table: &mut Table, further: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
    if let Some(further) = further {
        for (key, given) in further.iter().filter(|(_, given)| !given.is_none()) {
            let key: String = key.extract()?;
            let inside = value(&given, &key)?;
            table.insert(key, inside);
        }
    }
    Ok(())
}
